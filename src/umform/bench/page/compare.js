// @ts-check
// Comparison of jobs: numbers in columns, curves in one picture.

import { get } from "./api.js";
import { element, make, wide } from "./dom.js";
import { differing, fullHeading, givenText } from "./fields.js";
import { plot } from "./plot.js";
import { cell, forShop, heading } from "./quantities.js";
import { language, t } from "./texts.js";

/** @param {string[]} names */
export async function compare(names) {
  const place = element("compare");
  const asked = await Promise.allSettled(names.map((name) => get(`/api/jobs/${name}`)));
  // A link may name jobs that are deleted or not finished.
  const jobs = asked.flatMap((one) => (one.status === "fulfilled" && one.value.summary.measures ? [one.value] : []));
  if (!jobs.length) {
    place.replaceChildren(make("p", { class: "soft" }, t("compare.empty")));
    return;
  }
  const curves = await Promise.all(jobs.map(async (job) => ({ name: `${job.number}`, ...(await get(`/api/jobs/${job.id}/curve`)) })));
  const head = make("tr", {}, make("td"), ...jobs.map((job, i) => make("th", { scope: "col" }, make("i", { class: `swatch c${i % 6}` }), `${job.number}`)));
  const given = [...new Set(["material", "angle", ...differing(jobs)])].map((name) => givenRow(fullHeading(name), jobs.map((job) => givenText(job, name))));
  /** @type {import("./quantities.js").Quantity[][]} */
  const columns = jobs.map((job) => [...(job.summary.quantities ?? []), ...(job.summary.checks ?? [])]);
  const row = (/** @type {string} */ name, /** @type {(one: any, job: any) => any} */ as) => {
    const ones = columns.map((column, i) => [column.find((one) => one.name === name), jobs[i]]).map(([one, job]) => one && as(one, job));
    return make("tr", {}, make("th", { scope: "row" }, heading(ones.find(Boolean))), ...ones.map(cell));
  };
  const press = row("largest_force", (one, job) => forShop(one, job.summary.length));
  const found = [...new Set(columns.flat().map((one) => one.name))].map((name) => row(name, (one) => one));
  place.replaceChildren(
    make("figure", { class: "card" }, plot(curves, { x: t("axis.stroke"), y: t("axis.force"), label: t("curve.label") }, 900, 320)),
    wide(make("table", { class: "columns" }, make("thead", {}, head), make("tbody", {}, ...given, press, ...found))),
    make("p", { class: "bar" }, make("a", { class: "button", href: `/api/jobs.csv?ids=${jobs.map((job) => job.id).join(",")}&language=${language}` }, t("file.table")),
      make("button", { type: "button", onclick: () => window.print() }, t("print"))),
  );
}

/** @param {string} name @param {string[]} cells */
const givenRow = (name, cells) => make("tr", {}, make("th", { scope: "row" }, name), ...cells.map((cell) => make("td", {}, cell)));
