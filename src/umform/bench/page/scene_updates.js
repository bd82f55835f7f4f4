// @ts-check
// In the frame of the 3D view: updates from the page around it, and from no other.

addEventListener("message", ({ source, data }) => {
  const { umform } = /** @type {any} */ (window);
  if (source !== parent || !data?.scene || !umform) return;
  const { names, columns } = data.table;
  const numbers = (/** @type {string} */ name) => columns[name].map((/** @type {number | null} */ value) => value ?? NaN);
  umform.renew(data.scene, { ...data.table, columns: Object.fromEntries(names.map((/** @type {string} */ name) => [name, numbers(name)])) });
});
