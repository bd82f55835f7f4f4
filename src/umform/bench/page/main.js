// @ts-check
// The page: its views, and how they work together.

import { get, post } from "./api.js";
import { compare } from "./compare.js";
import { Deck } from "./deck.js";
import { element, make } from "./dom.js";
import { Drawing } from "./drawing.js";
import { fields, known, setFields } from "./fields.js";
import { Form, VIEWS_OF_WORK } from "./form.js";
import { Jobs } from "./jobs.js";
import { Result } from "./result.js";
import { placeOf, showSeries } from "./series.js";
import { askTable } from "./table.js";
import { loadTexts, number, problemText, t } from "./texts.js";
import { showAgain, tour } from "./tour.js";

const VIEWS = ["bend", "compare", "all", "deck"];
/** The view of a kind of work. @param {string} work */
const viewOf = (work) => (VIEWS_OF_WORK.includes(work) ? work : "bend");

async function start() {
  if (location.search) history.replaceState(null, "", location.pathname + location.hash); // the token stays in the cookie
  const [, library] = await Promise.all([loadTexts(), get("/api/library")]);
  setFields(library.fields);
  const drawing = new Drawing(element("drawing"));
  const comparing = () => location.hash.startsWith("#compare") || location.hash.startsWith("#all");
  const jobs = new Jobs((name) => go(`bend/${name}`), (chosen) => chosen.length && location.hash.startsWith("#compare") && go(`compare/${chosen.join(",")}`),
    () => comparing() && show());
  const result = new Result(library, drawing, {
    gone: () => go(viewOf(form.values.work)),
    expected,
    ask: (/** @type {string} */ name, /** @type {any} */ what) => jobs.ask(name, what),
    again: (/** @type {any} */ job) => {
      Object.assign(form.values, structuredClone(known(job.parameters)));
      form.build();
      go(viewOf(form.values.work));
      form.look();
    },
    correct: async (/** @type {any} */ values) => {
      const answer = await post("/api/jobs", { forms: [values] });
      await jobs.refresh();
      go(`bend/${answer.jobs[0]}`);
    },
    sketch,
    tables: () => tables(),
    angles: (/** @type {any} */ job) => askTable({ values: taken(job) }, library, ordered),
    table: (/** @type {any} */ job) => {
      const { material, thickness, opening, angle } = job.parameters;
      Object.assign(form.values, taken(job), { metals: [material], thicknesses: [thickness], openings: [opening] }, angle === null ? {} : { angles: [angle] });
      form.setWork("table");
      go("table");
    },
  });
  const form = new Form(library, (found, values) => {
    if (!result.name) sketch(found, values.work);
    if (found.drawing && !result.name) drawing.set(found.drawing, { ...values, ...found.shown });
    element("sketch").classList.toggle("old", !found.drawing);
    if (!result.name) expected(found, values);
  });
  const tables = () => jobs.rows.filter((row) => row.state === "done" && row.parameters.work === "table");
  form.tables = tables;
  /** The form of a job. @param {any} job */
  const taken = (job) => ({ ...form.values, ...structuredClone(known(job.parameters)) });
  const ordered = async (/** @type {string} */ series) => {
    await jobs.refresh();
    go(placeOf(series));
  };
  const deck = new Deck((name) => go(`bend/${name}`));

  element("form").addEventListener("submit", async (/** @type {Event} */ event) => {
    event.preventDefault();
    try {
      const answer = await post("/api/jobs", { forms: [form.values] });
      await jobs.refresh();
      go(`bend/${answer.jobs[0]}`);
    } catch (problem) {
      const { answer } = /** @type {any} */ (problem);
      form.refuse((answer?.problems ?? [{ what: String(problem) }]).map(problemText).join("; "));
    }
  });
  element("fields").addEventListener("input", () => result.name && go(viewOf(form.values.work)));
  element("table").addEventListener("click", () => askTable(form, library, ordered));
  element("tour").addEventListener("click", () => {
    go("bend");
    tour();
  });
  element("language").addEventListener("change", async () => {
    await loadTexts(element("language").value);
    showAgain();
    form.build();
    form.look();
    jobs.mark(jobs.shown);
    result.job = null;
    result.refresh();
    show();
  });

  /** @param {string} place */
  function go(place) {
    if (location.hash === `#${place}`) show();
    else location.hash = place;
  }

  async function show() {
    const [wanted, rest = ""] = location.hash.slice(1).split("/");
    const view = VIEWS.includes(wanted) ? wanted : "bend";
    for (const one of VIEWS) element(`view-${one}`).hidden = one !== view;
    if (view === "bend" && !rest && viewOf(form.values.work) !== (wanted || "bend")) {
      if (wanted) form.setWork(VIEWS_OF_WORK.includes(wanted) ? wanted : "bend");
    }
    const current = view === "bend" ? viewOf(form.values.work) : view;
    for (const link of document.querySelectorAll("nav [data-view]")) {
      if (/** @type {any} */ (link).dataset.view === current) link.setAttribute("aria-current", "page");
      else link.removeAttribute("aria-current");
    }
    if (view === "bend" && rest !== result.name) { // `rest`: a job
      jobs.mark(rest);
      await result.open(rest);
      if (!rest) form.look();
    }
    if (view === "deck") await deck.start();
    if (view === "compare") {
      const names = rest ? rest.split(",") : [...jobs.chosen];
      await compare(names.filter((name) => /^[0-9a-f]{12}$/.test(name)).slice(0, 6));
      const series = [...new Set(jobs.rows.map((row) => row.series).filter(Boolean))].slice(0, 5);
      element("compare").append(...series.map((name) => make("p", {}, make("a", { href: `#${placeOf(name)}` }, t("table.of", { name })))));
    }
    if (view === "all") showSeries(jobs.rows, decodeURIComponent(rest));
  }

  addEventListener("hashchange", show);
  await show();
  document.documentElement.dataset.ready = "yes";
  tour(false);
}

/**
 * The card above the results: tools and sheet, or the part that is to be unfolded; nothing above a job without a drawing.
 * @param {any} found @param {string} work @param {boolean} [ofJob]
 */
function sketch(found, work, ofJob = false) {
  const flat = viewOf(work) === "flat";
  const [card, place] = [element("sketch"), element("part-view")];
  card.hidden = ofJob ? !found.drawing : flat && !found.part;
  place.hidden = !flat;
  element("drawing").style.display = flat ? "none" : "";
  element("drawing-text").hidden = flat;
  if (!found.drawing) element("expected").replaceChildren();
  const seen = flat && found.part ? JSON.stringify(found.part) : "";
  if (seen === place.dataset.seen) return;
  place.dataset.seen = seen;
  place.replaceChildren(...(seen ? [make("iframe", { class: "alone", title: t("shape.title"), sandbox: "allow-scripts", src: `/files/parts/${encodeURIComponent(found.part.name)}` })] : []));
}

/**
 * Values by workshop rules, and the force of the press, which is computed after the run.
 * @param {any} found @param {any} values @param {any} [needed]
 */
function expected(found, values, needed) {
  const facts = found.expected;
  const drawn = found.drawing?.kind === "draw";
  element("drawing-text").textContent = drawn ? t(`drawing.${values.work}`, { thickness: found.drawing.thickness })
    : found.drawing ? t("drawing.text", { opening: values.opening, thickness: thicknesses(values), ...found.shown }) : t(toolsFit(found.problems ?? []) ? "drawing.old" : "drawing.unfit");
  if (facts?.draw) return show(drawFacts(facts.draw));
  const press = needed ?? facts?.press;
  const range = (/** @type {any} */ { force: [low, high], beyond }) =>
    `${low === high ? number(low, 0) : `${number(low, 0)}–${number(high, 0)}`}${beyond ? ` ${t("rule.beyond")}` : ""} kN/m`;
  const rows = !facts ? [] : [
    ["press", t(`rule.press.${press.operation}`), `${press.beyond ? "> " : ""}${number(press.force, 1)} kN`, t(`rule.press.${press.basis}`)],
    ["ratio", t("rule.ratio"), number(facts.ratio, 1)], ["rm", t("rule.rm"), `${number(facts.tensile_strength, 0)} MPa`],
    ["force", t("rule.force"), range(facts)],
    ...facts.forces.filter((/** @type {any} */ one) => one.operation !== "bend").map((/** @type {any} */ one) => [one.operation, t(`rule.${one.operation}`), range(one)]),
    ["radius", t("rule.radius"), `${number(facts.radius, 1)} mm`],
  ];
  if (facts?.flat && !needed) { // outside dimensions: what the shop wants first
    const { length, lines, computed } = facts.flat;
    const about = computed ? "" : `${t("rule.about")} `;
    const how = t(computed ? "rule.flat.computed" : "rule.flat.about");
    rows.unshift(["flat", t("rule.flat"), `${about}${number(length, 2)} mm`, how], ["lines", t("rule.lines"), `${about}${lines.map((/** @type {number} */ one) => number(one, 2)).join(" · ")} mm`, how]);
  }
  show(rows);
}

/** The thickness of the sheet, and of a second one on it. @param {any} values */
const thicknesses = ({ thickness, second_material: second, second_thickness: other }) => [thickness, ...(second ? [other] : [])].map((one) => number(one)).join(" + ");

/** Whether no error is one of the tools. @param {{where: string}[]} problems */
const toolsFit = (problems) => !problems.some(({ where }) => where === "opening" || fields.some((one) => one.tool && one.name === where));

/** Numbers with their labels below the drawing. @param {any[][]} rows */
function show(rows) {
  element("expected").replaceChildren(...rows.map(([name, label, value, title]) =>
    make("div", { "data-rule": name, title: title ?? t(`rule.${name}.title`) }, make("dt", {}, label), make("dd", {}, value))));
}

/** What a toolmaker looks at before a part is drawn. @param {any} facts */
const drawFacts = ({ ratio, gap, pressure, stroke, height }) => [
  ["draw_ratio", t("rule.draw_ratio"), ratio, "", 2], ["draw_gap", t("rule.draw_gap"), gap, "mm", 2], ["draw_pressure", t("rule.draw_pressure"), pressure, "MPa", 2],
  ["draw_stroke", t("rule.draw_stroke"), stroke, "mm", 1], ["draw_height", t("rule.draw_height"), height, "mm", 1],
].filter(([, , value]) => value !== null).map(([name, label, value, unit, decimals]) => [name, label, `${number(value, decimals)} ${unit}`]);

start();
