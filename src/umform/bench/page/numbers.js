// @ts-check
// The numbers of a bend: those that the machine needs first, the others folded; the press force of any job.

import { make } from "./dom.js";
import { message } from "./messages.js";
import { howRead, numberField, taking, unclear } from "./number_field.js";
import { forShop, table, tile } from "./quantities.js";
import { number, t } from "./texts.js";

/** The first numbers, and those that are folded, in the order of the page. */
const FIRST = ["stroke", "press", "springback", "bend_deduction"];
const MORE = ["largest_force", "angle", "radius", "k_factor", "outer_strain", "thinning"];
/** Standard gravity in m/s², for forces in tonnes. */
const GRAVITY = 9.80665;

/** @typedef {import("./quantities.js").Quantity} Quantity */

/** The force for choosing the press, as a quantity; none for a job without one. @param {any} summary @returns {Quantity[]} */
function pressOf({ press, coarse_mesh: coarse = [] }) {
  if (!press) return [];
  const band = press.band ?? null; // a job of an earlier bench has none
  const mesh = press.basis === "computed" && coarse.length > 0 && !band;
  return [{ name: "press", label: "", unit: "kN", decimals: 1, digits: 4, value: press.force, missed: false, band, of_mesh: mesh }];
}

/** The tile of the press force: in kN, in tonnes, and where it comes from. @param {any} summary */
export function pressTile(summary) {
  return pressOf(summary).map((one) => {
    const { force, basis, beyond } = summary.press;
    const [low, high] = summary.shop_forces ?? [];
    const whence = low === undefined && basis === "rule" ? t("means.press.rule.alone") : t(`means.press.${basis}`, { low: number(low, 0), high: number(high, 0) });
    const means = [`${beyond ? "> " : ""}${number(force / GRAVITY, 2)} t`, summary.length ? t("means.press.length", { length: summary.length }) : "", whence];
    return tile(one, "hero", means.filter(Boolean).join("; "));
  });
}

/**
 * @param {any} job @param {() => HTMLElement} measured the fields of a measured bend
 * @returns {Node[]}
 */
export function bendNumbers(job, measured) {
  const { summary } = job;
  const { measures, quantities = [], checks = [], shop_forces: shop, warnings = [], coarse_mesh: coarse = [], length } = summary;
  const named = (/** @type {string} */ name) => {
    if (name === "press") return pressTile(summary);
    return quantities.filter((/** @type {Quantity} */ one) => one.name === name).map((/** @type {Quantity} */ one) => {
      const shown = forShop(one, length);
      return tile(shown, "hero", t(`means.${shown.name}`, { length, each: number(one.value, 1) }));
    });
  };
  const notes = [];
  const ratio = measures.largest_force / (0.5 * (shop[0] + shop[1]));
  if (ratio < 0.93) notes.push(t("note.below", { percent: Math.round(100 * (1 - ratio)) }));
  if (measures.k_factor !== null && measures.k_factor < 0.33) notes.push(t("note.k"));
  if (!job.parameters.budget && !coarse.length && job.parameters.work !== "bottom") notes.push(t("note.nobudget"));
  const missed = [...quantities, ...checks].filter((/** @type {Quantity} */ one) => one.missed);
  return [
    ...[...warnings, ...coarse].map((/** @type {string} */ text) => make("p", { class: "note warn" }, message(text))),
    ...(missed.length ? [make("p", { class: "note bad" }, t("note.missed")), table(missed)] : []),
    make("dl", { class: "heroes first" }, ...FIRST.flatMap(named)),
    ...(job.parameters.work === "bend" ? [measured()] : []),
    make("details", { id: "more-numbers" }, make("summary", {}, t("numbers.more")),
      make("dl", { class: "heroes" }, ...MORE.flatMap(named)), flatLength(measures), ...notes.map((text) => make("p", { class: "note" }, text))),
    make("details", {}, make("summary", {}, t("all")), table([...quantities, ...checks])),
  ];
}

/** The flat length of a part from its outer dimensions. @param {any} measures */
function flatLength(measures) {
  if (measures.bend_deduction === null) return make("span");
  const output = make("output", { class: "value" });
  /** @type {any[]} */
  const fields = ["a", "b"].map((name) => numberField({ id: `flat-${name}`, "aria-label": t(`flat.${name}`) }, 100, () => reckon()));
  const reckon = () => {
    const texts = fields.map((field) => field.value);
    const legs = texts.map(taking);
    const wrong = legs.findIndex((leg) => typeof leg === "string");
    const sum = Number(legs[0]) + Number(legs[1]) - measures.bend_deduction;
    output.textContent = wrong >= 0 ? unclear(texts[wrong]) : [`${number(sum, 2)} mm`, ...texts.map(howRead).filter(Boolean)].join(", ");
  };
  reckon();
  return make("p", { class: "flat" }, `${t("flat")}: `, fields[0], " + ", fields[1], ` − ${number(measures.bend_deduction, 2)} = `, output);
}
