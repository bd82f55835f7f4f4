// @ts-check
// A part by its outside dimensions, from left to right: flange, bend, flange; bends are done in the order that is chosen.

import { element, make } from "./dom.js";
import { howRead, numberField } from "./number_field.js";
import { t } from "./texts.js";

/** @typedef {{line: number, angle: number | string | null, direction: "up" | "down"}} Bend */
/** @typedef {{flanges: (number | string | null)[], bends: Bend[]}} Part */
/** Most bends. */
const MOST = 20;

export class Outside {
  /** @param {() => void} changed */
  constructor(changed) {
    this.changed = changed;
    /** @type {Part} */
    this.part = { flanges: [], bends: [] };
  }

  /** @param {Part} part */
  build(part) {
    this.part = part;
    const { flanges, bends } = part;
    const lines = bends.map((_, i) => i + 1).map((line) => this.bend(line));
    const rows = flanges.flatMap((_, i) => [this.flange(i), ...(i < lines.length ? [lines[i]] : [])]);
    const add = make("button", { type: "button", id: "outside-add", disabled: bends.length >= MOST, onclick: () => this.add() }, t("bends.add"));
    return make("fieldset", { id: "f-outside", class: "bends outside", "aria-describedby": "n-outside" }, make("legend", {}, t("outside.title")),
      make("ol", { id: "outside-list" }, ...rows), add, make("p", { class: "note", id: "n-outside", role: "status" }));
  }

  /** @param {number} i */
  flange(i) {
    const taken = (/** @type {number | string | null} */ value) => {
      this.part.flanges[i] = value;
      this.changed();
    };
    const number = i + 1;
    const input = numberField({ id: `o-${i}-flange`, "aria-label": t("outside.flange", { number }) }, this.part.flanges[i], taken);
    return make("li", { class: "flange" }, make("span", {}, t("outside.leg", { number })), input, make("span", {}, "mm"));
  }

  /** @param {number} line */
  bend(line) {
    const { bends } = this.part;
    const at = bends.findIndex((one) => one.line === line);
    const row = bends[at];
    const taken = (/** @type {number | string | null} */ value) => {
      row.angle = value;
      this.changed();
    };
    const input = numberField({ id: `o-${line}-angle`, "aria-label": t("bends.angle", { number: line }) }, row.angle, taken);
    const way = make("select", { id: `o-${line}-direction`, "aria-label": t("bends.direction", { number: line }) },
      ...["up", "down"].map((one) => make("option", { value: one }, t(`bends.${one}`))));
    way.value = row.direction;
    way.addEventListener("change", () => {
      row.direction = way.value;
      this.changed();
    });
    const order = make("select", { id: `o-${line}-order`, "aria-label": t("outside.order", { number: line }), title: t("outside.order", { number: line }) },
      ...bends.map((_, i) => make("option", { value: i }, t("outside.nth", { number: i + 1 }))));
    order.value = String(at);
    order.addEventListener("change", () => this.move(at, Number(order.value), line));
    const remove = make("button", { type: "button", id: `o-${line}-remove`, disabled: bends.length === 1, "aria-label": t("bends.remove", { number: line }), onclick: () => this.take(line) }, "×");
    return make("li", {}, make("span", { "aria-hidden": "true" }, "∠"), input, way, order, remove);
  }

  /** How numbers with the decimal sign of the other language were read. */
  howRead() {
    const fields = [...element("f-outside").querySelectorAll("input")];
    return fields.flatMap((one) => {
      const text = howRead(one.value);
      return text ? [`${one.getAttribute("aria-label")}: ${text}`] : [];
    });
  }

  add() {
    const { flanges, bends } = this.part;
    const last = bends[bends.length - 1];
    flanges.push(flanges[flanges.length - 1]);
    bends.push({ ...last, line: bends.length + 1, direction: bends.find((one) => one.line === bends.length)?.direction ?? "up" });
    this.again(`o-${flanges.length - 1}-flange`);
  }

  /** Another place in the order. @param {number} from @param {number} to @param {number} line */
  move(from, to, line) {
    const { bends } = this.part;
    bends.splice(to, 0, ...bends.splice(from, 1));
    this.again(`o-${line}-order`);
  }

  /** Remove a bend and the flange to its right. @param {number} line */
  take(line) {
    const { flanges, bends } = this.part;
    flanges.splice(line, 1);
    bends.splice(bends.findIndex((one) => one.line === line), 1);
    for (const bend of bends) if (bend.line > line) bend.line -= 1;
    this.again("outside-add");
  }

  /** @param {string} focus */
  again(focus) {
    element("f-outside").replaceWith(this.build(this.part));
    element(focus)?.focus();
    this.changed();
  }
}
