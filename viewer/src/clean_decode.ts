// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { CleanPage, CleanSummary, EncodedAxes } from "./page_types.ts";
import { decodeBytes, decodeFloats, stepOf } from "./curves.ts";

/** x, y, z; null where the result has no such number. */
export type Axes = (Float32Array | null)[];

/** What the plots of one marker need: mm, m/s, m/s^2. */
export interface MarkerSeries {
  raw: Axes;
  position: Axes;
  positionSd: Axes;
  /** What came in less the result. */
  change: Axes;
  velocity: Axes;
  velocitySd: Axes;
  acceleration: Axes;
  accelerationSd: Axes;
  /** What the values of x, y, z are rounded to; null: they are not. */
  steps: Record<"position" | "change" | "velocity" | "acceleration", (number | null)[]>;
}

/** A cleaned recording, ready to draw. */
export interface CleanTrial {
  summary: CleanSummary;
  /** Frames per point; above 1 the points hold the extremes of each stretch. */
  frameStep: number;
  time: Float64Array;
  /** Codes of the gap map, one row per marker. */
  before: Uint8Array[];
  after: Uint8Array[];
  /** Read when it is first asked for: a page may hold tens of megabytes, of which people look at little. */
  marker: (index: number) => MarkerSeries;
}

/** The series must have been inflated, see inflateAll(). */
export function decodeClean({ summary, series }: CleanPage): CleanTrial {
  if (summary.schema !== "kinemark.clean_report" || summary.schema_version !== 2) {
    throw new Error(`this page cannot read ${summary.schema} version ${summary.schema_version}`);
  }
  if (series.markers.length !== summary.markers.length) {
    throw new Error(`the page holds ${series.markers.length} series; ${summary.markers.length} markers need as many`);
  }
  const n = series.points;
  const axes = (encoded: EncodedAxes): Axes => encoded.map((text) => (text === null ? null : decodeFloats(text, n)));
  const known = new Map<number, MarkerSeries>();
  return {
    summary,
    frameStep: series.frame_step,
    time: Float64Array.from({ length: n }, (_, i) => summary.first_time_s + (i * series.frame_step) / summary.rate_hz),
    before: series.markers.map((m) => decodeBytes(m.before, n)),
    after: series.markers.map((m) => decodeBytes(m.after, n)),
    marker: (index) => {
      const found = known.get(index);
      if (found !== undefined) return found;
      const m = series.markers[index];
      if (m === undefined) throw new Error(`there is no marker ${index}`);
      const decoded: MarkerSeries = {
        raw: [],
        position: axes(m.position_mm),
        positionSd: axes(m.position_sd_mm),
        change: axes(m.change_mm),
        velocity: axes(m.velocity),
        velocitySd: axes(m.velocity_sd),
        acceleration: axes(m.acceleration),
        accelerationSd: axes(m.acceleration_sd),
        steps: { position: m.position_mm.map(stepOf), change: m.change_mm.map(stepOf), velocity: m.velocity.map(stepOf), acceleration: m.acceleration.map(stepOf) },
      };
      decoded.raw = m.raw_mm.map((text, k) => {
        if (text === null) return null;
        if (text.kind === "rounded") return decodeFloats(text, n);
        const change = decoded.change[k]!;
        return decoded.position[k]!.map((v, i) => v + change[i]!);
      });
      known.set(index, decoded);
      return decoded;
    },
  };
}
