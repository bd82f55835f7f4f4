// @ts-check
// Elements of the page.

/** @param {string} id @returns {any} */
export const element = (id) => document.getElementById(id);

/**
 * An element with attributes and content; a text is never read as HTML.
 * @param {string} tag @param {Record<string, any>} [attributes] @param {...(Node | string | null)} content @returns {any}
 */
export function make(tag, attributes = {}, ...content) {
  const node = document.createElement(tag);
  assign(node, attributes);
  node.append(...content.filter((one) => one !== null));
  return node;
}

/** A region that scrolls sideways, also by keyboard. @param {...(Node | null)} content */
export const wide = (...content) => make("div", { class: "wide", tabindex: "0" }, ...content);

/** @param {string} tag @param {Record<string, any>} [attributes] @param {...(Node | string)} content @returns {any} */
export function draw(tag, attributes = {}, ...content) {
  const node = document.createElementNS("http://www.w3.org/2000/svg", tag);
  assign(node, attributes);
  node.append(...content);
  return node;
}

/** @param {Element} node @param {Record<string, any>} attributes */
function assign(node, attributes) {
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else if (value === true) node.setAttribute(name, "");
    else if (value !== false && value !== null && value !== undefined) node.setAttribute(name, String(value));
  }
}
