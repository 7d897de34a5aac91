// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { MarkersPageData } from "../markers_types.ts";
import { unpackScene } from "../scene/scene.ts";
import { findingGroups } from "../sections/finding_groups.ts";
import { markersHeader } from "../sections/markers_header.ts";
import { recordedCurves, recordedGaps, recordedRest, recordedTable } from "../sections/recorded.ts";
import { plain } from "../sections/settings.ts";
import { ground } from "../sections/ground.ts";
import { space } from "../sections/space.ts";
import { timeBar } from "../sections/time_bar.ts";
import { el, section } from "../dom.ts";
import { bytes } from "../format.ts";
import { wholeOf, View } from "../view.ts";
import type { Content } from "./content.ts";

/** A recording as it is: in space, its gaps, the curves of a marker, and what else the file holds. */
export async function markersPage({ summary, scene: packed }: MarkersPageData): Promise<Content> {
  if (summary.schema_version !== 1) throw new Error(`this page cannot read ${summary.schema} version ${summary.schema_version}`);
  if (packed.names.length !== summary.markers.length) throw new Error("markers of the summary and of the space view differ");
  const scene = await unpackScene(packed, summary, (m) => summary.markers[m]!.labelled);
  const view = new View(wholeOf(summary));
  view.marker = scene.names.length === 0 ? -1 : Math.max(0, scene.isMain.indexOf(true));
  view.focus = summary.first_time_s;
  const parts = [
    space(scene, view, { trial: summary.trial, others: null, ...(summary.rate_known ? {} : { playHz: 60 }) }),
    ...(scene.forces.length > 0 ? [ground(scene, view)] : []),
    recordedCurves(scene, view),
    recordedGaps(scene, view),
  ];
  return {
    skip: ["space", "Skip to the space view"],
    header: markersHeader(summary),
    bar: timeBar(view, [
      ["attention", "Findings"],
      ["space", "Space"],
      ["marker", "One marker"],
      ["gaps", "Gaps"],
      ["markers", "Markers"],
      ["rest", "Channels"],
      ["settings", "File"],
    ]),
    sections: [
      findingGroups(summary.groups, { title: "What stands out", nothing: "Nothing. Every marker was measured in every frame." }, (finding, time) => {
        const marker = summary.markers.findIndex((m) => m.name === finding.subject);
        if (marker >= 0) view.set({ marker });
        view.jumpTo(time, "space");
      }),
      ...parts.map((p) => p.node),
      recordedTable(summary, view),
      recordedRest(summary, scene, view),
      section(
        "settings",
        "File",
        "",
        summary.command_line === "" ? null : el("pre", { tabindex: 0, "aria-label": "Command line" }, summary.command_line),
        plain("Input files", ["Role", "File", "Size", "Hash"], summary.inputs.map((i) => [i.role, i.path, bytes(i.bytes), `${i.hash_kind} ${i.hash}`])),
      ),
    ],
    start: () => parts.forEach((p) => p.start()),
  };
}
