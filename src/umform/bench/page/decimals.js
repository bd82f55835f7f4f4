// @ts-check
// Numbers as a reader types them: a point or a comma before the decimals, in both languages; never a guess.

/** @typedef {{value: number | null, problem: "" | "unreadable" | "ambiguous", other: boolean}} Read */

const NUMBER = /^[+-]?(\d+[.,]?\d*|[.,]\d+)(e[+-]?\d+)?$/i;
/** One sign with three digits behind it: three decimals, or thousands. */
const GROUP = /^[+-]?[1-9]\d{0,2}([.,])\d{3}$/;

/** The sign before decimals. @param {string} language */
export const point = (language) => (language === "de" ? "," : ".");

/**
 * A text as a number. The sign of the other language is read as the sign before decimals too (`other`), unless it may
 * separate thousands.
 * @param {string} text @param {string} language @returns {Read}
 */
export function read(text, language) {
  const plain = text.trim().replace("\u2212", "-");
  if (plain === "") return { value: null, problem: "", other: false };
  if (!NUMBER.test(plain)) return { value: null, problem: "unreadable", other: false };
  const sign = GROUP.exec(plain)?.[1] ?? point(language);
  if (sign !== point(language)) return { value: null, problem: "ambiguous", other: true };
  return { value: Number(plain.replace(",", ".")), problem: "", other: plain.includes(point(language) === "." ? "," : ".") };
}

/** A value as it stands in a field; what could not be read stands there as it was typed. @param {unknown} value @param {string} language */
export const typed = (value, language) => (typeof value === "number" ? String(value).replace(".", point(language)) : String(value ?? ""));
