// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { InputFile } from "../page_types.ts";
import { el, section } from "../dom.ts";
import { bytes, number } from "../format.ts";

const exitWords: Record<number, string> = {
  0: "0, good",
  1: "1, ran but missed a quality check",
};

/** What every report knows of its run. */
export interface Run {
  version: string;
  command_line: string;
  exit_status: number;
  seed: number;
  threads: number;
  options: Record<string, string>;
  inputs: readonly InputFile[];
}

/** What it takes to make this result again. `methods` and `tookS` stand among the facts of the run. */
export function settings(summary: Run, methods: readonly [string, string][], tookS: number | null): HTMLElement {
  const facts: [string, string][] = [
    ["Program", `kinemark ${summary.version}`],
    ...methods,
    ["Exit status", exitWords[summary.exit_status] ?? String(summary.exit_status)],
    ["Seed", String(summary.seed)],
    ["Threads", String(summary.threads)],
    ["Time taken", tookS === null ? "–" : `${number(tookS, 3)} s`],
  ];
  return section(
    "settings",
    "Settings and inputs",
    "",
    summary.command_line === "" ? null : el("pre", { tabindex: 0, "aria-label": "Command line" }, summary.command_line),
    el(
      "div",
      { class: "columns" },
      plain("Run", ["What", "Value"], facts),
      plain("Options", ["Option", "Value"], Object.entries(summary.options)),
    ),
    plain(
      "Input files",
      ["Role", "File", "Size", "Hash"],
      summary.inputs.map((i) => [i.role, i.path, bytes(i.bytes), `${i.hash_kind} ${i.hash}`]),
    ),
  );
}

/** A table of words; null without rows. */
export function plain(caption: string, titles: readonly string[], rows: readonly (readonly string[])[]): HTMLElement | null {
  if (rows.length === 0) return null;
  return el(
    "div",
    { class: "table" },
    el(
      "table",
      {},
      el("caption", {}, caption),
      el("thead", {}, el("tr", {}, ...titles.map((t) => el("th", { scope: "col" }, t)))),
      el(
        "tbody",
        {},
        ...rows.map((cells) => el("tr", {}, ...cells.map((c, i) => (i === 0 ? el("th", { scope: "row" }, c) : el("td", {}, c))))),
      ),
    ),
  );
}
