// @ts-check
// The flat pattern of a part: drawing, bends, steps of the operator, warnings.

import { make, wide } from "./dom.js";
import { message } from "./messages.js";
import { tile } from "./quantities.js";
import { number, t } from "./texts.js";

/** @param {any} job @returns {Node[]} */
export function flatNumbers({ id, summary: { flat, press, prismatic, collisions } }) {
  const [length, width] = flat.size;
  const one = (/** @type {string} */ name, /** @type {number | null} */ value, /** @type {string} */ unit, /** @type {number} */ decimals) =>
    ({ name, label: "", unit, decimals, digits: 4, value, missed: false, band: null });
  const tiles = [one("length", length, "mm", 2), one("width", width, "mm", 2), one("thickness", flat.thickness, "mm", 2), one("bends", flat.bends.length, "", 0),
    ...(press === null ? [] : [one("press", press, "kN", 1)])];
  const red = [...(flat.order.length || !flat.bends.length ? [] : [t("flat.noorder")]), ...collisions.map(message)];
  const bad = red.map((text) => make("p", { class: "note bad" }, text));
  const warnings = flat.warnings.map((/** @type {string} */ text) => make("p", { class: "note warn" }, message(text)));
  const notes = [t("flat.folded", { distance: flat.folded_back }), ...(flat.order.length && !prismatic ? [t("flat.cuts")] : []),
    ...(flat.flange_errors ? [t("flat.flanges", { errors: flat.flange_errors.map((/** @type {number} */ error) => number(error, 3)).join(", ") })] : []),
    ...(flat.unit_of_the_file.startsWith("milli") ? [] : [t("part.unit", { unit: flat.unit_of_the_file })])];
  const picture = make("img", { src: `/files/${id}/flat.svg`, alt: t("flat.picture", { length, width }) });
  return [
    ...bad, ...warnings,
    make("dl", { class: "heroes" }, ...tiles.map((each) => tile(each, "flat"))),
    make("figure", { class: "card paper" }, picture, make("figcaption", {}, t("flat.caption"))),
    rows("flat-bends", t("flat.bends"), ["number", "angle", "way", "radius", "drawn", "allowance", "source"], flat.bends.map(bend)),
    ...(flat.steps.length ? [rows("flat-steps", t("flat.steps"), ["step", "number", "turn", "part", "die", "punch", "stop", "stroke", "loaded", "force"], flat.steps.map((/** @type {any} */ each, /** @type {number} */ i) => step(each, i, 180 - flat.bends.find((/** @type {any} */ one) => one.number === each.bend).angle)))] : []),
    ...notes.map((text) => make("p", { class: "note" }, text)),
  ];
}

/** @param {any} bend */
const bend = ({ number: count, angle, direction, radius, radius_of_the_drawing: drawn, allowance, source }) =>
  [count, `${number(angle, 2)}°`, t(`bends.${direction}`), number(radius, 3), number(drawn, 3), number(allowance, 3), message(source)];

/** @param {any} step @param {number} i @param {number} part angle of the part there */
const step = ({ bend: count, turned, opening, die_angle: die, punch_radius: punch, stop, against, stroke, loaded_angle: loaded, force }, i, part) =>
  [i + 1, count, turned ? t("yes") : "", `${number(part, 2)}°`, `V${number(opening)} / ${number(die)}°`, `R ${number(punch)}`, stop === null ? message(against) : `${number(stop, 2)} (${message(against)})`,
    number(stroke, 3), loaded === null ? "–" : `${number(loaded, 2)}°`, number(force, 1)];

/** A table with a caption. @param {string} id @param {string} title @param {string[]} names @param {any[][]} lines */
function rows(id, title, names, lines) {
  const head = make("tr", {}, ...names.map((name) => make("th", { scope: "col" }, t(`flat.col.${name}`))));
  const body = lines.map((line) => make("tr", {}, ...line.map((cell) => make("td", {}, String(cell)))));
  return wide(make("table", { class: "columns", id }, make("caption", {}, title), make("thead", {}, head), make("tbody", {}, ...body)));
}
