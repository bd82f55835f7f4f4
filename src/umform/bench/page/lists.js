// @ts-check
// Lists of numbers in one field: blanks or semicolons between them, or first:last:step.

import { taking, unclear } from "./number_field.js";
import { language, t } from "./texts.js";
import { typed } from "./decimals.js";

/** Most numbers of a range. */
const MOST = 100;

/** Entries of a text. @param {string} text */
const entries = (text) => text.split(/[;\s]+|,\s+/).filter(Boolean);

/** Numbers of an entry: one, or those of a range; null if it is unclear. @param {string} entry @returns {number[] | null} */
function numbersOf(entry) {
  const parts = entry.split(":").map(taking);
  if (![1, 3].includes(parts.length) || parts.some((one) => typeof one !== "number")) return null;
  if (parts.length === 1) return /** @type {number[]} */ (parts);
  const [first, last, step] = /** @type {number[]} */ (parts);
  const count = Math.floor((last - first) / step + 1e-9) + 1;
  return step > 0 && count >= 1 && count <= MOST ? Array.from({ length: count }, (_, i) => Number((first + i * step).toPrecision(12))) : null;
}

/** The numbers of a text, or the text if one of them is unclear. @param {string} text @returns {number[] | string} */
export function takingList(text) {
  const found = entries(text).map(numbersOf);
  return found.some((one) => one === null) ? text : found.flatMap((one) => one ?? []);
}

/** A list as it stands in a field. @param {unknown} values */
export const typedList = (values) => (Array.isArray(values) ? values.map((one) => typed(one, language)).join(" ") : String(values ?? ""));

/** Why a text is no clear list. @param {string} text */
export function unclearList(text) {
  const wrong = entries(text).find((one) => numbersOf(one) === null) ?? text;
  return wrong.includes(":") ? t("list.range", { text: wrong }) : unclear(wrong);
}
