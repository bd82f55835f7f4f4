// @ts-check
// "I measured 91.3": the metal is corrected by a measured bend, and the bend to the wanted angle is found again.

import { tableNumbers } from "./bend_table.js";
import { make, wide } from "./dom.js";
import { label } from "./fields.js";
import { message } from "./messages.js";
import { howRead, numberField, taking, unclear } from "./number_field.js";
import { plot } from "./plot.js";
import { heading, numberText } from "./quantities.js";
import { number, problemText, t } from "./texts.js";

/** The fields, with their units. */
const FIELDS = [["measured_angle", "°"], ["measured_force", "kN/m"], ["measured_radius", "mm"]];
/** Standard deviations from which a measurement is not met. */
const FAR = 2;
/** Numbers of the bend that are compared, in their order. */
const SHOWN = ["stroke", "largest_force", "springback", "radius", "k_factor", "bend_deduction"];

/** Fields below the numbers of a bend. @param {any} job @param {any} actions */
export function measuredForm(job, actions) {
  const { measures } = job.summary;
  /** @type {Record<string, any>} */
  const inputs = {};
  const said = make("p", { class: "note", role: "status", id: "measured-said" });
  for (const [name] of FIELDS) inputs[name] = numberField({ id: `m-${name}` }, null, () => { said.textContent = howRead(inputs[name].value); said.className = "note"; });
  const tables = actions.tables().filter((/** @type {any} */ row) => row.parameters.metals.includes(job.parameters.material));
  const again = make("select", { id: "m-issue_again" }, make("option", { value: "" }, t("again.none")),
    ...tables.map((/** @type {any} */ row) => make("option", { value: row.id }, `${row.number} · ${row.title}`)));
  if (tables.length) again.value = tables[0].id;
  const fields = FIELDS.map(([name, unit]) => make("label", { for: `m-${name}` }, `${label(name)}, ${unit}`, inputs[name]));
  const send = make("button", { class: "main", type: "submit", id: "measured-go" }, t("measured.go"));
  const form = make("form", { class: "measured", novalidate: true }, ...fields, make("label", { for: "m-issue_again" }, label("issue_again"), again), send, said);
  form.addEventListener("submit", async (/** @type {Event} */ event) => {
    event.preventDefault();
    const given = Object.fromEntries(FIELDS.map(([name]) => [name, taking(inputs[name].value)]));
    const wrong = Object.values(given).find((value) => typeof value === "string");
    try {
      if (wrong !== undefined) throw new Error(unclear(String(wrong)));
      await actions.correct({ ...valuesOf(job), ...given, work: "correct", stroke: measures.stroke, angle: job.parameters.angle ?? measures.angle, issue_again: again.value || null });
    } catch (problem) {
      const { answer } = /** @type {any} */ (problem);
      said.className = "note bad";
      said.textContent = (answer?.problems ?? [{ what: /** @type {Error} */ (problem).message }]).map(problemText).join("; ");
    }
  });
  return make("details", { id: "measured" }, make("summary", {}, t("measured.title")), make("p", { class: "soft" }, t("measured.lead", { stroke: number(measures.stroke, 3) })), form);
}

/** The form of a bend, without what a correction has not. @param {any} job */
const valuesOf = ({ parameters }) => Object.fromEntries(Object.entries(parameters).filter(([name]) => name !== "budget"));

/** The corrected metal, the bend with it, and the table. @param {any} job @returns {Node[]} */
export function corrected({ parameters, summary }) {
  const { corrected: factors, notes, misfit, bends, curves, table } = summary;
  const missed = misfit === null || misfit > FAR || factors.some((/** @type {any} */ one) => one.error === null);
  const tiles = factors.map((/** @type {any} */ one) => make("div", { "data-factor": one.name }, make("dt", {}, t(`factor.${one.name}`, {}, t("factor.shape", { name: one.name }))),
    make("dd", {}, make("b", {}, `× ${number(one.value, 3)}`), make("span", {}, ` ± ${number(one.error, 3)}`))));
  const stroke = (/** @type {number} */ i) => bends[i].find((/** @type {any} */ one) => one.name === "stroke");
  const hero = bends ? [make("div", { "data-measure": "new_stroke" }, make("dt", {}, t("measured.stroke", { angle: number(parameters.angle, 2) })),
    make("dd", {}, make("b", {}, numberText(stroke(1))), make("span", {}, " mm")), make("dd", { class: "soft" }, t("measured.instead", { stroke: numberText(stroke(0)) })))] : [];
  return [
    ...(missed ? [make("p", { class: "note bad" }, t("measured.missed"))] : []),
    make("dl", { class: "heroes" }, ...hero, ...tiles),
    ...notes.map((/** @type {string} */ text) => make("p", { class: "note" }, message(text))),
    ...(bends ? [compared(bends)] : []),
    make("figure", { class: "card" }, plot(curves.map((/** @type {any} */ curve, /** @type {number} */ i) => ({ name: String(i), ...curve })), { x: t("axis.strain"), y: t("axis.stress"), label: t("measured.curves") }),
      make("figcaption", {}, make("i", { class: "swatch c0" }), `${t("measured.before")} `, make("i", { class: "swatch c1" }), t("measured.after"))),
    ...(table ? [make("h3", {}, t("measured.table")), ...tableNumbers({ summary })] : []),
  ];
}

/** The bend to the wanted angle with both metals. @param {any[][]} bends */
function compared(bends) {
  const rows = SHOWN.flatMap((name) => bends[0].filter((one) => one.name === name)).map((one) => {
    const other = bends[1].find((each) => each.name === one.name);
    return make("tr", {}, make("th", { scope: "row" }, heading(one)), make("td", {}, numberText(one)), make("td", {}, numberText(other)));
  });
  const head = make("tr", {}, make("td"), make("th", { scope: "col" }, t("measured.before")), make("th", { scope: "col" }, t("measured.after")));
  return wide(make("table", { class: "columns", id: "measured-bends" }, make("thead", {}, head), make("tbody", {}, ...rows)));
}
