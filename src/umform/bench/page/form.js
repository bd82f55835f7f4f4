// @ts-check
// The form: the server checks it after each change.

import { post, Refused } from "./api.js";
import { Bends } from "./bends.js";
import { element, make } from "./dom.js";
import { fields, help, label, sizeField, sizesIn } from "./fields.js";
import { store, stored } from "./storage.js";
import { put } from "./notes.js";
import { found as metalsWith, heading, MetalList, nameOf } from "./metal_list.js";
import { takingList, typedList, unclearList } from "./lists.js";
import { howRead, numberField, show, unclear } from "./number_field.js";
import { Outside } from "./outside.js";
import { Parts, partText } from "./parts.js";
import { has, number, problemText, t } from "./texts.js";
import { sizesText, Tools } from "./tools.js";

/** Kinds of work with a view of their own. */
export const VIEWS_OF_WORK = ["flat", "table"];
/** Lists that the server fills. */
const LISTS = ["punch", "die", "part", "issue_again"];
/** Milliseconds after which a request without an answer is repeated. */
const AGAIN = 2000;

/** The refused number, which may be one of several in the field. @param {any} row @param {boolean} many */
function valueOf({ value = "" }, many) {
  const plain = value !== "" && Number.isFinite(Number(value));
  return plain ? ` (${number(Number(value))})` : many && value ? ` (${value})` : "";
}

export class Form {
  /** @param {any} library @param {(found: any, values: any) => void} looked */
  constructor(library, looked) {
    this.library = library;
    this.looked = looked;
    this.values = structuredClone({ ...Object.fromEntries(fields.map((one) => [one.name, one.default])), ...stored(fields.map(({ name }) => name)) });
    this.bends = new Bends(() => this.look());
    this.outside = new Outside(() => this.look());
    this.tools = new Tools((kind, name) => this.takeTool(kind, name));
    this.parts = new Parts((name) => this.takePart(name));
    /** Finished bend tables, by metal, which a correction may issue again. @type {() => any[]} */
    this.tables = () => [];
    /** @type {MetalList | null} */
    this.metals = null;
    /** Values of empty fields that follow from others, as the server found them. @type {Record<string, number>} */
    this.follow = {};
    this.round = 0;
    /** @type {AbortController | null} */
    this.asking = null;
    /** Suitable tools, and the button that takes them. @type {Record<string, number | null>} */
    this.offered = {};
    this.remedy = make("button", { type: "button", onclick: () => this.takeRemedy() });
    this.build();
    this.look();
    Promise.all([this.tools.refresh(), this.parts.refresh()]).then(() => this.fillLists());
  }

  /** The fields of this kind of work. */
  shown() {
    return fields.filter(({ name, works }) => works.includes(this.values.work) && !(name === "work" && VIEWS_OF_WORK.includes(this.values.work)));
  }

  build() {
    const open = new Set([...document.querySelectorAll("#fields details[open]")].map((one) => /** @type {any} */ (one).dataset.group));
    const press = this.shown().some(({ tool }) => tool); // of a press brake
    const drawings = this.shown().some(({ name }) => name === "die");
    const groups = [...new Set(fields.map(({ group }) => group))].map((group) => {
      const rows = this.shown().filter((field) => field.group === group).map((field) => this.row(field));
      if (!group) return make("div", { class: "group" }, ...rows);
      const name = group === "Tools" && !press ? "More" : group;
      const hint = has(`group.${name}.hint`) ? [make("p", { class: "soft" }, t(`group.${name}.hint`))] : [];
      const more = name === "Tools" && drawings ? [make("button", { type: "button", id: "tool-ask", onclick: () => this.tools.ask() }, t("tool.ask"))] : [];
      if (!rows.length) return make("span");
      return make("details", { "data-group": group, open: open.has(group) }, make("summary", {}, t(`group.${name}`, {}, group)),
        make("div", { class: "group" }, ...hint, ...rows, ...more));
    });
    const { work } = this.values;
    element("table").hidden = work !== "bend"; // a table is one of angles
    element("form-title").textContent = t(`form.title.${work}`, {}, t("form.title"));
    element("run").textContent = t(`run.${work}`, {}, t("run"));
    element("fields").replaceChildren(...groups);
  }

  /** @param {import("./fields.js").Field} field */
  row(field) {
    const { name, kind, unit, usual } = field;
    const value = this.values[name];
    if (kind === "bends") return this.bends.build(value);
    if (kind === "outside") return this.outside.build(value);
    const common = { id: `f-${name}`, "aria-describedby": `n-${name}` };
    const text = make("label", { for: `f-${name}` }, label(name));
    const note = make("p", { class: "note", id: `n-${name}`, role: "status" });
    /** @type {any} */
    let input;
    /** @type {any} */
    let search = null;
    if (name === "material") {
      this.metals = new MetalList(this.library.metals, value, (metal) => this.take(name, metal));
      return make("div", { class: "row metal", "data-field": name, title: help(field) }, text, this.metals.node, note);
    }
    if (kind === "words") {
      const chosen = () => [...input.selectedOptions].map((one) => one.value);
      search = make("input", { id: "metals-search", type: "search", class: "search", placeholder: t("metals.search"), "aria-label": t("metals.search"), autocomplete: "off" });
      search.addEventListener("input", () => {
        const left = [false, true].flatMap((card) => metalsWith(this.library.metals, card, search.value)).map((metal) => metal.name);
        for (const one of input.options) one.hidden = !left.includes(one.value);
        for (const group of input.querySelectorAll("optgroup")) group.hidden = [...group.children].every((one) => one.hidden);
      });
      input = make("select", { ...common, multiple: true, size: 8, onchange: () => this.take(name, chosen()) }, ...this.options(field));
      for (const one of input.options) one.selected = Array.isArray(value) && value.includes(one.value);
    } else if (kind === "numbers") {
      input = make("input", { ...common, type: "text", autocomplete: "off", value: typedList(value) });
      input.addEventListener("input", () => this.take(name, takingList(input.value)));
    } else if (kind === "select") {
      const taken = (/** @type {string | null} */ chosen) => (name === "punch" || name === "die" ? this.takeNamed(name, chosen) : this.take(name, chosen));
      input = make("select", { ...common, onchange: () => taken(input.value || null) }, ...this.options(field));
      input.value = value ?? (name === "punch" || name === "die" ? this.named(name) : "");
    } else if (kind === "check") {
      input = make("input", { ...common, type: "checkbox", checked: Boolean(value), onchange: () => this.take(name, input.checked) });
    } else {
      const list = usual.length ? `l-${name}` : null;
      input = numberField({ ...common, list, placeholder: this.placeholder(field) }, value, (taken) => this.take(name, taken), field);
    }
    const unitText = unit ? make("span", { class: "unit", "aria-hidden": "true" }, unit) : null;
    const offered = usual.length && kind === "number" ? make("datalist", { id: `l-${name}` }, ...usual.map((one) => make("option", { value: one }))) : null;
    const box = make("span", { class: "input" }, search, input, unitText, offered);
    const more = name === "part" ? this.parts.controls(value) : null;
    return make("div", { class: `row ${kind}`, "data-field": name, title: help(field) }, text, box, more, note);
  }

  /** Fill the lists that the server gave. The rest of the form stays: the user may be typing there. */
  fillLists() {
    for (const field of this.shown().filter(({ name }) => LISTS.includes(name))) {
      const list = element(`f-${field.name}`);
      list.replaceChildren(...this.options(field));
      list.value = this.values[field.name] ?? "";
    }
    this.showNamed();
  }

  /** @param {import("./fields.js").Field} field */
  options({ name, choices }) {
    if (name === "punch" || name === "die") return this.tools.options(name, this.values[name], this.library.tools[name]);
    if (name === "part") return this.parts.options(this.values.part);
    if (name === "issue_again") {
      const rows = this.tables().filter((row) => row.parameters.metals.includes(this.values.material));
      return [make("option", { value: "" }, t("again.none")), ...rows.map((row) => make("option", { value: row.id }, `${row.number} · ${row.title}`))];
    }
    const offered = name === "work" ? choices.filter((one) => !VIEWS_OF_WORK.includes(one)) : choices;
    const ofMetals = name === "metals" || name === "second_material";
    if (!ofMetals) return offered.map((one) => make("option", { value: one }, t(`${name}.${one}`, {}, one)));
    const group = (/** @type {boolean} */ card) => metalsWith(this.library.metals, card, "").map((metal) => make("option", { value: metal.name }, nameOf(metal)));
    const none = name === "metals" ? [] : [make("option", { value: "" }, t("second.none"))];
    return [...none, ...[false, true].map((card) => make("optgroup", { label: heading(card) }, ...group(card)))];
  }

  /** The value of an empty field. @param {import("./fields.js").Field} field */
  placeholder({ name, times }) {
    const { work, mesh } = this.values;
    const thickness = this.values[`${work}_thickness`] ?? this.values.thickness;
    const metal = this.metal();
    if (name === "rolling") return metal?.directional ? "" : "–";
    if (name in this.follow) return number(this.follow[name]);
    if (times !== null) return Number.isFinite(thickness) ? number(times * thickness) : "";
    const thick = metal?.thicker.findLast((/** @type {any} */ range) => thickness >= range.from);
    const values = { ...metal, ...thick, ...this.library.meshes[mesh] };
    return name in values ? number(values[name]) : "";
  }

  /** Show the values of empty fields in grey. */
  fillPlaceholders() {
    for (const field of this.shown()) {
      if (field.kind === "number") element(`f-${field.name}`).placeholder = this.placeholder(field);
    }
  }

  metal() {
    return this.library.metals.find((/** @type {any} */ metal) => metal.name === this.values.material);
  }

  /** A field has changed. @param {string} name @param {any} value */
  take(name, value) {
    const before = this.values[name];
    this.values[name] = value;
    if (name === "work") this.suitWork(before);
    const pairs = this.values.work === "correct" ? [] : [["force_per_metre", "travel"], ["stroke", "angle"]];
    for (const pair of pairs) {
      if (pair.includes(name) && value !== null) this.change({ [pair[1 - pair.indexOf(name)]]: null });
    }
    if (name === "opening") this.suitRadius();
    if (name === "material") this.suitMaterial();
    if (name === "part") this.build();
    this.look();
  }

  /** The work of another view. @param {string} work */
  setWork(work) {
    if (this.values.work === work) return;
    const before = this.values.work;
    this.values.work = work;
    this.suitWork(before, false);
    this.look();
  }

  /** A part was read; null: it was deleted. @param {string | null} name */
  takePart(name) {
    this.values.part = name;
    this.build();
    this.look();
  }

  /** A drawn tool was read; null: it was deleted. @param {"punch" | "die"} kind @param {string | null} name */
  takeTool(kind, name) {
    if (name || !this.tools.rows.some((one) => one.kind === kind && one.name === this.values[kind])) this.values[kind] = name;
    this.build();
    this.look();
  }

  /** Change tools and goal for another kind of work. @param {string} before @param {boolean} [focus] */
  suitWork(before, focus = true) {
    const { work, thickness, force_per_metre: force, travel } = this.values;
    const { proportions, fields: known } = this.library;
    const t = Number.isFinite(thickness) ? thickness : known.find((/** @type {any} */ one) => one.name === "thickness").default;
    if ([work, before].includes("hem")) { // a hem has tools of its own
      const sized = fields.filter(({ name }) => name in proportions[""]);
      const sizes = sized.map(({ name, unit }) => [name, (proportions[work] ?? proportions[""])[name] * (unit === "mm" ? t : 1)]);
      this.change({ ...Object.fromEntries(sizes), punch: null, die: null, gap: null, flange: null, base: null });
    }
    if (work === "bottom" && force === null && travel === null) {
      this.change({ travel: 0, [sizeField("die", "angle")]: 88, [sizeField("punch", "angle")]: 88, punch: null, die: null });
    }
    if (work === "bend" && this.values.angle === null && this.values.stroke === null) this.change({ angle: 90 });
    if (work === "correct" && this.values.angle === null) this.change({ angle: 90 });
    this.build();
    if (focus) element("f-work")?.focus();
  }

  /** The option of the usual tool that has the sizes of the form. @param {"punch" | "die"} kind */
  named(kind) {
    const usual = this.library.tools[kind].find((/** @type {any} */ { sizes }) => Object.entries(sizes).every(([name, size]) => this.values[name] === size));
    return usual ? `usual:${usual.name}` : "";
  }

  /** Show the names of the tools whose sizes the form has. */
  showNamed() {
    for (const kind of /** @type {("punch" | "die")[]} */ (["punch", "die"])) {
      const list = element(`f-${kind}`);
      if (list) list.value = this.values[kind] ?? this.named(kind);
    }
  }

  /** The shoulder radius of the library's dies with this opening. */
  suitRadius() {
    const [opening, radius] = [sizeField("die", "opening"), sizeField("die", "radius")];
    const die = this.library.tools.die.find((/** @type {any} */ { sizes }) => sizes[opening] === this.values[opening]);
    if (die) this.change({ [radius]: die.sizes[radius] });
  }

  /** The sizes of a usual tool, or a drawn one. @param {"punch" | "die"} kind @param {string | null} value */
  takeNamed(kind, value) {
    const usual = this.library.tools[kind].find((/** @type {any} */ { name }) => `usual:${name}` === value);
    this.change(usual ? { ...usual.sizes, [kind]: null } : { [kind]: value });
    this.look();
  }

  suitMaterial() {
    const metal = this.metal();
    this.change({ yield_stress: null, tensile_strength: null, uniform_elongation: null, rolling: metal.directional ? 90 : null });
    this.fillPlaceholders();
  }

  /** Set some values, in the fields too. @param {Record<string, any>} values */
  change(values) {
    for (const [name, value] of Object.entries(values)) {
      this.values[name] = value;
      const input = element(`f-${name}`);
      if (!input) continue;
      if (name === "material") this.metals?.show(value);
      else if (input.type === "checkbox") input.checked = Boolean(value);
      else if (input.tagName === "SELECT") input.value = value ?? "";
      else if (Array.isArray(value)) input.value = typedList(value);
      else show(input, value);
    }
  }

  /** Let the server check the form; only the last answer counts. */
  async look() {
    this.round += 1;
    const round = this.round;
    this.asking?.abort();
    this.asking = new AbortController();
    store(this.values);
    this.fillPlaceholders();
    this.showNamed();
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

  /** Show the findings beside the fields. @param {any} found */
  say(found) {
    this.follow = found.follow ?? this.follow;
    this.fillPlaceholders();
    this.change(found.measured ?? {});
    for (const { name, tool } of this.shown().filter((one) => one.tool)) element(`f-${name}`).disabled = Boolean(this.values[tool]) && element(`f-${tool}`) !== null;
    const offer = (/** @type {"punch" | "die"} */ tool) => sizesText(sizesIn(tool, { ...this.values, ...found.change }));
    this.remedy.textContent = found.change ? t("offer", { die: offer("die"), punch: offer("punch") }) : "";
    this.offered = found.change ?? {};
    const notes = this.notes(found);
    for (const { name } of fields) {
      if (!element(`f-${name}`)) continue;
      const { kind, texts } = notes.get(name) ?? { kind: "", texts: [] };
      notes.delete(name);
      put(element(`n-${name}`), kind, texts, name === "angle" && found.change ? this.remedy : null);
      if (kind) element(`n-${name}`).closest("details")?.setAttribute("open", "");
      element(`f-${name}`).removeAttribute("aria-invalid");
      if (kind === "bad") element(`f-${name}`).setAttribute("aria-invalid", "true");
    }
    this.mark(found.problems);
    if (found.part) put(element("n-part"), "", [partText(found.part)]);
    const others = [...notes.values()];
    put(element("form-note"), others.some(({ kind }) => kind === "bad") ? "bad" : "warn", others.flatMap(({ texts }) => texts));
    element("run").disabled = found.problems.length > 0;
  }

  /** Mark the numbers of bends and flanges with an error. @param {any[]} problems */
  mark(problems) {
    for (const one of document.querySelectorAll(".bends input")) one.removeAttribute("aria-invalid");
    const outside = this.values.work === "outside";
    for (const { where } of problems) {
      const [, bend, part] = /^bend (\d+), (\w+)/.exec(where) ?? [];
      const [, flange] = /^flange (\d+)/.exec(where) ?? [];
      const i = Number(bend ?? flange) - 1;
      const id = flange ? `o-${i}-flange` : outside ? `o-${this.values.outside.bends[i]?.line}-${part}` : `b-${i}-${part}`;
      element(id)?.setAttribute("aria-invalid", "true");
    }
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
    for (const { name, kind } of this.shown()) {
      const text = kind === "number" ? howRead(element(`f-${name}`).value) : "";
      if (text) add(name, "", text);
    }
    if (element("f-bends")) this.bends.howRead().forEach((text) => add("bends", "", text));
    if (element("f-outside")) this.outside.howRead().forEach((text) => add("outside", "", text));
    for (const [kind, rows] of [["warn", found.warnings], ["bad", found.problems]]) {
      for (const row of rows) {
        const [, bend, part] = /^bend (\d+)(?:, (\w+))?/.exec(row.where) ?? [];
        const [, flange] = /^flange (\d+)/.exec(row.where) ?? [];
        const outside = this.values.work === "outside";
        const bends = outside ? this.values.outside.bends : this.values.bends;
        const typed = bend ? bends[Number(bend) - 1]?.[part] : flange ? this.values.outside.flanges[Number(flange) - 1] : this.values[row.where];
        const asked = bend ? part : flange || fields.find((one) => one.name === row.where)?.kind === "number";
        const many = fields.find((one) => one.name === row.where)?.kind === "numbers";
        const text = many && typeof typed === "string" && typed.trim() ? unclearList(typed) : asked && typeof typed === "string" ? unclear(typed) : problemText(row) + valueOf(row, many);
        const number = bend && outside ? bends[Number(bend) - 1]?.line : Number(bend); // by its line: so it stands on the form
        const of = bend ? `${t("bend.number", { number })}: ` : flange ? `${t("outside.leg", { number: Number(flange) })}: ` : "";
        add(bend || flange ? (outside ? "outside" : "bends") : row.where, row.level ?? kind, of + text);
      }
    }
    return notes;
  }

  /** Show an error below the form. @param {string} text */
  refuse(text) {
    put(element("form-note"), "bad", [text]);
  }

  /** Take the suitable tools of the last answer. */
  takeRemedy() {
    this.change(this.offered);
    this.look();
    element("f-angle").focus();
  }
}
