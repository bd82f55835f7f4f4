// @ts-check
// Results of a part with several bends, and of a hem.

import { make } from "./dom.js";
import { message } from "./messages.js";
import { pressTile } from "./numbers.js";
import { cell, forShop, heading, table, tile } from "./quantities.js";
import { number, t } from "./texts.js";

/** The numbers of a bend for the machine, and those of a hem. */
const OF_BEND = ["stroke", "largest_force", "angle", "final_angle", "springback", "radius", "k_factor", "bend_deduction", "outer_strain"];
const OF_HEM = ["height", "springback", "largest_force", "left", "tip_gap", "loop_gap", "roll_in", "angle", "outer_strain", "thinning"];

/** @param {any} job @returns {Node[]} */
export function stripNumbers({ summary }) {
  const red = summary.collisions ?? [];
  const warnings = [...summary.warnings, ...(summary.coarse_mesh ?? [])].map((/** @type {string} */ text) => make("p", { class: `note ${red.includes(text) ? "bad" : "warn"}` }, message(text)));
  return [...warnings, ...(summary.hem ? hem(summary) : part(summary))];
}

/** @typedef {import("./quantities.js").Quantity} Quantity */

/** @param {any} summary */
function part(summary) {
  const { bends, columns = [], sizes = [], quantities = [], checks = [], flat_length: flat, length } = summary;
  const named = (/** @type {Quantity[]} */ column, /** @type {string} */ name) => forShop(/** @type {Quantity} */ (column.find((one) => one.name === name)), length);
  const rows = columns.length ? OF_BEND.map((name) => make("tr", {}, make("th", { scope: "row" }, heading(named(columns[0], name), "strip")),
    ...columns.map((/** @type {Quantity[]} */ column) => cell(named(column, name))))) : [];
  const given = (/** @type {string} */ name, /** @type {(bend: any) => string} */ text) =>
    make("tr", {}, make("th", { scope: "row" }, t(`strip.${name}`)), ...bends.map((/** @type {any} */ bend) => make("td", {}, text(bend))));
  const head = make("tr", {}, make("td"), ...bends.map((/** @type {any} */ _, /** @type {number} */ i) => make("th", { scope: "col" }, t("bend.number", { number: i + 1 }))));
  const whole = { name: "flat", label: "", unit: "mm", decimals: 2, digits: 4, value: flat, missed: false, band: null };
  return [
    make("dl", { class: "heroes" }, ...pressTile(summary), ...[whole, ...sizes].map((one) => tile(one, "strip"))),
    make("div", { class: "wide" }, make("table", { class: "columns", id: "strip-table" }, make("thead", {}, head), make("tbody", {},
      given("position", (bend) => `${number(bend.position, 1)} mm`), given("way", (bend) => t(bend.over ? "bends.down" : "bends.up")),
      given("wanted", (bend) => `${number(bend.wanted, 1)}°`), ...rows))),
    all([...quantities, ...checks], "measure"),
    make("p", { class: "note" }, t("strip.note")),
  ];
}

/** @param {any} summary */
function hem(summary) {
  const { quantities = [], checks = [], length, first } = summary;
  const tiles = OF_HEM.flatMap((name) => quantities.filter((/** @type {Quantity} */ one) => one.name === name)).map((one) => tile(forShop(one, length), "hem"));
  return [make("dl", { class: "heroes" }, ...pressTile(summary), ...tiles), all([...quantities, ...checks], "hem"), make("p", { class: "note" }, t("hem.first", { angle: number(first.angle, 1), stroke: number(first.stroke, 2) }))];
}

/** @param {Quantity[]} quantities @param {string} words */
const all = (quantities, words) => make("details", {}, make("summary", {}, t("all")), table(quantities, words));
