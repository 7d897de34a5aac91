// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { inflated } from "./scene/unpack.ts";

/** A curve as it stands in the page; src/kinemark/stages/report/README.md describes it. */
export interface PackedCurve {
  kind: "rounded";
  /** What the numbers are multiples of. */
  step: number;
  order: 0 | 1 | 2;
  bytes: number;
  absent: boolean;
  data: string | Uint8Array;
}

export interface PackedCodes {
  kind: "codes";
  data: string | Uint8Array;
}

/** Base64 of float32 in pages of earlier versions. */
export type EncodedCurve = PackedCurve | string;
/** Base64 of bytes in pages of earlier versions. */
export type EncodedCodes = PackedCodes | string;

const isPacked = (part: object): part is PackedCurve | PackedCodes =>
  "kind" in part && "data" in part && (part.kind === "rounded" || part.kind === "codes");

/** Inflate every curve within `part`, in place: afterwards they can be decoded at once. */
export async function inflateAll(part: unknown): Promise<void> {
  if (typeof part !== "object" || part === null || part instanceof Uint8Array) return;
  if (isPacked(part)) {
    if (typeof part.data === "string") part.data = await inflated(part.data);
    return;
  }
  await Promise.all(Object.values(part).map(inflateAll));
}

const bytesOf = (data: string | Uint8Array): Uint8Array =>
  typeof data === "string" ? Uint8Array.from(atob(data), (c) => c.charCodeAt(0)) : data;

export function decodeBytes(codes: EncodedCodes, points: number): Uint8Array {
  const bytes = bytesOf(typeof codes === "string" ? codes : codes.data);
  if (bytes.length !== points) throw new Error(`a series holds ${bytes.length} codes; ${points} points need as many`);
  return bytes;
}

function float32s(base64: string, points: number): Float32Array {
  const bytes = decodeBytes(base64, 4 * points);
  const view = new DataView(bytes.buffer);
  return Float32Array.from({ length: points }, (_, i) => view.getFloat32(4 * i, true));
}

export function decodeFloats(curve: EncodedCurve, points: number): Float32Array {
  if (typeof curve === "string") return float32s(curve, points);
  const planes = curve.bytes + (curve.absent ? 1 : 0);
  const bytes = decodeBytes({ kind: "codes", data: curve.data }, planes * points);
  const out = new Float32Array(points);
  let word = 0;
  let slope = 0;
  for (let i = 0; i < points; ++i) {
    let packed = 0;
    for (let b = 0; b < curve.bytes; ++b) packed |= bytes[b * points + i]! << (8 * b);
    const change = (packed >>> 1) ^ -(packed & 1);
    if (curve.order === 0) word = change;
    else {
      slope = curve.order === 2 && i > 1 ? (slope + change) | 0 : change;
      word = (word + slope) | 0;
    }
    out[i] = curve.absent && bytes[curve.bytes * points + i] === 1 ? NaN : word * curve.step;
  }
  return out;
}

/** What the numbers of these curves are rounded to, the finest of them; null: they are not. */
export function stepOf(...curves: (EncodedCurve | null | undefined)[]): number | null {
  return finest(...curves.map((c) => (c === null || c === undefined || typeof c === "string" ? null : c.step)));
}

export function finest(...steps: (number | null | undefined)[]): number | null {
  const known = steps.filter((s) => typeof s === "number");
  return known.length === 0 ? null : Math.min(...known);
}

/** Decimals that multiples of a step of 1, 2 or 5 times a power of ten need. */
export const decimalsOfStep = (step: number): number => Math.max(0, -Math.floor(Math.log10(step) + 1e-9));

/** What a curve in the page holds of the result, in words that follow "the curves hold". */
export interface Precision {
  step: number | null;
  /** Frames of which the smallest and the largest value are kept; 1: all are. */
  framesOfPair: number;
}

/** Points of which each stands for several frames come in pairs. */
export const framesOfPair = (frameStep: number): number => (frameStep > 1 ? 2 * frameStep : 1);

export function precisionWords({ step, framesOfPair }: Precision, unit: string): string {
  const parts = [
    ...(framesOfPair > 1 ? [`smallest and largest of ${framesOfPair} frames each`] : []),
    ...(step === null ? [] : [`rounded to ${Number(step.toPrecision(1))} ${unit}`.trimEnd()]),
  ];
  return parts.join(", ");
}
