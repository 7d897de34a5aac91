// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { MarkersPage, MarkersSummary } from "../page_types.ts";
import type { Camera } from "../scene/camera.ts";
import { unpackScene } from "../scene/scene.ts";
import { markerCycles } from "../sections/marker_cycles.ts";
import { findingGroups } from "../sections/finding_groups.ts";
import { markersHeader } from "../sections/markers_header.ts";
import { recordedCurves, recordedGaps, recordedRest, recordedTable } from "../sections/recorded.ts";
import { neuralLanes, unpackLanes } from "../sections/neural.ts";
import { plain } from "../sections/settings.ts";
import { ground } from "../sections/ground.ts";
import { space } from "../sections/space.ts";
import { timeBar } from "../sections/time_bar.ts";
import { el, section } from "../dom.ts";
import { bytes } from "../format.ts";
import { clampRange, wholeOf, View } from "../view.ts";
import type { Content } from "./content.ts";

/** What is kept when a recording that was edited is drawn anew. */
export interface Kept {
  /** Draws the same view again; null at first. */
  view: View | null;
  /** Name of the marker that was chosen. */
  marker: string | null;
  camera: Camera | null;
}

/** The bar for edits, and what a page drawn before it leaves behind. */
export interface Editor {
  node: HTMLElement;
  kept: Kept;
  show: (summary: MarkersSummary, view: View) => void;
  /** What stands below the bar. */
  further: HTMLElement[];
}

/** The view as it was, on a recording whose markers and frames may be others. */
function resume(view: View, kept: Kept, names: readonly string[]): void {
  const { view: was } = kept;
  if (was === null) return;
  const whole = was.range[0] === was.whole[0] && was.range[1] === was.whole[1];
  view.range = whole ? view.whole : clampRange(was.range, view.whole);
  view.focus = was.focus === null ? null : Math.min(view.whole[1], Math.max(view.whole[0], was.focus));
  view.stretch = was.stretch;
  const same = kept.marker === null ? -1 : names.indexOf(kept.marker);
  if (same >= 0) view.marker = same;
  else if (was.marker >= 0) view.marker = Math.min(was.marker, names.length - 1);
}

/** A recording as it is: in space, its gaps, the curves of a marker, and what else the file holds. */
export async function markersPage({ summary, scene: packed, neural, editing }: MarkersPage, editor: Editor | null = null): Promise<Content> {
  if (summary.schema_version !== 1) throw new Error(`this page cannot read ${summary.schema} version ${summary.schema_version}`);
  if (packed.names.length !== summary.markers.length) throw new Error("markers of the summary and of the space view differ");
  const scene = await unpackScene(packed, summary, (m) => summary.markers[m]!.labelled);
  const view = new View(wholeOf(summary));
  view.marker = scene.names.length === 0 ? -1 : Math.max(0, scene.isMain.indexOf(true));
  view.focus = summary.first_time_s;
  view.editable = editor !== null;
  if (editor !== null) resume(view, editor.kept, scene.names);
  const recorded = scene.before === null ? null : { legend: "as recorded, before the edits", switch: "As recorded" };
  const inSpace = space(scene, view, { trial: summary.trial, others: recorded, ...(summary.rate_known ? {} : { playHz: 60 }), ...(editor === null ? {} : { kept: editor.kept }) });
  const refused = editing !== undefined && "refused" in editing ? [section("edit", "Edit", `This recording cannot be edited here: ${editing.refused}.`)] : [];
  const bar = editor === null ? refused : [editor.node, ...editor.further];
  editor?.show(summary, view);
  const lanes = neural === undefined ? null : await unpackLanes(neural);
  const parts = [
    ...(lanes === null ? [] : [neuralLanes(lanes, neural!.unit_count, view)]),
    ...(scene.forces.length > 0 ? [ground(scene, view)] : []),
    recordedCurves(scene, view),
    ...(summary.cycles ? [markerCycles(scene, view, summary.cycles)] : []),
    recordedGaps(scene, view),
  ];
  return {
    skip: ["space", "Skip to the space view"],
    header: markersHeader(summary),
    bar: timeBar(view, [
      ["attention", "Findings"],
      ["space", "Space"],
      ...(bar.length > 0 ? ([["edit", "Edit"]] as const) : []),
      ...(editor === null ? [] : ([["solved", "Angles"]] as const)),
      ...(lanes === null ? [] : ([["neural", "Spikes"]] as const)),
      ["marker", "One marker"],
      ...(summary.cycles ? ([["cycles", "Cycles"]] as const) : []),
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
      inSpace.node,
      ...bar,
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
    start: () => inSpace.start(),
    later: parts.map((p) => p.start),
    stop: () => {
      inSpace.stop();
      if (editor !== null) Object.assign(editor.kept, { view, marker: scene.names[view.marker] ?? null });
    },
  };
}
