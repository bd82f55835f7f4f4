// @ts-check
// The list of jobs, updated regularly, more often while one runs.

import { get, post } from "./api.js";
import { element, make } from "./dom.js";
import { language, number, problemText, t } from "./texts.js";
import { titleOf } from "./titles.js";

const [BUSY, IDLE] = [300, 2000];

export class Jobs {
  /**
   * @param {(name: string) => void} open @param {(chosen: string[]) => void} choose
   * @param {() => void} ended called when another job has ended
   */
  constructor(open, choose, ended) {
    this.ended = ended;
    this.endings = -1;
    this.open = open;
    this.choose = choose;
    /** @type {any[]} */
    this.rows = [];
    /** @type {Set<string>} */
    this.chosen = new Set();
    this.shown = "";
    this.seen = "";
    this.timer = 0;
    document.addEventListener("visibilitychange", () => document.hidden || this.refresh());
    this.refresh();
  }

  async refresh() {
    clearTimeout(this.timer);
    try {
      const { jobs, full } = await get("/api/jobs");
      this.rows = jobs;
      element("offline").hidden = true;
      element("full").hidden = !full;
      element("full").textContent = full ? `${problemText(full)} (${full.value})` : "";
      this.show();
    } catch {
      element("offline").hidden = false;
    }
    const busy = this.rows.some(({ state }) => state === "running" || state === "waiting");
    this.timer = setTimeout(() => this.refresh(), busy ? BUSY : IDLE);
  }

  /** @param {string} name */
  mark(name) {
    this.shown = name;
    this.seen = "";
    this.show();
  }

  show() {
    const endings = this.rows.filter((row) => row.state === "done").length;
    if (endings > this.endings && this.endings >= 0) this.ended();
    this.endings = endings;
    element("jobs-empty").hidden = this.rows.length > 0;
    const seen = JSON.stringify([this.rows.map(({ id, state, summary }) => [id, state, summary.verdict]), this.shown, [...this.chosen], language]);
    if (seen !== this.seen) {
      const focus = document.activeElement?.id;
      element("jobs").replaceChildren(...this.rows.map((row) => this.item(row)));
      if (focus?.startsWith("job-")) element(focus)?.focus();
    }
    this.seen = seen;
    for (const row of this.rows) element(`job-e-${row.id}`).textContent = end(row); // buttons stay, lest a click be lost
  }

  /** @param {any} row */
  item(row) {
    const { id, state, summary, number: count } = row;
    const name = titleOf(row);
    const comparable = state === "done" && summary.measures?.angle !== undefined;
    const said = t(`state.${markOf(state, summary)}`);
    const box = make("input", { type: "checkbox", id: `job-c-${id}`, "aria-label": t("compare.choose", { title: name }), checked: this.chosen.has(id), disabled: !comparable });
    box.addEventListener("change", () => this.toggle(id, box.checked));
    const button = make("button", { type: "button", id: `job-o-${id}`, "aria-current": id === this.shown ? "true" : null, onclick: () => this.open(id) },
      make("i", { class: `dot ${state} ${summary.verdict ?? ""}`, role: "img", title: said, "aria-label": said }), make("span", {}, `${count} · ${name}`), make("b", { id: `job-e-${id}` }));
    return make("li", {}, box, button);
  }

  /** @param {string} id @param {boolean} on */
  toggle(id, on) {
    if (on) this.chosen.add(id);
    else this.chosen.delete(id);
    element("chosen-count").hidden = this.chosen.size === 0;
    element("chosen-count").textContent = String(this.chosen.size);
    this.choose([...this.chosen]);
  }

  /** @param {string} name @param {"stop" | "resume" | "remove"} what */
  async ask(name, what) {
    await post(`/api/jobs/${name}/${what}`);
    if (what === "remove") this.toggle(name, false);
    await this.refresh();
  }
}

/** A finished job whose numbers are not good has a state of its own. @param {string} state @param {any} summary */
const markOf = (state, summary) => (state === "done" && summary.verdict ? summary.verdict : state);

/** Progress of a job, or its outcome. @param {any} row @returns {string} */
function end({ state, fraction, summary }) {
  const angle = summary.measures?.angle;
  const bad = ["missed", "collides"].includes(summary.verdict);
  return state === "running" ? `${Math.round(100 * fraction)} %` : state === "done" && angle && !bad ? `${number(angle, 1)}°` : t(`state.${markOf(state, summary)}`);
}
