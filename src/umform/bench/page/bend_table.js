// @ts-check
// A bend table: bends that are stored appear at once, the others as they are computed.

import { make, wide } from "./dom.js";
import { message } from "./messages.js";
import { number, t } from "./texts.js";

/** @typedef {{name: string, metal: string, thickness: number, opening: number, punch_radius: number, die_radius: number, angle: number, radius: number, k_factor: number,
 *   bend_allowance: number, bend_deduction: number, stroke: number, largest_force: number, springback: number, computed: boolean}} Row */

/** Columns and their decimals. @type {[keyof Row, number, string][]} */
const COLUMNS = [["radius", 3, "mm"], ["k_factor", 3, ""], ["bend_allowance", 3, "mm"], ["bend_deduction", 3, "mm"], ["stroke", 3, "mm"], ["largest_force", 1, "kN/m"], ["springback", 2, "°"]];

/** All bends, those of a setup together. @param {Row[]} rows @param {Row[]} [before] the same with the card as it was */
export function tableRows(rows, before = []) {
  const names = [...new Set(rows.map(({ name }) => name))];
  const old = (/** @type {Row} */ row) => before.find((one) => one.angle === row.angle && one.thickness === row.thickness && one.opening === row.opening
    && one.punch_radius === row.punch_radius && one.die_radius === row.die_radius);
  const cell = (/** @type {Row} */ row, /** @type {keyof Row} */ name, /** @type {number} */ decimals) => {
    const was = old(row)?.[name];
    const value = number(/** @type {number} */ (row[name]), decimals);
    const change = was === undefined ? null : make("span", { class: "soft was" }, ` (${number(/** @type {number} */ (was), decimals)})`);
    return make("td", {}, value, change);
  };
  const head = make("tr", {}, make("th", { scope: "col" }, `${t("measure.angle")}, °`),
    ...COLUMNS.map(([name, , unit]) => make("th", { scope: "col" }, [t(`measure.${name}`), unit].filter(Boolean).join(", "))));
  const group = (/** @type {string} */ name) => {
    const own = rows.filter((row) => row.name === name);
    const { metal, thickness, opening, punch_radius: punch, die_radius: die } = own[0];
    const title = t("table.setup", { metal, thickness, opening, punch, die });
    return [make("tr", {}, make("th", { scope: "rowgroup", colspan: COLUMNS.length + 1 }, title)),
      ...own.map((row) => make("tr", {}, make("th", { scope: "row" }, `${number(row.angle)}°`), ...COLUMNS.map(([name2, decimals]) => cell(row, name2, decimals))))];
  };
  return wide(make("table", { class: "columns", id: "bend-table" }, make("thead", {}, head), ...names.map((name) => make("tbody", {}, ...group(name)))));
}

/** @param {any} job @returns {Node[]} */
export function tableNumbers({ summary: { table, table_before: before, computed, remarks, failed, linear_error: error } }) {
  const warnings = [...failed.map((/** @type {string} */ text) => make("p", { class: "note bad" }, t("table.failed", { text: message(text) }))),
    ...remarks.map((/** @type {string} */ text) => make("p", { class: "note warn" }, message(text)))];
  const notes = [t("table.count", { count: table.length, computed }), t(error === null ? "table.unchecked" : "table.checked", { error: error ?? 0 }), t("table.definitions")];
  return [...warnings, tableRows(table, before), ...notes.map((text) => make("p", { class: "note" }, text))];
}
