// @ts-check
// Tools and sheet to scale: before a run by geometry, then as computed.

import { draw } from "./dom.js";
import { drawSketch } from "./draw_sketch.js";
import { drawPart, partByGeometry } from "./part.js";
import { number } from "./texts.js";

/** @typedef {[number, number]} Point */
/**
 * @typedef {{die: Point[], punch: Point[], half_length: number, largest_stroke: number, thickness: number,
 *   shoulder: number, radii: number, depth: number, sizes: {die: {opening: number}, punch: {radius: number}}, closed: {die: boolean, punch: boolean}}} Outlines
 */

export class Drawing {
  /** @param {SVGSVGElement} svg */
  constructor(svg) {
    this.svg = svg;
    /** @type {Outlines | null} */
    this.outlines = null;
    /** @type {any} */
    this.values = {};
    /** A section, an outline in the tools, or the profile of a part. @type {any} */
    this.computed = null;
    new ResizeObserver(() => this.show()).observe(svg);
  }

  /** @param {Outlines} outlines @param {any} values */
  set(outlines, values) {
    this.outlines = outlines;
    this.values = values;
    this.show();
  }

  /** @param {any} computed */
  setComputed(computed) {
    this.computed = computed;
    this.show();
  }

  show() {
    const { outlines } = this;
    const { clientWidth: width, clientHeight: height } = this.svg;
    if (!outlines || !width) return;
    const { computed } = this;
    if (/** @type {any} */ (outlines).kind === "draw") {
      drawSketch(this.svg, /** @type {any} */ (outlines));
      return;
    }
    if (computed?.profile || computed?.flattening) {
      drawPart(this.svg, computed.profile ?? computed.outline, "sheet computed");
      return;
    }
    if (!computed && ["sequence", "outside"].includes(this.values.work) && this.values.strip_length) {
      const part = partByGeometry(this.values, outlines.sizes.die.opening);
      drawPart(this.svg, part.outline, "sheet", part.bends, part.sizes);
      return;
    }
    const bent = computed?.outline ? computed : computed ? fromSection(computed) : byGeometry(outlines, this.values);
    const deep = Math.max(outlines.depth, outlines.largest_stroke);
    const extent = (/** @type {(point: Point) => number} */ of) => 1.08 * bent.outline.reduce((/** @type {number} */ most, /** @type {Point} */ point) => Math.max(most, of(point)), 0);
    const half = Math.max(1.1 * outlines.half_length, extent(([x]) => Math.abs(x)));
    const top = Math.max(0.95 * outlines.half_length, 3 * outlines.thickness, extent(([, z]) => z));
    const bottom = Math.max(1.18 * deep + outlines.thickness, 1.1 * extent(([, z]) => -z));
    const scale = Math.min(width / (2 * half), height / (top + bottom));
    const place = (/** @type {Point} */ [x, z]) =>
      /** @type {Point} */ ([width / 2 + x * scale, (height - (top + bottom) * scale) / 2 + (top - z) * scale]);
    const far = 4 * (width + height) / scale;
    /** @type {Point[]} */
    const die = [...outlines.die];
    const [first, last] = [die[0], die[die.length - 1]];
    const body = outlines.closed.die ? die : [[far * Math.sign(first[0]), 0], ...die.slice(1, -1), [far * Math.sign(last[0]), 0],
      [far * Math.sign(last[0]), -far], [far * Math.sign(first[0]), -far]];
    const punch = outlines.punch.map(([x, z]) => /** @type {Point} */ ([x, z - bent.stroke]));
    this.svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    this.svg.replaceChildren(
      shape(body, place, "tool"), shape(outlines.closed.punch ? punch : lengthened(punch, far), place, "tool"),
      ...(computed?.outline ? [] : [shape(flat(outlines), place, "before")]),
      shape(bent.outline, place, this.computed ? "sheet computed" : "sheet"), ...this.labels(place, bent, width, height),
    );
  }

  /**
   * @param {(point: Point) => Point} place @param {{angle: number, stroke: number, outline: Point[]}} bent
   * @param {number} width @param {number} height
   */
  labels(place, bent, width, height) {
    const opening = this.outlines?.sizes.die.opening ?? 0;
    const half = opening / 2;
    const [[left], [right]] = [place([-half, 0]), place([half, 0])];
    const low = height - 14;
    const [ax, az] = place([0, (this.outlines?.thickness ?? 0) - bent.stroke]);
    return [
      line(left, place([0, 0])[1], left, low - 4), line(right, place([0, 0])[1], right, low - 4),
      draw("path", { d: `M${left} ${low - 8}H${right}`, class: "arrow" }),
      label((left + right) / 2, low + 6, `V ${number(opening, opening % 1 ? 2 : 0)}`),
      Number.isFinite(bent.angle) ? label(ax, Math.max(az - 28, 22), `${number(bent.angle, this.computed ? 1 : undefined)}°`, "angle") : draw("g"),
    ];
  }
}

/** @param {number[][]} points @param {(point: any) => Point} place @param {string} name */
function shape(points, place, name) {
  const d = points.map((point) => place(point).map((value) => value.toFixed(1)).join(" ")).join("L");
  return draw("path", { d: `M${d}Z`, class: name });
}

/** @param {number} x1 @param {number} y1 @param {number} x2 @param {number} y2 */
const line = (x1, y1, x2, y2) => draw("line", { x1, y1, x2, y2, class: "dimension" });

/** @param {number} x @param {number} y @param {string} text @param {string} [name] */
const label = (x, y, text, name = "") => draw("text", { x, y, class: name, "text-anchor": "middle" }, text);

/** The punch, extended beyond the picture. @param {Point[]} punch @param {number} far @returns {Point[]} */
function lengthened(punch, far) {
  const [a, b] = punch;
  const slope = (a[0] - b[0]) / (a[1] - b[1]);
  const wide = Math.abs(b[0] + slope * (far - b[1]));
  return [[-wide * Math.sign(punch.at(-1)?.[0] ?? 1), far], ...punch.slice(1, -1), [wide * Math.sign(punch.at(-1)?.[0] ?? 1), far]];
}

/** @param {Outlines} outlines @returns {Point[]} */
function flat({ half_length: half, thickness }) {
  return [[-half, 0], [half, 0], [half, thickness], [-half, thickness]];
}

/**
 * A sheet wrapped around the tip of the punch, for the drawing before the run.
 * @param {Outlines} outlines @param {{angle: number | null, stroke: number | null}} values
 */
function byGeometry(outlines, { angle, stroke }) {
  const { radius } = outlines.sizes.punch;
  const { radii, shoulder, thickness, half_length: half } = outlines;
  const wayOf = (/** @type {number} */ a) =>
    ((shoulder - radii * Math.sin(a)) / Math.cos(a)) * Math.sin(a) + radii * (1 - Math.cos(a));
  let slope = angle === null ? 0 : ((180 - angle) / 360) * Math.PI;
  if (angle === null && stroke !== null) {
    let [low, high] = [0, 1.4];
    for (let i = 0; i < 40; i += 1) [low, high] = wayOf((low + high) / 2) < stroke ? [(low + high) / 2, high] : [low, (low + high) / 2];
    slope = low;
  }
  const way = Math.max(0, wayOf(slope));
  const centre = thickness - way + radius;
  const leg = Math.max(0, half - (radius + thickness / 2) * slope);
  const [ux, uz] = [Math.cos(slope), Math.sin(slope)];
  const along = (/** @type {number} */ r) => {
    /** @type {Point[]} */
    const arc = Array.from({ length: 13 }, (_, i) => {
      const at = (slope * i) / 12;
      return [r * Math.sin(at), centre - r * Math.cos(at)];
    });
    const [x, z] = arc[12];
    return [...arc, /** @type {Point} */ ([x + leg * ux, z + leg * uz])];
  };
  return { outline: both(along(radius), along(radius + thickness)), stroke: way, angle: 180 - (360 * slope) / Math.PI };
}

/** @param {{section: Point[][], stroke: number, angle: number}} computed */
function fromSection({ section: [outer, inner], stroke, angle }) {
  return { outline: both(inner, outer), stroke, angle };
}

/** Both halves of the sheet, from the inner and the outer face of one. @param {Point[]} inner @param {Point[]} outer @returns {Point[]} */
function both(inner, outer) {
  const mirror = (/** @type {Point[]} */ half) => half.map(([x, z]) => /** @type {Point} */ ([-x, z]));
  return [...mirror(inner).reverse(), ...inner, ...[...outer].reverse(), ...mirror(outer)];
}
