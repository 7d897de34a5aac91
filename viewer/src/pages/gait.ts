// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { GaitPage, GaitResult } from "../page_types.ts";
import { el, section } from "../dom.ts";
import { number, plural } from "../format.ts";
import { linkBar, numeric, resultFindings, resultHeader, resultRun, text } from "../sections/result_parts.ts";
import { sortableTable, type Column } from "../sections/table.ts";
import type { Content } from "./content.ts";
import { drawnFigure } from "./study.ts";

type Row = GaitResult["measures"][number];
type Score = GaitResult["deviation"]["scores"][number];
type Event = GaitResult["events"][number];

const outside = (judgement: string): boolean => judgement === "below" || judgement === "above";

/** Value and interval, and below them where the norm is. */
const cell = (title: string, i: 0 | 1 | 2): Column<Row> => ({
  title,
  key: (row) => row.value[i],
  cell: (row) => el("span", { class: "beside-norm" }, row.value[i], row.judgement[i] === "" ? null : el("small", { class: outside(row.judgement[i]) ? "outside" : "" }, row.judgement[i])),
});

/** In the order of its rows, and on paper too. */
const whole = <T>(caption: string, columns: Column<T>[], rows: readonly T[]): HTMLElement =>
  sortableTable(caption, columns, rows, { column: -1, direction: "descending" }).node;

function measuresSection({ measures, level, norm_sources, treadmill }: GaitResult): HTMLElement | null {
  if (measures.length === 0) return null;
  const words = [
    level === null ? "Without intervals." : `In brackets the ${number(100 * level, 0)} % interval.`,
    ...(norm_sources.length === 0 ? [] : [`Norm: ${norm_sources.join("; ")}.`]),
    ...(treadmill ? ["On a treadmill: lengths and speed are those on its belt."] : []),
  ];
  const columns: Column<Row>[] = [
    ...(measures.some((r) => r.region !== "") ? [text<Row>("Region", (r) => r.region)] : []),
    text("Measure", (r) => r.title),
    text("Unit", (r) => r.unit),
    cell("Left", 0),
    cell("Right", 1),
    cell("Both", 2),
    ...(measures.some((r) => r.norm !== "") ? [text<Row>("Norm", (r) => r.norm)] : []),
  ];
  return section("measures", "Time and distance", words.join(" "), whole("Time and distance", columns, measures));
}

const definition =
  "Movement Analysis Profile: root mean square over the cycle of the mean curve less the norm’s mean, deg; the Gait Profile Score is the root mean square of nine of a side, of fifteen of both (Baker et al. 2009, Gait & Posture 30:265–269). No interval is given.";

function deviationSection({ deviation: { scores, side_deg, both_deg, lacking } }: GaitResult): HTMLElement | null {
  if (scores.length === 0) return null;
  const sides = side_deg.every((v) => v === null) ? [] : [{ title: "Gait Profile Score", value_deg: side_deg }];
  const columns: Column<Score>[] = [text("Variable", (r) => r.title), numeric("Left", "deg", 1, (r) => r.value_deg[0]), numeric("Right", "deg", 1, (r) => r.value_deg[1])];
  const both = both_deg === null ? `No Gait Profile Score of both sides: without curve or norm at every point are ${lacking.join(", ")}.` : `Gait Profile Score of both sides: ${number(both_deg, 1)} deg.`;
  return section("deviation", "Deviation from the norm", definition, whole("Movement Analysis Profile", columns, [...scores, ...sides]), el("p", {}, both));
}

function eventsSection({ events }: GaitResult): HTMLElement | null {
  if (events.length === 0) return null;
  const columns: Column<Event>[] = [text("Foot", (r) => r.foot), text("Event", (r) => r.event), numeric("Time", "s", 3, (r) => r.time_s), numeric("SD", "s", 3, (r) => r.sd_s), text("By", (r) => r.by)];
  return section("events", "Events", "", whole("Events", columns, events));
}

/** Every one, as a reader on paper cannot unfold them; after what is read first. */
function remarksSection({ groups }: GaitPage["summary"]): HTMLElement | null {
  const remarks = groups.filter((g) => g.level === "note").flatMap((g) => g.items);
  return remarks.length === 0 ? null : section("remarks", "To be known", "", el("ul", {}, ...remarks.map((r) => el("li", {}, r.text))));
}

function readingSection({ figures, own_error, curve_norm }: GaitResult): HTMLElement | null {
  if (figures.length === 0) return null;
  const sentences = [
    "0 % is a foot’s strike, 100 % its next one; each curve is of the cycles of its own side.",
    "The band about a mean is one standard deviation between cycles: how the person varies.",
    own_error
      ? "Dotted lines hold 95 % of the error of one curve by its measurement alone, from the noise of markers as their samples show it: a recording that was filtered shows less than it had, and skin that moves and markers put elsewhere are not in it. Where the lines would be no wider than the line of the mean, their width stands at the panel instead."
      : "How exact the angles are is not known: their file holds no standard deviations.",
    ...(curve_norm === "" ? [] : [`Norm: ${curve_norm}. Outside of it somewhere is not yet outside of what is usual: a band for each point by itself is left by most curves at some point.`]),
  ];
  return section("reading", "How to read it", "", el("ul", {}, ...sentences.map((s) => el("li", {}, s))));
}

/** A walk as clinicians read it: what must be known, curves over the cycle, measures of both feet, scores, events. */
export function gaitPage({ summary, result }: GaitPage): Content {
  const { feet, figures, measures, deviation, events } = result;
  const beyond = measures.filter((r) => r.judgement.some(outside)).length;
  const judged = measures.filter((r) => r.norm !== "").length;
  const sections = [
    resultFindings({ ...summary, groups: summary.groups.filter((g) => g.level === "attention") }, "No bound was missed."),
    figures.length === 0 ? null : section("figures", "Over the gait cycle", "", el("div", { class: "study-figures one-column" }, ...figures.map(drawnFigure))),
    measuresSection(result),
    deviationSection(result),
    eventsSection(result),
    remarksSection(summary),
    readingSection(result),
    resultRun(summary, [["Angles", result.angles_from ?? "none"]]),
  ].filter((s) => s !== null);
  const links = [["figures", "Figures"], ["measures", "Measures"], ["deviation", "Deviation"], ["events", "Events"], ["remarks", "Remarks"], ["reading", "How to read it"]] as const;
  return {
    skip: measures.length === 0 ? ["settings", "Skip to how it was made"] : ["measures", "Skip to the measures"],
    header: resultHeader("gait", `${feet.map((f) => f.in_words).join("; ")}. Angles: ${result.angles_from ?? "none"}.`, summary, [
      [number(feet[0].cycles), feet[0].cycles === 1 ? "left cycle" : "left cycles", "from strike to strike"],
      [number(feet[1].cycles), feet[1].cycles === 1 ? "right cycle" : "right cycles", "from strike to strike"],
      [number(events.length), "events", events.every((e) => e.sd_s !== null) ? "each with its SD" : "some without an SD"],
      [number(measures.length), "measures", judged === 0 ? "no norm beside them" : `${number(beyond)} of ${number(judged)} outside the norm`],
      [deviation.both_deg === null ? "–" : `${number(deviation.both_deg, 1)} deg`, "Gait Profile Score", deviation.scores.length === 0 ? "needs a norm with means" : "of both sides"],
      [number(figures.length), plural(figures.length, "figure").replace(/^\S+ /, ""), "each to be saved as SVG or PNG"],
    ]),
    bar: linkBar([["attention", "Attention"], ...links.filter(([id]) => sections.some((s) => s.id === id)), ["settings", "Run"]]),
    sections,
    start: () => undefined,
  };
}
