// @ts-check
// The form: what is to be bent, with which tools; each change is looked at by the server at once.

import { post, Refused } from "./api.js";
import { Bends } from "./bends.js";
import { element, make } from "./dom.js";
import { keep, kept } from "./kept.js";
import { put } from "./notes.js";
import { howRead, numberField, show, unclear } from "./number_field.js";
import { number, problemText, t } from "./texts.js";
import { MEASURED, Tools } from "./tools.js";

/** @typedef {{name: string, step?: number, kind?: "number" | "select" | "check" | "bends", list?: string, of?: string[]}} Field */
/** Fields by group; `of`: the kinds of work that have it. @type {Record<string, Field[]>} */
const GROUPS = {
  "": [
    { name: "work", kind: "select" },
    { name: "material", kind: "select" },
    { name: "thickness", step: 0.1 },
    { name: "opening", step: 1, list: "openings" },
    { name: "angle", step: 1, of: ["bend"] },
    { name: "press_force", step: 10, of: ["bottom"] },
    { name: "travel", step: 0.05, of: ["bottom"] },
    { name: "strip_length", step: 1, of: ["sequence"] },
    { name: "bends", kind: "bends", of: ["sequence"] },
    { name: "gap", step: 0.1, of: ["hem"] },
    { name: "insert", kind: "check", of: ["hem"] },
    { name: "flange", step: 1, of: ["hem"] },
    { name: "base", step: 1, of: ["hem"] },
    { name: "first_angle", step: 1, of: ["hem"] },
    { name: "length", step: 10 },
  ],
  tools: [
    { name: "die", kind: "select" },
    { name: "punch", kind: "select" },
    { name: "die_angle", step: 1, list: "die-angles" },
    { name: "die_radius", step: 0.1 },
    { name: "punch_angle", step: 1, list: "punch-angles" },
    { name: "punch_radius", step: 0.1, list: "punch-radii" },
  ],
  coil: [
    { name: "yield_stress", step: 5 },
    { name: "tensile_strength", step: 5 },
    { name: "uniform_elongation", step: 0.5 },
    { name: "rolling", step: 15 },
  ],
  run: [
    { name: "stroke", step: 0.1, of: ["bend"] },
    { name: "mesh", kind: "select" },
    { name: "budget", kind: "check", of: ["bend", "bottom"] },
    { name: "whole", kind: "check", of: ["bend", "bottom"] },
  ],
};
const FIELDS = Object.values(GROUPS).flat();
/** Milliseconds after which a question without an answer is asked again. */
const AGAIN = 2000;

export class Form {
  /** @param {any} library @param {(found: any, values: any) => void} looked */
  constructor(library, looked) {
    this.library = library;
    this.looked = looked;
    this.values = structuredClone({ ...library.defaults, ...kept(FIELDS.map(({ name }) => name)) });
    this.bends = new Bends(() => this.look());
    this.tools = new Tools((kind, name) => this.takeTool(kind, name));
    this.round = 0;
    /** @type {AbortController | null} */
    this.asking = null;
    /** Tools that would do, and the button that takes them. @type {Record<string, number | null>} */
    this.offered = {};
    this.remedy = make("button", { type: "button", onclick: () => this.takeRemedy() });
    this.build();
    this.look();
    this.tools.refresh().then(() => this.fillTools());
  }

  build() {
    const open = new Set([...document.querySelectorAll("#fields details[open]")].map((one) => /** @type {any} */ (one).dataset.group));
    const groups = Object.entries(GROUPS).map(([name, fields]) => {
      const rows = fields.filter(({ of }) => !of || of.includes(this.values.work)).map((field) => this.row(field));
      if (!name) return make("div", { class: "group" }, ...rows);
      const hint = make("p", { class: "soft" }, t(`group.${name}.hint`));
      const more = name === "tools" ? [make("button", { type: "button", id: "tool-ask", onclick: () => this.tools.ask() }, t("tool.ask"))] : [];
      return make("details", { "data-group": name, open: open.has(name) }, make("summary", {}, t(`group.${name}`)),
        make("div", { class: "group" }, hint, ...rows, ...more));
    });
    element("table").hidden = this.values.work !== "bend"; // a table is one of angles
    element("fields").replaceChildren(...groups, ...this.lists());
  }

  /** @param {Field} field */
  row({ name, step, kind = "number", list }) {
    const value = this.values[name];
    if (kind === "bends") return this.bends.build(value);
    const common = { id: `f-${name}`, "aria-describedby": `n-${name}` };
    /** @type {any} */
    let input;
    if (kind === "select") {
      input = make("select", { ...common, onchange: () => this.take(name, input.value || null) }, ...this.options(name));
      input.value = value ?? "";
    } else if (kind === "check") {
      input = make("input", { ...common, type: "checkbox", checked: Boolean(value), onchange: () => this.take(name, input.checked) });
    } else {
      input = numberField({ ...common, list, placeholder: this.placeholder(name) }, value, (taken) => this.take(name, taken), step);
    }
    const unit = this.library.units[name];
    const unitText = unit ? make("span", { class: "unit", "aria-hidden": "true" }, unit) : null;
    const text = make("label", { for: `f-${name}` }, t(`field.${name}`));
    const box = make("span", { class: "input" }, input, unitText);
    return make("div", { class: `row ${kind}`, "data-field": name }, text, box, make("p", { class: "note", id: `n-${name}`, role: "status" }));
  }

  /** Fill the lists of drawn tools. The rest of the form stays: the user may be typing there. */
  fillTools() {
    for (const name of ["punch", "die"]) {
      element(`f-${name}`)?.replaceChildren(...this.options(name));
      if (element(`f-${name}`)) element(`f-${name}`).value = this.values[name] ?? "";
    }
  }

  /** @param {string} name */
  options(name) {
    if (name === "punch" || name === "die") return this.tools.options(name, this.values[name]);
    if (name === "work") return this.library.works.map((/** @type {string} */ one) => make("option", { value: one }, t(`work.${one}`)));
    if (name === "mesh") return this.library.meshes.map((/** @type {string} */ one) => make("option", { value: one }, t(`mesh.${one}`)));
    const group = (/** @type {boolean} */ card) => this.library.metals.filter((/** @type {any} */ metal) => metal.card === card)
      .map((/** @type {any} */ metal) => make("option", { value: metal.name }, metal.number && metal.number !== metal.name ? `${metal.name} (${metal.number})` : metal.name));
    return [make("optgroup", { label: t("metals.standard") }, ...group(false)), make("optgroup", { label: t("metals.cards") }, ...group(true))];
  }

  /** @param {string} name */
  placeholder(name) {
    const metal = this.metal();
    if (name === "rolling") return metal?.directional ? "" : "–";
    const thick = metal?.thicker.findLast((/** @type {any} */ range) => this.values.thickness >= range.from);
    const values = { ...metal, ...thick };
    return name in values ? number(values[name]) : "";
  }

  /** Show the values of the standard for this thickness. */
  standard() {
    for (const { name } of GROUPS.coil) {
      const input = element(`f-${name}`);
      if (input) input.placeholder = this.placeholder(name);
    }
  }

  metal() {
    return this.library.metals.find((/** @type {any} */ metal) => metal.name === this.values.material);
  }

  lists() {
    const { dies, die_angles: angles, punches } = this.library.tools;
    const list = (/** @type {string} */ id, /** @type {number[]} */ values) =>
      make("datalist", { id }, ...[...new Set(values)].map((value) => make("option", { value })));
    const of = (/** @type {any[]} */ rows, /** @type {string} */ name) => rows.map((row) => row[name]);
    return [list("openings", of(dies, "opening")), list("die-angles", angles), list("punch-angles", of(punches, "angle")), list("punch-radii", of(punches, "radius"))];
  }

  /** A field has changed. @param {string} name @param {any} value */
  take(name, value) {
    this.values[name] = value;
    if (name === "work") this.suitWork();
    for (const [one, other] of [["press_force", "travel"], ["travel", "press_force"]]) {
      if (name === one && this.values[one] !== null) this.change({ [other]: null });
    }
    if (name === "stroke" && this.values.stroke !== null) this.change({ angle: null });
    if (name === "angle" && this.values.angle !== null) this.change({ stroke: null });
    if (name === "opening") this.suitRadius();
    if (name === "material") this.suitMaterial();
    this.look();
  }

  /** A drawn tool was read, or was deleted: then it is none. @param {"punch" | "die"} kind @param {string | null} name */
  takeTool(kind, name) {
    if (name || !this.tools.rows.some((one) => one.kind === kind && one.name === this.values[kind])) this.values[kind] = name;
    this.build();
    this.look();
  }

  /** Tools and goal that suit another kind of work. */
  suitWork() {
    const { work, thickness, press_force: force, travel, die_angle: angle } = this.values;
    const t = Number.isFinite(thickness) ? thickness : this.library.defaults.thickness;
    if (work === "bottom" && force === null && travel === null) this.change({ travel: 0, die_angle: 88, punch_angle: 88, punch: null, die: null });
    if (work === "bend" && this.values.angle === null && this.values.stroke === null) this.change({ angle: 90 });
    if (work === "hem") {
      this.change({ opening: 8 * t, die_angle: 30, die_radius: t, punch_angle: 30, punch_radius: 0.5 * t, punch: null, die: null, gap: t, flange: 12 * t, base: 30 * t });
    } else if (angle < 40) {
      this.change({ die_angle: 85, punch_angle: 85, die_radius: t, punch_radius: 0.75 * t });
    }
    this.build();
    element("f-work").focus();
  }

  /** The shoulder radius of the library's die with this opening. */
  suitRadius() {
    const die = this.library.tools.dies.find((/** @type {any} */ one) => one.opening === this.values.opening);
    if (die) this.change({ die_radius: die.radius });
  }

  suitMaterial() {
    const metal = this.metal();
    this.change({ yield_stress: null, tensile_strength: null, uniform_elongation: null, rolling: metal.directional ? 90 : null });
    this.standard();
  }

  /** Set some values, in the fields too. @param {Record<string, any>} values */
  change(values) {
    for (const [name, value] of Object.entries(values)) {
      this.values[name] = value;
      const input = element(`f-${name}`);
      if (!input) continue;
      if (input.type === "checkbox") input.checked = Boolean(value);
      else if (input.tagName === "SELECT") input.value = value ?? "";
      else show(input, value);
    }
  }

  /** Ask the server what it thinks of the form; only the last answer counts. */
  async look() {
    this.round += 1;
    const round = this.round;
    this.asking?.abort();
    this.asking = new AbortController();
    keep(this.values);
    this.standard();
    try {
      const found = await post("/api/look", this.values, this.asking.signal);
      if (round !== this.round) return;
      this.say(found);
      this.looked(found, this.values);
    } catch (problem) {
      if (/** @type {any} */ (problem).name === "AbortError" || round !== this.round) return;
      this.refuse(String(/** @type {any} */ (problem).message));
      if (!(problem instanceof Refused)) setTimeout(() => round === this.round && this.look(), AGAIN); // no answer
    }
  }

  /** Put what was found beside the fields. @param {any} found */
  say(found) {
    this.change(found.measured ?? {});
    for (const [kind, names] of Object.entries(MEASURED)) names.forEach((name) => (element(`f-${name}`).disabled = Boolean(this.values[kind])));
    this.remedy.textContent = found.change ? t("offer", found.change) : "";
    this.offered = found.change ?? {};
    const notes = this.notes(found);
    for (const { name } of FIELDS) {
      if (!element(`f-${name}`)) continue;
      const { kind, texts } = notes.get(name) ?? { kind: "", texts: [] };
      notes.delete(name);
      put(element(`n-${name}`), kind, texts, name === "angle" && found.change ? this.remedy : null);
      if (kind) element(`n-${name}`).closest("details")?.setAttribute("open", "");
      element(`f-${name}`).toggleAttribute("aria-invalid", false);
      if (kind === "bad") element(`f-${name}`).setAttribute("aria-invalid", "true");
    }
    const others = [...notes.values()];
    put(element("form-note"), others.some(({ kind }) => kind === "bad") ? "bad" : "warn", others.flatMap(({ texts }) => texts));
    element("run").disabled = found.problems.length > 0;
  }

  /**
   * Notes by field: numbers as they were read, warnings, errors.
   * @param {any} found @returns {Map<string, {kind: string, texts: string[]}>}
   */
  notes(found) {
    /** @type {Map<string, {kind: string, texts: string[]}>} */
    const notes = new Map();
    const add = (/** @type {string} */ where, /** @type {string} */ kind, /** @type {string} */ text) => {
      const there = notes.get(where) ?? { kind: "", texts: [] };
      notes.set(where, { kind: kind || there.kind, texts: [...there.texts, text] });
    };
    for (const { name, kind = "number" } of FIELDS) {
      const text = kind === "number" && element(`f-${name}`) ? howRead(element(`f-${name}`).value) : "";
      if (text) add(name, "", text);
    }
    if (element("f-bends")) this.bends.howRead().forEach((text) => add("bends", "", text));
    for (const [kind, rows] of [["warn", found.warnings], ["bad", found.problems]]) {
      for (const row of rows) {
        const bend = row.row ?? /^bend (\d+)/.exec(row.where)?.[1];
        const value = bend ? this.values.bends[bend - 1]?.[row.part] : this.values[row.where];
        const text = row.kind === "float_type" && typeof value === "string" ? unclear(value) : problemText(row);
        add(bend ? "bends" : row.where, row.level ?? kind, bend ? `${t("bend.number", { number: Number(bend) })}: ${text}` : text);
      }
    }
    return notes;
  }

  /** Say below the form why nothing can be done. @param {string} text */
  refuse(text) {
    put(element("form-note"), "bad", [text]);
  }

  /** Take the tools that would do, those of the last answer. */
  takeRemedy() {
    this.change(this.offered);
    this.look();
    element("f-angle").focus();
  }
}
