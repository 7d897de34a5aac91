// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { stateNames } from "../states.ts";

interface Head {
  /** Messages of this kind that this page did not get, since it connected. */
  dropped: number;
  frame: number;
  time_s: number;
  /** From when a frame was due until it was known to be drawn; null: not known yet. */
  answer_s: number | null;
}
export interface MarkersMessage extends Head {
  kind: "markers";
  /** M x 3, m; NaN where there is none. */
  x: Float32Array;
  /** M: codes of states.ts. */
  states: Uint8Array;
}
export interface AnglesMessage extends Head {
  kind: "angles";
  /** deg or mm */
  value: Float32Array;
  sd: Float32Array;
  determined: Uint8Array;
}
export interface SentenceMessage extends Head {
  kind: "sentence";
  text: string;
}
export type LiveMessage = MarkersMessage | AnglesMessage | SentenceMessage;

const headBytes = 40;
/** missing, measured, interpolated, filled from a model, upsampled, rejected: as data::SampleState counts. */
const stateOfCode = Uint8Array.from(["missing", "measured", "interpolated", "model_filled", "upsampled", "rejected"].map((name) => stateNames.indexOf(name as "missing")));

/** A message of the server; it throws at one that is none. server/live_viewer.h describes the bytes. */
export function decodeMessage(buffer: ArrayBuffer): LiveMessage {
  const view = new DataView(buffer);
  if (buffer.byteLength < headBytes || view.getUint8(1) !== 1) throw new Error("this page cannot read what the server sends");
  const [kind, count] = [view.getUint8(0), view.getUint16(2, true)];
  const answer = view.getFloat32(32, true);
  const head = { dropped: view.getUint32(4, true), frame: view.getFloat64(8, true), time_s: view.getFloat64(16, true), answer_s: Number.isNaN(answer) ? null : answer };
  const bytes = kind === 1 ? 13 * count : kind === 2 ? 9 * count : count;
  if (buffer.byteLength !== headBytes + bytes || kind < 1 || kind > 3) throw new Error("a message of the server is not as long as it says");
  const floats = (from: number, n: number): Float32Array => Float32Array.from({ length: n }, (_, i) => view.getFloat32(headBytes + 4 * (from + i), true));
  const rest = new Uint8Array(buffer, headBytes + bytes - count, count);
  if (kind === 1) return { kind: "markers", ...head, x: floats(0, 3 * count), states: rest.map((code) => stateOfCode[code] ?? 4) };
  if (kind === 2) return { kind: "angles", ...head, value: floats(0, count), sd: floats(count, count), determined: rest };
  return { kind: "sentence", ...head, text: new TextDecoder().decode(rest) };
}

/** What the server hears: how many messages of this connection are drawn. */
export function drawnMessage(count: number): ArrayBuffer {
  const buffer = new ArrayBuffer(8);
  new DataView(buffer).setFloat64(0, count, true);
  return buffer;
}
