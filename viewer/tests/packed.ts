// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { deflateSync, inflateSync } from "node:zlib";
import type { PackedCodes, PackedCurve } from "../src/page_types.ts";

export const deflated = (bytes: Uint8Array): string => deflateSync(bytes).toString("base64");

/** Codes as a page has them. */
export const packedCodes = (values: readonly number[]): PackedCodes => ({ kind: "codes", data: deflated(Uint8Array.from(values)) });

/** A curve as a page has it, of order 0; NaN is missing. */
export function packedCurve(values: readonly number[], step = 1e-5): PackedCurve {
  const n = values.length;
  const bytes = new Uint8Array(5 * n);
  values.forEach((value, i) => {
    const word = Number.isNaN(value) ? 0 : Math.round(value / step);
    const zigzag = (word << 1) ^ (word >> 31);
    for (let b = 0; b < 4; ++b) bytes[b * n + i] = (zigzag >>> (8 * b)) & 255;
    bytes[4 * n + i] = Number.isNaN(value) ? 1 : 0;
  });
  return { kind: "rounded", step, order: 0, bytes: 4, absent: true, data: deflated(bytes) };
}

/** A page whose curves are inflated, as inflateAll() leaves it, without waiting. */
export function inflated<Page>(page: Page): Page {
  for (const part of Object.values(page as object) as unknown[]) if (typeof part === "object" && part !== null && !(part instanceof Uint8Array)) inflated(part);
  const packed = page as { kind?: unknown; data?: unknown };
  if ((packed.kind === "rounded" || packed.kind === "codes") && typeof packed.data === "string") packed.data = new Uint8Array(inflateSync(Buffer.from(packed.data, "base64")));
  return page;
}
