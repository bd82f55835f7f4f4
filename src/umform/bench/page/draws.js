// @ts-check
// Results of a drawn part.

import { make } from "./dom.js";
import { message } from "./messages.js";
import { table, tile } from "./quantities.js";
import { t } from "./texts.js";

/** @param {any} job @returns {Node[]} */
export function drawnNumbers({ summary: { ending, about_errors: about, quantities = [], checks = [], warnings = [] } }) {
  const leading = quantities.filter((/** @type {any} */ one) => one.leading && one.value !== null);
  return [
    ...warnings.map((/** @type {string} */ text) => make("p", { class: `note ${text === ending ? "bad" : "warn"}` }, message(text))),
    make("dl", { class: "heroes" }, ...leading.map((/** @type {any} */ one) => tile(one, "drawn"))),
    ...(about ? [make("p", { class: "note" }, message(about))] : []),
    make("details", {}, make("summary", {}, t("all")), table([...quantities, ...checks], "drawn")),
  ];
}
