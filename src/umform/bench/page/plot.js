// @ts-check
// Curves in one picture: force over stroke of a run, or of several jobs.

import { draw } from "./dom.js";
import { number } from "./texts.js";

const [LEFT, RIGHT, TOP, BOTTOM] = [52, 14, 14, 38];

/**
 * @param {{name: string, x: number[], y: number[]}[]} curves
 * @param {{x: string, y: string, band?: [number, number], label: string}} words @param {number} [width] @param {number} [height]
 */
export function plot(curves, words, width = 560, height = 250) {
  const [xs, ys] = [curves.flatMap(({ x }) => x), curves.flatMap(({ y }) => y)];
  const right = largest(xs) || 1;
  const top = 1.12 * Math.max(largest(ys), words.band?.[1] ?? 0) || 1;
  const [low, left] = [Math.min(0, smallest(ys)), Math.min(0, smallest(xs))];
  const px = (/** @type {number} */ x) => LEFT + ((x - left) / (right - left)) * (width - LEFT - RIGHT);
  const py = (/** @type {number} */ y) => height - BOTTOM - ((y - low) / (top - low)) * (height - TOP - BOTTOM);
  const svg = draw("svg", { class: "plot", viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": words.label });
  for (const value of ticks(low, top, 4)) {
    svg.append(draw("line", { x1: LEFT, x2: width - RIGHT, y1: py(value), y2: py(value) }));
    svg.append(draw("text", { x: LEFT - 8, y: py(value) + 4, "text-anchor": "end" }, number(value)));
  }
  for (const value of ticks(left, right, 6)) {
    svg.append(draw("text", { x: px(value), y: height - BOTTOM + 17, "text-anchor": "middle" }, number(value)));
  }
  if (words.band) {
    const [a, b] = words.band;
    svg.append(draw("rect", { x: LEFT, width: width - LEFT - RIGHT, y: py(b), height: py(a) - py(b), class: "band" }));
  }
  svg.append(draw("text", { x: width - RIGHT, y: height - 4, "text-anchor": "end", class: "name" }, words.x));
  svg.append(draw("text", { x: LEFT + 6, y: TOP + 2, class: "name" }, words.y));
  curves.forEach(({ x, y }, i) => {
    const d = x.map((value, k) => `${px(value).toFixed(1)} ${py(y[k]).toFixed(1)}`).join("L");
    if (d) svg.append(draw("path", { d: `M${d}`, class: `curve c${i % 6}` }));
    if (curves.length === 1 && x.length) {
      svg.append(draw("circle", { cx: px(x[x.length - 1]), cy: py(y[y.length - 1]), r: 4, class: "c0" }));
    }
  });
  return svg;
}

/** @param {number[]} values */
const largest = (values) => values.reduce((a, b) => Math.max(a, b), 0);
/** @param {number[]} values */
const smallest = (values) => values.reduce((a, b) => Math.min(a, b), Infinity);

/** Round numbers for the ticks of a range. @param {number} low @param {number} high @param {number} parts @returns {number[]} */
function ticks(low, high, parts) {
  if (!(high > low) || !Number.isFinite(high - low)) return [];
  const power = 10 ** Math.floor(Math.log10((high - low) / parts));
  const step = power * ([1, 2, 5, 10].find((factor) => factor * power >= (high - low) / parts) ?? 10);
  const first = Math.ceil(low / step - 1e-9);
  const count = Math.min(20, Math.floor(high / step + 1e-9) - first + 1);
  return Array.from({ length: Math.max(0, count) }, (_, i) => Number(((first + i) * step).toPrecision(10)));
}
