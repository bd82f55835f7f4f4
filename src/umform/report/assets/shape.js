// The picture in space: observer, controls, player, legend.

const VIEWS = { oblique: [-0.55, -1, 0.5], below: [-0.55, -1, -0.5], front: [0, -1, 0], side: [1, 0, 0], top: [0, -1e-4, 1] };

class ShapeView {
  constructor(scene) {
    this.canvas = element("shape-canvas");
    THREE.ColorManagement.enabled = false;
    this.renderer = new THREE.WebGLRenderer({ canvas: this.canvas, antialias: true, alpha: true });
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
    this.world = new THREE.Scene();
    this.fill(scene);
    this.camera = new THREE.OrthographicCamera();
    this.camera.up.set(0, 0, 1);
    this.orbit = new THREE.OrbitControls(this.camera, this.canvas);
    this.orbit.enableZoom = false; // until the picture is chosen, the wheel moves the page
    this.orbit.zoomToCursor = true;
    this.corners = this.cornersOfPath();
    this.frame = this.count - 1;
    this.field = this.head.fields[0];
    this.listen();
    this.resize();
    this.look("oblique");
    this.show();
  }

  // The bodies of a scene, in place of those before.
  fill(scene) {
    this.world.traverse((one) => [one.geometry, one.material].forEach((part) => part?.dispose()));
    this.world.clear();
    this.head = scene.head;
    this.count = scene.head.frames.length;
    this.sheet = new Sheet(scene);
    this.tools = scene.head.tools.map((_, number) => new ToolBody(scene, number));
    this.world.add(this.sheet.mesh, this.sheet.lines, this.sheet.axes, ...this.tools.map((tool) => tool.group));
    this.images = new THREE.Group();
    for (const image of [this.sheet, ...this.tools].flatMap((body) => body.images)) this.images.add(image);
    this.world.add(this.images);
  }

  // A later state of the same run: field and choices stay, the view too once it was turned, the last frame is the last.
  renew(scene) {
    const last = this.frame === this.count - 1;
    this.fill(scene);
    this.field = this.head.fields.find(({ name }) => name === this.field.name) ?? this.head.fields[0];
    element("shape-field").replaceChildren(...this.head.fields.map(({ label }) => new Option(label)));
    element("shape-field").selectedIndex = this.head.fields.indexOf(this.field);
    element("shape-frame").max = this.count - 1;
    this.frame = last ? this.count - 1 : Math.min(this.frame, this.count - 1);
    this.corners = this.cornersOfPath();
    if (this.side) this.look(this.side);
    else this.before();
    this.show();
  }

  get whole() {
    return element("shape-whole").checked;
  }

  // Corners of a box around the sheet in all frames, with its mirror images if they are shown.
  cornersOfPath() {
    const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
    for (let frame = 0; frame < this.count; frame += 1) {
      this.sheet.points(frame).forEach((x, i) => {
        low[i % 3] = Math.min(low[i % 3], x);
        high[i % 3] = Math.max(high[i % 3], x);
      });
    }
    for (const { axis, at } of this.whole ? this.head.mirrors : []) {
      [low[axis], high[axis]] = [Math.min(low[axis], 2 * at - high[axis]), Math.max(high[axis], 2 * at - low[axis])];
    }
    return [0, 1, 2, 3, 4, 5, 6, 7].map((n) => new THREE.Vector3(...low.map((x, i) => ((n >> i) & 1 ? high[i] : x))));
  }

  listen() {
    const on = (id, event, act) => element(id).addEventListener(event, act);
    on("shape-field", "change", (event) => {
      this.field = this.head.fields[event.target.selectedIndex];
      this.show();
    });
    on("shape-scale", "change", () => this.show());
    on("shape-lines", "change", () => this.show());
    on("shape-rolling", "change", () => this.show());
    on("shape-tools", "change", () => this.show());
    on("shape-whole", "change", () => {
      this.corners = this.cornersOfPath();
      this.look("oblique");
      this.show();
    });
    on("shape-frame", "input", (event) => {
      this.pause();
      this.goto(Number(event.target.value));
    });
    on("shape-options", "click", () => {
      const open = element("shape-bar").classList.toggle("open"); // on a small screen only; else they are always open
      element("shape-options").setAttribute("aria-expanded", String(open));
    });
    on("shape-play", "click", () => (this.playing ? this.pause() : this.play()));
    document.querySelectorAll("[data-view]").forEach((button) => {
      button.addEventListener("click", () => this.look(button.dataset.view));
    });
    this.orbit.addEventListener("change", () => this.draw());
    this.orbit.addEventListener("start", () => (this.side = null));
    this.canvas.addEventListener("pointerdown", () => this.canvas.focus({ preventScroll: true }));
    this.canvas.addEventListener("focus", () => (this.orbit.enableZoom = true));
    this.canvas.addEventListener("blur", () => (this.orbit.enableZoom = false));
    this.canvas.addEventListener("keydown", (event) => this.key(event));
    this.canvas.addEventListener("pointermove", (event) => this.probe(event));
    this.canvas.addEventListener("pointerleave", () => (element("shape-probe").hidden = true));
    new ResizeObserver(() => this.resize()).observe(this.canvas.parentElement);
    document.addEventListener("row", (event) => this.gotoRow(event.detail));
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    if (!clientWidth || !clientHeight) return;
    this.renderer.setPixelRatio(window.devicePixelRatio);
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.frustum();
    this.draw();
  }

  // What the picture spans: `reach` (half width, half height) fits left of the legend.
  frustum() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    const free = width - element("legend").offsetWidth - 24;
    const [across, up] = this.reach ?? [1, 1];
    const unit = Math.max((2 * across) / free, (2 * up) / height); // length of a pixel
    Object.assign(this.camera, {
      left: -0.5 * free * unit, right: (width - 0.5 * free) * unit, top: 0.5 * height * unit, bottom: -0.5 * height * unit,
    });
    this.camera.updateProjectionMatrix();
  }

  // Look from a side, so that the whole path of the sheet is in the picture.
  look(name) {
    this.side = name;
    const centre = this.corners[0].clone().add(this.corners[7]).multiplyScalar(0.5);
    const towards = new THREE.Vector3(...VIEWS[name]).normalize();
    const right = new THREE.Vector3().crossVectors(this.camera.up, towards).normalize();
    const up = new THREE.Vector3().crossVectors(towards, right);
    const arms = this.corners.map((corner) => corner.clone().sub(centre));
    this.reach = [right, up].map((axis) => 1.15 * Math.max(...arms.map((arm) => Math.abs(arm.dot(axis)))));
    const far = 8 * arms[0].length();
    this.camera.position.copy(centre).addScaledVector(towards, 0.5 * far);
    Object.assign(this.camera, { zoom: 1, near: 0, far });
    this.before();
    this.orbit.target.copy(centre);
    this.frustum();
    this.orbit.update();
    this.draw();
  }

  // Lines and tools are drawn before what they lie on, by parts of the size of the path.
  before() {
    const size = this.corners[0].distanceTo(this.corners[7]);
    const nearer = (part) => (2 * part * size) / (this.camera.far - this.camera.near); // the depth is 2 in the picture
    this.sheet.before(nearer(this.head.look.before.lines));
    for (const tool of this.tools) tool.before(nearer(this.head.look.before.tools));
  }

  key(event) {
    const turn = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    const zoom = { "+": 1.1, "=": 1.1, "-": 1 / 1.1 }[event.key];
    const arm = this.camera.position.clone().sub(this.orbit.target);
    if (turn) {
      arm.applyAxisAngle(this.camera.up, turn[0] * 0.1);
      const right = new THREE.Vector3().crossVectors(this.camera.up, arm).normalize();
      arm.applyAxisAngle(right, turn[1] * 0.1);
    } else if (zoom) {
      this.camera.zoom *= zoom;
      this.camera.updateProjectionMatrix();
    } else if (event.key === "Home") {
      this.look("oblique");
    } else {
      return;
    }
    event.preventDefault();
    if (event.key !== "Home") {
      this.side = null;
      this.camera.position.copy(this.orbit.target).add(arm);
    }
    this.orbit.update();
    this.draw();
  }

  goto(frame) {
    this.frame = frame;
    this.show();
  }

  // The frame that is nearest to a row of the history.
  gotoRow(row) {
    const far = this.head.frames.map((mark) => Math.abs(mark.row - row));
    this.pause();
    this.goto(far.indexOf(Math.min(...far)));
  }

  play() {
    if (this.count < 2) return;
    this.playing = true;
    this.button("Pause", true);
    const each = Math.max(1000 / 25, Math.min(250, 5000 / this.count));
    let last = performance.now();
    if (this.frame === this.count - 1) this.goto(0);
    const next = (now) => {
      if (!this.playing) return;
      if (now - last >= each) {
        last = now;
        this.goto(this.frame + 1);
        if (this.frame === this.count - 1) this.pause();
      }
      requestAnimationFrame(next);
    };
    requestAnimationFrame(next);
  }

  pause() {
    this.playing = false;
    this.button("Play", false);
  }

  button(name, pressed) {
    const play = element("shape-play");
    play.setAttribute("aria-label", name);
    play.setAttribute("aria-pressed", String(pressed));
  }

  // Bring everything to the present frame and choice.
  show() {
    const range = this.sheet.range(this.field, element("shape-scale").value === "all" ? undefined : this.frame);
    this.sheet.show(this.frame, this.field, range);
    this.sheet.lined(element("shape-lines").checked);
    this.sheet.rolled(this.head.rolling && element("shape-rolling").checked);
    this.images.visible = this.whole;
    this.sheet.faces.whole(this.whole);
    for (const tool of this.tools) {
      tool.place(this.frame);
      tool.look(element("shape-tools").value);
    }
    this.legend(range);
    const { row } = this.head.frames[this.frame];
    element("shape-frame").value = this.frame;
    const { curves } = window.umform;
    element("shape-step").textContent = curves.step(row);
    element("shape-time").textContent = `${curves.place(row)} · state ${this.frame} of ${this.count - 1}`;
    element("shape-time").dataset.row = row;
    document.dispatchEvent(new CustomEvent("frame", { detail: row }));
    this.draw();
  }

  legend([bottom, top]) {
    const hex = this.head.look.map;
    const colours = Array.from({ length: 16 }, (_, i) => `#${hex.substr(6 * Math.round((i * 63) / 15), 6)}`);
    element("legend-name").textContent = this.field.label;
    element("legend-bar").style.background = `linear-gradient(to top, ${colours.join(", ")})`;
    const rows = top > bottom ? [0, 1, 2, 3, 4].map((i) => bottom + ((top - bottom) * i) / 4) : [bottom];
    element("legend-ticks").replaceChildren(...rows.reverse().map((value) => {
      const row = document.createElement("span");
      row.textContent = Math.abs(value) < 1e-9 * Math.max(-bottom, top) ? "0" : digits(Number(value.toPrecision(3)));
      return row;
    }));
  }

  // The value under the pointer.
  probe(event) {
    const label = element("shape-probe");
    label.hidden = true;
    if (event.buttons || this.playing) return;
    const box = this.canvas.getBoundingClientRect();
    const [x, y] = [event.clientX - box.left, event.clientY - box.top];
    const ray = new THREE.Raycaster();
    ray.setFromCamera(new THREE.Vector2((2 * x) / box.width - 1, 1 - (2 * y) / box.height), this.camera);
    const images = this.whole ? this.sheet.images.map((image) => image.children[0].children[0]) : [];
    const [hit] = ray.intersectObjects([this.sheet.mesh, ...images], false);
    if (!hit) return;
    const { array } = this.sheet.faces.geometry.getAttribute("value");
    const weights = hit.barycoord.toArray();
    const value = [hit.face.a, hit.face.b, hit.face.c].reduce((sum, corner, i) => sum + weights[i] * array[corner], 0);
    label.textContent = `${this.field.label} ${digits(Number(value.toPrecision(4)))}`;
    label.style.transform = `translate(${x + 14}px, ${y + 14}px)`;
    label.hidden = false;
  }

  draw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.renderer.render(this.world, this.camera);
    });
  }
}
