// @ts-check
// Results of a part with several bends, and of a hem.

import { make } from "./dom.js";
import { message } from "./messages.js";
import { number, t } from "./texts.js";

/** Numbers of each bend: name, decimals, unit. @type {[string, number, string][]} */
const OF_BEND = [["position", 1, "mm"], ["wanted", 1, "°"], ["stroke", 3, "mm"], ["largest_force", 1, "kN"], ["angle", 2, "°"], ["final_angle", 2, "°"],
  ["springback", 2, "°"], ["radius", 2, "mm"], ["k_factor", 3, ""], ["bend_deduction", 3, "mm"], ["outer_strain", 3, ""]];
/** @type {[string, number, string][]} */
const OF_HEM = [["height", 3, "mm"], ["springback", 3, "mm"], ["largest_force", 0, "kN"], ["tip_gap", 3, "mm"], ["loop_gap", 3, "mm"], ["angle", 2, "°"],
  ["outer_strain", 3, ""], ["thinning", 1, "%"]];

/** @param {any} job @returns {Node[]} */
export function stripNumbers({ summary }) {
  const red = summary.collisions ?? [];
  const warnings = [...summary.warnings, ...(summary.coarse_mesh ?? [])].map((/** @type {string} */ text) => make("p", { class: `note ${red.includes(text) ? "bad" : "warn"}` }, message(text)));
  return [...warnings, ...(summary.hem ? hem(summary) : part(summary))];
}

/** @param {any} summary */
function part({ bends, flanges, flat_length: flat, length_balance: balance, length }) {
  const value = (/** @type {any} */ bend, /** @type {string} */ name) => (name === "largest_force" ? (bend[name] * length) / 1e3 : bend[name]);
  const rows = OF_BEND.map(([name, digits, unit]) => make("tr", {}, make("th", { scope: "row" }, `${t(`strip.${name}`)}${unit ? `, ${unit}` : ""}`),
    ...bends.map((/** @type {any} */ bend) => make("td", {}, number(value(bend, name), digits)))));
  const way = make("tr", {}, make("th", { scope: "row" }, t("strip.way")), ...bends.map((/** @type {any} */ bend) => make("td", {}, t(bend.over ? "bends.down" : "bends.up"))));
  const head = make("tr", {}, make("td"), ...bends.map((/** @type {any} */ _, /** @type {number} */ i) => make("th", { scope: "col" }, t("bend.number", { number: i + 1 }))));
  const sizes = [[t("strip.flat"), flat, 2], ...flanges.map((/** @type {number} */ one, /** @type {number} */ i) => [t("strip.flange", { number: i + 1 }), one, 2]),
    [t("strip.balance"), balance, 3]];
  return [
    make("dl", { class: "heroes" }, ...sizes.map(([name, one, digits]) => tile(name, number(one, digits), "mm"))),
    make("div", { class: "wide" }, make("table", { class: "columns", id: "strip-table" }, make("thead", {}, head), make("tbody", {}, way, ...rows))),
    make("p", { class: "note" }, t("strip.note")),
  ];
}

/** @param {any} summary */
function hem({ hem: measures, length, first }) {
  const tiles = OF_HEM.map(([name, digits, unit]) => {
    const one = measures[name];
    const shown = one === null ? null : name === "largest_force" ? (one * length) / 1e3 : name === "thinning" ? 100 * (1 - one) : one;
    return tile(t(`hem.${name}`), number(shown, digits), unit);
  });
  return [make("dl", { class: "heroes" }, ...tiles), make("p", { class: "note" }, t("hem.first", { angle: first.angle.toFixed(1), stroke: first.stroke.toFixed(2) }))];
}

/** @param {string} name @param {string} value @param {string} unit */
const tile = (name, value, unit) => make("div", {}, make("dt", {}, name), make("dd", {}, make("b", {}, value), make("span", {}, ` ${unit}`)));
