// @ts-check
// Changes of the page: said by screen readers, and on a small screen scrolled to.

import { element } from "./dom.js";

/** A small screen, on which form and result do not fit side by side. */
export const narrow = () => matchMedia("(max-width: 48rem)").matches;

/** @param {string} text */
export function announce(text) {
  element("announced").textContent = text;
}

/** @param {string} id */
export function goTo(id) {
  element(id).scrollIntoView({ block: "start", behavior: "instant" });
}
