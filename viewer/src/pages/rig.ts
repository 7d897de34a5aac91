// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { CalibratePage, CalibrateResult, ReconstructPage, ReconstructResult } from "../page_types.ts";
import { el, section } from "../dom.ts";
import { number, percent, plural } from "../format.ts";
import { forest, type Estimate } from "../plots/forest.ts";
import { heatMap } from "../plots/heat_map.ts";
import { svgFigure } from "../plots/svg_figure.ts";
import { TimePlot } from "../plots/time_plot.ts";
import { unpackScene } from "../scene/scene.ts";
import { palette } from "../theme.ts";
import { median, numeric, resultFindings, resultHeader, resultRun, table, text, withSd } from "../sections/result_parts.ts";
import { space } from "../sections/space.ts";
import { timeBar } from "../sections/time_bar.ts";
import { View, wholeOf } from "../view.ts";
import type { Content } from "./content.ts";
import { around } from "./joints.ts";

const shifts = ["right", "down", "forward"] as const;
const turns = ["tilt", "pan", "roll"] as const;

async function inSpaceOf(data: CalibratePage | ReconstructPage, followed: string): Promise<{ view: View; part: ReturnType<typeof space> }> {
  if (data.scene === null || data.summary.clock === null) throw new Error("a page of cameras needs their places");
  const scene = await unpackScene(data.scene, data.summary.clock);
  const view = new View(wholeOf(data.summary.clock));
  view.focus = data.summary.clock.first_time_s;
  return { view, part: space(scene, view, { trial: data.summary.trial, others: null, lead: followed }) };
}

/** A calibrated rig: how well it fits, where the cameras stand, what to turn. */
export async function calibratePage(data: CalibratePage): Promise<Content> {
  const { summary, result } = data;
  const { view, part } = await inSpaceOf(data, "Cameras as calibrated, and in the second colour as they were meant to stand. Each instant is a pose of the tree.");
  const aligned = result.alignment?.cameras ?? [];
  const deviations = (names: readonly string[], value: (c: (typeof aligned)[number]) => readonly (number | null)[], sd: (c: (typeof aligned)[number]) => readonly (number | null)[]): Estimate[] =>
    aligned.flatMap((c) => names.map((name, k) => around(`${c.camera} ${name}`, value(c)[k]!, sd(c)[k] === 0 ? null : sd(c)[k]!)));
  return {
    skip: ["turn", "Skip to what to turn"],
    header: resultHeader("calibration", `Method ${result.method}`, summary, [
      [number(result.chi2_per_dof, 2), "chi² per degree of freedom", "1 where the model explains the counts"],
      [`${number(result.side_rms_mm, 2)} mm`, "RMS error of tree sides", "triangulated without the tree"],
      [number(result.poses), "poses", `${plural(result.sightings ?? 0, "sighting")}`],
      [number(result.outliers), "outliers", result.sightings ? percent((result.outliers ?? 0) / result.sightings) : "–"],
      [number(result.cameras.length), "cameras", result.warp_degree === undefined ? "" : `warp of degree ${result.warp_degree}`],
      [result.alignment === undefined ? "–" : result.alignment.aligned ? "yes" : "no", "aligned", "within tolerance of the nominal rig"],
    ]),
    bar: timeBar(view, [["attention", "Attention"], ["space", "Space"], ["turn", "What to turn"], ["cameras", "Cameras"], ["settings", "Run"]]),
    sections: [
      resultFindings(summary, "Nothing. The cameras stand where they were meant to, and the model explains the counts."),
      part.node,
      section(
        "turn",
        "What to turn",
        result.alignment === undefined ? "Nothing was compared with the nominal rig." : result.alignment.next,
        ...(aligned.length === 0
          ? []
          : [
              svgFigure("Lens against its nominal place", forest(deviations(shifts, (c) => c.right_down_forward_mm, (c) => c.right_down_forward_sd_mm), { label: "Deviation of each lens from its nominal place", axis: "deviation of the lens (mm); the interval is ±1.96 SD", reference: 0 })),
              svgFigure("Rotation still needed", forest(deviations(turns, (c) => c.tilt_pan_roll_deg, (c) => c.tilt_pan_roll_sd_deg), { label: "Rotation that each camera still needs", axis: "rotation still needed (deg); the interval is ±1.96 SD", reference: 0 })),
            ]),
        table<(typeof aligned)[number]>(
          "Cameras against their nominal poses",
          [text("Camera", (c) => c.camera), ...shifts.map((name, k) => withSd<(typeof aligned)[number]>(name, "mm", 1, (c) => c.right_down_forward_mm[k], (c) => c.right_down_forward_sd_mm[k] || null)), ...turns.map((name, k) => withSd<(typeof aligned)[number]>(name, "deg", 3, (c) => c.tilt_pan_roll_deg[k], (c) => c.tilt_pan_roll_sd_deg[k] || null))],
          aligned,
        ),
      ),
      section(
        "cameras",
        "Cameras",
        "Where the lenses stand, with one standard deviation.",
        table<CalibrateResult["cameras"][number]>(
          "Lenses in the laboratory",
          [text("Camera", (c) => c.name), ...[0, 1, 2].map((k) => withSd<CalibrateResult["cameras"][number]>("xyz"[k]!, "mm", 1, (c) => c.centre_mm[k], (c) => c.centre_sd_mm?.[k])), ...[0, 1, 2].map((k) => numeric<CalibrateResult["cameras"][number]>(`SD about ${"xyz"[k]!}`, "deg", 3, (c) => c.rotation_sd_deg?.[k]))],
          result.cameras,
        ),
      ),
      resultRun(summary, [["Method", result.method]]),
    ],
    start: () => part.start(),
  };
}

type Led = ReconstructResult["leds"][number];

/** How brightly each camera sees each LED over time; null where no light is known. */
function lightOf(result: ReconstructResult, view: View): { node: HTMLElement; start: () => void } | null {
  const curves = result.light_curves ?? [];
  if (curves.length === 0) return null;
  const boxes = curves.map((curve) => ({ curve, box: el("div", { class: "plot axis" }) }));
  const cameras = curves[0]!.cameras;
  const node = section(
    "light",
    "Light",
    "Light of each LED as each camera sees it: 1 is an LED of the calibration that faces the camera. An LED that turns away shows less.",
    el("div", { class: "controls" }, el("span", { class: "keys" }, ...cameras.map((name, c) => el("span", { class: `key axis-${c % 3}` }, name)))),
    ...boxes.map(({ curve, box }) => el("figure", {}, el("figcaption", {}, curve.led), box)),
  );
  const start = (): void => {
    for (const { curve, box } of boxes)
      new TimePlot(box, view, {
        label: `Light of ${curve.led} over time as each camera sees it`,
        height: 160,
        series: curve.cameras.map((name, c) => ({ name, stroke: () => palette().axes[(c % 3) as 0], width: 1.4 })),
        unit: () => "light",
        fromZero: true,
        hatched: () => [],
      }).setData([curve.time_s, ...curve.seen]);
  };
  return { node, start };
}

/** Points from counts: what became of each LED, and how certain a point is where. */
export async function reconstructPage(data: ReconstructPage): Promise<Content> {
  const { summary, result } = data;
  const { view, part } = await inSpaceOf(data, "Points, the cameras that saw them, and their rays.");
  const { leds } = result;
  const sum = (value: (led: Led) => number): number => leds.reduce((n, led) => n + value(led), 0);
  const frames = sum((l) => l.frames);
  const share = (n: number): string => percent(frames === 0 ? null : n / frames);
  const maps = result.precision.filter((m) => m !== null);
  const sds = maps[0]?.sd_mm ?? [];
  const light = lightOf(result, view);
  return {
    skip: ["leds", "Skip to the LEDs"],
    header: resultHeader("reconstruction", `Method ${result.method}`, summary, [
      [number(leds.length), leds.length === 1 ? "LED" : "LEDs", plural(result.frames, "frame")],
      [share(sum((l) => l.located)), "located", `${number(sum((l) => l.located))} points`],
      [`${number(median(sds), 2)} mm`, "median SD of a point", "median of the map below"],
      [share(sum((l) => l.occluded + l.saturated)), "not seen", "by two cameras"],
      [share(sum((l) => l.inconsistent)), "contradicted", "the cameras disagree"],
      [number(median(leds.map((l) => l.chi2_per_dof)), 2), "chi² per degree of freedom", "median of the LEDs"],
    ]),
    bar: timeBar(view, [["attention", "Attention"], ["space", "Space"], ["precision", "Precision"], ["leds", "LEDs"], ...(light === null ? [] : [["light", "Light"] as [string, string]]), ["settings", "Run"]]),
    sections: [
      resultFindings(summary, "Nothing. Every LED was located in nearly every frame, and the cameras agree."),
      part.node,
      section(
        "precision",
        "Precision",
        maps.length === 0 ? "The method states no covariance." : "Median standard deviation of a point (root of the sum over the axes), by where it is. Six shades hold about as many cells each; the numbers below are their edges in mm.",
        el("div", { class: "columns charts" }, ...maps.map((m) => svgFigure(m.axes[1] === 2 ? "Seen along y" : "Seen along z", heatMap(m, `Standard deviation of points over ${"xyz"[m.axes[0]]!} and ${"xyz"[m.axes[1]]!}`)))),
      ),
      section(
        "leds",
        "LEDs",
        "",
        table<Led>(
          "What became of each LED",
          [
            text("LED", (l) => l.name),
            numeric("Located", "frames", 0, (l) => l.located),
            numeric("Located", "%", 1, (l) => (l.frames === 0 ? null : (100 * l.located) / l.frames)),
            numeric("Occluded", "", 0, (l) => l.occluded),
            numeric("Saturated", "", 0, (l) => l.saturated),
            numeric("Contradicted", "", 0, (l) => l.inconsistent),
            numeric("Near the edge", "", 0, (l) => l.near_edge),
            withSd<Led>("Light", "", 4, (l) => l.light, (l) => l.light_sd),
            numeric("chi²/dof", "", 2, (l) => l.chi2_per_dof),
            numeric("Cut-off", "Hz", 1, (l) => l.cutoff_hz),
          ],
          leds,
        ),
      ),
      ...(light === null ? [] : [light.node]),
      resultRun(summary, [["Method", result.method]]),
    ],
    start: () => {
      part.start();
      light?.start();
    },
  };
}
