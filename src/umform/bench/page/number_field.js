// @ts-check
// Fields for numbers, which read texts in the same way.

import { read, typed } from "./decimals.js";
import { make } from "./dom.js";
import { language, t } from "./texts.js";

/**
 * A field for a number. `taken` gets the number, null for an empty field, or the text if it is no clear number.
 * @param {Record<string, any>} attributes @param {unknown} value @param {(value: number | string | null) => void} taken
 * @param {{integer?: boolean, bounds?: {gt?: number, ge?: number, lt?: number, le?: number}}} [range] of the arrow keys
 */
export function numberField(attributes, value, taken, { integer = false, bounds = {} } = {}) {
  // A field of type "number" drops a comma without a message in an English browser.
  const field = make("input", { type: "text", inputmode: "decimal", autocomplete: "off", ...attributes, value: typed(value, language) });
  field.addEventListener("input", () => taken(taking(field.value)));
  field.addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => {
    const way = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    const now = taking(field.value);
    if (!way || typeof now !== "number") return;
    event.preventDefault();
    const step = integer ? 1 : 10 ** Math.floor(Math.log10(Math.abs(now) || 1) - 1); // the second digit
    const next = Number((now + way * step).toPrecision(12));
    const { gt = -Infinity, ge = -Infinity, lt = Infinity, le = Infinity } = bounds;
    if (next <= gt || next < ge || next >= lt || next > le) return;
    show(field, next);
    taken(next);
  });
  return field;
}

/** The number of a text, null for none, or the text if it is no clear number. @param {string} text @returns {number | string | null} */
export function taking(text) {
  const { value, problem } = read(text, language);
  return problem ? text : value;
}

/** @param {any} field @param {unknown} value */
export function show(field, value) {
  field.value = typed(value, language);
}

/** Why a text is no clear number. @param {string} text */
export function unclear(text) {
  const plain = text.trim();
  if (read(text, language).problem !== "ambiguous") return t("number.unreadable", { text: plain });
  const [few, many] = [".", ""].map((sign) => Number(plain.replace(/[.,]/, sign)));
  return t("number.ambiguous", { text: plain, few: typed(few, language), many: typed(many, language) });
}

/** How a text was read, where its sign before the decimals is that of another language. @param {string} text */
export function howRead(text) {
  const { value, problem, other } = read(text, language);
  return other && !problem ? t("number.read", { number: typed(value, language) }) : "";
}
