// @ts-check
// All texts in the language of the reader, and numbers as they are written there.

import { element } from "./dom.js";
import { loadMessages, message } from "./messages.js";

/** @type {Record<string, any>} */
let texts = {};
export let language = "en";

/** @returns {string} */
function preferred() {
  let kept = null;
  try {
    kept = localStorage.getItem("language");
  } catch { /* no storage: the browser's language */ }
  return kept ?? (navigator.language.startsWith("de") ? "de" : "en");
}

/** @param {string} [wanted] */
export async function loadTexts(wanted = preferred()) {
  language = wanted === "de" ? "de" : "en";
  [texts] = await Promise.all([fetch(`/assets/${language}.json`).then((answer) => answer.json()), loadMessages(language)]);
  try {
    localStorage.setItem("language", language);
  } catch { /* it is asked for again next time */ }
  document.documentElement.lang = language;
  element("language").value = language;
  for (const node of document.querySelectorAll("[data-t]")) node.textContent = t(/** @type {any} */ (node).dataset.t);
  for (const node of document.querySelectorAll("[data-t-label]")) {
    node.setAttribute("aria-label", t(/** @type {any} */ (node).dataset.tLabel));
  }
}

/**
 * A text by its key, with values in place of {names}.
 * @param {string} key @param {Record<string, any>} [values] @param {string} [otherwise] @returns {string}
 */
export function t(key, values = {}, otherwise = key) {
  const text = texts[key] ?? otherwise;
  return text.replace(/\{(\w+)\}/g, (/** @type {string} */ all, /** @type {string} */ name) => {
    const value = values[name];
    return value === undefined ? all : typeof value === "number" ? number(value) : String(value);
  });
}

/** @param {string} key @returns {boolean} */
export const has = (key) => key in texts;

/** @param {number | null | undefined} value @param {number} [decimals] @returns {string} */
export function number(value, decimals) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  const options = decimals === undefined
    ? { maximumFractionDigits: 4 } : { minimumFractionDigits: decimals, maximumFractionDigits: decimals };
  if (decimals !== undefined && Math.abs(value) < 0.5 * 10 ** -decimals) value = 0; // no -0.00
  return value.toLocaleString(language, { useGrouping: false, ...options });
}

/**
 * An error in the language of the reader.
 * @param {Record<string, any>} problem @returns {string}
 */
export function problemText(problem) {
  const kind = `kind.${problem.kind}`;
  if (has(kind)) return t(kind, problem.bounds ?? {});
  const parts = [problem.what, problem.cause].filter(Boolean).map(message).join("; ");
  return problem.remedy ? `${parts} → ${message(problem.remedy)}` : parts;
}
