// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { CleanPage, Finding } from "../page_types.ts";
import { decodeClean } from "../clean_decode.ts";
import { sceneOfClean } from "../scene/of_clean.ts";
import { unpackScene } from "../scene/scene.ts";
import { cleanGaps } from "../sections/clean_gaps.ts";
import { cleanHeader } from "../sections/clean_header.ts";
import { cleanMarker } from "../sections/clean_marker.ts";
import { cleanTable } from "../sections/clean_table.ts";
import { findingGroups, groupFindings } from "../sections/finding_groups.ts";
import { recording } from "../sections/recording.ts";
import { space } from "../sections/space.ts";
import { settings } from "../sections/settings.ts";
import { timeBar } from "../sections/time_bar.ts";
import { wholeOf, View } from "../view.ts";
import type { Content } from "./content.ts";

/** A cleaned recording: what was filled and filtered, why, and how certain the result is. */
export async function cleanPage(data: CleanPage): Promise<Content> {
  const trial = decodeClean(data);
  const { summary } = trial;
  const view = new View(wholeOf(summary));
  const show = (name: string, time: number, length = 0): void => {
    const marker = summary.markers.findIndex((m) => m.name === name);
    if (marker >= 0) view.set({ marker });
    view.jumpTo(time, marker >= 0 ? "marker" : "gaps", length);
  };
  const jump = (finding: Finding, time: number): void => show(finding.subject, time);
  if (summary.markers.length > 0) view.marker = worthALook(data);
  const scene = sceneOfClean(trial) ?? (data.scene ? await unpackScene(data.scene, summary) : null);
  const others = scene === null || scene.before === null ? null : { legend: "as it came in", switch: "Before" };
  const inSpace = scene === null ? [] : [space(scene, view, { trial: summary.trial, others })];
  const plots = [cleanGaps(trial, view), cleanMarker(trial, view, show)] as const;
  const [first, ...rest] = [...inSpace, ...plots];
  const table = cleanTable(summary, view);
  return {
    skip: ["markers", "Skip to the markers"],
    header: cleanHeader(summary),
    bar: timeBar(view, [
      ["attention", "Attention"],
      ...(scene === null ? [] : [["space", "Space"] as const]),
      ["gaps", "Gaps"],
      ["markers", "Markers"],
      ["marker", "One marker"],
      ["recording", "Recording"],
      ["settings", "Settings"],
    ]),
    sections: [
      findingGroups(
        groupFindings(summary.findings),
        {
          title: "What needs your attention",
          nothing: `Nothing. No gap was left open, no fill is uncertain, and no defect was found.${summary.markers.every((m) => m.white === true) ? " Every residual is white." : ""}`,
        },
        jump,
        summary.gates,
      ),
      ...inSpace.map((s) => s.node),
      plots[0].node,
      table,
      plots[1].node,
      recording(summary, show),
      settings(summary, [["Gaps", summary.gap_method], ["Filter", summary.filter_method]], summary.clean_s),
    ],
    start: () => first!.start(),
    later: rest.map((p) => p.start),
  };
}

/** The marker to begin with: the one that the first finding names, otherwise the first. */
function worthALook({ summary }: CleanPage): number {
  for (const { subject } of summary.findings) {
    const marker = summary.markers.findIndex((m) => m.name === subject);
    if (marker >= 0) return marker;
  }
  return 0;
}
