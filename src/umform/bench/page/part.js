// @ts-check
// A part of several bends to scale: before the run by geometry, then as computed.

import { draw } from "./dom.js";
import { number } from "./texts.js";

/** @typedef {[number, number]} Point */
/** @typedef {{at: Point, text: string, inside: Point}} Mark the number and angle of a bend, with the direction to its inner side */
/** @typedef {{from: Point, to: Point, side: number, text: string}} Size a dimension on the outer side of a flange */
/** Inside radius over the opening, workshop rule. */
const RADIUS = 0.16;

/**
 * Outline of the finished part, and where its bends are.
 * @param {any} values @param {number} opening @returns {{outline: Point[], bends: Mark[], sizes: Size[]}}
 */
export function partByGeometry({ strip_length: length, bends, thickness, flanges = [] }, opening) {
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
  /** Where the outer faces of each bend meet, and on which side. @type {{side: number, before: number, apex: Point}[]} */
  const turns = [];
  for (const { position, angle, direction, order } of ordered) {
    const turn = ((180 - (angle ?? 180)) / 180) * Math.PI;
    const arc = radius * turn;
    const before = heading;
    const side = direction === "down" ? -1 : 1; // the outer face is below if the legs go up
    go(Math.max(0, position - arc / 2 - at));
    const start = [x, z];
    for (let i = 0; i < 12; i += 1) {
      heading += ((direction === "down" ? -1 : 1) * turn) / 24; // the middle of the piece
      go(arc / 12);
      heading += ((direction === "down" ? -1 : 1) * turn) / 24;
      if (i === 5) marks.push({ at: /** @type {Point} */ ([x, z]), inside: /** @type {Point} */ ([-side * Math.sin(heading), side * Math.cos(heading)]), text: `${order}: ${number(angle, 0)}°` });
    }
    const [sx, sz] = start;
    const set = (radius + thickness / 2) * Math.tan(turn / 2);
    turns.push({ side, before, apex: /** @type {Point} */ ([sx + set * Math.cos(before) + (side * thickness * Math.sin(before)) / 2, sz + set * Math.sin(before) - (side * thickness * Math.cos(before)) / 2]) });
  }
  go(Math.max(0, length - at));
  const face = (/** @type {number} */ side) => middle.map(([px, pz, a]) => /** @type {Point} */ ([px - side * thickness * Math.sin(a) / 2, pz + side * thickness * Math.cos(a) / 2]));
  const ends = [middle[0], middle[middle.length - 1]];
  const sizes = flanges.length !== turns.length + 1 ? [] : flanges.map((/** @type {number} */ flange, /** @type {number} */ i) => {
    const { side } = turns[i] ?? turns[i - 1];
    const of = (/** @type {[number, number, number]} */ [px, pz, a]) => /** @type {Point} */ ([px + (side * thickness * Math.sin(a)) / 2, pz - (side * thickness * Math.cos(a)) / 2]);
    const along = turns[i]?.before ?? heading;
    const shift = turns[i - 1] ? ((side - turns[i - 1].side) * thickness) / 2 : 0; // both ends on one face
    const [fx, fz] = turns[i - 1]?.apex ?? of(ends[0]);
    return { from: /** @type {Point} */ ([fx + shift * Math.sin(along), fz - shift * Math.cos(along)]), to: turns[i]?.apex ?? of(ends[1]), side, text: number(flange) };
  });
  return { outline: [...face(-1), ...face(1).reverse()], bends: marks, sizes };
}

/**
 * Draws an outline as large as the picture allows.
 * @param {SVGSVGElement} svg @param {Point[]} outline @param {string} name @param {Mark[]} [marks] @param {Size[]} [sizes]
 */
export function drawPart(svg, outline, name, marks = [], sizes = []) {
  const { clientWidth: width, clientHeight: height } = svg;
  const [xs, zs] = [outline.map(([x]) => x), outline.map(([, z]) => z)];
  const [left, right, low, high] = [Math.min(...xs), Math.max(...xs), Math.min(...zs), Math.max(...zs)];
  const room = sizes.length ? 40 : 0; // for dimension lines
  const scale = Math.min((width - 90 - room) / (right - left || 1), (height - 70 - room) / (high - low || 1));
  const place = (/** @type {number[]} */ [x, z]) => [width / 2 + (x - (left + right) / 2) * scale, height / 2 - (z - (low + high) / 2) * scale];
  const d = outline.map((point) => place(point).map((value) => value.toFixed(1)).join(" ")).join("L");
  const away = place([(left + right) / 2, (low + high) / 2]);
  const labels = marks.map(({ at, inside: [ix, iz], text }) => {
    const [x, y] = place(at);
    const far = Math.hypot(x - away[0], y - away[1]) || 1;
    const [nx, ny, by] = sizes.length ? [ix, -iz, 26] : [(x - away[0]) / far, (y - away[1]) / far, 22];
    return draw("text", { x: x + by * nx, y: y + by * ny + 4, class: "mark", "text-anchor": "middle" }, text);
  });
  svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  svg.replaceChildren(draw("path", { d: `M${d}Z`, class: name }), ...labels, ...sizes.flatMap((one) => dimension(one, place)));
}

/** A dimension line beside a flange, with lines to its ends. @param {Size} size @param {(point: Point) => number[]} place */
function dimension({ from, to, side, text }, place) {
  const [[ax, ay], [bx, by]] = [place(from), place(to)];
  const long = Math.hypot(bx - ax, by - ay) || 1;
  const [nx, ny] = [(-(by - ay) / long) * side, ((bx - ax) / long) * side]; // to the outer side; y points down
  const at = (/** @type {number} */ x, /** @type {number} */ y, /** @type {number} */ away) => `${(x + away * nx).toFixed(1)} ${(y + away * ny).toFixed(1)}`;
  return [
    draw("path", { d: `M${at(ax, ay, 3)}L${at(ax, ay, 22)}M${at(bx, by, 3)}L${at(bx, by, 22)}M${at(ax, ay, 18)}L${at(bx, by, 18)}`, class: "dimension" }),
    draw("text", { x: (ax + bx) / 2 + 30 * nx, y: (ay + by) / 2 + 30 * ny + 4, class: "mark size", "text-anchor": "middle" }, text),
  ];
}
