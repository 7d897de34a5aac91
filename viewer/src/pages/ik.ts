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
  const others = { legend: "on the model; the tie is the error", switch: "Model" };
  const inSpace = scene === null ? [] : [space(scene, view, { trial: summary.trial, others })];
  const forces = scene !== null && scene.forces.length > 0 ? [ground(scene, view)] : [];
  const plots = [angles(trial, view), ...inSpace, compare(trial, view, null, data.cycles ?? null), ...forces, markers(trial, view), gaps(trial, view)];
  const jump = (finding: Finding, time: number): void => {
    const coordinate = summary.coordinates.findIndex((c) => c.name === finding.subject);
    if (finding.about === "coordinate" && coordinate >= 0) view.set({ coordinate });
    view.jumpTo(time, "angles");
  };
  return {
    skip: ["angles", "Skip to the joint angles"],
    header: header(summary),
    bar: timeBar(view, [
      ["attention", "Attention"],
      ["angles", "Joint angles"],
      ...(scene === null ? [] : [["space", "Space"] as const]),
      ["compare", "Side by side"],
      ["markers", "Markers"],
      ["gaps", "Gaps"],
      ["worst", "Worst frames"],
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
      worstFrames(summary, view),
      settings(summary, [["Method", summary.method]], summary.solve_s),
    ],
    start: () => plots[0]!.start(),
    later: plots.slice(1).map((p) => p.start),
  };
}
