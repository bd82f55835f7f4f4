// @ts-check
// All bends that were ordered at once, in one table: angles and openings in rows, filled as the jobs end.

import { element, make } from "./dom.js";
import { differing, fullHeading, givenText } from "./fields.js";
import { language, number, t } from "./texts.js";

/** Columns: number of the bend, decimals, unit. @type {[string, number, string][]} */
const COLUMNS = [["stroke", 3, "mm"], ["press", 1, "kN"], ["largest_force", 1, "kN/m"], ["springback", 2, "°"], ["angle", 2, "°"], ["radius", 3, "mm"], ["k_factor", 3, ""], ["bend_deduction", 3, "mm"]];

/** Where a series is shown. @param {string} name */
export const placeOf = (name) => `all/${encodeURIComponent(name)}`;

/** @param {any[]} rows all jobs, the latest first @param {string} name */
export function showSeries(rows, name) {
  const ordered = rows.filter((row) => row.series === name);
  const others = differing(ordered).filter((field) => !["opening", "angle"].includes(field)); // of several orders of this name
  const key = (/** @type {any} */ { parameters }) => JSON.stringify(["opening", "angle", ...others].map((field) => parameters[field] ?? null));
  const latest = ordered.filter((row, i) => ordered.findIndex((other) => key(other) === key(row)) === i)
    .sort((a, b) => a.parameters.opening - b.parameters.opening || a.parameters.angle - b.parameters.angle);
  const done = latest.filter((row) => row.state === "done");
  element("all-title").textContent = t("series.title", { name });
  const head = make("tr", {}, ...[t("series.opening"), t("series.wanted"), ...others.map(fullHeading), ...COLUMNS.map(([column, , unit]) => [t(column === "press" ? "hero.press" : `measure.${column}`), unit].filter(Boolean).join(", ")), t("series.job")]
    .map((text) => make("th", { scope: "col" }, text)));
  const parts = [
    make("p", { class: "soft", role: "status" }, t("series.done", { done: done.length, count: latest.length })),
    make("div", { class: "wide card" }, make("table", { class: "columns", id: "series-table" }, make("thead", {}, head), make("tbody", {}, ...latest.map((row) => line(row, others))))),
    make("p", { class: "bar" }, make("a", { class: "button", href: `/api/jobs.csv?ids=${latest.map(({ id }) => id).join(",")}&language=${language}` }, t("file.table")),
      make("button", { type: "button", onclick: () => window.print() }, t("print"))),
  ];
  element("all").replaceChildren(...(latest.length ? parts : [make("p", { class: "soft" }, t("series.none"))]));
}

/** @param {any} row @param {string[]} others fields in which rows differ, beside opening and angle */
function line(row, others) {
  const { id, number: count, state, parameters, summary } = row;
  const { measures = {}, press, verdict } = summary;
  const value = (/** @type {string} */ name) => (name === "press" ? press?.force : measures[name]);
  const cells = state === "done" && measures.stroke !== undefined
    ? COLUMNS.map(([name, decimals]) => make("td", {}, number(value(name), decimals)))
    : [make("td", { colspan: COLUMNS.length, class: "soft state" }, state === "running" ? `${Math.round(100 * row.fraction)} %` : t(`state.${state}`))];
  const bad = ["missed", "collides"].includes(verdict);
  return make("tr", {}, make("th", { scope: "row" }, `V ${number(parameters.opening)}`), make("th", { scope: "row" }, `${number(parameters.angle)}°`),
    ...others.map((field) => make("td", {}, givenText(row, field))), ...cells,
    make("td", { class: bad ? "bad" : null }, make("a", { href: `#bend/${id}` }, String(count)), bad ? ` ${t(`state.${verdict}`)}` : ""));
}
