// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { IkPage, IkSensors, IkSummary, PackedCodes, PackedCurve } from "./page_types.ts";
import { decodeBytes, decodeFloats, stepOf } from "./curves.ts";

/** One coordinate on the points of the plots, deg or m; NaN where it is not determined. */
export interface CoordinateSeries {
  value: Float32Array;
  sd: Float32Array | null;
  /** 1 where a frame of this point is not determined; null when all are. */
  undetermined: Uint8Array | null;
  /** What the values are rounded to; null, or not there: they are not. */
  step?: number | null;
}

/** Inertial sensors on the points of the plots. */
export interface SensorCurves {
  facts: IkSensors;
  /** One per sensor, deg; NaN where it is not used. */
  errorDeg: Float32Array[];
  /** What these are rounded to, in the same order. */
  stepDeg: (number | null)[];
  rmsDeg: Float32Array;
  /** One per sensor: 0 measured, 2 missing, 3 rejected. */
  gaps: Uint8Array[];
}

/** A solved trial, ready to draw. */
export interface Trial {
  summary: IkSummary;
  /** Frames per point; above 1 the points hold the extremes of each stretch. */
  frameStep: number;
  time: Float64Array;
  coordinates: CoordinateSeries[];
  /** N m or N, one per coordinate; empty where none were computed. */
  torques: (CoordinateSeries | null)[];
  rmsErrorMm: Float32Array;
  /** One per used marker, in the order of summary.markers. */
  markerErrorMm: Float32Array[];
  /** What these are rounded to, in the same order. */
  markerErrorStepMm: (number | null)[];
  /** One per marker of summary.markers: 0 measured, 1 filled, 2 missing, 3 rejected; null when not known. */
  gaps: (Uint8Array | null)[];
  /** 0 converged, 1 not all determined, 2 not converged, 3 no markers. */
  status: Uint8Array;
  /** In place of markers or beside them; null: none. */
  sensors: SensorCurves | null;
}

/** What fixes the coordinates, in words. */
export const seenBy = (trial: Trial): string => (trial.sensors !== null && trial.summary.markers.length === 0 ? "sensors" : "visible markers");

/** The series must have been inflated, see inflateAll(). */
export function decode({ summary, series, sensors = null }: IkPage): Trial {
  if (summary.schema !== "kinemark.ik_report" || summary.schema_version !== 2) {
    throw new Error(`this page cannot read ${summary.schema} version ${summary.schema_version}`);
  }
  const n = series.points;
  const floats = (text: PackedCurve) => decodeFloats(text, n);
  const bytes = (text: PackedCodes) => decodeBytes(text, n);
  return {
    summary,
    frameStep: series.frame_step,
    time: Float64Array.from({ length: n }, (_, i) => summary.first_time_s + (i * series.frame_step) / summary.rate_hz),
    coordinates: series.coordinates.map((c) => ({
      value: floats(c.value),
      sd: c.sd === null ? null : floats(c.sd),
      undetermined: c.undetermined === null ? null : bytes(c.undetermined),
      step: stepOf(c.value),
    })),
    torques: (series.torques ?? []).map((t) => (t === null ? null : { value: floats(t.value), sd: t.sd === null ? null : floats(t.sd), undetermined: null, step: stepOf(t.value) })),
    rmsErrorMm: floats(series.rms_error_mm),
    markerErrorMm: series.marker_error_mm.map(floats),
    markerErrorStepMm: series.marker_error_mm.map(stepOf),
    gaps: series.gaps.map((g) => (g === null ? null : bytes(g))),
    status: bytes(series.status),
    sensors:
      sensors === null || series.sensor_rms_deg === undefined
        ? null
        : {
            facts: sensors,
            errorDeg: (series.sensor_error_deg ?? []).map(floats),
            stepDeg: (series.sensor_error_deg ?? []).map(stepOf),
            rmsDeg: floats(series.sensor_rms_deg),
            gaps: (series.sensor_gaps ?? []).map(bytes),
          },
  };
}
