// @ts-check
// Tools and blank of a drawn part to scale, with their main sizes.

import { draw } from "./dom.js";
import { number } from "./texts.js";

/** @typedef {[number, number]} Point */
/**
 * @typedef {{kind: "draw", tools: Point[][], sheet: Point[], box: [number, number, number, number], round: boolean, thickness: number,
 *   sizes: {text: number, name: string, from: Point, to: Point}[]}} Sketch
 */
/** Pixels for a dimension line. */
const ROW = 22;

/** @param {SVGSVGElement} svg @param {Sketch} sketch */
export function drawSketch(svg, { tools, sheet, box: [left, right, low, high], sizes, round }) {
  const { clientWidth: width, clientHeight: height } = svg;
  const foot = ROW * sizes.length + 6;
  const scale = Math.min((width - 20) / (right - left), (height - foot - 10) / (high - low));
  const [x0, y0] = [width / 2 - ((left + right) / 2) * scale, (height - foot - (high - low) * scale) / 2 + high * scale];
  const place = (/** @type {Point} */ [x, z]) => [x0 + x * scale, y0 - z * scale];
  const shape = (/** @type {Point[]} */ points, /** @type {string} */ name) =>
    draw("path", { d: `M${points.map((point) => place(point).map((value) => value.toFixed(1)).join(" ")).join("L")}Z`, class: name });
  const bottom = y0 - low * scale;
  const lines = sizes.flatMap(({ text, from, to }, i) => {
    const y = bottom + ROW * (i + 0.8);
    const [[a], [b]] = [place(from), place(to)];
    return [
      draw("line", { x1: a, y1: place(from)[1], x2: a, y2: y + 4, class: "dimension faint" }), draw("line", { x1: b, y1: place(to)[1], x2: b, y2: y + 4, class: "dimension faint" }),
      draw("path", { d: `M${a} ${y}H${b}`, class: "arrow" }),
      draw("text", { x: (a + b) / 2, y: y - 4, "text-anchor": "middle", class: "size" }, `${round ? "Ø " : ""}${number(text, text % 1 ? 2 : 0)}`),
    ];
  });
  svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  svg.replaceChildren(...tools.map((one) => shape(one, "tool")), shape(sheet, "sheet"), ...lines);
}
