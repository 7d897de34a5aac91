// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { PackedScene } from "./scene/types.ts";
import type { EncodedCodes, EncodedCurve } from "./curves.ts";
import type { StateName } from "./states.ts";
import type { Finding, Gate, InputFile } from "./types.ts";

export type StateCounts = Record<StateName, number>;

/** `kinemark.clean_report`; src/kinemark/stages/report/README.md describes each field. Unknown numbers are null. */
export interface CleanSummary {
  schema: string;
  schema_version: number;
  trial: string;
  gap_method: string;
  filter_method: string;
  verdict: "good" | "attention";
  exit_status: number;
  frames: number;
  rate_hz: number;
  first_time_s: number;
  /** Number of frame 0 as the recording's file counts; reports of earlier versions do not have it. */
  first_frame?: number;
  clean_s: number | null;
  threads: number;
  seed: number;
  version: string;
  command_line: string;
  before: StateCounts;
  after: StateCounts;
  findings: Finding[];
  gates: Gate[];
  upsampling: { looked: boolean; factor: number; done: string; handled: boolean; sentences: string[] };
  markers: CleanMarker[];
  gap_count: number;
  gaps: CleanGap[];
  defect_count: number;
  defects: CleanDefect[];
  options: Record<string, string>;
  inputs: InputFile[];
  warnings: string[];
}

export interface CleanMarker {
  name: string;
  before: StateCounts;
  after: StateCounts;
  gaps_filled: number;
  gaps_open: number;
  longest_open_s: number;
  largest_fill_sd_mm: number | null;
  method: string;
  order: number;
  cutoff_hz: number | null;
  noise_sd_mm: number | null;
  noise_from: string;
  words: string;
  criterion: string;
  tried: TriedFilter[];
  residual_rms_mm: number | null;
  autocorrelation: (number | null)[];
  autocorrelation_if_white: (number | null)[];
  white: boolean | null;
  white_p: number | null;
  white_departure: number | null;
  bar_scale: (number | null)[];
  gap_bar_scale: (number | null)[];
  bad_variances: number;
  upsampling_factor: number;
  upsampling_kernel: string;
  band: string;
  spectrum: Spectrum;
}

export interface TriedFilter {
  order: number;
  cutoff_hz: number | null;
  criterion: number | null;
}

export interface Spectrum {
  frequency_hz: number[];
  raw_mm2_per_hz: (number | null)[];
  residual_mm2_per_hz: (number | null)[];
}

export interface CleanGap {
  marker: string;
  first_frame: number;
  last_frame: number;
  first_time_s: number;
  last_time_s: number;
  length_s: number;
  at_edge: boolean;
  filled: boolean;
  method: string;
  how: string;
  weights: { name: string; weight: number | null; rms_mm: number | null; guarded: boolean }[];
  sd_mm: number | null;
  max_sd_mm: number | null;
  windows: number;
  window_s: number | null;
  predictors: string[];
  dropped: string[];
  why_open: string;
}

export interface CleanDefect {
  kind: string;
  marker: string;
  other_marker: string;
  first_frame: number;
  last_frame: number;
  first_time_s: number;
  last_time_s: number;
  confidence: number | null;
  sentence: string;
  done: string;
  handled: boolean;
}

/** One curve per axis; null where the result has no such number. */
export type EncodedAxes = (EncodedCurve | null)[];

/** What came in: position and change together. */
export interface Sum {
  kind: "sum";
}

export interface EncodedMarker {
  raw_mm: (EncodedCurve | Sum | null)[];
  position_mm: EncodedAxes;
  position_sd_mm: EncodedAxes;
  change_mm: EncodedAxes;
  velocity: EncodedAxes;
  velocity_sd: EncodedAxes;
  acceleration: EncodedAxes;
  acceleration_sd: EncodedAxes;
  before: EncodedCodes;
  after: EncodedCodes;
}

export interface CleanPageData {
  summary: CleanSummary;
  series: { frame_step: number; points: number; markers: EncodedMarker[] };
  /** Of a page whose points are not frames. */
  scene?: PackedScene | null;
}
