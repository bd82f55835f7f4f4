// @ts-check
// The bends of a part in the order of the work: position, angle, direction; rows can be added, moved and deleted.

import { element, make } from "./dom.js";
import { howRead, numberField } from "./number_field.js";
import { t } from "./texts.js";

/** @typedef {{position: number | string | null, angle: number | string | null, direction: "up" | "down"}} Bend */

export class Bends {
  /** @param {() => void} changed */
  constructor(changed) {
    this.changed = changed;
    /** @type {Bend[]} */
    this.rows = [];
  }

  /** @param {Bend[]} rows */
  build(rows) {
    // The browser may have kept rows of another version.
    rows.splice(0, rows.length, ...rows.map(({ position, angle, direction = "up" }) => ({ position, angle, direction })));
    this.rows = rows;
    const list = make("ol", { id: "bends-list" }, ...rows.map((row, i) => this.row(row, i)));
    const add = make("button", { type: "button", id: "bends-add", disabled: rows.length >= 20, onclick: () => this.add() }, t("bends.add"));
    return make("fieldset", { id: "f-bends", class: "bends", "aria-describedby": "n-bends" }, make("legend", {}, t("bends.title")), list, add,
      make("p", { class: "note", id: "n-bends", role: "status" }));
  }

  /** @param {Bend} row @param {number} i */
  row(row, i) {
    const number = i + 1;
    const input = (/** @type {"position" | "angle"} */ name) => {
      const taken = (/** @type {number | string | null} */ value) => {
        row[name] = value;
        this.changed();
      };
      return numberField({ id: `b-${i}-${name}`, "aria-label": t(`bends.${name}`, { number }) }, row[name], taken);
    };
    const way = make("select", { id: `b-${i}-direction`, "aria-label": t("bends.direction", { number }) },
      ...["up", "down"].map((one) => make("option", { value: one }, t(`bends.${one}`))));
    way.value = row.direction;
    way.addEventListener("change", () => {
      row.direction = way.value;
      this.changed();
    });
    const earlier = make("button", { type: "button", id: `b-${i}-earlier`, disabled: i === 0, "aria-label": t("bends.earlier", { number }), onclick: () => this.swap(i) }, "↑");
    const remove = make("button", { type: "button", id: `b-${i}-remove`, disabled: this.rows.length === 1, "aria-label": t("bends.remove", { number }), onclick: () => this.take(i) }, "×");
    return make("li", {}, make("span", {}, `${number}.`), input("position"), input("angle"), way, earlier, remove);
  }

  /** How numbers with the decimal sign of the other language were read. */
  howRead() {
    return this.rows.flatMap((_, i) => ["position", "angle"].map((name) => howRead(element(`b-${i}-${name}`).value))
      .filter(Boolean).map((text) => `${t("bend.number", { number: i + 1 })}: ${text}`));
  }

  add() {
    const last = this.rows[this.rows.length - 1];
    this.again([...this.rows, { ...last, position: (Number(last.position) || 0) + 30 }], `b-${this.rows.length}-position`);
  }

  /** @param {number} i */
  swap(i) {
    const rows = [...this.rows];
    [rows[i - 1], rows[i]] = [rows[i], rows[i - 1]];
    this.again(rows, `b-${i - 1}-position`);
  }

  /** @param {number} i */
  take(i) {
    this.again(this.rows.filter((_, k) => k !== i), "bends-add");
  }

  /** @param {Bend[]} rows @param {string} focus */
  again(rows, focus) {
    this.rows.splice(0, this.rows.length, ...rows);
    element("f-bends").replaceWith(this.build(this.rows));
    element(focus)?.focus();
    this.changed();
  }
}
