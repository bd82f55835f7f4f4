// @ts-check
// The fields of the form, as the server reads them off the parameters of the processes.

import { message } from "./messages.js";
import { has, number, t } from "./texts.js";

/**
 * @typedef {{name: string, label: string, help: string, valid: string, unit: string, group: string, works: string[],
 *   kind: "number" | "numbers" | "words" | "select" | "check" | "bends" | "outside", integer: boolean, bounds: {gt?: number, ge?: number, lt?: number, le?: number},
 *   choices: string[], default: any, times: number | null, tool: "" | "punch" | "die", size: string, usual: number[]}} Field
 */

/** All of them, in their order. @type {Field[]} */
export let fields = [];

/** @param {Field[]} given */
export function setFields(given) {
  fields = given;
}

/** Those values that the form has; a job of another version may have others. @param {Record<string, any>} values */
export const known = (values) => Object.fromEntries(fields.filter(({ name }) => name in values).map(({ name }) => [name, values[name]]));

/** The full name of a field, as the command calls it. @param {string} name */
function fullLabel(name) {
  const text = message(fields.find((one) => one.name === name)?.label ?? name).replace(/^(the|der|die|das) |,$/gi, "");
  return text.charAt(0).toUpperCase() + text.slice(1);
}

/** The key of the short label of a field; drawn parts have common ones. @param {string} name */
const keyOf = (name) => [`label.${name}`, `label.${name.replace(/^(cup|u)_/, "draw.")}`].find(has);

/** The label of a field: a word of the shop where there is one. @param {string} name */
export function label(name) {
  const key = keyOf(name);
  return key ? t(key) : fullLabel(name);
}

/** The name of a field as the command calls it, its sentence, and its valid values. @param {Field} field */
export function help({ name, help: sentence, valid }) {
  const full = !sentence && keyOf(name) ? `${fullLabel(name)}.` : "";
  return [full, sentence && message(sentence), valid && t("field.valid", { valid: message(valid) })].filter(Boolean).join(" ");
}

/** The field of a size of a tool. @param {"punch" | "die"} tool @param {string} size */
export const sizeField = (tool, size) => fields.find((one) => one.tool === tool && one.size === size)?.name ?? "";

/** Sizes of a tool by their own names, from values of the form. @param {"punch" | "die"} tool @param {Record<string, any>} values */
export const sizesIn = (tool, values) =>
  Object.fromEntries(fields.filter((one) => one.tool === tool && one.name in values).map((one) => [one.size, values[one.name]]));

/** Names of the fields in which jobs differ. @param {any[]} jobs */
export const differing = (jobs) => fields.map(({ name }) => name)
  .filter((name) => new Set(jobs.map(({ parameters }) => JSON.stringify(parameters[name] ?? null))).size > 1);

/** The label of a field beside those of all groups. @param {string} name */
export const fullHeading = (name) => (name.startsWith("second_") ? `${t("group.Second sheet")}: ${label(name)}` : label(name));

/** The value of a field of a job, in words. @param {any} job @param {string} name @returns {string} */
export function givenText({ parameters }, name) {
  const value = parameters[name] ?? null;
  if (typeof value === "boolean") return t(value ? "yes" : "no");
  return typeof value === "string" ? t(`${name}.${value}`, {}, value) : number(value);
}
