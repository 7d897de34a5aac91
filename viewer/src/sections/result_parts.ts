// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { ResultSummary } from "../page_types.ts";
import { el, section } from "../dom.ts";
import { bytes, number } from "../format.ts";
import { findingGroups } from "./finding_groups.ts";
import { medianOf, tile, titleRow } from "./header.ts";

export { medianOf as median };
import { plain } from "./settings.ts";
import { sortableTable, type Column } from "./table.ts";

export type Tile = readonly [value: string, label: string, detail: string];

/** Name, verdict and the numbers that people look for first: the same on every page. */
export const resultHeader = (what: string, below: string, summary: ResultSummary, tiles: readonly Tile[]): HTMLElement =>
  el(
    "header",
    {},
    titleRow(what, summary.trial, el("p", { class: "model" }, below), {
      verdict: summary.verdict,
      findings: summary.groups.flatMap((g) => g.items.map((item) => ({ ...item, level: g.level }))),
    }),
    el("dl", { class: "tiles" }, ...tiles.map(([value, label, detail]) => tile(value, label, detail))),
  );

/** Links to the sections, and nothing else where there is no time. */
export const linkBar = (links: readonly (readonly [string, string])[]): HTMLElement =>
  el("nav", { class: "bar", "aria-label": "Page" }, el("span", { class: "links" }, ...links.map(([id, words]) => el("a", { href: `#${id}` }, words))));

export const resultFindings = (summary: ResultSummary, nothing: string, jump: Parameters<typeof findingGroups>[2] = null): HTMLElement =>
  findingGroups(summary.groups, { title: "What needs your attention", nothing }, jump);

/** How it came about. */
export const resultRun = (summary: ResultSummary, facts: readonly [string, string][]): HTMLElement =>
  section(
    "settings",
    "How it was made",
    "",
    summary.command_line === "" ? null : el("pre", { tabindex: 0, "aria-label": "Command line" }, summary.command_line),
    plain("Run", ["What", "Value"], [["Program", `kinemark ${summary.version}`], ...facts]),
    plain("Input files", ["Role", "File", "Size", "Hash"], summary.inputs.map((i) => [i.role, i.path, bytes(i.bytes), `${i.hash_kind} ${i.hash}`])),
  );

export const text = <T>(title: string, cell: (row: T) => string): Column<T> => ({ title, key: cell, cell });

/** A number with its unit; a dash where it is not known. */
export const numeric = <T>(title: string, unit: string, decimals: number, value: (row: T) => number | null | undefined): Column<T> => ({
  title,
  ...(unit === "" ? {} : { unit }),
  numeric: true,
  key: (row) => value(row) ?? null,
  cell: (row) => number(value(row), decimals),
});

/** Value and interval in one cell: "43.5 ± 1.2". */
export const withSd = <T>(title: string, unit: string, decimals: number, value: (row: T) => number | null | undefined, sd: (row: T) => number | null | undefined): Column<T> => ({
  title,
  unit,
  numeric: true,
  key: (row) => value(row) ?? null,
  cell: (row) => {
    const [v, s] = [value(row), sd(row)];
    return v === null || v === undefined ? "–" : s === null || s === undefined ? number(v, decimals) : `${number(v, decimals)} ± ${number(s, decimals)}`;
  },
});

/** Rows above which a table is folded. */
const longTable = 24;

/** A table in the order of its rows; a long one is folded, and on paper left out unless somebody unfolded it. */
export function table<T>(caption: string, columns: Column<T>[], rows: readonly T[]): HTMLElement | null {
  if (rows.length === 0) return null;
  const { node } = sortableTable(caption, columns, rows, { column: -1, direction: "descending" });
  return rows.length <= longTable ? node : el("details", { class: "long" }, el("summary", {}, `${caption}: ${number(rows.length)} rows`), node);
}
