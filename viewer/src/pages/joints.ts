// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { Joint, JointsResult, JointsPage } from "../page_types.ts";
import { el, section } from "../dom.ts";
import { number, percent, plural } from "../format.ts";
import { forest, type Estimate } from "../plots/forest.ts";
import { svgFigure } from "../plots/svg_figure.ts";
import { eigen } from "../scene/plane.ts";
import { unpackScene } from "../scene/scene.ts";
import { median, numeric, resultFindings, resultHeader, resultRun, table, text, withSd } from "../sections/result_parts.ts";
import { space } from "../sections/space.ts";
import { timeBar } from "../sections/time_bar.ts";
import { View, wholeOf } from "../view.ts";
import type { Content } from "./content.ts";

/** A marker in the axes of its segment, m; its noise in mm. */
interface Placed {
  segment: string;
  name: string;
  x: readonly (number | null)[];
  noise: number | null;
}

type Three = [number, number, number];
const placedIn = (j: Joint): number => j.frames.determined + j.frames.bridged + j.frames.ambiguous;
/** Of a hinge's centre only what lies across its axis is known. */
const sdOf = (j: Joint): number | null => j.centre_sd_across_axis_m ?? j.centre_sd_m;

/** Standard deviations of a centre in its parent, mm: along the direction known best, and worst. */
export function principalSds(joint: Joint): Three | null {
  const c = joint.covariance_in_parent_m2;
  if (c === null || c.flat().some((v) => v === null)) return null;
  return eigen(c as [Three, Three, Three]).values.map((v) => 1e3 * Math.sqrt(Math.max(0, v))) as Three;
}

/** Centres and axes of joints, each with how well it is known. */
export async function jointsPage({ summary, result, scene: packed }: JointsPage): Promise<Content> {
  if (packed === null || summary.clock === null) throw new Error("a page of joints needs the recording");
  const scene = await unpackScene(packed, summary.clock);
  const view = new View(wholeOf(summary.clock));
  view.focus = summary.clock.first_time_s;
  const inSpace = space(scene, view, { trial: summary.trial, others: null });
  const { joints, lengths, segments } = result;
  const hinges = joints.filter((j) => j.kind === "hinge").length;
  const placed = joints.reduce((sum, j) => sum + placedIn(j), 0);
  const possible = joints.length * result.frames;
  const spread = joints.flatMap((j): Estimate[] => {
    const sds = principalSds(j);
    return sds === null ? [] : [{ name: j.name, value: sds[1], low: sds[2], high: sds[0] }];
  });
  return {
    skip: ["joints", "Skip to the joints"],
    header: resultHeader("joint centres and axes", `Method ${result.method}`, summary, [
      [number(joints.length), joints.length === 1 ? "joint" : "joints", `${plural(hinges, "hinge")}, ${plural(joints.length - hinges, "ball joint")}`],
      [`${number(scaledMedian(joints.map(sdOf)), 1)} mm`, "median SD of a centre", "of hinges across the axis"],
      [percent(possible === 0 ? null : placed / possible), "placed", `of ${plural(result.frames, "frame")}`],
      [number(segments.length), segments.length === 1 ? "segment" : "segments", `${plural(segments.reduce((n, s) => n + s.markers.length, 0), "marker")}`],
      [`${number(scaledMedian(lengths.map((l) => l.sd_m)), 1)} mm`, "median SD of a length", plural(lengths.length, "length")],
      [`${number(result.noise_sd_m === null ? null : 1e3 * result.noise_sd_m, 2)} mm`, "marker noise", "SD per axis"],
    ]),
    bar: timeBar(view, [["attention", "Attention"], ["space", "Space"], ["joints", "Joints"], ["lengths", "Lengths"], ["segments", "Segments"], ["settings", "Run"]]),
    sections: [
      resultFindings(summary, "Nothing. Every joint is a body's, and every one is placed in every frame.", (_finding, time) => view.jumpTo(time, "space")),
      inSpace.node,
      section(
        "joints",
        "Joints",
        "The interval reaches from the direction that is known best to the one known worst; the dot is the third. Standard deviations of the centre in its parent segment.",
        ...(spread.length === 0 ? [] : [svgFigure("How well each centre is known", forest(spread, { label: "Standard deviations of each joint centre along its principal directions", axis: "SD of the centre along its principal directions (mm)", fromZero: true }))]),
        table<Joint>(
          "Joint centres",
          [
            text("Joint", (j) => j.name),
            text("Kind", (j) => j.kind),
            text("Between", (j) => `${j.parent} and ${j.child}`),
            numeric("SD", "mm", 1, (j) => (sdOf(j) === null ? null : 1e3 * sdOf(j)!)),
            numeric("Axis SD", "deg", 2, (j) => j.axis_sd_deg),
            numeric("Range of motion", "deg", 0, (j) => j.range_of_motion_deg),
            numeric("Placed", "frames", 0, placedIn),
            numeric("of these ambiguous", "", 0, (j) => j.frames.ambiguous),
          ],
          joints,
        ),
        table<Joint>("What the motion shows of each joint", [text("Joint", (j) => j.name), { ...text<Joint>("In words", (j) => j.words), cell: (j) => el("span", { class: "wide" }, j.words) }], joints),
        table<Joint>(
          "Where they lie in the parent segment",
          [text("Joint", (j) => j.name), text("Parent", (j) => j.parent), ...[0, 1, 2].map((k) => withSd<Joint>("xyz"[k]!, "mm", 1, (j) => mm(j.centre_in_parent_m?.[k]), (j) => rootMm(j.covariance_in_parent_m2?.[k]?.[k]))), text("Axis", (j) => (j.axis_in_parent ?? []).map((v) => number(v, 3)).join(", ") || "–")],
          joints,
        ),
      ),
      section(
        "lengths",
        "Lengths",
        lengths.length === 0 ? "No segment has two joints." : "Distances between joints of one segment; the interval is ±1.96 SD, which holds the true length in about 95 % of cases.",
        ...(lengths.length === 0 ? [] : [svgFigure("Lengths", forest(lengths.map((l) => around(l.name, mm(l.length_m), mm(l.sd_m))), { label: "Lengths of segments with their intervals", axis: "length (mm)", fromZero: true }))]),
        table<JointsResult["lengths"][number]>("Lengths of segments", [text("Length", (l) => l.name), numeric("Length", "mm", 1, (l) => mm(l.length_m)), numeric("SD", "mm", 1, (l) => mm(l.sd_m))], lengths),
      ),
      section(
        "segments",
        "Segments",
        "Markers that move together, and where they lie in the segment's own axes.",
        table<Placed>(
          "Markers of segments",
          [text("Marker", (m) => m.name), text("Segment", (m) => m.segment), ...[0, 1, 2].map((k) => numeric<Placed>("xyz"[k]!, "mm", 1, (m) => mm(m.x[k]))), numeric("Noise SD", "mm", 2, (m) => m.noise)],
          segments.flatMap((s) => s.markers.map((m): Placed => ({ segment: s.name, name: m.name, x: m.x_in_segment_m, noise: mm(result.marker_noise?.find((n) => n.name === m.name)?.sd_m) }))),
        ),
      ),
      resultRun(summary, [["Method", result.method], ...(result.next_step === undefined ? [] : [["Next step", result.next_step] as [string, string]])]),
    ],
    start: () => inSpace.start(),
  };
}

const mm = (v: number | null | undefined): number | null => (v === null || v === undefined ? null : 1e3 * v);
const rootMm = (v: number | null | undefined): number | null => (v === null || v === undefined ? null : 1e3 * Math.sqrt(Math.max(0, v)));
const scaledMedian = (values: readonly (number | null | undefined)[]): number | null => mm(median(values));

/** 1.96 standard deviations to each side. */
export const around = (name: string, value: number | null, sd: number | null): Estimate => ({
  name,
  value,
  low: value === null || sd === null ? null : value - 1.96 * sd,
  high: value === null || sd === null ? null : value + 1.96 * sd,
});
