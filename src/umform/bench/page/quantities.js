// @ts-check
// Quantities of a job as the server declares them: label, unit, decimals, error, limit; all tables use them.

import { make, wide } from "./dom.js";
import { message } from "./messages.js";
import { has, language, number, t } from "./texts.js";

/**
 * @typedef {{name: string, label: string, unit: string, decimals: number | null, digits: number, value: number | null, missed: boolean, of_mesh?: boolean,
 *   band: {error: number | null, middle: number | null, source: string} | null}} Quantity
 */

/** @param {Quantity} one */
const unitOf = ({ unit }) => (unit === "degrees" ? "°" : unit);

/** A value, an error or another number, as the terminal shows it: by its decimals, unless they show an error as zero, else to the second digit of its error. @param {Quantity} one @param {number | null} value */
function shown({ decimals, digits, band, value: own }, value) {
  const hidden = band?.error && own && Number(band.error.toFixed(decimals ?? 0)) === 0 && band.error / Math.abs(own) >= 10 ** -digits;
  const fixed = hidden ? null : decimals;
  const places = fixed ?? (band?.error ? Math.max(1 - Math.floor(Math.log10(band.error)), 0) : null);
  if (places !== null || value === null) return number(value, places ?? undefined);
  return value.toLocaleString(language, { useGrouping: false, maximumSignificantDigits: digits });
}

/** @param {Quantity} one */
export const best = ({ value, band }) => band?.middle ?? value;

/** The label, translated where known; those of a bend or a stage begin with its name. @param {Pick<Quantity, "name" | "label">} one @param {string} words @returns {string} */
export function labelOf({ name, label }, words) {
  const key = [`${words}.${name}`, `measure.${name}`].find(has);
  if (key) return t(key);
  const [, stage = "", rest = ""] = /^([^:]+): (.*)$/.exec(name) ?? [];
  const [, bend] = /^bend (\d+)$/.exec(stage) ?? [];
  if (bend || has(`stage.${stage}`)) {
    const of = bend ? t("bend.number", { number: Number(bend) }) : t(`stage.${stage}`);
    return `${of}: ${labelOf({ name: rest, label: label.replace(`${stage}: `, "") }, words)}`;
  }
  const [, sheet, measure] = /^sheet(\d+)_(.*)$/.exec(name) ?? [];
  if (sheet) return `${t("sheet.number", { number: Number(sheet) })}: ${labelOf({ name: measure, label: label.replace(`sheet ${sheet}: `, "") }, words)}`;
  const [, flange] = /^flange (\d+)$/.exec(name) ?? [];
  return flange ? t("strip.flange", { number: Number(flange) }) : message(label);
}

/** Label and unit. @param {Quantity} one @param {string} words */
export const heading = (one, words = "measure") => [labelOf(one, words), unitOf(one)].filter(Boolean).join(", ");

/** @param {Quantity} one */
export const errorText = (one) => [one.band && one.band.error !== null ? bandText(one, one.band) : "", one.of_mesh ? t("of.mesh") : ""].filter(Boolean).join(", ");

/** @param {Quantity} one @param {{error: number | null, source: string}} band */
const bandText = (one, band) => (band.source === "given" ? t("given") : `± ${shown(one, band.error)}`);

/** The number, marked beyond its limit. @param {Quantity} one */
export const numberText = (one) => `${shown(one, best(one))}${one.missed ? ` ${t("missed")}` : ""}`;

/** A cell of a table; none for a quantity that a job has not. @param {Quantity | undefined} one */
export const cell = (one) => make("td", { class: one?.missed ? "bad" : null }, one ? numberText(one) : "");

/** A row of a table: label, number, error, unit. @param {Quantity} one @param {string} words */
export const row = (one, words = "measure") =>
  make("tr", {}, make("th", { scope: "row" }, labelOf(one, words)), cell(one), make("td", {}, errorText(one)), make("td", {}, unitOf(one)));

/** All rows as a table. @param {Quantity[]} quantities @param {string} [words] */
export const table = (quantities, words) =>
  wide(make("table", {}, make("tbody", {}, ...quantities.map((one) => row(one, words)))));

/** A number and its error in large letters, what it means below. @param {Quantity} one @param {string} words @param {string} [means] */
export const tile = (one, words, means) =>
  make("div", { "data-measure": one.name }, make("dt", {}, labelOf(one, words)),
    make("dd", { class: one.missed ? "bad" : null }, make("b", {}, numberText(one)), make("span", {}, ` ${[unitOf(one), errorText(one)].filter(Boolean).join(" ")}`)),
    means ? make("dd", { class: "soft" }, means) : null);

/** For the workshop: the largest force over the whole length in kN, the thinnest point as thinning in per cent. @param {Quantity} one @param {number} length @returns {Quantity} */
export function forShop(one, length) {
  const of = (/** @type {(value: number) => number} */ change, /** @type {number} */ factor, /** @type {Partial<Quantity>} */ what) => {
    const changed = (/** @type {number | null | undefined} */ value) => (value === null || value === undefined ? null : change(value));
    const error = one.band?.error ?? null;
    const band = one.band && { ...one.band, middle: changed(one.band.middle), error: error === null ? null : factor * error };
    return { ...one, ...what, value: changed(one.value), band };
  };
  if (one.name === "largest_force") return of((value) => (value * length) / 1e3, length / 1e3, { unit: "kN", decimals: 1 });
  if (one.name === "thinning") return of((value) => 100 * (1 - value), 100, { name: "thinned", unit: "%", decimals: 1 });
  return one.name === "outer_strain" ? { ...one, decimals: 3 } : one;
}
