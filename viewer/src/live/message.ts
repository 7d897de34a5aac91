// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { Vec } from "../scene/vec.ts";
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
  /** B x 7: origin in m and quaternion w x y z of each body, of the pushed one while there is one; NaN where nothing is known. */
  poses: Float32Array;
  /** G x 3, m: goals of the markers of the source; NaN where there is none. */
  goals: Float32Array;
  /** How far a push has moved a marker of the model, mm; null: nobody pushes. */
  pushed_mm: number | null;
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
  const [bodies, goals] = [view.getUint16(36, true), view.getUint16(38, true)];
  const more = bodies === 0 ? 0 : 7 * bodies + 3 * goals + 1;
  const bytes = kind === 1 ? 13 * count : kind === 2 ? 9 * count + 4 * more : count;
  if (buffer.byteLength !== headBytes + bytes || kind < 1 || kind > 3) throw new Error("a message of the server is not as long as it says");
  const floats = (from: number, n: number): Float32Array => Float32Array.from({ length: n }, (_, i) => view.getFloat32(headBytes + 4 * (from + i), true));
  const rest = new Uint8Array(buffer, headBytes + bytes - 4 * (kind === 2 ? more : 0) - count, count);
  if (kind === 1) return { kind: "markers", ...head, x: floats(0, 3 * count), states: rest.map((code) => stateOfCode[code] ?? 4) };
  if (kind === 2) {
    const after = (from: number, n: number): Float32Array => Float32Array.from({ length: n }, (_, i) => view.getFloat32(headBytes + 9 * count + 4 * (from + i), true));
    const pushed = bodies === 0 ? NaN : after(more - 1, 1)[0]!;
    return { kind: "angles", ...head, value: floats(0, count), sd: floats(count, count), determined: rest, poses: after(0, 7 * bodies), goals: after(7 * bodies, bodies === 0 ? 0 : 3 * goals), pushed_mm: Number.isNaN(pushed) ? null : pushed };
  }
  return { kind: "sentence", ...head, text: new TextDecoder().decode(rest) };
}

/** What the server hears: how many messages of this connection are drawn. */
export function drawnMessage(count: number): ArrayBuffer {
  const buffer = new ArrayBuffer(8);
  new DataView(buffer).setFloat64(0, count, true);
  return buffer;
}

/** A force (N, in the world) at a point (m, in the body) of a body; none lets go. */
export function pushMessage(body: number, point: Vec, force: Vec): ArrayBuffer {
  const buffer = new ArrayBuffer(28);
  const view = new DataView(buffer);
  view.setUint8(0, 1);
  view.setUint8(1, 1);
  view.setUint16(2, body, true);
  [...point, ...force].forEach((value, i) => view.setFloat32(4 + 4 * i, value, true));
  return buffer;
}
