// @ts-check
// The list of metals with a search: standards and published cards in groups of their own; one of them is chosen.

import { make } from "./dom.js";
import { number, t } from "./texts.js";

/** @typedef {{name: string, number: string, aliases: string[], card: boolean, basis: string, yield_stress: number, tensile_strength: number}} Metal */

/** @param {Metal} metal */
export const nameOf = ({ name, number: of }) => (of && of !== name ? `${name} (${of})` : name);

/** The metals of a group in which a text occurs: in name, number, other names or basis. @param {Metal[]} metals @param {boolean} card @param {string} text */
export function found(metals, card, text) {
  const words = text.toLowerCase().split(/\s+/).filter(Boolean);
  const told = (/** @type {Metal} */ metal) => [metal.name, metal.number, ...metal.aliases, metal.basis].join(" ").toLowerCase();
  return metals.filter((metal) => metal.card === card && words.every((word) => told(metal).includes(word)));
}

/** Headings of the groups. @param {boolean} card */
export const heading = (card) => t(card ? "metals.cards" : "metals.standard");

export class MetalList {
  /** @param {Metal[]} metals @param {string} chosen @param {(name: string) => void} taken */
  constructor(metals, chosen, taken) {
    this.metals = metals;
    this.chosen = chosen;
    this.taken = taken;
    /** Place of the option that Enter takes. */
    this.at = -1;
    /** @type {any} */
    this.input = make("input", { id: "f-material", type: "text", role: "combobox", autocomplete: "off", spellcheck: false, "aria-expanded": "false", "aria-controls": "metal-options",
      "aria-autocomplete": "list", "aria-describedby": "n-material", value: this.text() });
    this.list = make("div", { id: "metal-options", role: "listbox", "aria-label": t("metals.title"), hidden: true });
    this.node = make("span", { class: "input combo" }, this.input, this.list);
    this.input.addEventListener("focus", () => this.input.select());
    this.input.addEventListener("click", () => this.open(""));
    this.input.addEventListener("input", () => this.open(this.input.value));
    this.input.addEventListener("blur", () => this.close());
    this.input.addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => this.key(event));
    this.list.addEventListener("mousedown", (/** @type {Event} */ event) => event.preventDefault()); // the field keeps the focus
  }

  text() {
    const metal = this.metals.find(({ name }) => name === this.chosen);
    return metal ? nameOf(metal) : this.chosen;
  }

  /** Another metal was chosen elsewhere. @param {string} name */
  show(name) {
    this.chosen = name;
    this.input.value = this.text();
  }

  /** @param {string} search */
  open(search) {
    const groups = [false, true].map((card) => ({ card, rows: found(this.metals, card, search) })).filter(({ rows }) => rows.length);
    const all = groups.flatMap(({ rows }) => rows);
    const option = (/** @type {Metal} */ metal) => make("div", { role: "option", id: `metal-${this.metals.indexOf(metal)}`, "aria-selected": String(metal.name === this.chosen), onclick: () => this.take(metal.name) },
      make("b", {}, nameOf(metal)), make("span", {}, t("metals.row", { re: number(metal.yield_stress, 0), rm: number(metal.tensile_strength, 0), basis: t(`basis.${metal.basis}`, {}, metal.basis) })));
    this.list.replaceChildren(...groups.map(({ card, rows }) => make("div", { role: "group", "aria-label": heading(card) }, make("div", { class: "head", "aria-hidden": "true" }, heading(card)), ...rows.map(option))),
      ...(all.length ? [] : [make("div", { class: "head" }, t("metals.none", { text: search }))]));
    this.list.hidden = false;
    this.input.setAttribute("aria-expanded", "true");
    this.mark(search ? 0 : all.findIndex(({ name }) => name === this.chosen));
  }

  options() {
    return [.../** @type {any} */ (this.list).querySelectorAll("[role=option]")];
  }

  /** @param {number} at */
  mark(at) {
    const options = this.options();
    this.at = Math.max(-1, Math.min(at, options.length - 1));
    options.forEach((one, i) => one.classList.toggle("at", i === this.at));
    const now = options[this.at];
    if (now) this.input.setAttribute("aria-activedescendant", now.id);
    else this.input.removeAttribute("aria-activedescendant");
    now?.scrollIntoView({ block: "nearest" });
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    const way = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (way) {
      event.preventDefault();
      if (this.list.hidden) this.open("");
      else this.mark(Math.max(0, this.at + way));
    } else if (event.key === "Enter" && !this.list.hidden) {
      event.preventDefault(); // it takes a metal, and does not bend
      this.options()[this.at]?.click();
    } else if (event.key === "Escape" && !this.list.hidden) {
      event.preventDefault();
      this.close();
    }
  }

  /** @param {string} name */
  take(name) {
    this.show(name);
    this.close();
    this.taken(name);
  }

  close() {
    this.list.hidden = true;
    this.input.setAttribute("aria-expanded", "false");
    this.input.removeAttribute("aria-activedescendant");
    this.input.value = this.text();
  }
}
