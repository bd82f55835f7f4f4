// @ts-check
// A part of several bends to scale: before the run by geometry, then as computed.

import { draw } from "./dom.js";
import { number } from "./texts.js";

/** @typedef {[number, number]} Point */
/** Inside radius over the opening, workshop rule. */
const RADIUS = 0.16;

/**
 * Outline of the finished part, and where its bends are.
 * @param {any} values @param {number} opening @returns {{outline: Point[], bends: {at: Point, text: string}[]}}
 */
export function partByGeometry({ strip_length: length, bends, thickness }, opening) {
  const radius = RADIUS * opening + thickness / 2;
  const ordered = bends.map((/** @type {any} */ one, /** @type {number} */ i) => ({ ...one, order: i + 1 }))
    .filter((/** @type {any} */ one) => one.position > 0 && one.position < length).sort((/** @type {any} */ a, /** @type {any} */ b) => a.position - b.position);
  let [x, z, heading, at] = [0, 0, 0, 0];
  /** @type {[number, number, number][]} */
  const middle = [[x, z, heading]];
  const go = (/** @type {number} */ way) => {
    [x, z, at] = [x + way * Math.cos(heading), z + way * Math.sin(heading), at + way];
    middle.push([x, z, heading]);
  };
  const marks = [];
  for (const { position, angle, direction, order } of ordered) {
    const turn = ((180 - (angle ?? 180)) / 180) * Math.PI;
    const arc = radius * turn;
    go(Math.max(0, position - arc / 2 - at));
    for (let i = 0; i < 12; i += 1) {
      heading += ((direction === "down" ? -1 : 1) * turn) / 12;
      go(arc / 12);
      if (i === 5) marks.push({ at: /** @type {Point} */ ([x, z]), text: `${order}: ${number(angle, 0)}°` });
    }
  }
  go(Math.max(0, length - at));
  const face = (/** @type {number} */ side) => middle.map(([px, pz, a]) => /** @type {Point} */ ([px - side * thickness * Math.sin(a) / 2, pz + side * thickness * Math.cos(a) / 2]));
  return { outline: [...face(-1), ...face(1).reverse()], bends: marks };
}

/**
 * Draws an outline as large as the picture allows.
 * @param {SVGSVGElement} svg @param {Point[]} outline @param {string} name @param {{at: Point, text: string}[]} [marks]
 */
export function drawPart(svg, outline, name, marks = []) {
  const { clientWidth: width, clientHeight: height } = svg;
  const [xs, zs] = [outline.map(([x]) => x), outline.map(([, z]) => z)];
  const [left, right, low, high] = [Math.min(...xs), Math.max(...xs), Math.min(...zs), Math.max(...zs)];
  const scale = Math.min((width - 90) / (right - left || 1), (height - 70) / (high - low || 1));
  const place = (/** @type {number[]} */ [x, z]) => [width / 2 + (x - (left + right) / 2) * scale, height / 2 - (z - (low + high) / 2) * scale];
  const d = outline.map((point) => place(point).map((value) => value.toFixed(1)).join(" ")).join("L");
  const centre = [(left + right) / 2, (low + high) / 2];
  const labels = marks.map(({ at, text }) => {
    const [x, y] = place(at);
    const away = place(centre);
    const far = Math.hypot(x - away[0], y - away[1]) || 1;
    return draw("text", { x: x + (22 * (x - away[0])) / far, y: y + (22 * (y - away[1])) / far + 4, class: "mark", "text-anchor": "middle" }, text);
  });
  svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  svg.replaceChildren(draw("path", { d: `M${d}Z`, class: name }), ...labels);
}
