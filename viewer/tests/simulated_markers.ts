// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { MarkersPage, PackedScene, PackedSeries } from "../src/page_types.ts";
import { deflated } from "./packed.ts";
import { hostile } from "./simulated.ts";

/** Series as the program packs them: 16-bit steps, each less the one before, low bytes ahead of high bytes. */
export function pack(values: readonly number[][], step = 1e-5): PackedSeries {
  const points = values[0]?.length ?? 0;
  const count = values.length * points;
  const bytes = new Uint8Array(2 * count);
  const offset = values.map((series) => Math.min(...series));
  values.forEach((series, s) => {
    let before = 0;
    series.forEach((v, i) => {
      const word = Math.round((v - offset[s]!) / step);
      const change = (word - before) & 0xffff;
      before = word;
      bytes[s * points + i] = change & 255;
      bytes[count + s * points + i] = change >> 8;
    });
  });
  return { kind: "int16", series: values.length, points, offset, step: values.map(() => step), data: deflated(bytes) };
}

export const markerNames = ["A", "B", "C", "D", "E", "F", hostile, "*8"];
/** What each marker is in frames 50 to 99: codes of states.ts. */
export const middleStates = [0, 2, 3, 1, 4, 5, 0, 0];

/** Where marker m is in frame f, m. */
export const placeOf = (m: number, f: number): [number, number, number] => [
  -0.9 + 0.26 * m + 0.1 * Math.sin(0.05 * f),
  0.35 * (m % 3) + 0.001 * f,
  0.4 + 0.15 * ((3 * m) % 7),
];

/** A made-up recording of eight markers, a force plate and its force, 200 frames at 100 Hz from 1 s on. */
export function simulatedMarkers(frames = 200): MarkersPage {
  const M = markerNames.length;
  const axes = Array.from({ length: 3 * M }, (_, s) => Array.from({ length: frames }, (_, f) => placeOf(Math.floor(s / 3), f)[s % 3]!));
  const states = new Uint8Array(M * frames);
  for (let m = 0; m < M; ++m) for (let f = 50; f < 100; ++f) states[m * frames + f] = middleStates[m]!;
  // What is absent holds the place where it was last.
  for (const m of [4, 5]) for (let k = 0; k < 3; ++k) axes[3 * m + k]!.fill(axes[3 * m + k]![49]!, 50, 100);
  const line = (value: number): number[] => Array.from({ length: frames }, () => value);
  const counts = (m: number): MarkersPage["summary"]["markers"][number]["states"] => {
    const made = { measured: frames, interpolated: 0, model_filled: 0, upsampled: 0, missing: 0, rejected: 0 };
    const names = ["measured", "upsampled", "interpolated", "model_filled", "missing", "rejected"] as const;
    made.measured -= middleStates[m] === 0 ? 0 : 50;
    if (middleStates[m] !== 0) made[names[middleStates[m]!]!] = 50;
    return made;
  };
  return {
    summary: {
      schema: "kinemark.markers_report",
      schema_version: 1,
      trial: `walk ${hostile}`,
      format: "C3D",
      units: "mm",
      software: hostile,
      verdict: "good",
      frames,
      rate_hz: 100,
      rate_known: true,
      first_time_s: 1,
      first_frame: 101,
      version: "0.1.0",
      command_line: "kinemark report walk.c3d -o walk.html",
      groups: [
        { level: "note", title: "2 markers partly missing", items: [
          { level: "note", about: "marker", subject: "E", text: `E ${hostile}: missing in 50 of 200 frames`, time_s: 1.5 },
          { level: "note", about: "marker", subject: "F", text: "F: missing in 50 of 200 frames", time_s: 1.5 },
        ] },
      ],
      markers: markerNames.map((name, m) => ({
        name,
        labelled: !name.startsWith("*"),
        states: counts(m),
        gaps: middleStates[m]! >= 4 ? 1 : 0,
        longest_gap_s: middleStates[m]! >= 4 ? 0.5 : null,
        longest_gap_time_s: middleStates[m]! >= 4 ? 1.5 : null,
      })),
      channel_count: 2,
      channels: [
        { name: "Fz1", kind: "analog", unit: "N", rate_hz: 1000 },
        { name: hostile, kind: "angle", unit: "deg", rate_hz: 100 },
      ],
      event_count: 1,
      events: [{ label: "Foot Strike", context: "Left", time_s: 1.75 }],
      cycles: null,
      inputs: [{ role: "markers", path: "walk.c3d", bytes: 1000, hash: "00ff", hash_kind: "XXH3-64" }],
    },
    scene: {
      frame_step: 1,
      points: frames,
      up: [0, 0, 1],
      up_from: "the force plates",
      names: markerNames,
      markers: { positions_m: pack(axes), states: deflated(states) },
      model_m: null,
      before: null,
      worst: null,
      plates: [{ type: 2, corners_m: [[0, 0, 0], [0.4, 0, 0], [0.4, 0.6, 0], [0, 0.6, 0]] }],
      forces: [{ name: "plate 1", force_n: pack([line(0), line(0), line(700)], 0.05), point_m: pack([line(0.2), line(0.3), line(0)]) }],
    },
  };
}

/** The same with four strikes of the left foot, whose marker A swings once a cycle, and none twice of the right. */
export function simulatedWalk(): MarkersPage {
  const data = simulatedMarkers(400);
  const strike = (context: string, time_s: number): { label: string; context: string; time_s: number } => ({ label: "Foot Strike", context, time_s });
  const period = (2 * Math.PI) / 0.05 / 100;
  const times = [0, 1, 2, 3].map((i) => 1 + i * period);
  data.summary.events = [...times.map((t) => strike("Left", t)), strike("Right", 1.7)];
  data.summary.event_count = data.summary.events.length;
  data.summary.cycles = { Left: times.slice(1).map((t, i): [number, number] => [times[i]!, t]), Right: [] };
  return data;
}

/** The used markers of simulated() in space, and a model 2 cm above them. */
export function simulatedScene(frames = 400): PackedScene {
  const place = (lift: number): number[][] =>
    Array.from({ length: 9 }, (_, s) => Array.from({ length: frames }, (_, f) => placeOf(Math.floor(s / 3), f)[s % 3]! + (s % 3 === 1 ? lift : 0)));
  const states = new Uint8Array(3 * frames);
  states.fill(4, frames + 200, frames + 260);
  return {
    frame_step: 1,
    points: frames,
    up: [0, 1, 0],
    up_from: "the model's gravity",
    names: ["A", "B", "C"],
    markers: { positions_m: pack(place(0)), states: deflated(states) },
    model_m: pack(place(0.02)),
    before: null,
    worst: null,
    plates: [],
    forces: [],
  };
}
