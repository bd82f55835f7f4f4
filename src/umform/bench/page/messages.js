// @ts-check
// Messages of the program in the language of the reader: English templates with {} and their translations.

import { point } from "./decimals.js";

/** @type {Map<string, string>} */
let exact = new Map();
/** @type {[RegExp, string][]} */
let filled = [];
/** A number with decimals, which is no part of a name or a path. */
const DECIMALS = /(?<![\w.])\d+\.\d+(?:e[+-]?\d+)?(?![\w]|\.\w)/g;
let sign = ".";

/** @param {string} language */
export async function loadMessages(language) {
  const known = language === "en" ? {} : await (await fetch(`/assets/messages.${language}.json`)).json();
  const pairs = /** @type {[string, string][]} */ (Object.entries(known));
  sign = point(language);
  exact = new Map(pairs.filter(([text]) => !text.includes("{}")));
  // the longest first: "{} differ" would match too much
  filled = pairs.filter(([text]) => text.includes("{}")).sort(([a], [b]) => b.length - a.length)
    .map(([text, other]) => [new RegExp(`^${text.split("{}").map(escaped).join("(.+?)")}$`, "s"), other]);
}

/** @param {string} text */
const escaped = (text) => text.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");

/** A message and its inserts, translated where known. @param {string} text @returns {string} */
export function message(text) {
  const known = exact.get(text);
  if (known !== undefined) return known;
  for (const [pattern, other] of filled) {
    const found = pattern.exec(text);
    if (found) {
      let at = 0;
      return other.replace(/\{\}/g, () => listed(found[(at += 1)]));
    }
  }
  return text;
}

/** An insert: a list of messages, or one of them, or numbers and names. @param {string} text */
function listed(text) {
  const parts = text.split(", ");
  const said = parts.map(message);
  if (said.every((one, i) => one !== parts[i])) return said.join(", ");
  const whole = message(text);
  return whole === text ? text.replace(DECIMALS, (number) => number.replace(".", sign)) : whole;
}
