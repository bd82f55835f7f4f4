// @ts-check
// A table by angle and opening: one bend for each pair.

import { post } from "./api.js";
import { element, make } from "./dom.js";
import { label } from "./fields.js";
import { takingList, unclearList } from "./lists.js";
import { number, problemText, t } from "./texts.js";

/** Numbers of a list; an unclear one is an error. @param {string} text @returns {number[]} */
function listed(text) {
  const numbers = takingList(text);
  if (typeof numbers === "string") throw new Error(unclearList(numbers));
  return numbers.slice(0, 12).filter((value) => value > 0);
}

/** @param {any} form @param {any} library @param {(names: string[]) => void} ordered */
export function askTable(form, library, ordered) {
  const dialog = element("table-dialog");
  const values = { ...form.values };
  const near = library.tools.dies.map((/** @type {any} */ die) => die.opening).filter((/** @type {number} */ one) => one >= 6 * values.thickness && one <= 12 * values.thickness);
  const angles = make("input", { id: "table-angles", value: `90 105 120 135` });
  const openings = make("input", { id: "table-openings", value: (near.length ? near : [values.opening]).join(" ") });
  const said = make("p", { class: "note", role: "status" });
  const form2 = make("form", { method: "dialog" }, make("h2", { id: "table-title" }, t("table.open")), make("p", { class: "soft" }, t("table.lead")),
    make("label", {}, t("table.angles"), angles), make("label", {}, t("table.openings"), openings), said,
    make("div", { class: "bar" }, make("button", { class: "main", type: "submit", id: "table-go" }, t("table.run")), make("button", { type: "button", onclick: () => dialog.close() }, t("cancel"))));
  form2.addEventListener("submit", async (/** @type {Event} */ event) => {
    event.preventDefault();
    try {
      const forms = listed(openings.value).flatMap((opening) => {
        const die = library.tools.dies.find((/** @type {any} */ one) => one.opening === opening);
        return listed(angles.value).map((angle) => ({ ...values, opening, angle, stroke: null, die: null, die_radius: die?.radius ?? values.die_radius }));
      });
      const answer = await post("/api/jobs", { forms, series: `${values.material} ${values.thickness} mm` });
      if (answer.refused.length) {
        said.textContent = t("table.refused", { count: answer.refused.length, titles: answer.refused.map((/** @type {any} */ one) => one.title).join(", ") });
        said.className = "note warn";
      } else {
        dialog.close();
      }
      ordered(answer.jobs);
    } catch (problem) {
      const { answer } = /** @type {any} */ (problem);
      said.textContent = (answer?.problems ?? [{ what: /** @type {Error} */ (problem).message }]).map(problemText).join("; ");
      said.className = "note bad";
    }
  });
  dialog.replaceChildren(form2);
  dialog.showModal();
}

/**
 * Angles in rows, openings in columns, of the finished jobs of a series.
 * @param {any[]} rows
 */
export function seriesTable(rows) {
  const done = rows.filter((row) => row.summary.measures?.angle);
  const angles = [...new Set(done.map((row) => row.parameters.angle))].sort((a, b) => a - b);
  const openings = [...new Set(done.map((row) => row.parameters.opening))].sort((a, b) => a - b);
  if (angles.length * openings.length < 2) return null;
  const cell = (/** @type {number} */ angle, /** @type {number} */ opening) => {
    const found = done.find((row) => row.parameters.angle === angle && row.parameters.opening === opening)?.summary.measures;
    return found ? make("td", {}, `${number(found.stroke, 2)} / ${number(found.largest_force, 0)} / ${number(found.bend_deduction, 2)}`) : make("td", {}, "–");
  };
  const head = make("tr", {}, make("th", {}, label("angle")), ...openings.map((opening) => make("th", { scope: "col" }, `V ${number(opening)}`)));
  const body = angles.map((angle) => make("tr", {}, make("th", { scope: "row" }, `${number(angle)}°`), ...openings.map((opening) => cell(angle, opening))));
  return make("figure", { class: "card" }, make("div", { class: "wide" }, make("table", { class: "columns" }, make("thead", {}, head), make("tbody", {}, ...body))),
    make("figcaption", {}, t("table.caption")));
}
