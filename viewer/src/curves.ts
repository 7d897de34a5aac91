// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { PackedCodes, PackedCurve } from "./page_types.ts";
import { inflated } from "./scene/unpack.ts";

/** As it stands in the page, or inflated. */
type Inflated<Packed> = Omit<Packed, "data"> & { data: string | Uint8Array };

const isPacked = (part: object): part is Inflated<PackedCurve> | Inflated<PackedCodes> =>
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

/** Bytes of codes that inflateAll() has inflated. */
export function decodeBytes({ data }: Inflated<PackedCodes>, points: number): Uint8Array {
  if (typeof data === "string") throw new Error("a series must be inflated before it is read");
  if (data.length !== points) throw new Error(`a series holds ${data.length} codes; ${points} points need as many`);
  return data;
}

/** Numbers of a curve that inflateAll() has inflated; NaN where they are missing. */
export function decodeFloats(curve: Inflated<PackedCurve>, points: number): Float32Array {
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

/** What the numbers of a curve are rounded to; null: there is none. */
export const stepOf = (curve: PackedCurve | null): number | null => curve?.step ?? null;

/** What all of these curves are held to at least, so that no number seems finer than it is. */
export function coarsest(...steps: (number | null | undefined)[]): number | null {
  const known = steps.filter((s) => typeof s === "number");
  return known.length === 0 ? null : Math.max(...known);
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
