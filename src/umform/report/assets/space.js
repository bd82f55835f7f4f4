// Surfaces in space: the sheet, which deforms, and the tools, which move.

// `nearer`: towards the observer, as a part of the depth of the picture, which a parallel projection does not show.
const VERTEX = `
  in vec3 position; in vec3 normal; in float value;
  uniform mat4 modelViewMatrix, projectionMatrix; uniform mat3 normalMatrix; uniform float nearer;
  out vec3 vNormal; out float vValue;
  void main() {
    vNormal = normalMatrix * normal;
    vValue = value;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
    gl_Position.z -= nearer;
  }`;

// Light without a direction and three lamps that go with the observer, as umform.report.looks has them.
const FRAGMENT = `
  precision highp float;
  in vec3 vNormal; in float vValue;
  uniform sampler2D map; uniform vec2 range; uniform vec3 colour; uniform float opacity; uniform bool mapped, flat_;
  uniform vec4 lamps[3]; uniform float ambient; uniform vec2 shine;
  out vec4 result;
  void main() {
    float t = clamp((vValue - range.x) / (range.y - range.x), 0.0, 1.0);
    vec3 own = mapped ? texture(map, vec2(t * 63.0 / 64.0 + 0.5 / 64.0, 0.5)).rgb : colour;
    if (flat_) { result = vec4(own, opacity); return; }
    vec3 n = normalize(gl_FrontFacing ? vNormal : -vNormal);
    float light = ambient;
    float gleam = 0.0;
    for (int i = 0; i < 3; i += 1) {
      float lit = max(dot(n, lamps[i].xyz), 0.0);
      light += lamps[i].w * lit;
      if (lit > 0.0) gleam += lamps[i].w * pow(max(reflect(-lamps[i].xyz, n).z, 0.0), shine.y);
    }
    result = vec4(own * light + shine.x * gleam, opacity);
  }`;

// Products of mirrors at some planes, as groups that hold the images of a body; the body itself is not among them.
function images(mirrors, body) {
  return Array.from({ length: 2 ** mirrors.length - 1 }, (_, n) => {
    const rows = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]];
    mirrors.forEach(({ axis, at }, bit) => {
      if (((n + 1) >> bit) & 1) Object.assign(rows[axis], { [axis]: -1, 3: 2 * at });
    });
    const group = new THREE.Group();
    group.matrixAutoUpdate = false;
    group.matrix.set(...rows.flat(), 0, 0, 0, 1);
    group.matrixWorldNeedsUpdate = true;
    group.add(body());
    return group;
  });
}

function material(look, options, uniforms) {
  const lamps = look.light.lamps.flatMap(({ towards, strength }) => [...new THREE.Vector3(...towards).normalize().toArray(), strength]);
  const values = {
    map: null, range: new THREE.Vector2(0, 1), colour: new THREE.Color(), opacity: 1, mapped: false, flat_: false,
    nearer: 0, lamps, ambient: look.light.ambient, shine: new THREE.Vector2(0, 1), ...uniforms,
  };
  return new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3, vertexShader: VERTEX, fragmentShader: FRAGMENT, side: THREE.DoubleSide, ...options,
    uniforms: Object.fromEntries(Object.entries(values).map(([name, value]) => [name, { value }])),
  });
}

// Lines without light.
const ink = (look, colour, opacity) =>
  material(look, { transparent: opacity < 1 }, { colour: new THREE.Color(colour), opacity, flat_: true });

class Sheet {
  constructor(scene) {
    const { head, arrays } = scene;
    this.arrays = arrays;
    this.look = head.look;
    this.faces = head.patches ? new Patches(scene) : new Triangles(arrays.faces, arrays.groups, arrays.owners);
    const { sheet } = this.look.light;
    this.material = material(this.look, {}, { mapped: true, map: texture(this.look.map), shine: new THREE.Vector2(...sheet) });
    this.mesh = new THREE.Mesh(this.faces.geometry, this.material);
    this.lines = new THREE.LineSegments(this.faces.lines(), ink(this.look, this.look.colours.lines, this.look.opacity.lines));
    this.axes = this.rollingLines();
    this.mesh.frustumCulled = this.lines.frustumCulled = this.axes.frustumCulled = false;
    const all = [this.mesh, this.lines, this.axes];
    this.images = images(head.mirrors, () => new THREE.Group().add(...all.map((part) => part.clone())));
  }

  // Whether edges are drawn.
  lined(visible) {
    this.lines.visible = visible;
    for (const image of this.images) image.children[0].children[1].visible = visible;
  }

  // Whether the rolling direction is drawn.
  rolled(visible) {
    this.axes.visible = visible;
    for (const image of this.images) image.children[0].children[2].visible = visible;
  }

  // How far lines are drawn before the faces, as a part of the depth of the picture.
  before(nearer) {
    this.lines.material.uniforms.nearer.value = this.axes.material.uniforms.nearer.value = nearer;
  }

  // A line for each face.
  rollingLines() {
    return new THREE.LineSegments(emptyGeometry(2 * this.faces.count), ink(this.look, this.look.colours.rolling, 1));
  }

  // Lines along the rolling direction through the middles of the faces; none on faces that it stands on.
  turnAxes(frame, points) {
    if (!this.arrays.rolling) return;
    const directions = this.arrays.rolling.at(frame);
    const position = this.axes.geometry.getAttribute("position");
    const { length, lying, before } = this.look.rolling;
    this.faces.middles(points, (face, middle, normal, size, owner) => {
      const along = new THREE.Vector3().fromArray(directions, 3 * owner);
      along.addScaledVector(normal, -along.dot(normal));
      along.setLength(along.length() > lying ? length * size : 0);
      middle.addScaledVector(normal, before * size);
      middle.clone().sub(along).toArray(position.array, 6 * face);
      middle.clone().add(along).toArray(position.array, 6 * face + 3);
    });
    position.needsUpdate = true;
  }

  points(frame) {
    return this.arrays.displacements.at(frame).map((shift, i) => this.arrays.points[i] + shift);
  }

  values(field, frame) {
    return this.arrays[`field ${field.name}`].at(frame);
  }

  // Smallest and largest value in a frame, or in all of them without a frame.
  range(field, frame) {
    const { codes, size, low, step } = this.arrays[`field ${field.name}`];
    const part = frame === undefined ? codes : codes.subarray(frame * size, (frame + 1) * size);
    const ends = [part.reduce((a, b) => Math.min(a, b)), part.reduce((a, b) => Math.max(a, b))];
    return ends.map((code) => low + step * code);
  }

  show(frame, field, [bottom, top]) {
    const points = this.points(frame);
    this.faces.move(points);
    this.turnAxes(frame, points);
    this.faces.colour(this.values(field, frame), field);
    this.material.uniforms.range.value.set(bottom, top > bottom ? top : bottom + 1);
  }
}

class ToolBody {
  constructor({ head, arrays }, number) {
    const { look } = head;
    this.poses = arrays[`tool ${number} poses`];
    this.clear = look.opacity.tool;
    const faces = new Triangles(arrays[`tool ${number} faces`], arrays[`tool ${number} groups`]);
    faces.move(arrays[`tool ${number} points`]);
    const shine = new THREE.Vector2(...look.light.tool);
    this.material = material(look, { transparent: true }, { colour: new THREE.Color(look.colours.tool), shine });
    this.edges = ink(look, look.colours.lines, look.opacity.edges);
    this.group = new THREE.Group();
    this.group.add(new THREE.Mesh(faces.geometry, this.material));
    this.group.add(new THREE.LineSegments(new THREE.EdgesGeometry(faces.geometry, look.edge), this.edges));
    this.group.matrixAutoUpdate = false;
    this.images = images(head.toolMirrors[number].map((plane) => head.mirrors[plane]), () => this.group.clone());
    this.bodies = [this.group, ...this.images.map((image) => image.children[0])];
  }

  place(frame) {
    const pose = this.poses.subarray(12 * frame, 12 * frame + 12);
    for (const body of this.bodies) {
      body.matrix.set(...pose, 0, 0, 0, 1);
      body.matrixWorldNeedsUpdate = true;
    }
  }

  // How far it is drawn before the sheet, as a part of the depth of the picture: chords of elements enter tools.
  before(nearer) {
    this.material.uniforms.nearer.value = this.edges.uniforms.nearer.value = nearer;
  }

  // Seen through, a tool does not hide the sheet behind it.
  look(how) {
    const clear = how === "clear";
    for (const body of this.bodies) body.visible = how !== "hidden";
    this.material.uniforms.opacity.value = clear ? this.clear : 1;
    this.material.depthWrite = !clear;
  }
}

function texture(hex) {
  const count = hex.length / 6;
  const bytes = new Uint8Array(4 * count).fill(255);
  for (let i = 0; i < count; i += 1) {
    for (let k = 0; k < 3; k += 1) bytes[4 * i + k] = parseInt(hex.substr(6 * i + 2 * k, 2), 16);
  }
  const made = new THREE.DataTexture(bytes, count, 1);
  made.minFilter = made.magFilter = THREE.LinearFilter;
  made.needsUpdate = true;
  return made;
}
