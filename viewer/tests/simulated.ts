// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { CycleCurves, IkPage, PackedCodes, PackedCurve } from "../src/page_types.ts";
import { packedCodes, packedCurve } from "./packed.ts";

/** A text that would do harm if any part of the page took it for markup. */
export const hostile = "</script><img src=x onerror=alert(1)>&lt;b&gt;";

/** Three cycles on 101 points, the second without its middle, their mean and their spread, so much higher. */
function swings(higher: number): Pick<CycleCurves, "each" | "mean" | "sd"> {
  const swing = (p: number): number => higher + 10 * Math.sin((2 * Math.PI * p) / 100);
  const over = (value: (p: number) => number): number[] => Array.from({ length: 101 }, (_, p) => value(p));
  return { each: packedCurve([-1, 0, 1].flatMap((off) => over((p) => (off === 0 && p > 40 && p < 60 ? NaN : swing(p) + off)))), mean: packedCurve(over(swing)), sd: packedCurve(over(() => 1)) };
}

/**
 * A small made-up trial: three coordinates (one with a hidden stretch, frames 200 to 259), three used markers (B
 * missing there, C off by 40 mm in frame 100) and one left out.
 */
export function simulated(frames = 400): IkPage {
  const rate = 100;
  const hidden = (f: number): boolean => f >= 200 && f < 260;
  const series = (value: (f: number) => number): PackedCurve => packedCurve(Array.from({ length: frames }, (_, f) => value(f)));
  const codes = (value: (f: number) => number): PackedCodes => packedCodes(Array.from({ length: frames }, (_, f) => value(f)));
  const errorC = (f: number): number => (f === 100 ? 40 : 3);
  const marker = (name: string, rms: number | null, max: number | null, at: number | null) => ({
    name,
    used: name !== "Left.Out",
    why_excluded: name === "Left.Out" ? "it is at the origin in every frame." : "",
    weight: name === "Left.Out" ? 0 : 1,
    seen_frames: name === "B" ? frames - 60 : name === "Left.Out" ? 0 : frames,
    rejected_frames: 0,
    rms_error_mm: rms,
    max_error_mm: max,
    max_error_time_s: at,
    noise_sd_mm: rms === null ? null : rms / 2,
  });
  const coordinate = (name: string, unit: "deg" | "m", determined: number) => ({
    name,
    unit,
    unit_in_tables: unit,
    locked: false,
    determined_frames: determined,
    open_frames: null,
    min: -10,
    max: 10,
    median_sd: 1.5,
    limits: null,
    at_limit_frames: 0,
  });
  return {
    summary: {
      schema: "kinemark.ik_report",
      schema_version: 2,
      trial: `walk ${hostile}`,
      model: "arm",
      method: "least squares",
      verdict: "attention",
      exit_status: 1,
      frames,
      rate_hz: rate,
      first_time_s: 0,
      first_frame: 0,
      solve_s: 0.02,
      frames_per_s: frames / 0.02,
      threads: 1,
      seed: 7,
      version: "0.1.0",
      command_line: "kinemark ik --model arm.osim --markers walk.trc --output walk.mot",
      rms_error_mm: 4.2,
      max_error_mm: 40,
      determined_fraction: 1 - 60 / (3 * frames),
      status_frames: { converged: frames - 60, not_converged: 0, underdetermined: 60, no_markers: 0 },
      rejected_samples: 0,
      rejected_fraction: 0,
      rejected: [],
      exchanged: [],
      findings: [
        { level: "attention", about: "gate", subject: "marker_max", text: "A marker is 40 mm off.", time_s: 1 },
        { level: "note", about: "coordinate", subject: "wrist", text: "wrist is not determined in 60 frames.", time_s: 2 },
        { level: "note", about: "warning", subject: "", text: hostile, time_s: null },
      ],
      gates: [
        { name: "marker_max", passed: false, value: 40, bound: 30, unit: "mm", sentence: "A marker is 40 mm off." },
        { name: "marker_rms", passed: true, value: 4.2, bound: 20, unit: "mm", sentence: "RMS 4.2 mm, bound 20 mm." },
      ],
      mass_kg: null,
      coordinates: [coordinate("shoulder", "deg", frames), coordinate("wrist", "deg", frames - 60), coordinate("root_tx", "m", frames)],
      markers: [marker("A", 2, 2, 0), marker("B", 5, 5, 0), marker("C", 3.6, 40, 1), marker("Left.Out", null, null, null)],
      worst_frames: [
        { frame: 100, time_s: 1, rms_error_mm: 23.3, markers_seen: 3, worst_marker: "C", worst_marker_error_mm: 40, status: "converged" },
        { frame: 10, time_s: 0.1, rms_error_mm: 3.6, markers_seen: 3, worst_marker: "B", worst_marker_error_mm: 5, status: "converged" },
      ],
      options: { robust: "none" },
      inputs: [{ role: "markers", path: "walk.trc", bytes: 123456, hash: "00ff00ff00ff00ff", hash_kind: "XXH3-64" }],
      warnings: [hostile],
    },
    series: {
      frame_step: 1,
      points: frames,
      coordinates: [
        { value: series((f) => 10 * Math.sin(f / 30)), sd: series(() => 1.5), undetermined: null },
        { value: series((f) => (hidden(f) ? NaN : 10 * Math.cos(f / 30))), sd: series((f) => (hidden(f) ? NaN : 3)), undetermined: codes((f) => (hidden(f) ? 1 : 0)) },
        { value: series(() => 0.5), sd: null, undetermined: null },
      ],
      torques: [],
      rms_error_mm: series((f) => (f === 100 ? 23.3 : 3.6)),
      marker_error_mm: [series(() => 2), series((f) => (hidden(f) ? NaN : 5)), series(errorC)],
      gaps: [codes(() => 0), codes((f) => (hidden(f) ? 2 : 0)), codes((f) => (f === 101 ? 3 : 0)), null],
      status: codes((f) => (hidden(f) ? 1 : 0)),
    },
    cycles: {
      points: 101,
      curves: (["Right", "Left"] as const).map((side) => ({ coordinate: "shoulder", side, count: 3, whole: 2, fewest: 2, most: 3, drawn: 3, ...swings(side === "Left" ? 4 : 0) })),
    },
    scene: null,
  };
}

/** The same angles beside two inertial sensors, or from them alone: the shank has no sample in frames 200 to 259, its largest angle in frame 100. */
export function simulatedSensors(alone: boolean, frames = 400): IkPage {
  const page = simulated(frames);
  const hidden = (f: number): boolean => f >= 200 && f < 260;
  const series = (value: (f: number) => number): PackedCurve => packedCurve(Array.from({ length: frames }, (_, f) => value(f)));
  const codes = (value: (f: number) => number): PackedCodes => packedCodes(Array.from({ length: frames }, (_, f) => value(f)));
  page.sensors = {
    heading_deg: 30,
    heading_sd_deg: 0.5,
    heading_from: "motion",
    pose_drift_deg: 0.75,
    noise_sd_deg: null,
    rms_deg: 3.6,
    max_deg: 12,
    rows: [
      { name: `trunk ${hostile}`, body: "trunk", placed_by: "pose", seen_frames: frames, rejected_samples: 0, rms_deg: 3, max_deg: 3, max_time_s: 0 },
      { name: "shank_imu", body: "shank", placed_by: alone ? "pose" : "markers", seen_frames: frames - 60, rejected_samples: 1, rms_deg: 4, max_deg: 12, max_time_s: 1 },
    ],
  };
  page.series.sensor_error_deg = [series(() => 3), series((f) => (hidden(f) ? NaN : f === 100 ? 12 : 4))];
  page.series.sensor_rms_deg = series((f) => (f === 100 ? 8.7 : 3.5));
  page.series.sensor_gaps = [codes(() => 0), codes((f) => (f === 201 ? 3 : hidden(f) ? 2 : 0))];
  if (!alone) return page;
  page.summary.markers = [];
  page.summary.worst_frames = [];
  page.summary.rms_error_mm = page.summary.max_error_mm = null;
  page.series.marker_error_mm = [];
  page.series.gaps = [];
  page.series.rms_error_mm = series(() => NaN);
  return page;
}
