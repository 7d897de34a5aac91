// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { MarkersSummary, RecordedMarker } from "../page_types.ts";
import { partWithCode, stretches, type Line } from "../band.ts";
import { el, section } from "../dom.ts";
import { number, percent, seconds } from "../format.ts";
import { GapMap, type MapRow } from "../plots/gap_map.ts";
import { TimePlot } from "../plots/time_plot.ts";
import { pointAt, type Scene } from "../scene/scene.ts";
import { isThere } from "../scene/track.ts";
import { firstAbsent, stateKind, stateWords } from "../states.ts";
import { palette } from "../theme.ts";
import type { View } from "../view.ts";
import { nameCell } from "./cells.ts";
import { absent, filledIn, total } from "./clean_header.ts";
import { legend } from "./gaps.ts";
import { sortableTable } from "./table.ts";

interface Part {
  node: HTMLElement;
  start: () => void;
}

/** Markers by time: where samples come from. */
export function recordedGaps(scene: Scene, view: View): Part {
  const box = el("div", { class: "gap-map", id: "gap-map" });
  const rows = scene.names.map((name, m): MapRow => ({
    name,
    kind: stateKind,
    codes: scene.worst.subarray(m * scene.points, (m + 1) * scene.points),
    marker: m,
  }));
  const map = new GapMap(box, scene.time, view, rows);
  const thinned = scene.frameStep === 1 ? "" : " A spot that stands for several frames shows the worst of them.";
  const node = section("gaps", "Gaps", `Where each marker's samples come from. Click a marker to see its curve.${thinned}`, legend(stateKind), map.readout, box);
  return { node, start: () => map.draw() };
}

const axisNames = ["x", "y", "z"] as const;

/** x, y and z of the picked marker with the state of each sample. */
export function recordedCurves(scene: Scene, view: View): Part {
  const { names, points } = scene;
  const picker = el("select", { id: "marker-name", change: () => view.set({ marker: picker.selectedIndex }) });
  picker.append(...names.map((n) => el("option", {}, n)));
  const step = (by: number): void => view.set({ marker: (Math.max(0, view.marker) + by + names.length) % names.length });
  const readout = el("p", { class: "readout", id: "marker-readout" });
  const boxes = axisNames.map((a) => el("div", { class: "plot axis", id: `plot-${a}` }));
  const value = (m: number, axis: number, p: number): number => 1e3 * scene.markers.x[(3 * m + axis) * points + p]!;

  function read(): void {
    const time = view.pointer ?? view.focus;
    if (time === null || view.marker < 0) {
      readout.textContent = "Point at a curve to read values; click to go there; drag to zoom; double-click for the whole recording.";
      return;
    }
    const p = pointAt(scene, time);
    const state = scene.markers.states[view.marker * points + p]!;
    const words = axisNames.map((a, k) => `${a} ${number(value(view.marker, k, p), 2)}`).join(", ");
    readout.replaceChildren(
      `${seconds(scene.time[p]!)}, frame ${number(scene.firstFrame + p * scene.frameStep)}, ${stateWords[state as 0]}: `,
      el("b", {}, state >= firstAbsent ? "no value" : `${words} mm`),
    );
  }

  function start(): void {
    let hatched: [number, number][] = [];
    const made = [1, 2, 3] as const;
    const nothing: Line = Array.from(scene.time, () => null);
    const { before } = scene;
    const recorded = (m: number, axis: number): Line =>
      before === null ? nothing : Array.from(scene.time, (_, p) => (isThere(before, points, m, p) ? 1e3 * before.x[(3 * m + axis) * points + p]! : null));
    const plots = boxes.map(
      (box, k) =>
        new TimePlot(box, view, {
          label: `${axisNames[k]} of the marker over time`,
          height: 150,
          series: [
            { stroke: (dense) => (dense ? palette().dense : palette().line), width: 1.6 },
            ...made.map((code) => ({ stroke: () => palette().states[code], width: 2.6, hidden: true })),
            { stroke: () => palette().second, width: before === null ? 0 : 1.4, hidden: true, dash: [5, 4] },
          ],
          unit: () => `${axisNames[k]} (mm)`,
          hatched: () => hatched,
        }),
    );
    let drawn = -1;
    const update = (): void => {
      const m = view.marker;
      if (m !== drawn && m >= 0 && m < names.length) {
        drawn = m;
        picker.selectedIndex = m;
        const codes = scene.markers.states.subarray(m * points, (m + 1) * points);
        const half = scene.frameStep / scene.rateHz / 2;
        hatched = stretches(codes, firstAbsent).map(([from, to]) => [scene.time[from]! - half, scene.time[to - 1]! + half]);
        plots.forEach((plot, k) => {
          const line = Array.from(scene.time, (_, p) => (isThere(scene.markers, points, m, p) ? value(m, k, p) : null));
          plot.setData([scene.time, line, ...made.map((code) => (codes.includes(code) ? partWithCode(line, codes, code) : nothing)), recorded(m, k)]);
        });
      }
      read();
    };
    view.onChange(update);
    update();
  }

  const node = section(
    "marker",
    "One marker",
    "Coordinates in the laboratory. Coloured spans were made, not measured; striped ones hold no value.",
    el(
      "div",
      { class: "controls" },
      el("label", { for: "marker-name" }, "Marker"),
      el("button", { type: "button", "aria-label": "Marker before", click: () => step(-1) }, "‹"),
      picker,
      el("button", { type: "button", "aria-label": "Next marker", click: () => step(1) }, "›"),
    ),
    el(
      "p",
      { class: "keys" },
      el("span", { class: "key" }, "measured"),
      ...[1, 2, 3].flatMap((code) => (scene.markers.states.includes(code) ? [el("span", { class: `key made-${code}` }, stateWords[code as 1])] : [])),
      ...(scene.before === null ? [] : [el("span", { class: "key recorded" }, "as recorded, before the edits")]),
    ),
    readout,
    ...boxes,
  );
  return { node, start: names.length === 0 ? () => undefined : start };
}

/** All markers in numbers; a click picks one. */
export function recordedTable(summary: MarkersSummary, view: View): HTMLElement {
  const { markers } = summary;
  const indexOf = new Map(markers.map((m, i) => [m, i]));
  const share = (m: RecordedMarker, n: number): number | null => (total(m.states) === 0 ? null : n / total(m.states));
  const cell = (m: RecordedMarker, n: number): string => percent(share(m, n)).replace(" %", "");
  const made = (m: RecordedMarker): number => filledIn(m.states) + m.states.upsampled;
  const { node, mark } = sortableTable<RecordedMarker>(
    "Samples per marker",
    [
      { title: "Marker", key: (m) => m.name, cell: (m) => nameCell(m.name) },
      { title: "Measured", unit: "%", numeric: true, key: (m) => share(m, m.states.measured), cell: (m) => cell(m, m.states.measured) },
      { title: "Filled", unit: "%", numeric: true, key: (m) => share(m, made(m)), cell: (m) => cell(m, made(m)) },
      { title: "Missing", unit: "%", numeric: true, key: (m) => share(m, absent(m.states)), cell: (m) => cell(m, absent(m.states)) },
      { title: "Gaps", numeric: true, key: (m) => m.gaps, cell: (m) => number(m.gaps) },
      { title: "Longest", unit: "s", numeric: true, key: (m) => m.longest_gap_s, cell: (m) => number(m.longest_gap_s, 3) },
      { title: "From", unit: "s", numeric: true, key: (m) => m.longest_gap_time_s, cell: (m) => number(m.longest_gap_time_s, 3) },
    ],
    markers,
    { column: 0, direction: "ascending" },
    (m) => view.set({ marker: indexOf.get(m)! }),
  );
  const show = (): void => mark((m) => indexOf.get(m) === view.marker);
  view.onChange(show);
  show();
  return section("markers", "Markers", "", node);
}

/** What else the file holds: channels, force plates, events. */
export function recordedRest(summary: MarkersSummary, scene: Scene, view: View): HTMLElement {
  type Channel = MarkersSummary["channels"][number];
  type Moment = MarkersSummary["events"][number];
  const { channels, events } = summary;
  const more = (all: number, shown: number, what: string): HTMLElement | null =>
    all > shown ? el("p", { class: "lead" }, `The first ${number(shown)} of ${number(all)} ${what}.`) : null;
  const channelTable = sortableTable<Channel>(
    "Channels",
    [
      { title: "Channel", key: (c) => c.name, cell: (c) => c.name },
      { title: "Kind", key: (c) => c.kind, cell: (c) => c.kind },
      { title: "Unit", key: (c) => c.unit, cell: (c) => (c.unit === "" ? "–" : c.unit) },
      { title: "Rate", unit: "Hz", numeric: true, key: (c) => c.rate_hz, cell: (c) => number(c.rate_hz, Number.isInteger(c.rate_hz) ? 0 : 2) },
    ],
    channels,
    { column: 1, direction: "ascending" },
  );
  const eventTable = sortableTable<Moment>(
    "Events",
    [
      { title: "Time", unit: "s", key: (e) => e.time_s, cell: (e) => el("button", { type: "button", class: "jump plain" }, number(e.time_s, 3)) },
      { title: "Event", key: (e) => e.label, cell: (e) => e.label },
      { title: "Side", key: (e) => e.context, cell: (e) => e.context },
    ],
    events,
    { column: 0, direction: "ascending" },
    (e) => view.jumpTo(e.time_s, "space"),
  );
  return section(
    "rest",
    "Channels, plates and events",
    scene.plates.length === 0 ? "The file describes no force plate." : `${number(scene.plates.length)} force ${scene.plates.length === 1 ? "plate" : "plates"}; ${scene.forces.length === 0 ? "their forces are not known" : "their forces are the arrows in space"}.`,
    el(
      "div",
      { class: "columns" },
      channels.length === 0 ? el("p", { class: "facts" }, "No channels besides the markers.") : el("details", channels.length <= 12 ? { open: true } : {}, el("summary", {}, `${number(summary.channel_count)} channels`), channelTable.node),
      events.length === 0 ? el("p", { class: "facts" }, "No events.") : el("div", {}, eventTable.node, more(summary.event_count, events.length, "events")),
    ),
    more(summary.channel_count, channels.length, "channels"),
  );
}
