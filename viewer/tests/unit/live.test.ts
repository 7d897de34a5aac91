// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { LiveSummary } from "../../src/page_types.ts";
import { describe, expect, it } from "vitest";
import type { AnglesMessage, MarkersMessage } from "../../src/live/message.ts";
import type { LiveStream as Stream, Surroundings } from "../../src/live/stream.ts";
import { install } from "../fake_dom.ts";

install();
const { LiveCurves } = await import("../../src/live/curves.ts");
const { decodeMessage, drawnMessage, pushMessage } = await import("../../src/live/message.ts");
const { LiveStream } = await import("../../src/live/stream.ts");
const { LiveWindow } = await import("../../src/live/window.ts");
const { bounds } = await import("../../src/scene/scene.ts");

/** A message as server/live_viewer.cc writes it. */
function bytes(kind: number, frame: number, time_s: number, floats: number[], tail: number[], { dropped = 0, answer_s = NaN, version = 1 } = {}): ArrayBuffer {
  const buffer = new ArrayBuffer(40 + 4 * floats.length + tail.length);
  const view = new DataView(buffer);
  view.setUint8(0, kind);
  view.setUint8(1, version);
  view.setUint16(2, tail.length, true);
  view.setUint32(4, dropped, true);
  view.setFloat64(8, frame, true);
  view.setFloat64(16, time_s, true);
  view.setFloat32(32, answer_s, true);
  floats.forEach((v, i) => view.setFloat32(40 + 4 * i, v, true));
  new Uint8Array(buffer).set(tail, 40 + 4 * floats.length);
  return buffer;
}
const marker = (frame: number, x = frame, more = {}): ArrayBuffer => bytes(1, frame, frame / 240, [x, 0, 1], [1], more);
const text = (words: string): ArrayBuffer => bytes(3, 0, 0, [], [...new TextEncoder().encode(words)]);

const summary: LiveSummary = {
  schema: "kinemark.live", schema_version: 1, trial: "x", source: "sim:", version: "1", recording: null, rate_hz: 240,
  markers: ["A", "B"], up: [0, 0, 1], up_from: "", extent_m: null, coordinates: [], bodies: [], targets: [], levels: [], strict: false,
};

describe("a message", () => {
  it("is read byte by byte, with the states of this page", () => {
    const m = decodeMessage(bytes(1, 7, 0.5, [1.5, -2, 0.25, NaN, NaN, NaN], [1, 5], { dropped: 9, answer_s: 0.25 })) as MarkersMessage;
    expect([m.kind, m.frame, m.time_s, m.dropped, m.answer_s]).toEqual(["markers", 7, 0.5, 9, 0.25]);
    expect([...m.x.slice(0, 3)]).toEqual([1.5, -2, 0.25]);
    expect([...m.states]).toEqual([0, 5]);
    expect(decodeMessage(bytes(1, 0, 0, [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0], [0, 2, 3, 4]))).toMatchObject({ states: Uint8Array.from([4, 2, 3, 1]), answer_s: null });
    expect(decodeMessage(bytes(2, 3, 0, [10, 20, 0.5, 1], [1, 0]))).toMatchObject({ kind: "angles", value: Float32Array.from([10, 20]), sd: Float32Array.from([0.5, 1]), determined: Uint8Array.from([1, 0]) });
    expect(decodeMessage(text("the disk is full · ü"))).toMatchObject({ kind: "sentence", text: "the disk is full · ü" });
  });
  it("of angles holds poses of bodies, goals and how far the body is pushed", () => {
    const poses = [1, 2, 3, 1, 0, 0, 0.25];
    const made = new Uint8Array(40 + 9 + 4 * (7 + 6 + 1));
    made.set(new Uint8Array(bytes(2, 3, 0, [10, 0.5], [1])));
    const view = new DataView(made.buffer);
    view.setUint16(36, 1, true);
    view.setUint16(38, 2, true);
    [...poses, 4, 5, 6, NaN, NaN, NaN, 12.5].forEach((v, i) => view.setFloat32(49 + 4 * i, v, true));
    const m = decodeMessage(made.buffer) as AnglesMessage;
    expect([[...m.value], [...m.sd], [...m.determined]]).toEqual([[10], [0.5], [1]]);
    expect([[...m.poses], [...m.goals], m.pushed_mm]).toEqual([poses, [4, 5, 6, NaN, NaN, NaN], 12.5]);
    view.setFloat32(49 + 4 * 13, NaN, true);
    expect((decodeMessage(made.buffer) as AnglesMessage).pushed_mm).toBeNull();
    expect(() => decodeMessage(made.buffer.slice(0, -1))).toThrow();
    expect(decodeMessage(bytes(2, 3, 0, [10, 0.5], [1]))).toMatchObject({ poses: new Float32Array(0), pushed_mm: null });
  });
  it("says what pushes the body, byte by byte as server/live_push.h has it", () => {
    const view = new DataView(pushMessage(258, [0.5, -1, 2], [100, 0, -0.25]));
    expect([view.byteLength, view.getUint8(0), view.getUint8(1), view.getUint16(2, true)]).toEqual([28, 1, 1, 258]);
    expect([0, 1, 2, 3, 4, 5].map((i) => view.getFloat32(4 + 4 * i, true))).toEqual([0.5, -1, 2, 100, 0, -0.25]);
  });
  it("that is none is refused", () => {
    for (const wrong of [new ArrayBuffer(0), new ArrayBuffer(39), bytes(1, 0, 0, [1], [1]), bytes(4, 0, 0, [], []), bytes(0, 0, 0, [], []), bytes(1, 0, 0, [1, 2, 3], [1], { version: 2 })])
      expect(() => decodeMessage(wrong)).toThrow();
  });
  it("says how many are drawn", () => {
    expect(new DataView(drawnMessage(12345)).getFloat64(0, true)).toBe(12345);
  });
});

/** A connection that the test moves. */
class Wire {
  binaryType = "";
  sent: number[] = [];
  pushes: ArrayBuffer[] = [];
  closed = false;
  onopen: () => void = () => undefined;
  onmessage: (e: { data: ArrayBuffer }) => void = () => undefined;
  onclose: (e: { code: number; reason: string }) => void = () => undefined;
  send(data: ArrayBuffer): void {
    if (data.byteLength !== 8) return void this.pushes.push(data);
    this.sent.push(new DataView(data).getFloat64(0, true));
  }
  close(): void {
    this.closed = true;
  }
}

function streaming(): { stream: Stream; wires: Wire[]; waits: number[]; later: (() => void)[]; clock: { ms: number }; frames: number[] } {
  const [wires, waits, later, clock, frames]: [Wire[], number[], (() => void)[], { ms: number }, number[]] = [[], [], [], { ms: 0 }, []];
  const around: Surroundings = {
    connect: () => {
      const wire = new Wire();
      wires.push(wire);
      return wire as unknown as WebSocket;
    },
    now: () => clock.ms,
    later: (task, ms) => {
      waits.push(ms);
      later.push(task);
    },
  };
  const stream = new LiveStream("ws://x", { markers: (m) => frames.push(m.frame), angles: () => undefined, changed: () => undefined }, around);
  stream.start();
  return { stream, wires, waits, later, clock, frames };
}

describe("the connection", () => {
  it("counts what came and what was dropped, and says what is drawn", () => {
    const { stream, wires, frames, clock } = streaming();
    const wire = wires[0]!;
    expect(stream.state).toBe("connecting");
    wire.onopen();
    for (const f of [10, 11]) wire.onmessage({ data: marker(f) });
    wire.onmessage({ data: marker(20, 0, { dropped: 8, answer_s: 0.004 }) });
    expect(frames).toEqual([10, 11, 20]);
    expect([stream.state, stream.dropped, stream.missed, stream.lastFrame]).toEqual(["open", 8, 0, 20]);
    expect(stream.answer_s).toBeCloseTo(0.004);
    stream.drawn();
    stream.drawn();
    expect(wire.sent).toEqual([3]);
    clock.ms = 1000;
    expect(stream.rateHz()).toBe(1.5);
    clock.ms = 5000;
    expect(stream.rateHz()).toBe(0);
  });
  it("is taken up again when it is lost, and what came meanwhile is missed", () => {
    const { stream, wires, waits, later } = streaming();
    wires[0]!.onopen();
    wires[0]!.onmessage({ data: marker(5) });
    wires[0]!.onmessage({ data: marker(8, 0, { dropped: 2 }) });
    wires[0]!.onclose({ code: 1006, reason: "" });
    expect(stream.state).toBe("lost");
    expect(stream.sentence).toContain("lost");
    stream.drawn();
    expect(wires[0]!.sent).toEqual([]);
    later[0]!();
    wires[1]!.onopen();
    expect([stream.state, stream.sentence]).toEqual(["open", ""]);
    wires[1]!.onmessage({ data: marker(100) });
    wires[1]!.onmessage({ data: marker(102, 0, { dropped: 1 }) });
    expect([stream.missed, stream.dropped]).toEqual([91, 3]);
    stream.drawn();
    expect(wires[1]!.sent).toEqual([2]);
    expect(waits).toEqual([500]);
  });
  it("is tried more rarely, with advice, while nobody answers", () => {
    const { stream, wires, waits, later } = streaming();
    for (let i = 0; i < 7; ++i) {
      expect(stream.sentence.includes("started again")).toBe(i > 3);
      wires[i]!.onclose({ code: 1006, reason: "" });
      later[i]!();
    }
    expect(waits).toEqual([500, 1000, 2000, 4000, 5000, 5000, 5000]);
  });
  it("carries pushes while it is there", () => {
    const { stream, wires } = streaming();
    stream.push(1, [0, 0, 0], [1, 0, 0]);
    wires[0]!.onopen();
    stream.push(1, [0, 0, 0], [1, 0, 0]);
    wires[0]!.onclose({ code: 1006, reason: "" });
    stream.push(1, [0, 0, 0], [1, 0, 0]);
    expect(wires[0]!.pushes.map((p) => p.byteLength)).toEqual([28]);
  });
  it("ends with the sentence of the server and is not taken up again", () => {
    const { stream, wires, waits } = streaming();
    wires[0]!.onopen();
    wires[0]!.onclose({ code: 1000, reason: "the source has ended after 5 frames" });
    expect([stream.state, stream.sentence]).toEqual(["ended", "The source has ended after 5 frames. What you see is the last frame."]);
    expect(waits).toEqual([]);
  });
  it("ends where the server is not understood", () => {
    const { stream, wires, waits } = streaming();
    wires[0]!.onopen();
    wires[0]!.onmessage({ data: new ArrayBuffer(3) });
    wires[0]!.onclose({ code: 1006, reason: "" });
    expect(stream.state).toBe("ended");
    expect(stream.sentence).toContain("cannot read");
    expect([wires[0]!.closed, waits]).toEqual([true, []]);
  });
  it("shows what people should know", () => {
    const { stream, wires } = streaming();
    wires[0]!.onopen();
    wires[0]!.onmessage({ data: text("the recording ends: disk full") });
    expect([stream.state, stream.sentence]).toEqual(["open", "the recording ends: disk full"]);
  });
});

describe("the last seconds", () => {
  const frame = (f: number, a: number | null, b: number | null): MarkersMessage => ({
    kind: "markers", dropped: 0, frame: f, time_s: f / 240, answer_s: null,
    x: Float32Array.from([a ?? NaN, 0, 0, b ?? NaN, 0, 0]), states: Uint8Array.from([a === null ? 4 : 0, b === null ? 4 : 0]),
  });
  it("end at the newest frame, one point for four frames", () => {
    const shown = new LiveWindow(summary);
    const { scene } = shown;
    const P = scene.points;
    expect([P, scene.frameStep]).toEqual([240, 4]);
    shown.push(frame(0, 1, null));
    shown.push(frame(1, 2, null));
    expect(shown.seen).toEqual([true, false]);
    shown.push(frame(9, 3, 5));
    expect(shown.seen).toEqual([true, true]);
    expect([...scene.markers.x.slice(P - 3, P)]).toEqual([2, 2, 3]);
    expect([...scene.markers.states.slice(P - 3, P)]).toEqual([0, 4, 0]);
    expect(scene.time[P - 1]).toBeCloseTo(9 / 240);
    expect(scene.time[P - 1]! - scene.time[0]!).toBeCloseTo((239 * 4) / 240);
    expect(scene.firstFrame).toBe(9 - 239 * 4);
  });
  it("keep a marker that is missing where it was last", () => {
    const shown = new LiveWindow(summary);
    shown.push(frame(0, 1, 7));
    shown.push(frame(4, 2, null));
    const P = shown.scene.points;
    expect(shown.scene.markers.x[4 * P - 1]).toBe(7);
    expect(shown.scene.markers.states[2 * P - 1]).toBe(4);
  });
  it("forget what is older, and frames that come late", () => {
    const shown = new LiveWindow(summary);
    shown.push(frame(0, 1, 1));
    shown.push(frame(1_000_000, 2, 2));
    shown.push(frame(5, 9, 9));
    const P = shown.scene.points;
    expect([...shown.scene.markers.states.slice(0, P)].filter((s) => s === 0)).toHaveLength(1);
    expect(shown.scene.markers.x[P - 1]).toBe(2);
  });
  it("have a point for each frame that they still hold, and the nearest for those that did not come", () => {
    const shown = new LiveWindow(summary);
    const P = shown.scene.points;
    for (const f of [1900, 1960, 1996, 2000]) shown.push(frame(f, 1, 1));
    expect([2000, 1999, 1960, 5, -1, 2400].map((f) => shown.pointOf(f))).toEqual([P - 1, P - 2, P - 11, P - 1, P - 1, P - 1]);
    expect([1964, 1988, 1920].map((f) => shown.pointOf(f))).toEqual([P - 11, P - 2, P - 26]);
    expect(shown.scene.markers.states[shown.pointOf(1964)]).toBe(0);
  });
  it("stand where the markers are known to come", () => {
    const shown = new LiveWindow({ ...summary, extent_m: [[-1, -2, 0], [1, 2, 3]] });
    expect(bounds(shown.scene)).toEqual([[-1, -2, 0], [1, 2, 3]]);
  });
});

describe("the curves of angles", () => {
  const angle = (time_s: number, value: number, determined = 1): Parameters<InstanceType<typeof LiveCurves>["push"]>[0] => ({
    kind: "angles", dropped: 0, frame: 0, time_s, answer_s: null, value: Float32Array.from([value]), sd: Float32Array.from([0.5]), determined: Uint8Array.from([determined]), poses: new Float32Array(0), goals: new Float32Array(0), pushed_mm: null,
  });
  it("hold ten seconds, thirty points in each, the newest last", () => {
    const curves = new LiveCurves(1);
    expect(curves.range()).toBeNull();
    for (let f = 0; f <= 240; ++f) curves.push(angle(f / 240, f));
    expect(curves.range()).toEqual([-9, 1]);
    const { value, sd } = curves.series[0]!;
    expect([...value.slice(-3)]).toEqual([231, 239, 240]);
    expect(sd![299]).toBe(0.5);
    expect([...value].filter((v) => !Number.isNaN(v))).toHaveLength(31);
    expect([...curves.time].every((t, i) => i === 0 || t > curves.time[i - 1]!)).toBe(true);
  });
  it("have no band where an angle is not determined", () => {
    const curves = new LiveCurves(1);
    curves.push(angle(0, 3, 0));
    const { sd, undetermined } = curves.series[0]!;
    expect([Number.isNaN(sd![299]!), undetermined![299]]).toEqual([true, 1]);
    curves.push(angle(1, NaN, 0));
    expect(undetermined![299]).toBe(0);
  });
});
