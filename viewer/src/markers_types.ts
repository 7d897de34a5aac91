// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { StateCounts } from "./clean_types.ts";
import type { CycleSpans } from "./cycles.ts";
import type { Editing } from "./editing/types.ts";
import type { PackedScene } from "./scene/types.ts";
import type { Finding, InputFile } from "./types.ts";

/** `kinemark.markers_report`; src/kinemark/stages/report/README.md describes each field. */
export interface MarkersSummary {
  schema: string;
  schema_version: number;
  trial: string;
  format: string;
  units: string;
  software: string;
  verdict: "good" | "attention";
  frames: number;
  rate_hz: number;
  rate_known: boolean;
  first_time_s: number;
  first_frame: number;
  version: string;
  command_line: string;
  groups: { level: "attention" | "note"; title: string; items: Finding[] }[];
  markers: RecordedMarker[];
  channel_count: number;
  channels: { name: string; kind: string; unit: string; rate_hz: number }[];
  event_count: number;
  events: { label: string; context: string; time_s: number }[];
  /** Strike and next strike of each cycle, s; null: no foot strikes twice. */
  cycles?: CycleSpans | null;
  inputs: InputFile[];
}

export interface RecordedMarker {
  name: string;
  labelled: boolean;
  states: StateCounts;
  gaps: number;
  longest_gap_s: number | null;
  longest_gap_time_s: number | null;
}

export interface MarkersPageData {
  summary: MarkersSummary;
  scene: PackedScene;
  /** Of a page of `kinemark serve` alone. */
  editing?: Editing;
}
