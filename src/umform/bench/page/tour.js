// @ts-check
// The tour: six stops in about a minute, offered once.

import { element, make } from "./dom.js";
import { t } from "./texts.js";

const STOPS = [["fields", "form"], ["sketch", "drawing"], ["n-angle", "checks"], ["run", "run"], ["jobs-title", "jobs"], ["result", "numbers"]];

/** Show the present stop again in another language, if a tour is open. */
export let showAgain = () => {};

/** @param {boolean} [asked] */
export function tour(asked = true) {
  try {
    if (!asked && localStorage.getItem("tour")) return;
    localStorage.setItem("tour", "seen");
  } catch {
    if (!asked) return;
  }
  const dialog = element("tour-dialog");
  let at = 0;
  const show = () => {
    for (const node of document.querySelectorAll(".lit")) node.classList.remove("lit");
    const [id, name] = STOPS[at];
    const place = element(id);
    (place.hidden ? element("sketch") : place).classList.add("lit");
    (place.hidden ? element("sketch") : place).scrollIntoView({ block: "center", behavior: "instant" });
    const next = make("button", { type: "button", class: "main", autofocus: true, onclick: () => go(1) }, t(at === STOPS.length - 1 ? "tour.end" : "tour.next"));
    const back = make("button", { type: "button", disabled: at === 0, onclick: () => go(-1) }, t("tour.back"));
    const leave = make("button", { type: "button", onclick: () => dialog.close() }, t("tour.leave"));
    dialog.replaceChildren(make("h2", { id: "tour-title" }, t(`tour.${name}.title`)), make("p", {}, t(`tour.${name}`)),
      make("div", { class: "bar" }, next, back, leave, make("span", { class: "soft" }, `${at + 1} / ${STOPS.length}`)));
    next.focus();
  };
  const go = (/** @type {number} */ way) => {
    at += way;
    if (at >= STOPS.length) dialog.close();
    else show();
  };
  showAgain = () => { if (dialog.open) show(); };
  dialog.onclose = () => document.querySelectorAll(".lit").forEach((node) => node.classList.remove("lit"));
  dialog.show();
  dialog.onkeydown = (/** @type {KeyboardEvent} */ event) => {
    if (event.key === "Escape") dialog.close(); // a dialog that is not modal does not do so by itself
  };
  show();
}
