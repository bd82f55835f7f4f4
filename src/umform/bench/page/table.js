// @ts-check
// A table by angle and opening: one bend for each pair.

import { post } from "./api.js";
import { element, make } from "./dom.js";
import { label, sizeField } from "./fields.js";
import { takingList, unclearList } from "./lists.js";
import { problemText, t } from "./texts.js";

/** Numbers of a list; an unclear one is an error. @param {string} text @returns {number[]} */
function listed(text) {
  const numbers = takingList(text);
  if (typeof numbers === "string") throw new Error(unclearList(numbers));
  return numbers;
}

/** @param {any} form @param {any} library @param {(series: string) => void} ordered */
export function askTable(form, library, ordered) {
  const dialog = element("table-dialog");
  const values = { ...form.values };
  const [opening, radius] = [sizeField("die", "opening"), sizeField("die", "radius")];
  const dies = new Map(library.tools.die.map((/** @type {any} */ { sizes }) => [sizes[opening], sizes[radius]]));
  dies.set(values[opening], values[radius]); // of the form
  const near = [...dies.keys()].filter((/** @type {number} */ one) => one >= 6 * values.thickness && one <= 12 * values.thickness);
  const angles = make("input", { id: "table-angles", value: `90 105 120 135` });
  const openings = make("input", { id: "table-openings", value: (near.length ? near : [values.opening]).join(" ") });
  const said = make("p", { class: "note", role: "status" });
  const form2 = make("form", { method: "dialog" }, make("h2", { id: "table-title" }, t("table.open")), make("p", { class: "soft" }, t("table.lead")),
    make("label", {}, t("table.angles"), angles), make("label", {}, t("table.openings"), openings), said,
    make("div", { class: "bar" }, make("button", { class: "main", type: "submit", id: "table-go" }, t("table.run")), make("button", { type: "button", onclick: () => dialog.close() }, t("cancel"))));
  form2.addEventListener("submit", async (/** @type {Event} */ event) => {
    event.preventDefault();
    try {
      const forms = listed(openings.value).flatMap((wide) => listed(angles.value).map((angle) =>
        ({ ...values, [opening]: wide, angle, stroke: null, die: wide === values[opening] ? values.die : null, [radius]: dies.get(wide) ?? values[radius] })));
      const series = `${values.material} ${values.thickness} mm`;
      const answer = await post("/api/jobs", { forms, series });
      ordered(series);
      if (answer.refused.length) {
        said.textContent = t("table.refused", { count: answer.refused.length, titles: answer.refused.map((/** @type {any} */ one) => one.title).join(", ") });
        said.className = "note warn";
      } else {
        dialog.close();
      }
    } catch (problem) {
      const { answer } = /** @type {any} */ (problem);
      said.textContent = (answer?.problems ?? [{ what: /** @type {Error} */ (problem).message }]).map(problemText).join("; ");
      said.className = "note bad";
    }
  });
  dialog.replaceChildren(form2);
  dialog.showModal();
}
