// @ts-check
// One job: its progress, then its numbers with their meaning.

import { get, post } from "./api.js";
import { element, make, wide } from "./dom.js";
import { known } from "./fields.js";
import { message } from "./messages.js";
import { announce, goTo, narrow } from "./announce.js";
import { bendNumbers } from "./numbers.js";
import { plot } from "./plot.js";
import { table, tile } from "./quantities.js";
import { placeOf } from "./series.js";
import { corrected, measuredForm } from "./correct.js";
import { drawnNumbers } from "./draws.js";
import { flatNumbers } from "./flat.js";
import { stripNumbers } from "./strips.js";
import { tableNumbers, tableRows } from "./bend_table.js";
import { language, number, problemText, t } from "./texts.js";
import { titleOf } from "./titles.js";

const OFTEN = 200;

export class Result {
  /** @param {any} library @param {import("./drawing.js").Drawing} drawing @param {any} actions */
  constructor(library, drawing, actions) {
    this.library = library;
    this.drawing = drawing;
    this.actions = actions;
    this.name = "";
    this.timer = 0;
    /** @type {any} */
    this.job = null;
    this.shapeOf = "";
    /** The fields of a measured bend: they stay while numbers change. @type {any} */
    this.measured = null;
    /** Findings of the server for the form of the job. @type {any} */
    this.looked = {};
    // Buttons and the frame of the 3D view are kept while numbers change: no click is lost, nothing is loaded again.
    this.bar = make("div", { class: "bar-part" });
    this.top = make("div", { class: "top-part" });
    this.space = make("div", { class: "shape" });
    this.foot = make("div", { class: "foot-part" });
    this.seen = this.barOf = this.footOf = "";
    element("result").replaceChildren(this.bar, this.top, this.space, this.foot);
  }

  /** @param {string} name */
  async open(name) {
    this.name = name;
    this.job = null;
    this.shapeOf = "";
    this.measured = null;
    this.space.replaceChildren();
    element("result").hidden = !name;
    this.drawing.setComputed(null);
    if (name) await this.refresh();
  }

  async refresh() {
    clearTimeout(this.timer);
    const name = this.name;
    if (!name) return;
    try {
      const job = await get(`/api/jobs/${name}`);
      if (name !== this.name) return;
      const seen = JSON.stringify([job.state, job.reason, job.live, job.ended]);
      const before = this.job;
      if (seen !== this.seen || !before) await this.show(job);
      if (before?.state !== job.state) this.tell(job);
      if (!before && narrow()) goTo("result");
      this.seen = seen;
      this.job = job;
    } catch (problem) {
      if (/** @type {any} */ (problem).status === 404) {
        this.actions.gone();
        return;
      }
    }
    const busy = !this.job || ["running", "waiting"].includes(this.job.state);
    if (busy) this.timer = setTimeout(() => this.refresh(), OFTEN);
  }

  /** @param {any} job */
  async show(job) {
    const parts = [];
    const bar = JSON.stringify([job.id, job.state, job.has_checkpoint, language]);
    if (bar !== this.barOf) {
      this.bar.replaceChildren(this.head(job));
      this.measured = null; // its words are those of the language
    }
    this.barOf = bar;
    if (!this.job) {
      this.looked = job.kind === "bend" ? await post("/api/look", known(job.parameters)) : {};
      if (job.id !== this.name) return; // another job was opened meanwhile
      this.actions.sketch({ drawing: this.looked.drawing }, job.parameters.work, true);
      if (this.looked.drawing) this.drawing.set(this.looked.drawing, { ...job.parameters, ...this.looked.shown });
    }
    if (this.looked.drawing) this.actions.expected(this.looked, job.parameters, job.summary.press);
    if (job.summary.profile) this.drawing.setComputed({ profile: job.summary.profile });
    else if (job.live.section || job.live.outline) this.drawing.setComputed(job.live);
    if (job.state === "running" || job.state === "waiting") parts.push(this.progress(job));
    if (job.state === "failed" || job.reason) parts.push(this.failure(job));
    if (job.state === "stopped") parts.push(make("p", { class: "soft" }, t(job.has_checkpoint ? "stopped.checkpoint" : "stopped")));
    if (job.state === "done" && job.summary.measures) parts.push(...bendNumbers(job, () => (this.measured ??= measuredForm(job, this.actions))));
    if (job.state === "running" && job.live.table?.length) parts.push(tableRows(job.live.table));
    const results = { flat: flatNumbers, table: tableNumbers, correct: corrected, cup: drawnNumbers, u: drawnNumbers }[/** @type {string} */ (job.parameters.work)];
    if (job.state === "done" && results) parts.push(...results(job));
    if (job.state === "done" && job.summary.profile) parts.push(...stripNumbers(job));
    if (job.state === "done" && job.summary.last) parts.push(this.last(job));
    const curve = this.curve(job);
    if (curve) parts.push(curve);
    const focus = document.activeElement?.id;
    this.top.replaceChildren(...parts);
    if (job.has_shape) this.shape(job);
    const foot = JSON.stringify([job.id, job.files, language]);
    if (foot !== this.footOf) this.foot.replaceChildren(...(job.files.length ? [this.files(job)] : []));
    this.footOf = foot;
    if (focus) element(focus)?.focus({ preventScroll: true });
  }

  /** @param {any} job */
  head(job) {
    const button = (/** @type {string} */ what, /** @type {string} */ name = "") =>
      make("button", { type: "button", id: `do-${what}`, class: name, onclick: () => this.act(job, what) }, t(`do.${what}`));
    const actions = job.state === "running" || job.state === "waiting" ? [button("stop")]
      : [...(job.state === "done" ? [] : [button(job.has_checkpoint ? "resume" : "restart", "main")]), ...(job.kind === "bend" ? [button("again")] : []), button("remove")];
    const others = job.series ? [make("a", { class: "button", href: `#${placeOf(job.series)}` }, t("series.open"))] : [];
    const form = make("button", { type: "button", class: "narrow", onclick: () => goTo("form") }, t("to.form"));
    return make("header", {}, make("h2", {}, `${job.number} · ${titleOf(job)}`), make("div", { class: "bar" }, form, ...others, ...actions, ...this.next(job)));
  }

  /** Work that goes on from a finished bend, one click away. @param {any} job */
  next(job) {
    if (job.state !== "done" || job.parameters.work !== "bend") return [];
    const button = (/** @type {string} */ name, /** @type {() => void} */ act) => make("button", { type: "button", id: `next-${name}`, onclick: act }, t(`next.${name}`));
    return [
      button("measured", () => {
        element("measured").open = true;
        goTo("measured");
        element("m-measured_angle").focus({ preventScroll: true });
      }),
      button("angles", () => this.actions.angles(job)),
      button("table", () => this.actions.table(job)),
    ];
  }

  /** Show the outcome of the job, and on a small screen scroll there. @param {any} job */
  tell(job) {
    const state = job.state === "done" ? t("told.done") : t(`state.${job.state}`);
    announce(t(narrow() ? "told.above" : "told", { number: job.number, title: titleOf(job), state }));
  }

  /** @param {any} job @param {string} what */
  async act(job, what) {
    if (what === "again") this.actions.again(job);
    else if (what !== "remove" || window.confirm(t("remove.sure", { title: job.title }))) await this.actions.ask(job.id, what === "restart" ? "resume" : what);
    await this.refresh();
  }

  /** The error of a job. @param {any} job */
  failure({ reason, summary: { error } }) {
    const all = error ? error.all ?? [error] : [{ what: reason }];
    const text = (/** @type {any} */ one) => [problemText({ ...one, kind: "" }), [one.where, one.value].filter(Boolean).join(": ")].filter(Boolean).join("\n");
    return make("pre", { class: "bad" }, all.map(text).join("\n\n"));
  }

  /** @param {any} job */
  progress(job) {
    const { live } = job;
    const percent = Math.round(100 * (live.fraction ?? 0));
    const text = job.state === "waiting" ? t("state.waiting") : [live.operations > 1 ? t("operation", live) : "", t(`phase.${live.phase}`, live),
      live.increments ? t("increments", live) : "", live.count ? t("bends.done", live) : "", live.stroke === undefined ? "" : `${number(live.stroke, 2)} mm`,
      live.angle === undefined ? "" : `${number(live.angle, 1)}°`, live.seconds ? `${number(live.seconds, 0)} s` : ""].filter(Boolean).join(" · ");
    return make("div", { class: "progress" }, make("progress", { max: 100, value: percent, "aria-label": t("progress") }), make("p", { role: "status" }, text));
  }

  /** The end of the run of a deck. @param {any} job */
  last(job) {
    const rows = Object.entries(job.summary.last).map(([name, value]) => make("tr", {}, make("th", { scope: "row" }, name), make("td", {}, number(/** @type {number} */ (value)))));
    const notes = [...job.summary.warnings.map((/** @type {string} */ text) => make("p", { class: "note warn" }, message(text))),
      ...job.summary.events.map((/** @type {string} */ text) => make("p", { class: "note" }, message(text)))];
    const { quantities = [], checks = [], key = [] } = job.summary;
    const tiles = key.map((/** @type {import("./quantities.js").Quantity} */ one) => tile(one, "hero"));
    return make("div", { class: "last" }, ...notes, make("dl", { class: "heroes first" }, ...tiles), table([...quantities, ...checks]), make("details", {}, make("summary", {}, t("deck.end")), wide(make("table", {}, make("tbody", {}, ...rows)))));
  }

  /** @param {any} job */
  curve(job) {
    const { curve } = job.live;
    if (job.parameters.work === "correct" || !curve?.x.length) return null;
    const bend = job.kind === "bend";
    const words = { x: bend ? t("axis.stroke") : curve.names[0], y: bend ? t(curve.of ? "axis.punch" : "axis.force") : curve.names[1], label: t("curve.label"), band: bend ? job.summary.shop_forces : undefined };
    const ended = !["running", "waiting"].includes(job.state);
    const caption = make("figcaption", {}, bend && words.band ? t("curve.band") : t(ended ? "curve.ended" : "curve.live"));
    const width = Math.max(280, Math.min(560, element("result").clientWidth - 60)); // letters as large as all others on a phone
    return make("figure", { class: "card" }, plot([{ name: "", ...curve }], words, width), caption);
  }

  /** Scene and curves of the report in a frame of their own. @param {any} job */
  shape(job) {
    const version = `${job.id}-${job.live.shape}`;
    if (version === this.shapeOf) return;
    const before = this.shapeOf;
    this.shapeOf = version;
    if (before && job.parameters.work === "flat") return;
    if (before) {
      this.renew(job.id);
      return;
    }
    const frame = make("iframe", { title: t("shape.title"), sandbox: "allow-scripts allow-downloads", src: `/files/${job.id}/shape.html` });
    const alone = job.parameters.work === "flat"; // a solid has no later state
    frame.classList.toggle("alone", alone);
    if (!alone) frame.addEventListener("load", () => this.renew(job.id)); // the page of the shape is as old as the first state
    this.space.replaceChildren(frame);
  }

  /** Send the present scene to the frame of the 3D view, which keeps its view and choices. @param {string} name */
  async renew(name) {
    const frame = this.space.querySelector("iframe");
    try {
      const scene = await get(`/api/jobs/${name}/scene`);
      if (name === this.name) frame?.contentWindow?.postMessage(scene, "*"); // a frame without an origin has no name
    } catch { /* the next state is as good */ }
  }

  /** @param {any} job */
  files(job) {
    const named = { "report.html": "file.report", "curve.csv": "file.csv", "history.csv": "file.history", "bend.toml": "file.deck", "as-run.toml": "file.deck", "bend.json": "file.json", "sequence.json": "file.json", "hem.json": "file.json", "curves.csv": "file.csv", "profile.csv": "file.profile",
      "flat.dxf": "file.dxf", "flat.svg": "file.svg", "flat.json": "file.json", "sheet.html": "file.sheet", "bends.csv": "file.table", "bends.json": "file.json", "metal.toml": "file.metal" };
    const link = (/** @type {string} */ file, /** @type {string} */ text) => make("a", { class: "button", href: `/files/${job.id}/${file}${file.endsWith(".csv") && language === "de" ? "?language=de" : ""}`, target: file.endsWith(".html") ? "_blank" : null, rel: "noopener" }, text);
    const first = Object.entries(named).filter(([file]) => job.files.includes(file)).map(([file, key]) => link(file, t(key)));
    const formats = Object.entries({ ".FCStd": "FreeCAD", ".inventor.txt": "Inventor", ".bnd": "Creo", ".solidworks.txt": "SolidWorks" });
    for (const [ending, name] of formats) {
      const of = job.files.filter((/** @type {string} */ file) => file.endsWith(ending));
      first.push(...of.map((/** @type {string} */ file) => link(file, of.length > 1 ? `${name}: ${file.slice(0, -ending.length)}` : name)));
    }
    const others = job.files.filter((/** @type {string} */ file) => !(file in named) && !formats.some(([ending]) => file.endsWith(ending))).map((/** @type {string} */ file) => make("li", {}, link(file, file)));
    return make("footer", {}, make("div", { class: "bar" }, ...first, make("button", { type: "button", id: "do-print", onclick: () => window.print() }, t("print"))),
      make("details", {}, make("summary", {}, t("files.more")), make("ul", { class: "bar" }, ...others), make("p", { class: "soft" }, t("files.where", { folder: job.folder }))));
  }
}
