// @ts-check
// Titles of jobs: what was computed, and whether on a section of the sheet or on its whole length.

import { t } from "./texts.js";

/** Kinds of work that bend a sheet. */
const BENDS = ["bend", "bottom"];

/** @param {any} job */
export function titleOf({ title, kind, parameters }) {
  if (kind !== "bend" || !BENDS.includes(parameters.work)) return title;
  return `${title}, ${t(parameters.whole ? "title.whole" : "title.section")}`;
}
