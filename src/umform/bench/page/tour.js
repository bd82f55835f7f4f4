// @ts-check
// The tour: six stops in about a minute, offered once.

import { element, make } from "./dom.js";
import { t } from "./texts.js";

const STOPS = [["fields", "form"], ["sketch", "drawing"], ["f-angle", "checks"], ["run", "run"], ["jobs-title", "jobs"], ["result", "numbers"]];

/** On a phone there is no room beside the form: the tour is only shown if it is asked for, below what it points at. */
const narrow = () => matchMedia("(max-width: 48rem)").matches;

/** Show the present stop again in another language, if a tour is open. */
export let showAgain = () => {};

/** @param {boolean} [asked] */
export function tour(asked = true) {
  try {
    if (!asked && (narrow() || localStorage.getItem("tour"))) return;
    localStorage.setItem("tour", "seen");
  } catch {
    if (!asked) return;
  }
  const dialog = element("tour-dialog");
  let at = 0;
  const show = () => {
    for (const node of document.querySelectorAll(".lit")) node.classList.remove("lit");
    const [id, name] = STOPS[at];
    const node = element(id);
    const place = !node || node.hidden ? element("sketch") : node.closest(".row") ?? node;
    place.classList.add("lit");
    const next = make("button", { type: "button", class: "main", autofocus: true, onclick: () => go(1) }, t(at === STOPS.length - 1 ? "tour.end" : "tour.next"));
    const back = make("button", { type: "button", disabled: at === 0, onclick: () => go(-1) }, t("tour.back"));
    const leave = make("button", { type: "button", onclick: () => dialog.close() }, t("tour.leave"));
    dialog.replaceChildren(make("h2", { id: "tour-title" }, t(`tour.${name}.title`)), make("p", {}, t(`tour.${name}`)),
      make("div", { class: "bar" }, next, back, leave, make("span", { class: "soft" }, `${at + 1} / ${STOPS.length}`)));
    document.body.style.paddingBottom = narrow() ? `${dialog.offsetHeight + 24}px` : "";
    place.scrollIntoView({ block: narrow() ? "start" : "center", behavior: "instant" });
    next.focus({ preventScroll: true });
  };
  const go = (/** @type {number} */ way) => {
    at += way;
    if (at >= STOPS.length) dialog.close();
    else show();
  };
  showAgain = () => { if (dialog.open) show(); };
  dialog.onclose = () => {
    document.querySelectorAll(".lit").forEach((node) => node.classList.remove("lit"));
    document.body.style.paddingBottom = "";
  };
  dialog.show();
  dialog.onkeydown = (/** @type {KeyboardEvent} */ event) => {
    if (event.key === "Escape") dialog.close(); // a dialog that is not modal does not do so by itself
  };
  show();
}
