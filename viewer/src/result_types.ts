// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { Clock } from "./scene/scene.ts";
import type { PackedScene } from "./scene/types.ts";
import type { Finding, InputFile } from "./types.ts";

/** Findings of one kind, folded into a line. */
export interface FindingGroup {
  level: "attention" | "note";
  title: string;
  items: Finding[];
}

/** `kinemark.result_report`; src/kinemark/stages/report/README.md describes each field. */
export interface ResultSummary {
  schema: string;
  schema_version: number;
  kind: "joints" | "scale" | "calibrate" | "reconstruct" | "study" | "measures";
  trial: string;
  verdict: "good" | "attention";
  version: string;
  command_line: string;
  groups: FindingGroup[];
  inputs: InputFile[];
  clock: Clock | null;
}

export interface ResultPageData<Result = unknown> {
  summary: ResultSummary;
  /** The document that the command writes. */
  result: Result;
  scene: PackedScene | null;
}

type Known = number | null;
type Three = [Known, Known, Known];

export interface JointsResult {
  frames: number;
  rate_hz: number;
  noise_sd_m: Known;
  method: string;
  next_step?: string;
  segments: { name: string; kind: string; markers: { name: string; x_in_segment_m: Three }[] }[];
  joints: Joint[];
  lengths: { name: string; length_m: Known; sd_m: Known }[];
  marker_noise?: { name: string; sd_m: number }[];
}

export interface Joint {
  name: string;
  kind: string;
  parent: string;
  child: string;
  method: string;
  words: string;
  range_of_motion_deg: Known;
  centre_in_parent_m: Three | null;
  covariance_in_parent_m2: [Three, Three, Three] | null;
  axis_in_parent?: Three;
  axis_sd_deg?: Known;
  centre_sd_m: Known;
  centre_sd_across_axis_m?: Known;
  frames: Record<"determined" | "bridged" | "ambiguous" | "undetermined", number>;
}

export interface ScaleResult {
  model: string;
  mass_kg: number;
  factors: Record<string, [number, number, number]>;
  muscles: { name: string; ratio: number; before_m: number; after_m: number }[];
  measurements?: { name: string; factor: number; pairs: { markers: [string, string]; measured_m: number; measured_sd_m: Known; model_m: number }[] }[];
  placed?: { rms_m: number; not_in_static_trial: string[]; markers: { name: string; body: string; before_in_body_m: [number, number, number]; after_in_body_m: [number, number, number]; error_m: Known; fixed: boolean }[] };
  static?: Adapted;
  motion?: Adapted;
}

export interface Adapted {
  frames: number;
  iterations: number;
  converged: boolean;
  rms_before_m: number;
  rms_after_m: number;
  noise_sd_m: number;
  soft_tissue_sd_m: number | null;
  lengths: { name: string; initial_m: number; length_m: number; sd_m: Known; determined: boolean }[];
  parameters: { name: string; kind: "size" | "joint place" | "marker place"; initial: number; value: number; sd: Known; prior_sd: number; determined: boolean }[];
  not_determined: string[];
}

export interface CalibrateResult {
  method: string;
  chi2_per_dof?: number;
  warp_degree?: number;
  poses?: number;
  sightings?: number;
  outliers?: number;
  side_rms_mm?: number;
  alignment?: {
    aligned: boolean;
    next: string;
    cameras: { camera: string; right_down_forward_mm: Three; right_down_forward_sd_mm: Three; tilt_pan_roll_deg: Three; tilt_pan_roll_sd_deg: Three }[];
  };
  cameras: { name: string; centre_mm: Three; centre_sd_mm: Three | null; rotation_sd_deg: Three | null }[];
}

export interface ReconstructResult {
  method: string;
  frames: number;
  leds: { name: string; frames: number; located: number; occluded: number; saturated: number; inconsistent: number; near_edge: number; chi2_per_dof?: Known; cutoff_hz?: Known; rejected?: number }[];
  precision: (import("./plots/heat_map.ts").Cells | null)[];
}

/** Measures of paths, as `measure -o OUT.json` has them, and their figures. */
export interface MeasuresResult {
  /** What the page is of, and what its rows are of. */
  heading: string;
  rows: string;
  markers: number;
  regions: number;
  level: number;
  refits: number;
  most_not_measured: number;
  measures: {
    measure: string;
    subject: string;
    region?: string;
    title: string;
    /** Value, interval and unit in words. */
    shown: string;
    value: Known;
    unit: string;
    interval: { kind: string; low: Known; high: Known; level: number; approximate: boolean };
    share_not_measured: Known;
    method: string;
    remark?: string;
  }[];
  figures: { name: string; caption: string; body: string }[];
}

export interface StudyResult {
  title: string;
  description: string;
  classic: string;
  columns: string;
  seeds: number[];
  rows: { quantity: string; unit: string; paper: Known; classic: Known; ours: Known; expected: Known; expected_is: string | null; bound: Known | [Known, Known]; pass: boolean | null }[];
  figures: { caption: string; body: string }[];
}
