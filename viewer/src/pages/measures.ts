// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { MeasuresResult, MeasuresPage } from "../page_types.ts";
import { el, section } from "../dom.ts";
import { number, plural } from "../format.ts";
import { neuralLanes, unpackLanes } from "../sections/neural.ts";
import { linkBar, resultFindings, resultHeader, resultRun, table, text } from "../sections/result_parts.ts";
import type { Column } from "../sections/table.ts";
import { View } from "../view.ts";
import type { Content } from "./content.ts";
import { drawnFigure } from "./study.ts";

type Row = MeasuresResult["measures"][number];

const percent = (share: number | null): string => (share === null ? "–" : `${number(100 * share, 1)} %`);

/** What a recording's movements were: what must be known, figures, the table. */
export async function measuresPage({ summary, result }: MeasuresPage): Promise<Content> {
  const known = result.measures.filter((r) => r.value !== null);
  const covered = known.filter((r) => r.interval.kind !== "none");
  const columns: Column<Row>[] = [
    text(result.rows, (r) => r.subject),
    ...(result.regions > 1 ? [text<Row>("Region", (r) => r.region ?? "")] : []),
    text("Measure", (r) => r.title),
    { title: "Value and interval", key: (r) => r.value, cell: (r) => r.shown },
    { title: "Not measured", numeric: true, key: (r) => r.share_not_measured, cell: (r) => percent(r.share_not_measured) },
    text("To be known", (r) => r.remark ?? ""),
  ];
  const { neural } = result;
  const lanes = neural === undefined ? [] : [neuralLanes(await unpackLanes(neural), neural.unit_count, new View([neural.start_s, neural.start_s + neural.bins * neural.bin_s]))];
  const level = `${number(100 * result.level, 0)} %`;
  return {
    skip: ["table", "Skip to the table"],
    header: resultHeader("measures", result.heading, summary, [
      [number(result.measures.length), "measures", `of ${number(result.markers)} (${result.rows.toLowerCase()}) in ${plural(result.regions, "span", "spans")}`],
      [number(covered.length), `with an interval of ${level}`, result.refits === 0 ? "none was asked for" : `by ${number(result.refits)} refits`],
      [number(covered.filter((r) => r.interval.approximate).length), "approximate", "cover less in some movements"],
      [number(result.measures.length - known.length), "not determined", "the table says why"],
      [percent(result.most_not_measured), "not measured", "where most is missing"],
      [number(result.figures.length), "figures", "each to be saved as SVG or PNG"],
    ]),
    bar: linkBar([["attention", "Attention"], ["figures", "Figures"], ...(lanes.length > 0 ? ([["neural", "Spikes"]] as [string, string][]) : []), ["table", "Table"], ["settings", "Run"]]),
    sections: [
      resultFindings(summary, "Nothing stands out."),
      section("figures", "Figures", "", el("div", { class: "study-figures" }, ...result.figures.map(drawnFigure))),
      ...lanes.map((l) => l.node),
      section("table", "Measures", "", table("Measures", columns, result.measures)),
      resultRun(summary, [["Refits", number(result.refits)], ["Level", level]]),
    ],
    start: () => lanes.forEach((l) => l.start()),
  };
}
