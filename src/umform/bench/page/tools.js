// @ts-check
// Drawn punches and dies: drawings are uploaded, read by the server, and stored under a name.

import { get, post } from "./api.js";
import { element, make } from "./dom.js";
import { label, sizesIn } from "./fields.js";
import { coded } from "./files.js";
import { number, problemText, t } from "./texts.js";

/** @typedef {{kind: "punch" | "die", name: string, angle?: number, radius?: number, opening?: number, layer?: string, unit?: string, layers?: string[]}} Tool */
/** Largest drawing in bytes. */
const MOST = 6e6;

export class Tools {
  /** @param {(kind: "punch" | "die", name: string | null) => void} taken */
  constructor(taken) {
    this.taken = taken;
    /** @type {Tool[]} */
    this.rows = [];
  }

  async refresh() {
    this.rows = (await get("/api/tools")).tools;
  }

  /** By numbers, usual ones by name, those of drawings. @param {"punch" | "die"} kind @param {string | null} value @param {{name: string, sizes: Record<string, number>}[]} usual */
  options(kind, value, usual) {
    const names = this.rows.filter((one) => one.kind === kind).map(({ name }) => name);
    const all = value && !names.includes(value) ? [...names, value] : names;
    const drawn = all.map((name) => make("option", { value: name }, name));
    return [make("option", { value: "" }, t("tool.numbers")), ...(drawn.length ? [make("optgroup", { label: t("tool.drawn") }, ...drawn)] : []),
      make("optgroup", { label: t("tool.usual") }, ...usual.map(({ name, sizes }) => make("option", { value: `usual:${name}` }, sizesText(sizesIn(kind, sizes)))))];
  }

  ask() {
    const dialog = element("tool-dialog");
    const kind = make("select", { id: "tool-kind" }, ...["punch", "die"].map((one) => make("option", { value: one }, label(one))));
    const file = make("input", { id: "tool-file", type: "file", accept: ".dxf", required: true });
    const name = make("input", { id: "tool-name", maxlength: 40, required: true });
    const layer = make("input", { id: "tool-layer", list: "tool-layers", placeholder: t("tool.layer.all") });
    const said = make("p", { class: "note", role: "status", id: "tool-said" });
    const send = make("button", { class: "main", type: "submit", id: "tool-send" }, t("tool.send"));
    file.addEventListener("change", () => {
      if (!name.value && file.files[0]) name.value = file.files[0].name.replace(/\.dxf$/i, "").replace(/[^\p{L}\p{N} _.+-]/gu, " ").trim().slice(0, 40);
    });
    const form = make("form", { method: "dialog" }, make("h2", { id: "tool-title" }, t("tool.title")), make("p", { class: "soft" }, t("tool.lead")),
      make("label", {}, t("tool.kind"), kind), make("label", {}, t("tool.file"), file), make("label", {}, t("tool.name"), name),
      make("label", {}, t("tool.layer"), layer), make("datalist", { id: "tool-layers" }), said,
      make("div", { class: "bar" }, send, make("button", { type: "button", id: "tool-close", onclick: () => dialog.close() }, t("tour.leave"))),
      make("ul", { id: "tool-list" }));
    form.addEventListener("submit", async (/** @type {Event} */ event) => {
      event.preventDefault();
      if (!file.files[0]) return;
      send.disabled = true;
      said.className = "note";
      said.textContent = t("tool.reading");
      await this.send(kind.value, file.files[0], name.value.trim(), layer.value.trim(), said);
      send.disabled = false;
    });
    dialog.replaceChildren(form);
    this.list();
    dialog.showModal();
  }

  /** @param {"punch" | "die"} kind @param {File} file @param {string} name @param {string} layer @param {any} said */
  async send(kind, file, name, layer, said) {
    /** @param {string} text @param {string} how */
    const say = (text, how) => {
      said.textContent = text;
      said.className = `note ${how}`;
    };
    if (file.size > MOST) return say(t("tool.large", { most: MOST / 1e6 }), "bad");
    try {
      const answer = await post("/api/tools", { kind, name, layer, drawing: await coded(file) });
      if (answer.problem) {
        element("tool-layers").replaceChildren(...answer.layers.map((/** @type {string} */ one) => make("option", { value: one })));
        const layers = answer.layers.length > 1 ? t("tool.layers", { layers: answer.layers.join(", ") }) : "";
        return say([problemText(answer.problem), answer.problem.value, layers].filter(Boolean).join(" – "), "bad");
      }
      await this.refresh();
      this.list();
      this.taken(kind, name);
      return say([t(`tool.read.${kind}`, answer), answer.unit ? t("tool.unit", answer) : t("tool.nounit")].join(" "), "good");
    } catch (problem) {
      const { answer } = /** @type {any} */ (problem);
      return say((answer?.problems ?? [answer ?? { what: String(problem) }]).map(problemText).join("; "), "bad");
    }
  }

  list() {
    element("tool-list").replaceChildren(...this.rows.map((one) => make("li", {},
      make("span", {}, `${label(one.kind)} · ${one.name}`, make("span", { class: "soft" }, ` ${sizesText(one)}`)),
      make("button", { type: "button", "aria-label": t("tool.remove", { name: one.name }), onclick: () => this.remove(one) }, "×"))));
  }

  /** @param {Tool} one */
  async remove({ kind, name }) {
    if (!window.confirm(t("tool.remove.sure", { name }))) return;
    await post("/api/tools/remove", { kind, name });
    await this.refresh();
    this.list();
    this.taken(kind, null);
  }
}

/** Sizes of a tool in short. @param {{opening?: number, angle?: number, radius?: number}} one */
export function sizesText({ opening, angle, radius }) {
  const short = (/** @type {number} */ value, /** @type {number} */ decimals) => number(Number(value.toFixed(decimals)));
  return [opening === undefined ? "" : `V ${short(opening, 1)}`, angle === undefined ? "?" : `${short(angle, 1)}°`, radius === undefined ? "" : `R ${short(radius, 2)}`].filter(Boolean).join(" ");
}
