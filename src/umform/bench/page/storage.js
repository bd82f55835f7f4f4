// @ts-check
// The values of the form, stored in the browser.

/** The stored values of some fields. @param {string[]} names @returns {Record<string, any>} */
export function stored(names) {
  try {
    const values = JSON.parse(localStorage.getItem("form") ?? "{}");
    return Object.fromEntries(names.map((name) => [name, values[name]]).filter(([, value]) => value !== undefined));
  } catch {
    return {};
  }
}

/** @param {Record<string, any>} values */
export function store(values) {
  try {
    localStorage.setItem("form", JSON.stringify(values));
  } catch { /* it is typed again next time */ }
}
