// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { Vec } from "../scene/vec.ts";

/** `kinemark.live`; src/kinemark/stages/report/README.md describes each field. */
export interface LiveSummary {
  schema: string;
  schema_version: number;
  trial: string;
  source: string;
  version: string;
  recording: string | null;
  rate_hz: number;
  markers: string[];
  up: Vec;
  up_from: string;
  extent_m: [Vec, Vec] | null;
  coordinates: { name: string; unit: "deg" | "mm" }[];
}

export interface LivePageData {
  summary: LiveSummary;
}
