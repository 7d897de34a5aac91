// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, test } from "vitest";
import { baseOf, Channel } from "../../src/editing/channel.ts";
import { isOurs, keyOf } from "../../src/editing/keys.ts";
import * as make from "../../src/editing/operations.ts";

const clock: make.Frames = { firstFrame: 480, frames: 438, rateHz: 100, startS: 4.79 };
const whole: make.Choice = { markers: ["LKNE"], first: null, last: null };

describe("frames", () => {
  test("are those of the file, and times come back to them", () => {
    expect(make.frameAt(clock, 4.79)).toBe(480);
    expect(make.frameAt(clock, 5.0)).toBe(501);
    for (const frame of [480, 499, 700, 917]) expect(make.frameAt(clock, make.timeOf(clock, frame))).toBe(frame);
  });
  test("beyond the recording are its first and last", () => {
    expect(make.frameAt(clock, -3)).toBe(480);
    expect(make.frameAt(clock, 99)).toBe(917);
    expect(make.framesWithin(clock, [-3, 99])).toEqual([480, 917]);
  });
  test("within a span are neither before nor behind it", () => {
    expect(make.framesWithin(clock, [4.795, 4.825])).toEqual([481, 483]);
    expect(make.framesWithin(clock, [4.8, 4.82])).toEqual([481, 483]);
    expect(make.framesWithin(clock, [4.801, 4.802])).toEqual([481, 481]);
  });
});

describe("operations", () => {
  test("are in the words of a journal, and leave out what is not chosen", () => {
    expect(make.cut(whole)).toEqual([{ do: "cut", marker: "LKNE" }]);
    expect(make.cut({ ...whole, first: 500, last: 510 })).toEqual([{ do: "cut", marker: "LKNE", first: 500, last: 510 }]);
    expect(make.swap({ ...whole, first: 500 }, "RKNE")).toEqual([{ do: "swap", marker: "LKNE", with: "RKNE", first: 500 }]);
    expect(make.relabel(whole, " RANK ")).toEqual([{ do: "relabel", marker: "LKNE", to: "RANK" }]);
    expect(make.fill(whole, "pchip")).toEqual([{ do: "fill", marker: "LKNE", method: "pchip" }]);
    expect(make.crop({ ...whole, last: 700 })).toEqual([{ do: "crop", last: 700 }]);
    expect(make.region(whole, "gait", clock)).toEqual([{ do: "region", name: "gait", first: 480, last: 917 }]);
    expect(make.undo(3)).toEqual([{ do: "undo", count: 3 }]);
  });
  test("of several markers are one each", () => {
    expect(make.unfill({ ...whole, markers: ["A", "B"] })).toEqual([
      { do: "unfill", marker: "A" },
      { do: "unfill", marker: "B" },
    ]);
  });
  test("of events name their side where there is one", () => {
    const event = { label: "Foot Strike", context: "Left", time_s: 5.2 };
    expect(make.markEvent({ ...event, label: " Foot Strike " })).toEqual([{ do: "mark", ...event }]);
    expect(make.markEvent({ ...event, context: "" })).toEqual([{ do: "mark", label: "Foot Strike", time_s: 5.2 }]);
    expect(make.moveEvent(event, 5.5)).toEqual([{ do: "move", ...event, to_s: 5.5 }]);
    expect(make.deleteEvent(event)).toEqual([{ do: "delete", ...event }]);
  });
  test("that lack something are a sentence", () => {
    const two = { ...whole, markers: ["A", "B"] };
    const none = { ...whole, markers: [] };
    for (const asked of [make.cut(none), make.fill(none, "auto"), make.swap(two, "C"), make.swap(whole, "LKNE"), make.relabel(whole, " "), make.relabel(two, "C"), make.crop(whole), make.region(whole, "", clock), make.moveEvent(undefined, 1), make.deleteEvent(undefined), make.markEvent({ label: " ", context: "", time_s: 1 })]) {
      expect(asked).toMatch(/^[A-Z].*\.$/);
    }
  });
});

describe("keys", () => {
  const pressed = (key: string, more: object = {}): Parameters<typeof keyOf>[0] => ({ key, ctrlKey: false, metaKey: false, altKey: false, shiftKey: false, target: null, ...more });
  test("undo and redo as everywhere", () => {
    expect(keyOf(pressed("z", { ctrlKey: true }))).toBe("undo");
    expect(keyOf(pressed("z", { metaKey: true }))).toBe("undo");
    expect(keyOf(pressed("Z", { ctrlKey: true, shiftKey: true }))).toBe("redo");
    expect(keyOf(pressed("y", { ctrlKey: true }))).toBe("redo");
  });
  test("leave to the browser what is its own", () => {
    expect(keyOf(pressed("c", { ctrlKey: true }))).toBe("");
    expect(keyOf(pressed("f", { ctrlKey: true }))).toBe("");
    expect(keyOf(pressed("c", { altKey: true }))).toBe("");
    expect(keyOf(pressed("c"))).toBe("c");
  });
  test("are text where somebody types", () => {
    const at = (tagName: string, type = ""): boolean => isOurs(pressed("c", { target: { tagName, type } }));
    expect(["INPUT", "SELECT", "TEXTAREA"].map((t) => at(t, "text"))).toEqual([false, false, false]);
    expect([at("BUTTON"), at("CANVAS"), at("INPUT", "checkbox"), at("INPUT", "range"), isOurs(pressed("c"))]).toEqual([true, true, true, true, true]);
  });
});

describe("the channel", () => {
  const answering = (status: number, body: string, asked: [string, RequestInit | undefined][] = []): Channel =>
    new Channel("/api/trial/3", async (url, init) => {
      asked.push([String(url), init]);
      return new Response(body, { status });
    });
  test("sends an operation with what the page believes", async () => {
    const asked: [string, RequestInit | undefined][] = [];
    const answer = await answering(200, '{"edits":[]}', asked).post(4, { do: "undo", count: 1 });
    expect(asked[0]![0]).toBe("/api/trial/3/edits");
    expect(asked[0]![1]).toMatchObject({ method: "POST", headers: { "Content-Type": "application/json" }, credentials: "omit" });
    expect(JSON.parse(String(asked[0]![1]!.body))).toEqual({ expected: 4, edit: { do: "undo", count: 1 } });
    expect(answer).toEqual({ value: { edits: [] }, state: null, refused: null });
  });
  test("tells a refusal as the server words it, with the state of a conflict", async () => {
    expect(await answering(422, '{"error":"no such marker"}').post(0, { do: "undo" })).toEqual({ value: null, state: null, refused: "no such marker" });
    expect(await answering(409, '{"error":"others","editing":{"edits":[1]}}').state()).toEqual({ value: null, state: { edits: [1] }, refused: "others" });
  });
  test("has a sentence for everything else", async () => {
    for (const status of [401, 413, 421, 500, 503]) expect((await answering(status, "<p>").data()).refused).toMatch(/^[A-Z].*\.$/);
    const dead = new Channel("/api/trial/3", () => Promise.reject(new TypeError("failed")));
    expect((await dead.state()).refused).toMatch(/does not answer.*journal/);
    expect((await answering(200, "no JSON").state()).value).toBeNull();
  });
  test("asks about the trial of the address, and of no other", () => {
    const session = "/0123456789abcdef0123456789abcdef";
    expect(baseOf(`${session}/trial/12`)).toBe(`${session}/api/trial/12`);
    expect(new Channel(`${session}/api/trial/12`).anglesPage("now")).toBe(`${session}/trial/12/angles/now`);
    for (const path of ["/", "/trial/1", `${session}/`, `${session}/trial/`, `${session}/trial/0`, `${session}/trial/1/x`, "/x/trial/1", "/tmp/walk.html", "/trial/1/../2"]) expect(baseOf(path)).toBeNull();
  });
});
