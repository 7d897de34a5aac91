// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import type { AnglesMessage } from "../../src/live/message.ts";
import type { Eyes, PushHand as Hand } from "../../src/live/push.ts";
import type { LiveSummary } from "../../src/page_types.ts";
import type { Vec } from "../../src/scene/vec.ts";
import { install, type FakeElement } from "../fake_dom.ts";

install();
const { LiveBody, turned } = await import("../../src/live/body.ts");
const { PushHand, mostN, dragNPerM } = await import("../../src/live/push.ts");
const { livePush } = await import("../../src/sections/live_push.ts");

const summary: LiveSummary = {
  schema: "kinemark.live", schema_version: 1, trial: "x", source: "sim:", version: "1", recording: null, rate_hz: 240, markers: ["A", "B", "C"],
  up: [0, 0, 1], up_from: "", extent_m: null, coordinates: [],
  bodies: [
    { name: "trunk", parent: -1, mass_kg: 30, com_m: [0, 0, 0.2] },
    { name: "arm", parent: 0, mass_kg: 3, com_m: [0.1, 0, 0] },
  ],
  targets: [
    { marker: 0, body: 0, point_m: [0, 0, 0.1], level: 0 },
    { marker: 2, body: 1, point_m: [0.1, 0, 0], level: 1 },
  ],
  levels: ["A", "all others"], strict: false,
};
const half = Math.SQRT1_2;
/** The trunk stands at the origin; the arm begins a metre above and is turned by 90 degrees about z. */
const message = (more: Partial<AnglesMessage> = {}): AnglesMessage => ({
  kind: "angles", dropped: 0, frame: 5, time_s: 0, answer_s: null, value: new Float32Array(0), sd: new Float32Array(0), determined: new Uint8Array(0),
  poses: Float32Array.from([0, 0, 0, 1, 0, 0, 0, 0, 0, 1, half, 0, 0, half]),
  goals: Float32Array.from([0.003, 0, 0.1, 9, 9, 9, NaN, NaN, NaN]), pushed_mm: null, ...more,
});
const near = (a: readonly number[], b: readonly number[]): void => a.forEach((v, i) => expect(v).toBeCloseTo(b[i]!, 5));

describe("the body that follows", () => {
  it("turns points by quaternions", () => {
    near(turned([half, 0, 0, half], [1, 0, 0]), [0, 1, 0]);
    near(turned([half, half, 0, 0], [0, 1, 2]), [0, -2, 1]);
  });
  it("knows where its bodies, markers and goals are", () => {
    const body = new LiveBody(summary, 4);
    expect(body.levelDistances()).toEqual([NaN, NaN]);
    body.push(message());
    body.putAt(2);
    const at = (list: Float32Array, b: number): number[] => [0, 1, 2].map((k) => list[(3 * b + k) * 4 + 2]!);
    near(at(body.bodies.end, 0), [0, 0, 1]);
    near(at(body.bodies.origin, 1), [0, 0, 1]);
    near(at(body.bodies.end, 1), [0, 0.2, 1]);
    expect(body.bodies.origin[1]).toBeNaN();
    near([...body.goals.model], [0, 0, 0.1, 0, 0.1, 1]);
    near([...body.goals.x.slice(0, 3)], [0.003, 0, 0.1]);
    near([body.levelDistances()[0]!], [3]);
    expect(body.levelDistances()[1]).toBeNaN();
    near(body.inBody(1, body.world(1, [0.3, 0.2, 0.1])), [0.3, 0.2, 0.1]);
  });
  it("takes no older frame, and none of other bodies", () => {
    const body = new LiveBody(summary, 4);
    body.push(message());
    body.push(message({ frame: 4, pushed_mm: 7 }));
    body.push(message({ frame: 9, poses: new Float32Array(7) }));
    expect([body.frame, body.pushed_mm]).toEqual([5, null]);
    body.push(message({ frame: 6, pushed_mm: 7 }));
    expect([body.frame, body.pushed_mm]).toEqual([6, 7]);
  });
});

/** A picture that looks along y: a millimetre is a pixel. */
const eyes: Eyes = { place: (x) => [1000 * x[0], -1000 * x[2], 1], pixel: () => ({ right: [0.001, 0, 0], up: [0, 0, 0.001] }) };

function holding(facts = summary): { hand: Hand; sent: [number, Vec, Vec][]; body: InstanceType<typeof LiveBody> } {
  const sent: [number, Vec, Vec][] = [];
  const body = new LiveBody(facts, 4);
  body.push(message());
  return { hand: new PushHand(body, (...words) => void sent.push(words)), sent, body };
}

describe("a push", () => {
  it("takes hold of what is near, and of nothing else", () => {
    const { hand } = holding();
    expect(hand.grab(300, -300, eyes)).toBe(false);
    expect(hand.name).toBe("");
    expect(hand.grab(10, -300, eyes)).toBe(true);
    expect(hand.name).toBe("trunk");
    expect(hand.grab(0, -300, { ...eyes, place: (x) => [1000 * x[0], -1000 * x[2], -1] })).toBe(false);
  });
  it("is as strong as the pointer went far, at the point that is held", () => {
    const { hand, sent, body } = holding();
    hand.grab(0, -300, eyes);
    hand.tick(0);
    expect(sent).toEqual([]);
    hand.drag(150, -400, eyes);
    hand.tick(10);
    expect(sent).toHaveLength(1);
    expect(sent[0]![0]).toBe(0);
    near(sent[0]![1], [0, 0, 0.3]);
    near(sent[0]![2], [0.15 * dragNPerM, 0, 0.1 * dragNPerM]);
    near(body.goals.push![0], [0, 0, 0.3]);
    near(body.goals.push![1], [0.15, 0, 0.4]);
  });
  it("is said again while it lasts, and its end once", () => {
    const { hand, sent, body } = holding();
    hand.grab(0, -300, eyes);
    hand.drag(150, -300, eyes);
    for (const ms of [0, 50, 100, 150, 199, 200, 399, 401]) hand.tick(ms);
    expect(sent).toHaveLength(3);
    hand.drop();
    hand.drop();
    hand.tick(900);
    expect(sent).toHaveLength(4);
    expect(sent[3]![2]).toEqual([0, 0, 0]);
    expect([hand.force, body.goals.push]).toEqual([null, null]);
  });
  it("is never stronger than the server allows", () => {
    const { hand, sent } = holding();
    hand.grab(0, -300, eyes);
    hand.drag(499, -300, eyes);
    expect(hand.isCapped).toBe(false);
    hand.drag(3000, 2000, eyes);
    hand.tick(0);
    expect(hand.isCapped).toBe(true);
    const force = Math.hypot(...sent[0]![2].map(Math.fround));
    expect(force).toBeLessThan(mostN);
    expect(force).toBeGreaterThan(0.99 * mostN);
  });
});

describe("the controls below the picture", () => {
  function shown(facts = summary): ReturnType<typeof holding> & { tell: () => void; find: (id: string) => FakeElement; key: (type: string, key: string) => void } {
    const made = holding(facts);
    const { node, tell } = livePush(facts, made.body, { hand: made.hand, picture: () => ({ right: [1, 0, 0], up: [0, 0, 1] }), dragging: () => undefined, changed: () => made.hand.tick(0) });
    const all = (n: FakeElement): FakeElement[] => [n, ...n.children.flatMap((c) => ("children" in c ? all(c as FakeElement) : []))];
    const find = (id: string): FakeElement => all(node as unknown as FakeElement).find((n) => n.getAttribute("id") === id)!;
    find("push-force").value = "200";
    find("push-body").value = "1";
    const key = (type: string, name: string): void => {
      for (const [of, listener] of find("push-keys").listeners) if (of === type) listener({ type, key: name, preventDefault: () => undefined, stopPropagation: () => undefined } as unknown as Parameters<typeof listener>[0]);
    };
    return { ...made, tell, find, key };
  }
  it("name the levels with their distances of now", () => {
    const { tell, find } = shown();
    tell();
    expect(find("live-levels").textContent).toBe("Level 1: A, 3.0 mm RMSLevel 2: all others, no goal now");
  });
  it("say of a level of tasks alone that it has no markers, not that it has no goal", () => {
    const { tell, find } = shown({ ...summary, levels: ["A", "com:y=0.9m", "all others"], targets: [{ ...summary.targets[0]! }, { ...summary.targets[1]!, level: 2 }] });
    tell();
    expect(find("live-levels").textContent).toBe("Level 1: A, 3.0 mm RMSLevel 2: com:y=0.9m, no markersLevel 3: all others, no goal now");
  });
  it("push by keys as long as they are held", () => {
    const { sent, key } = shown();
    key("keydown", "ArrowUp");
    key("keydown", "ArrowUp");
    expect(sent).toEqual([[1, [0.1, 0, 0], [0, 0, 200]]]);
    key("keydown", "ArrowRight");
    near(sent[1]![2], [200 * half, 0, 200 * half]);
    key("keyup", "ArrowUp");
    near(sent[2]![2], [200, 0, 0]);
    key("keydown", "a");
    key("blur", "");
    expect(sent).toHaveLength(4);
    expect(sent[3]![2]).toEqual([0, 0, 0]);
    key("blur", "");
    expect(sent).toHaveLength(4);
  });
  it("say that what is pushed is no measurement", () => {
    const { tell, find, key, body } = shown();
    tell();
    expect(find("push-status").textContent).toBe("Nobody pushes the body.");
    key("keydown", "ArrowUp");
    body.push(message({ frame: 8, pushed_mm: 12.34 }));
    tell();
    expect(find("push-status").textContent).toMatch(/^Pushed: 200 N at arm; the body is up to 12\.3 mm from where its goals hold it\. It is a simulation here and no measurement/);
    key("keyup", "ArrowUp");
    tell();
    expect(find("push-status").textContent).toMatch(/by another page or until just now: the body is up to 12\.3 mm .*no measurement/);
    body.push(message({ frame: 9 }));
    tell();
    expect(find("push-status").textContent).toBe("Nobody pushes the body.");
  });
});
