// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { CleanGap, CleanMarker, CleanPage, EncodedMarker, PackedCodes, PackedCurve, StateCounts } from "../src/page_types.ts";
import { packedCodes, packedCurve } from "./packed.ts";
import { hostile } from "./simulated.ts";

const none: StateCounts = { missing: 0, measured: 0, interpolated: 0, model_filled: 0, upsampled: 0, rejected: 0 };

/**
 * A small made-up cleaned recording at 100 Hz: marker A without gaps; B filled from others in frames 100 to 159,
 * where its error bar is wide; C missing from frame 200 to 299, with a spike that was rejected in frame 50, no
 * derivatives and a residual that is not white; a fourth whose name would do harm if it were taken for markup.
 */
export function simulatedClean(frames = 400): CleanPage {
  const rate = 100;
  const names = ["A", "B", "C", hostile];
  const filled = (m: number, f: number): boolean => m === 1 && f >= 100 && f < 160;
  const open = (m: number, f: number): boolean => m === 2 && f >= 200 && f < 300;
  const spike = (m: number, f: number): boolean => m === 2 && f === 50;
  const codeBefore = (m: number, f: number): number => (filled(m, f) || open(m, f) ? 4 : 0);
  const codeAfter = (m: number, f: number): number => (spike(m, f) ? 5 : filled(m, f) ? 3 : open(m, f) ? 4 : 0);
  const series = (value: (f: number) => number): PackedCurve => packedCurve(Array.from({ length: frames }, (_, f) => value(f)));
  const codes = (value: (f: number) => number): PackedCodes => packedCodes(Array.from({ length: frames }, (_, f) => value(f)));
  const axes = (value: (f: number, axis: number) => number): [PackedCurve, PackedCurve, PackedCurve] => [series((f) => value(f, 0)), series((f) => value(f, 1)), series((f) => value(f, 2))];
  const path = (m: number, f: number, k: number): number => 100 * (m + 1) + 10 * k + 50 * Math.sin(f / 25 + k);
  const there = (m: number, f: number, v: number): number => (codeAfter(m, f) >= 4 ? NaN : v);
  const encoded = (m: number): EncodedMarker => ({
    raw_mm: axes((f, k) => (codeBefore(m, f) === 4 ? NaN : path(m, f, k) + (f % 2 === 0 ? 0.5 : -0.5))),
    position_mm: axes((f, k) => there(m, f, path(m, f, k))),
    position_sd_mm: axes((f) => there(m, f, filled(m, f) ? 12 : 0.25)),
    change_mm: axes((f) => (codeBefore(m, f) === 4 || spike(m, f) ? NaN : f % 2 === 0 ? 0.5 : -0.5)),
    velocity: m === 2 ? [null, null, null] : axes((f, k) => there(m, f, 0.2 * Math.cos(f / 25 + k))),
    velocity_sd: m === 2 ? [null, null, null] : axes((f) => there(m, f, 0.02)),
    acceleration: m === 2 ? [null, null, null] : axes((f, k) => there(m, f, -0.8 * Math.sin(f / 25 + k))),
    acceleration_sd: [null, null, null],
    before: codes((f) => codeBefore(m, f)),
    after: codes((f) => codeAfter(m, f)),
  });
  const marker = (m: number): CleanMarker => ({
    name: names[m]!,
    before: { ...none, measured: m === 1 ? frames - 60 : m === 2 ? frames - 100 : frames, missing: m === 1 ? 60 : m === 2 ? 100 : 0 },
    after: {
      ...none,
      measured: m === 1 ? frames - 60 : m === 2 ? frames - 101 : frames,
      model_filled: m === 1 ? 60 : 0,
      missing: m === 2 ? 100 : 0,
      rejected: m === 2 ? 1 : 0,
    },
    gaps_filled: m === 1 ? 1 : 0,
    gaps_open: m === 2 ? 1 : 0,
    longest_open_s: m === 2 ? 1 : 0,
    largest_fill_sd_mm: m === 1 ? 12 : null,
    method: "kalman",
    order: 3 + (m % 2),
    cutoff_hz: m === 3 ? null : 8 + m,
    noise_sd_mm: m === 3 ? null : [0.4, 0.9, 0.6][m]!,
    noise_from: "data",
    words: "A smoother whose order and cut-off have the least estimated risk.",
    criterion: "SURE, m^2",
    tried: [2, 3, 4, 5].map((order) => ({ order, cutoff_hz: 5 + order, criterion: order === 5 ? null : 1e-8 * order })),
    residual_rms_mm: 0.38,
    autocorrelation: m === 3 ? [] : m === 2 ? [0.5, 0.3, 0.2] : [0.02, -0.03, 0.01],
    autocorrelation_if_white: m === 3 ? [] : [-0.05, -0.04, -0.03],
    white: m === 3 ? null : m !== 2,
    white_p: m === 3 ? null : m === 2 ? 1e-9 : 0.4,
    white_departure: m === 3 ? null : m === 2 ? 0.31 : 0.02,
    bar_scale: [1.1, 1.2, 1.3, 1.4],
    gap_bar_scale: [1, 1, 1, 1],
    bad_variances: 0,
    upsampling_factor: 1,
    upsampling_kernel: "",
    band: "open",
    spectrum:
      m === 3
        ? { frequency_hz: [], raw_mm2_per_hz: [], residual_mm2_per_hz: [] }
        : { frequency_hz: [0.5, 1, 5, 10, 50], raw_mm2_per_hz: [10, 5, 0.1, 0.02, 0.02], residual_mm2_per_hz: [1e-9, 1e-7, 0.001, 0.01, 0.02] },
  });
  const gap = (name: string, first: number, last: number): CleanGap => ({
    marker: name,
    first_frame: first,
    last_frame: last,
    first_time_s: first / rate,
    last_time_s: last / rate,
    length_s: (last - first + 1) / rate,
    at_edge: false,
    filled: name === "B",
    method: name === "B" ? "auto" : "",
    how: name === "B" ? "auto: 70 % rigid; 30 % cubic" : "",
    weights: [],
    sd_mm: name === "B" ? 8 : null,
    max_sd_mm: name === "B" ? 12 : null,
    windows: name === "B" ? 40 : 0,
    window_s: name === "B" ? 0.6 : null,
    predictors: name === "B" ? ["A", hostile] : [],
    dropped: name === "B" ? ["C"] : [],
    why_open: name === "B" ? "" : `The gap is too long. ${hostile}`,
  });
  const markers = names.map((_, m) => marker(m));
  const sum = (side: "before" | "after"): StateCounts => {
    const out = { ...none };
    for (const m of markers) for (const state of Object.keys(out) as (keyof StateCounts)[]) out[state] += m[side][state];
    return out;
  };
  return {
    summary: {
      schema: "kinemark.clean_report",
      schema_version: 2,
      trial: `reach ${hostile}`,
      gap_method: "auto",
      filter_method: "kalman",
      verdict: "attention",
      exit_status: 0,
      frames,
      rate_hz: rate,
      first_time_s: 0,
      first_frame: 0,
      clean_s: 0.04,
      threads: 1,
      seed: 7,
      version: "0.1.0",
      command_line: "kinemark clean reach.c3d out.nwb --gaps auto --filter auto",
      before: sum("before"),
      after: sum("after"),
      findings: [
        { level: "attention", about: "gap", subject: "B", text: "1 gap of B was filled with a standard deviation above 10 mm.", time_s: 1 },
        { level: "note", about: "gap", subject: "C", text: "1 gap was left open.", time_s: 2 },
        { level: "note", about: "warning", subject: "", text: hostile, time_s: null },
      ],
      gates: [{ name: "left_open", passed: true, value: 6, bound: 10, unit: "%", sentence: "6 % left open, bound 10 %." }],
      upsampling: { looked: true, factor: 1, done: "", handled: false, sentences: ["No stream was interpolated.", hostile] },
      markers,
      gap_count: 2,
      gaps: [gap("B", 100, 159), gap("C", 200, 299)],
      defect_count: 1,
      defects: [
        {
          kind: "spike",
          marker: "C",
          other_marker: "",
          first_frame: 50,
          last_frame: 50,
          first_time_s: 0.5,
          last_time_s: 0.5,
          confidence: 0.97,
          sentence: `C leaves its path. ${hostile}`,
          done: "rejected",
          handled: true,
        },
      ],
      options: { gaps: "auto" },
      inputs: [{ role: "markers", path: "reach.c3d", bytes: 123456, hash: "00ff00ff00ff00ff", hash_kind: "XXH3-64" }],
      warnings: [hostile],
    },
    series: { frame_step: 1, points: frames, markers: names.map((_, m) => encoded(m)) },
    scene: null,
  };
}
