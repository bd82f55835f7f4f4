// Curves of the history: any columns over any other, with the values at the cursor.

const PLOT = { left: 76, right: 20, top: 16, bottom: 48 };

class Curves {
  constructor(table, colours) {
    Object.assign(this, { table, colours, svg: element("curves-plot"), row: null, frame: null });
    const { x, y, labels } = this.svg.dataset;
    this.labels = JSON.parse(labels);
    this.shown = [y];
    for (const id of ["curves-x", "curves-y"]) {
      element(id).append(...table.names.map((name) => new Option(this.label(name), name)));
    }
    element("curves-x").value = x;
    element("curves-x").addEventListener("change", () => this.show());
    element("curves-y").addEventListener("change", (event) => {
      if (event.target.value && !this.shown.includes(event.target.value)) this.shown.push(event.target.value);
      event.target.value = "";
      this.show();
    });
    this.svg.addEventListener("pointermove", (event) => this.hover(event));
    this.svg.addEventListener("pointerleave", () => this.choose(null));
    this.svg.addEventListener("click", () => this.send());
    this.svg.addEventListener("keydown", (event) => this.key(event));
    document.addEventListener("frame", (event) => {
      this.frame = event.detail;
      this.mark();
    });
    new ResizeObserver(() => this.resize()).observe(this.svg);
    this.resize();
  }

  // What a column is called, and where a row lies on the abscissa.
  label(name) {
    return this.labels[name] ?? name;
  }

  // A value with its name; the unit of a column as "force kN/m" stands behind the number.
  text(row, name = element("curves-x").value, precision = 6) {
    const value = digits(Number(Number(this.table.columns[name][row]).toPrecision(precision)));
    const [word, unit = ""] = name.includes(" ") ? this.label(name).split(/ (?=[^ ]*$)/) : [this.label(name)];
    return `${word} ${value} ${unit}`.trimEnd();
  }

  // Where a row lies, with the first curve there: a released sheet has the stroke of the drawn one, and no force.
  place(row) {
    return [element("curves-x").value, this.shown[0]].map((name) => this.text(row, name, 4)).join(", ");
  }

  // The step of a row, such as the release after a stroke; empty if there is only one.
  step(row) {
    const { step } = this.table.columns;
    const last = step ? step[step.length - 1] : 1;
    return last > 1 ? `step ${step[row]} of ${last}` : "";
  }

  // One unit of the picture is one pixel of the page, so that its letters are as large as all others.
  resize() {
    const { clientWidth, clientHeight } = this.svg;
    if (this.size?.width === clientWidth || !clientWidth) return;
    this.size = { width: clientWidth, height: clientHeight };
    this.svg.setAttribute("viewBox", `0 0 ${clientWidth} ${clientHeight}`);
    this.show();
  }

  make(name, attributes, ...content) {
    const node = document.createElementNS(this.svg.namespaceURI, name);
    for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
    node.append(...content);
    return node;
  }

  // The same columns with more rows; or fewer: of the next operation, or of an earlier state that comes late.
  renew(table) {
    const last = table.length - 1;
    Object.assign(this, { table, row: null, frame: this.frame === null || last < 0 ? null : Math.min(this.frame, last) });
    if (this.size) this.show();
  }

  // Positions in the picture, and the ticks.
  scales() {
    const along = this.table.columns[element("curves-x").value];
    const all = this.shown.flatMap((name) => this.table.columns[name]);
    const [left, right] = ends(along);
    const [bottom, top] = ends(all);
    const { width, height } = this.size;
    const w = width - PLOT.left - PLOT.right;
    const h = height - PLOT.top - PLOT.bottom;
    this.at = {
      x: (value) => PLOT.left + ((value - left) / (right - left)) * w,
      y: (value) => height - PLOT.bottom - ((value - bottom) / (top - bottom)) * h,
    };
    return { along, xs: ticks(left, right, this.size.width / 110), ys: ticks(bottom, top, 6) };
  }

  show() {
    const { along, xs, ys } = this.scales();
    const { width, height } = this.size;
    const grid = this.make("g", { class: "grid" });
    for (const value of xs) {
      const x = this.at.x(value);
      grid.append(this.make("line", { x1: x, x2: x, y1: PLOT.top, y2: height - PLOT.bottom }));
      grid.append(this.make("text", { x, y: height - PLOT.bottom + 20, "text-anchor": "middle" }, digits(value)));
    }
    for (const value of ys) {
      const y = this.at.y(value);
      grid.append(this.make("line", { x1: PLOT.left, x2: width - PLOT.right, y1: y, y2: y, class: value ? "" : "zero" }));
      grid.append(this.make("text", { x: PLOT.left - 10, y: y + 4, "text-anchor": "end" }, digits(value)));
    }
    const middle = (PLOT.left + width - PLOT.right) / 2;
    const name = this.make("text", { x: middle, y: height - 8, class: "name", "text-anchor": "middle" });
    name.append(this.label(element("curves-x").value));
    const lines = this.shown.map((column, i) => {
      const points = this.table.columns[column].map((y, k) => [this.at.x(along[k]), this.at.y(y)]);
      return this.make("path", { d: path(points), class: "curve", stroke: this.colour(i) });
    });
    this.marks = this.make("g", { class: "marks" });
    this.svg.replaceChildren(grid, name, ...lines, this.marks);
    this.names();
    this.mark();
  }

  colour(i) {
    return this.colours[i % this.colours.length];
  }

  // A button for each curve, with its value at the cursor; it takes the curve away.
  names() {
    element("curves-names").replaceChildren(...this.shown.map((column, i) => {
      const button = document.createElement("button");
      const [swatch, name, value, cross] = ["i", "span", "output", "b"].map((tag) => document.createElement(tag));
      swatch.style.background = this.colour(i);
      name.textContent = this.label(column);
      cross.textContent = "×";
      button.type = "button";
      button.title = `take ${this.label(column)} out`;
      button.disabled = this.shown.length === 1;
      button.append(swatch, name, value, cross);
      button.addEventListener("click", () => {
        this.shown = this.shown.filter((other) => other !== column);
        this.show();
      });
      return button;
    }));
  }

  // Dots at the row under the cursor, or at that of the frame in the picture above.
  mark() {
    if (!this.size) return; // nothing is drawn where there is no room yet
    const row = this.row ?? this.frame;
    const x = element("curves-x").value;
    this.marks.replaceChildren();
    element("curves-at").textContent = row === null ? "" : this.text(row);
    this.shown.forEach((column, i) => {
      const value = row === null ? NaN : this.table.columns[column][row];
      const output = element("curves-names").children[i].querySelector("output");
      output.textContent = row === null ? "" : digits(value);
      if (!Number.isFinite(value)) return;
      const [cx, cy] = [this.at.x(this.table.columns[x][row]), this.at.y(value)];
      if (i === 0) this.marks.append(this.make("line", { x1: cx, x2: cx, y1: PLOT.top, y2: this.size.height - PLOT.bottom }));
      this.marks.append(this.make("circle", { cx, cy, r: 5, fill: this.colour(i) }));
    });
  }

  // The row whose point is nearest to the pointer: a history may turn back, so no search along x.
  hover(event) {
    const box = this.svg.getBoundingClientRect();
    const [px, py] = [event.clientX - box.left, event.clientY - box.top];
    const along = this.table.columns[element("curves-x").value];
    let [nearest, least] = [null, Infinity];
    for (const column of this.shown) {
      this.table.columns[column].forEach((value, row) => {
        const far = (this.at.x(along[row]) - px) ** 2 + (this.at.y(value) - py) ** 2;
        if (far < least) [nearest, least] = [row, far];
      });
    }
    this.choose(nearest);
  }

  choose(row) {
    this.row = row;
    this.mark();
  }

  send() {
    if (this.row !== null) document.dispatchEvent(new CustomEvent("row", { detail: this.row }));
  }

  key(event) {
    const step = { ArrowLeft: -1, ArrowRight: 1, PageDown: -10, PageUp: 10 }[event.key];
    const last = this.table.length - 1;
    if (event.key === "Enter") this.send();
    else if (event.key === "Escape") this.choose(null);
    else if (event.key === "Home" || event.key === "End") this.choose(event.key === "Home" ? 0 : last);
    else if (step) this.choose(Math.min(last, Math.max(0, (this.row ?? this.frame ?? 0) + step)));
    else return;
    event.preventDefault();
  }
}

// Smallest and largest finite value, apart.
function ends(values) {
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) {
    if (!Number.isFinite(value)) continue;
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  if (low > high) return [0, 1];
  const half = low === high ? 0.5 * Math.max(1e-12, Math.abs(low)) || 0.5 : 0.02 * (high - low);
  return [low - half, high + half];
}

// Path through points; it is broken where a value is missing.
function path(points) {
  let pen = "M";
  return points.map(([x, y]) => {
    if (!Number.isFinite(x + y)) {
      pen = "M";
      return "";
    }
    const part = `${pen}${x.toFixed(2)},${y.toFixed(2)}`;
    pen = "L";
    return part;
  }).join("");
}
