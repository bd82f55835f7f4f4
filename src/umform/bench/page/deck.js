// @ts-check
// Any deck: opened, edited with its schema beside it, checked, run.

import { get, post } from "./api.js";
import { element, make } from "./dom.js";
import { message } from "./messages.js";
import { problemText, t } from "./texts.js";

export class Deck {
  /** @param {(name: string) => void} ran */
  constructor(ran) {
    this.ran = ran;
    /** @type {any} */
    this.schema = null;
    this.text = element("deck-text");
    this.text.addEventListener("input", () => this.changed());
    for (const event of ["click", "keyup"]) this.text.addEventListener(event, () => this.help());
    element("deck-template").addEventListener("change", () => this.take());
    element("deck-file").addEventListener("click", () => { element("deck-file").value = ""; }); // the same file again is a change
    element("deck-file").addEventListener("change", () => this.open());
    element("deck-check").addEventListener("click", () => this.check());
    element("deck-run").addEventListener("click", () => this.run());
    element("deck-save").addEventListener("click", () => this.save());
    this.at = "";
  }

  /** Load templates and schema when the view is first opened. */
  async start() {
    if (this.schema) return;
    this.schema = await get("/api/decks/schema");
    try {
      this.text.value = sessionStorage.getItem("deck") ?? "";
    } catch { /* it begins empty */ }
    if (!this.text.value) await this.take("air-bending");
    const { templates } = await get("/api/decks");
    element("deck-template").replaceChildren(make("option", { value: "" }, "…"), ...templates.map((/** @type {any} */ one) => make("option", { value: one.name }, one.title)));
    this.help();
  }

  /** @param {string} [name] */
  async take(name = element("deck-template").value) {
    if (!name) return;
    this.text.value = (await get(`/api/decks/template/${encodeURIComponent(name)}`)).text;
    this.changed();
  }

  async open() {
    const [file] = element("deck-file").files;
    if (file) this.text.value = await file.text();
    this.changed();
  }

  changed() {
    element("deck-found").replaceChildren();
    try {
      sessionStorage.setItem("deck", this.text.value);
    } catch { /* it is lost with the page */ }
    this.help();
  }

  async check() {
    element("deck-found").replaceChildren(make("li", { class: "soft" }, t("deck.checking")));
    const text = this.text.value;
    try {
      const { findings } = await post("/api/decks/check", { text });
      if (text !== this.text.value) return; // the deck has changed meanwhile
      element("deck-found").replaceChildren(...findings.map((/** @type {any} */ one) => make("li", { class: one.level },
        make("b", {}, one.about), ` ${message(one.text)}`, one.remedy ? make("em", {}, ` → ${message(one.remedy)}`) : null)));
    } catch (problem) {
      this.fail(problem);
    }
  }

  async run() {
    try {
      const { jobs } = await post("/api/decks/jobs", { text: this.text.value });
      this.ran(jobs[0]);
    } catch (problem) {
      this.fail(problem);
    }
  }

  /** @param {any} problem */
  fail(problem) {
    element("deck-found").replaceChildren(make("li", { class: "error" }, problemText(problem.answer ?? { what: String(problem) })));
  }

  save() {
    const url = URL.createObjectURL(new Blob([this.text.value], { type: "text/plain" }));
    make("a", { href: url, download: "deck.toml" }).click();
    URL.revokeObjectURL(url);
  }

  /** The keys of the table that the cursor is in. */
  help() {
    if (!this.schema) return;
    const before = this.text.value.slice(0, this.text.selectionStart);
    const headers = [...before.matchAll(/^\s*\[+\s*([^\]\n]+?)\s*\]+/gm)];
    const path = headers.length ? headers[headers.length - 1][1].split(".") : [];
    if (path.join(".") === this.at && element("deck-help").children.length) return;
    this.at = path.join(".");
    const parts = path.reduce((/** @type {any[]} */ nodes, /** @type {string} */ name) => nodes.flatMap((node) => this.below(node, name)), [this.schema]);
    const kinds = parts.flatMap((/** @type {any} */ node) => this.variants(node)).filter((/** @type {any} */ node) => node.properties);
    const title = path.length ? `[${path.join(".")}]` : t("deck.help");
    element("deck-help").replaceChildren(make("h2", {}, title), ...kinds.slice(0, 16).map((/** @type {any} */ node, /** @type {number} */ i) => this.table(node, kinds.length === 1 || (i === 0 && !path.length))));
  }

  /** @param {any} node @param {boolean} open */
  table(node, open) {
    const rows = Object.entries(node.properties).flatMap(([name, one]) => [make("dt", {}, name, make("span", {}, ` ${kindOf(one)}${(node.required ?? []).includes(name) ? " *" : ""}`)),
      make("dd", {}, one.description ?? "")]);
    return make("details", { open }, make("summary", {}, node.title ?? "", node.description ? make("span", { class: "soft" }, ` ${node.description}`) : null), make("dl", {}, ...rows));
  }

  /** @param {any} node @returns {any[]} */
  variants(node, depth = 0) {
    if (!node || depth > 6) return [];
    if (node.$ref) return this.variants(this.schema.$defs[node.$ref.split("/").at(-1)], depth + 1);
    const more = [...(node.oneOf ?? []), ...(node.anyOf ?? []), ...(node.items ? [node.items] : [])];
    return [...(node.properties ? [node] : []), ...more.flatMap((/** @type {any} */ one) => this.variants(one, depth + 1))];
  }

  /** @param {any} node @param {string} name @returns {any[]} */
  below(node, name) {
    if (!node) return [];
    if (node.patternProperties) return Object.values(node.patternProperties);
    if (node.properties?.[name]) return [node.properties[name]];
    return this.variants(node).flatMap((one) => (one.properties[name] ? [one.properties[name]] : []));
  }
}

/** @param {any} one @returns {string} */
function kindOf(one) {
  if (one.enum) return one.enum.join(" | ");
  if (one.const !== undefined) return String(one.const);
  const kinds = [one, ...(one.oneOf ?? []), ...(one.anyOf ?? [])].map(({ type, $ref }) => type ?? $ref?.split("/").at(-1)).filter(Boolean);
  const bounds = [one.exclusiveMinimum !== undefined ? `> ${one.exclusiveMinimum}` : "", one.minimum !== undefined ? `≥ ${one.minimum}` : "", one.maximum !== undefined ? `≤ ${one.maximum}` : ""].filter(Boolean).join(", ");
  return [[...new Set(kinds)].join(" | "), bounds].filter(Boolean).join(" ");
}
