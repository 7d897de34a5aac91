// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { EncodedCodes, EncodedCurve } from "./curves.ts";
import type { EncodedCycles } from "./cycles.ts";
import type { PackedScene } from "./scene/types.ts";

/** What Q_report.json holds; src/kinemark/stages/report/README.md describes each field. Unknown numbers are null. */
export interface Summary {
  schema: string;
  schema_version: number;
  trial: string;
  model: string;
  method: string;
  verdict: "good" | "attention";
  exit_status: number;
  frames: number;
  rate_hz: number;
  first_time_s: number;
  /** Number of frame 0 as the recording's file counts; reports of earlier versions do not have it. */
  first_frame?: number;
  solve_s: number | null;
  frames_per_s: number | null;
  threads: number;
  seed: number;
  version: string;
  command_line: string;
  rms_error_mm: number | null;
  max_error_mm: number | null;
  determined_fraction: number | null;
  status_frames: Record<FrameStatus, number>;
  rejected_samples: number;
  rejected_fraction: number | null;
  rejected: RejectedStretch[];
  /** Labels exchanged back; `frames` as in edits, "1-127/3". Not there in older pages. */
  exchanged?: { marker: string; other: string; frames: string; count: number; apart_mm: number | null }[];
  findings: Finding[];
  gates: Gate[];
  coordinates: CoordinateSummary[];
  markers: MarkerSummary[];
  worst_frames: WorstFrame[];
  /** Of the model; not there in older pages. */
  mass_kg?: number | null;
  options: Record<string, string>;
  inputs: InputFile[];
  warnings: string[];
}

export type FrameStatus = "converged" | "not_converged" | "underdetermined" | "no_markers";

export interface Finding {
  level: "attention" | "note";
  about: string;
  subject: string;
  text: string;
  time_s: number | null;
}

/** Samples of a marker that were left out; frames of the motion, both ends included. */
export interface RejectedStretch {
  marker: string;
  first_frame: number;
  last_frame: number;
  first_time_s: number | null;
  last_time_s: number | null;
  distance_mm: number | null;
  why: string;
}

export interface Gate {
  name: string;
  passed: boolean;
  value: number | null;
  bound: number | null;
  unit: string;
  sentence: string;
}

export interface CoordinateSummary {
  name: string;
  unit: "deg" | "m";
  locked: boolean;
  determined_frames: number;
  /** In which no visible marker fixes it; null: not known. Not there in older pages. */
  open_frames?: number | null;
  min: number | null;
  max: number | null;
  median_sd: number | null;
  /** Of the model, in the unit of the coordinate; null, or not there in older pages: none. */
  limits?: [number, number] | null;
  at_limit_frames?: number;
}

export interface MarkerSummary {
  name: string;
  used: boolean;
  why_excluded: string;
  weight: number | null;
  seen_frames: number;
  rejected_frames: number;
  rms_error_mm: number | null;
  max_error_mm: number | null;
  max_error_time_s: number | null;
  noise_sd_mm: number | null;
}

export interface WorstFrame {
  frame: number;
  time_s: number;
  rms_error_mm: number;
  markers_seen: number;
  worst_marker: string;
  worst_marker_error_mm: number;
  status: FrameStatus;
}

export interface InputFile {
  role: string;
  path: string;
  bytes: number;
  hash: string;
  hash_kind: string;
}

/** Plotted curves, packed. */
export interface EncodedSeries {
  frame_step: number;
  points: number;
  coordinates: { value: EncodedCurve; sd: EncodedCurve | null; undetermined: EncodedCodes | null }[];
  /** One per coordinate; empty, or not there in older pages, where torques were not computed. */
  torques?: ({ value: EncodedCurve; sd: EncodedCurve | null } | null)[];
  rms_error_mm: EncodedCurve;
  marker_error_mm: EncodedCurve[];
  gaps: (EncodedCodes | null)[];
  status: EncodedCodes;
}

export interface PageData {
  summary: Summary;
  series: EncodedSeries;
  /** Coordinates over the cycles that the recording's events mark; null, or not there in older pages: none. */
  cycles?: EncodedCycles | null;
  /** null, or not there in older pages: positions are not known. */
  scene?: PackedScene | null;
}
