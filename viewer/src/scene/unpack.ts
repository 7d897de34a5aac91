// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { PackedSeries } from "../page_types.ts";

/** Bytes of a base64 text that holds a zlib stream. */
export async function inflated(base64: string): Promise<Uint8Array> {
  const packed = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/**
 * Numbers of packed series, series after series. What was absent holds the number before it; the states tell
 * where that is.
 */
export function unpackWords(bytes: Uint8Array, packed: Omit<PackedSeries, "data">): Float32Array {
  const { series, points, kind } = packed;
  const count = series * points;
  const width = kind === "int16" ? 2 : 4;
  if (bytes.length !== width * count) {
    throw new Error(`a packed block holds ${bytes.length} bytes; ${series} series of ${points} points need ${width * count}`);
  }
  const out = new Float32Array(count);
  if (kind === "float32") {
    const bits = new Uint32Array(out.buffer);
    for (let s = 0; s < series; ++s) {
      let word = 0;
      for (let i = s * points; i < (s + 1) * points; ++i) {
        const change = bytes[i]! | (bytes[count + i]! << 8) | (bytes[2 * count + i]! << 16) | (bytes[3 * count + i]! << 24);
        word = (word + change) >>> 0;
        bits[i] = word;
      }
    }
    return out;
  }
  for (let s = 0; s < series; ++s) {
    const offset = packed.offset?.[s] ?? 0;
    const step = packed.step?.[s] ?? 1;
    let word = 0;
    for (let i = s * points; i < (s + 1) * points; ++i) {
      word = (word + (bytes[i]! | (bytes[count + i]! << 8))) & 0xffff;
      out[i] = offset + step * word;
    }
  }
  return out;
}

export const unpack = async (packed: PackedSeries): Promise<Float32Array> =>
  unpackWords(await inflated(packed.data), packed);
