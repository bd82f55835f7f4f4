// @ts-check
// Notes beside a field. Unchanged elements are kept: a button that is replaced between press and release loses its click.

import { make } from "./dom.js";

/**
 * @param {any} place @param {string} kind "bad", "warn" or "" @param {string[]} texts @param {any} [button] button of the remedy; the same element at each call
 */
export function put(place, kind, texts, button = null) {
  const name = kind ? `note ${kind}` : "note";
  if (place.className !== name) place.className = name;
  const spans = [...place.querySelectorAll("span")];
  if (JSON.stringify(spans.map((one) => one.textContent)) !== JSON.stringify(texts)) {
    for (const one of spans) one.remove();
    place.prepend(...texts.map((text) => make("span", {}, text)));
  }
  for (const one of place.querySelectorAll("button")) if (one !== button) one.remove();
  if (button && button.parentNode !== place) place.append(button);
}
