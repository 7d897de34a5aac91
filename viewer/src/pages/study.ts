// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { StudyPage, StudyResult } from "../page_types.ts";
import { el, section } from "../dom.ts";
import { number, plural } from "../format.ts";
import { svgFigure } from "../plots/svg_figure.ts";
import { linkBar, resultFindings, resultHeader, resultRun, table, text } from "../sections/result_parts.ts";
import type { Column } from "../sections/table.ts";
import { foreign } from "../foreign.ts";
import type { Content } from "./content.ts";

type Row = StudyResult["rows"][number];

/** Four significant digits, as the tables of the papers have them. */
export const significant = (v: number | null): string => (v === null ? "–" : String(Number(v.toPrecision(4))).replace("-", "−"));

const boundText = ({ bound }: Row): string => {
  if (bound === null) return "none";
  if (!Array.isArray(bound)) return `≤ ${significant(bound)}`;
  const [low, high] = bound;
  return high === null ? `≥ ${significant(low)}` : `${significant(low)} to ${significant(high)}`;
};

const value = (title: string, of: (row: Row) => number | null): Column<Row> => ({ title, numeric: true, key: of, cell: (row) => significant(of(row)) });

/** A founding paper beside ours: what is missed, figures, the table. */
export function studyPage({ summary, result }: StudyPage): Content {
  const bounded = result.rows.filter((r) => r.pass !== null);
  const missed = bounded.filter((r) => !r.pass).length;
  const better = result.rows.filter((r) => r.classic !== null);
  const columns: Column<Row>[] = [
    text("Quantity", (r) => r.quantity),
    text("Unit", (r) => (r.unit === "1" ? "" : r.unit)),
    value("Paper", (r) => r.paper),
    value(result.classic, (r) => r.classic),
    value("Ours", (r) => r.ours),
    value("Expected", (r) => r.expected),
    text("which is", (r) => r.expected_is ?? ""),
    text("Bound", boundText),
    { title: "Met", key: (r) => (r.pass === null ? "" : r.pass ? "yes" : "no"), cell: (r) => (r.pass === null ? "" : el("span", { class: r.pass ? "met" : "missed" }, r.pass ? "yes" : "no")) },
  ];
  return {
    skip: ["table", "Skip to the table"],
    header: resultHeader("study", result.description, summary, [
      [`${number(bounded.length - missed)} of ${number(bounded.length)}`, "bounds met", missed === 0 ? "none is missed" : `${number(missed)} missed`],
      [number(result.rows.length), "quantities", `${number(result.rows.filter((r) => r.paper !== null).length)} of them published`],
      [number(better.length), "compared", `with ${result.classic}`],
      [number(result.rows.filter((r) => r.expected !== null).length), "with an expected value", "a bound or a right value"],
      [number(result.seeds.length), result.seeds.length === 1 ? "seed" : "seeds", seedText(result.seeds)],
      [number(result.figures.length), "figures", "each to be saved as SVG or PNG"],
    ]),
    bar: linkBar([["attention", "Attention"], ["figures", "Figures"], ["table", "Table"], ["settings", "Run"]]),
    sections: [
      resultFindings(summary, bounded.length === 0 ? "Nothing was asked." : "Nothing. Every bound is met."),
      section("figures", "Figures", "", el("div", { class: "study-figures" }, ...result.figures.map(drawnFigure))),
      section("table", "The paper beside ours", `${result.columns}.`, table("Quantities", columns, result.rows)),
      resultRun(summary, [["Seeds", seedText(result.seeds)]]),
    ],
    start: () => undefined,
  };
}

/** A drawing of the command's, to be saved. */
export function drawnFigure({ caption, body }: { caption: string; body: string }): HTMLElement {
  const parts = foreign(body);
  const drawing = parts.find((p): p is SVGElement => p instanceof SVGElement);
  if (drawing === undefined) return el("figure", { class: "plot drawn" }, el("figcaption", {}, caption), ...parts);
  return svgFigure(caption, drawing, ...parts.filter((p) => p !== drawing));
}

/** 1, 2, 3, 7 as "1–3, 7". */
export function seedText(seeds: readonly number[]): string {
  const runs: [number, number][] = [];
  for (const seed of seeds) {
    const last = runs[runs.length - 1];
    if (last !== undefined && seed === last[1] + 1) last[1] = seed;
    else runs.push([seed, seed]);
  }
  return runs.length > 6 ? plural(seeds.length, "seed") : runs.map(([a, b]) => (a === b ? String(a) : `${a}–${b}`)).join(", ");
}
