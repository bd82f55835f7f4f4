// @ts-check
// Parts to unfold: STEP files are chosen or dropped, read by the server, and kept by their names.

import { get, post } from "./api.js";
import { element, make } from "./dom.js";
import { coded } from "./files.js";
import { message } from "./messages.js";
import { number, problemText, t } from "./texts.js";

/** @typedef {{name: string, thickness: number, unit: string, size: number[], holes: number, bends: {angle: number, radius: number, direction: string}[]}} Part */
/** Largest part in bytes. */
const MOST = 20e6;

export class Parts {
  /** @param {(name: string | null) => void} taken */
  constructor(taken) {
    this.taken = taken;
    /** @type {Part[]} */
    this.rows = [];
    this.said = { text: "", how: "" };
    const form = element("form");
    form.addEventListener("dragover", (/** @type {DragEvent} */ event) => this.over(event));
    form.addEventListener("dragleave", () => form.classList.remove("drop"));
    form.addEventListener("drop", (/** @type {DragEvent} */ event) => this.drop(event));
  }

  async refresh() {
    this.rows = (await get("/api/parts")).parts;
  }

  /** @param {string | null} value */
  options(value) {
    const names = this.rows.map(({ name }) => name);
    const all = value && !names.includes(value) ? [...names, value] : names;
    return [make("option", { value: "" }, t("part.none")), ...all.map((name) => make("option", { value: name }, name))];
  }

  /** Choose a file, delete the chosen part, what was said of the last file. @param {string | null} value */
  controls(value) {
    const file = make("input", { id: "part-file", type: "file", accept: ".step,.stp,.STEP,.STP", class: "hidden", "aria-label": t("part.file") });
    file.addEventListener("change", () => file.files[0] && this.send(file.files[0]));
    const again = () => {
      file.value = ""; // the same file again is a change
      file.click();
    };
    return make("div", { class: "bar", id: "part-controls" },
      make("button", { type: "button", id: "part-choose", onclick: () => again() }, t("part.file")), file,
      value ? make("button", { type: "button", id: "part-remove", "aria-label": t("part.remove", { name: value }), onclick: () => this.remove(value) }, "×") : null,
      make("p", { class: "soft" }, t("part.drop")),
      make("p", { id: "part-said", role: "status", class: `note ${this.said.how}` }, this.said.text));
  }

  /** @param {string} text @param {string} how */
  say(text, how) {
    this.said = { text, how };
    const place = element("part-said");
    if (!place) return;
    place.textContent = text;
    place.className = `note ${how}`;
  }

  /** @param {DragEvent} event */
  over(event) {
    if (!element("part-said") || !event.dataTransfer?.types.includes("Files")) return;
    event.preventDefault();
    element("form").classList.add("drop");
  }

  /** @param {DragEvent} event */
  drop(event) {
    element("form").classList.remove("drop");
    const file = event.dataTransfer?.files[0];
    if (!file || !element("part-said")) return;
    event.preventDefault();
    this.send(file);
  }

  /** @param {File} file */
  async send(file) {
    if (file.size > MOST) return this.say(t("part.large", { most: MOST / 1e6 }), "bad");
    this.say(t("part.reading", { name: file.name }), "");
    try {
      const answer = await post("/api/parts", { name: nameOf(file.name), content: await coded(file) });
      if (answer.problem) return this.say([problemText(answer.problem), message(answer.problem.value)].filter(Boolean).join(" – "), "bad");
      await this.refresh();
      this.say("", "");
      this.taken(answer.name);
    } catch (problem) {
      const { answer } = /** @type {any} */ (problem);
      this.say((answer?.problems ?? [answer ?? { what: String(problem) }]).map(problemText).join("; "), "bad");
    }
  }

  /** @param {string} name */
  async remove(name) {
    if (!window.confirm(t("part.remove.sure", { name }))) return;
    await post("/api/parts/remove", { name });
    await this.refresh();
    this.say("", "");
    this.taken(null);
  }
}

/** A name that the server takes. @param {string} name */
const nameOf = (name) => name.replace(/[^\p{L}\p{N} _.+-]/gu, " ").replace(/^[^\p{L}\p{N}]+/u, "").trim();

/** What was read of a part, in a line. @param {Part} part */
export function partText({ thickness, size, bends, holes, unit }) {
  const angles = bends.map(({ angle, radius }) => `${number(angle, 1)}° R ${number(radius, 2)}`).join(", ");
  return t("part.read", { thickness: number(thickness, 3), length: number(size[0], 1), width: number(size[1], 1), bends: bends.length, angles, holes })
    + (unit.startsWith("milli") ? "" : ` ${t("part.unit", { unit })}`);
}
