// @ts-check
// The values of the form, kept by the browser for the next visit.

/** What was typed last, if it may be kept. @param {string[]} names @returns {Record<string, any>} */
export function kept(names) {
  try {
    const values = JSON.parse(localStorage.getItem("form") ?? "{}");
    return Object.fromEntries(names.map((name) => [name, values[name]]).filter(([, value]) => value !== undefined));
  } catch {
    return {};
  }
}

/** @param {Record<string, any>} values */
export function keep(values) {
  try {
    localStorage.setItem("form", JSON.stringify(values));
  } catch { /* it is typed again next time */ }
}
