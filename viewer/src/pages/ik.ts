// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { Finding, IkPage } from "../page_types.ts";
import { decode } from "../decode.ts";
import { unpackScene } from "../scene/scene.ts";
import { angles } from "../sections/angles.ts";
import { compare } from "../sections/compare.ts";
import { ground } from "../sections/ground.ts";
import { findingGroups, groupFindings } from "../sections/finding_groups.ts";
import { gaps } from "../sections/gaps.ts";
import { header } from "../sections/header.ts";
import { markers } from "../sections/markers.ts";
import { sensors } from "../sections/sensors.ts";
import { space } from "../sections/space.ts";
import { settings } from "../sections/settings.ts";
import { timeBar } from "../sections/time_bar.ts";
import { worstFrames } from "../sections/worst_frames.ts";
import { wholeOf, View } from "../view.ts";
import type { Content } from "./content.ts";

/** A solved trial: joint angles with their error bars, marker errors, gaps, worst frames. */
export async function ikPage(data: IkPage): Promise<Content> {
  const trial = decode(data);
  const { summary } = trial;
  const view = new View(wholeOf(summary));
  const scene = data.scene ? await unpackScene(data.scene, summary) : null;
  const alone = trial.sensors !== null && summary.markers.length === 0;
  const others = { legend: "on the model; the tie is the error", switch: "Model" };
  const lead = "The model as the sensors turn it, each sensor in the middle of its body. Where the body stands is not known: positions stay at their defaults.";
  const inSpace = scene === null ? [] : [space(scene, view, alone ? { trial: summary.trial, others: null, lead } : { trial: summary.trial, others })];
  const forces = scene !== null && scene.forces.length > 0 ? [ground(scene, view)] : [];
  const rows = trial.sensors?.facts.rows ?? [];
  // Without markers the points in space are the sensors.
  const pick = (sensor: number): void => {
    if (alone && scene !== null) view.set({ marker: scene.names.indexOf(rows[sensor]?.name ?? "") });
  };
  const misses = trial.sensors === null ? [] : [sensors(trial, trial.sensors, view, pick)];
  if (alone && scene !== null) {
    let picked = view.marker;
    view.onChange(() => {
      if (view.marker === picked) return;
      picked = view.marker;
      view.set({ sensor: rows.findIndex((r) => r.name === scene.names[picked]) });
    });
  }
  const plots = [angles(trial, view), ...inSpace, compare(trial, view, null, data.cycles ?? null), ...forces, ...(alone ? [] : [markers(trial, view)]), ...misses, gaps(trial, view)];
  const jump = (finding: Finding, time: number): void => {
    const coordinate = summary.coordinates.findIndex((c) => c.name === finding.subject);
    if (finding.about === "coordinate" && coordinate >= 0) view.set({ coordinate });
    view.jumpTo(time, "angles");
  };
  return {
    skip: ["angles", "Skip to the joint angles"],
    header: header(summary, trial.sensors?.facts ?? null),
    bar: timeBar(view, [
      ["attention", "Attention"],
      ["angles", "Joint angles"],
      ...(scene === null ? [] : [["space", "Space"] as const]),
      ["compare", "Side by side"],
      ...(alone ? [] : [["markers", "Markers"] as const]),
      ...(trial.sensors === null ? [] : [["sensors", "Sensors"] as const]),
      ["gaps", "Gaps"],
      ...(alone ? [] : [["worst", "Worst frames"] as const]),
      ["settings", "Settings"],
    ]),
    sections: [
      findingGroups(
        groupFindings(summary.findings),
        { title: "What needs your attention", nothing: "Nothing. Every frame converged, every coordinate is determined in every frame, and there are no warnings." },
        jump,
        summary.gates,
      ),
      ...plots.map((p) => p.node),
      ...(alone ? [] : [worstFrames(summary, view)]),
      settings(summary, [["Method", summary.method]], summary.solve_s),
    ],
    start: () => plots[0]!.start(),
    later: plots.slice(1).map((p) => p.start),
  };
}
