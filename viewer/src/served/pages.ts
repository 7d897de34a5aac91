// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { FactList, FactsPage, NoticePage, TrialRow, Trials, TrialsPage } from "../page_types.ts";
import { el } from "../dom.ts";

/** A page of the server's own. */
export interface Served {
  title: string;
  header: HTMLElement;
  main: HTMLElement;
}

const backToList = (root: string): HTMLElement => el("p", { class: "model" }, el("a", { href: root }, "All trials"));
const brand = (what: string): HTMLElement => el("p", { class: "brand" }, el("b", {}, "kinemark"), what === "" ? null : ` ${what}`);

const count = (value: number | null): string => (value === null ? "" : String(value));

/** Only all of them is 100 %. */
export function measured(share: number | null): string {
  if (share === null) return "";
  return share < 1 ? `${Math.min(100 * share, 99.9).toFixed(1)} %` : "100 %";
}

function verdict({ state, verdict }: TrialRow): HTMLElement | null {
  if (state === "reading") return el("span", { class: "tag" }, "being read");
  if (state === "unreadable") return el("span", { class: "tag attention" }, "not readable");
  if (verdict === "good") return el("span", { class: "tag good" }, "Good");
  return verdict === "attention" ? el("span", { class: "tag attention" }, "Needs attention") : null;
}

function trial(row: TrialRow, showsFolder: boolean, root: string): HTMLElement {
  const numbers = [
    count(row.markers),
    count(row.frames),
    row.rate_hz === null ? "" : String(Number(row.rate_hz.toPrecision(5))),
    row.duration_s === null ? "" : row.duration_s.toFixed(2),
    measured(row.measured),
  ];
  return el(
    "tr",
    {},
    el(
      "th",
      { scope: "row" },
      el("a", { href: `${root}trial/${row.number}` }, row.name === "" ? "(no name)" : row.name),
      showsFolder ? el("small", {}, row.folder) : null,
    ),
    el("td", {}, verdict(row)),
    el("td", {}, row.kind ?? ""),
    ...numbers.map((text) => el("td", { class: "number" }, text)),
    el("td", { class: "said" }, row.said ?? ""),
  );
}

export function summary(rows: readonly TrialRow[]): string {
  const where = (of: (row: TrialRow) => boolean): number => rows.filter(of).length;
  const [attention, unreadable, reading] = [where((r) => r.verdict === "attention"), where((r) => r.state === "unreadable"), where((r) => r.state === "reading")];
  return [
    `${rows.length} ${rows.length === 1 ? "trial" : "trials"}`,
    attention > 0 ? `, ${attention} in need of attention` : "",
    unreadable > 0 ? `, ${unreadable} not readable` : "",
    reading > 0 ? `, ${reading} being read: this page fills in by itself` : "",
  ].join("");
}

const foldersOf = (rows: readonly TrialRow[]): string[] => [...new Set(rows.map((row) => row.folder))];
export const isReading = ({ trials }: Trials): boolean => trials.some((row) => row.state === "reading");

const columns = ["Trial", "Verdict", "Kind", "Markers", "Frames", "Rate, Hz", "Duration, s", "Measured", "Findings"];
const numbers = new Set(["Markers", "Frames", "Rate, Hz", "Duration, s", "Measured"]);

/** The list of trials; made anew while they are being read. */
export function trialsMain({ trials, notes }: Trials, root: string): HTMLElement {
  const several = foldersOf(trials).length > 1;
  const heads = columns.map((name) => el("th", { scope: "col", class: numbers.has(name) ? "number" : false }, name));
  const table = (): HTMLElement =>
    el(
      "div",
      { class: "table", role: "region", "aria-label": "Trials", tabindex: "0" },
      el("table", {}, el("thead", {}, el("tr", {}, ...heads)), el("tbody", {}, ...trials.map((row) => trial(row, several, root)))),
    );
  return el(
    "main",
    { id: "trials" },
    el(
      "section",
      {},
      el("p", { class: "lead", role: "status" }, summary(trials)),
      ...notes.map((note) => el("p", { class: "broken" }, note)),
      trials.length === 0 ? null : table(),
    ),
  );
}

export function trialsPage({ summary: { root }, list }: TrialsPage): Served {
  const folders = foldersOf(list.trials);
  const folder = folders.length === 1 && folders[0] !== "" ? el("p", { class: "model" }, folders[0]!) : null;
  return { title: "Trials", header: el("header", {}, brand("trials"), el("h1", {}, "Trials"), folder), main: trialsMain(list, root) };
}

const factList = ({ name, values }: FactList): HTMLElement =>
  el(
    "section",
    {},
    el("h2", {}, `${name} `, el("small", {}, String(values.length))),
    el("ul", { class: "names" }, ...values.map((value) => el("li", {}, value))),
  );

/** What a file holds. */
export function factsPage({ summary: { trial, kind, root }, warnings, facts, lists }: FactsPage): Served {
  const odd = el(
    "section",
    {},
    el("h2", {}, "What is odd"),
    el("ul", { class: "findings" }, ...warnings.map((text) => el("li", { class: "note" }, el("span", { class: "level" }, "note"), el("span", { class: "text" }, text)))),
  );
  const rows = facts.map(({ name, value }) => el("tr", {}, el("th", { scope: "row" }, name), el("td", {}, value)));
  const held = el(
    "section",
    {},
    el("h2", {}, "What it holds"),
    el("div", { class: "table", role: "region", "aria-label": "What it holds", tabindex: "0" }, el("table", { class: "held" }, el("tbody", {}, ...rows))),
  );
  return {
    title: trial,
    header: el("header", {}, brand(kind), el("h1", {}, trial), backToList(root)),
    main: el("main", {}, warnings.length === 0 ? null : odd, held, ...lists.map(factList)),
  };
}

/** One sentence on what is wrong, and the way back to the list. */
export const noticePage = ({ summary: { trial, root }, sentence }: NoticePage): Served => ({
  title: trial,
  header: el("header", {}, brand(""), el("h1", {}, trial), backToList(root)),
  main: el("main", {}, el("p", { class: "broken" }, sentence)),
});
