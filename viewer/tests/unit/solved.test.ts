// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { AnglesState, SolutionFacts } from "../../src/page_types.ts";
import { beforeEach, describe, expect, it, vi } from "vitest";
import FakePlot from "../fake_plot.ts";
import { fake, install } from "../fake_dom.ts";
import { inflated } from "../packed.ts";
import { simulated } from "../simulated.ts";

vi.mock("uplot", () => import("../fake_plot.ts"));
install();
Object.assign(document, { addEventListener: () => undefined });
const { decode } = await import("../../src/decode.ts");
const { Channel } = await import("../../src/editing/channel.ts");
const { coordinateChanges } = await import("../../src/editing/differences.ts");
const { compare } = await import("../../src/sections/compare.ts");
const { changeWords, SolvedAngles } = await import("../../src/sections/solved.ts");
const { View, wholeOf } = await import("../../src/view.ts");

describe("coordinateChanges", () => {
  it("has nothing to say of a solution and itself", () => {
    expect(coordinateChanges(decode(inflated(simulated())), decode(inflated(simulated())))).toEqual([]);
  });
  it("tells how far, when, and whether it is more than the standard deviations", () => {
    const [now, old] = [decode(inflated(simulated())), decode(inflated(simulated()))];
    const { value, sd } = now.coordinates[0]!;
    value[40] = value[40]! + 3 * sd![40]!;
    value[50] = value[50]! - 1.5 * sd![50]!;
    const [change, ...more] = coordinateChanges(now, old);
    expect(more).toEqual([]);
    expect(change).toMatchObject({ name: now.summary.coordinates[0]!.name, time: now.time[40], beyond: 1, came: 0, went: 0 });
    expect(change!.largest).toBeCloseTo(3 * sd![40]!, 3);
    expect(changeWords(change!)).toMatch(/^at most [\d.]+ deg more; beyond two standard deviations in 1 of/);
  });
  it("counts what is determined now and what is no longer", () => {
    const [now, old] = [decode(inflated(simulated())), decode(inflated(simulated()))];
    old.coordinates[0]!.value[10] = NaN;
    now.coordinates[0]!.value[11] = now.coordinates[0]!.value[12] = NaN;
    const [change] = coordinateChanges(now, old);
    expect(change).toMatchObject({ largest: 0, came: 1, went: 2 });
    expect(changeWords(change!)).toBe("determined in 1 more frame; no longer determined in 2 frames");
  });
  it("compares the same times of a cropped recording, and coordinates by name", () => {
    const [now, old] = [decode(inflated(simulated())), decode(inflated(simulated()))];
    now.time = now.time.slice(100);
    now.coordinates.forEach((c) => (c.value = c.value.slice(100)));
    expect(coordinateChanges(now, old)).toEqual([]);
    old.summary.coordinates.forEach((c) => (c.name += "?"));
    expect(coordinateChanges(now, old)).toEqual([]);
  });
});

describe("compare with what lies over it", () => {
  it("draws it dashed from the start, and shows what changed most first", () => {
    FakePlot.made = [];
    const [now, old] = [decode(inflated(simulated())), decode(inflated(simulated()))];
    old.coordinates.forEach((c) => (c.value = c.value.map((v) => v + 5)));
    const last = now.summary.coordinates.at(-1)!.name;
    const { node, start } = compare(now, new View(wholeOf(now.summary)), { trial: old, words: "as recorded", first: [last] });
    start();
    expect(fake(node).textContent).toContain("Dashed over it: the solution as recorded, angles 5.00 deg apart RMS.");
    expect(fake(node).tagged("figcaption")[0]!.textContent).toContain(last);
    expect(fake(node).all((e) => e.getAttribute("type") === "file")).toEqual([]);
    const data = FakePlot.made[0]!.data as number[][];
    expect(data[7]![50]! - data[3]![50]!).toBeCloseTo(5, 3);
  });
});

describe("the channel of angles", () => {
  it("asks, stops and fetches reports of one trial", async () => {
    const asked: [string, RequestInit | undefined][] = [];
    const channel = new Channel("/api/trial/3", async (url, init) => {
      asked.push([String(url), init]);
      return new Response("{}", { status: 202 });
    });
    await channel.angles();
    await channel.askAngles("stop");
    expect(await channel.anglesHtml("before")).toEqual({ html: "{}" });
    expect(asked.map(([url]) => url)).toEqual(["/api/trial/3/angles", "/api/trial/3/angles", "/trial/3/angles/before"]);
    expect(asked[1]![1]).toMatchObject({ method: "POST", headers: { "Content-Type": "application/json" }, body: '{"do":"stop"}' });
  });
  it("has a sentence where there are none, or nobody answers", async () => {
    const answering = (status: number) => new Channel("/api/trial/3", async () => new Response("<p>", { status }));
    expect(await answering(404).anglesHtml("now")).toEqual({ refused: expect.stringMatching(/no longer there/) as string });
    expect(await answering(401).anglesHtml("now")).toEqual({ refused: expect.stringMatching(/no longer let in/) as string });
    const dead = new Channel("/api/trial/3", () => Promise.reject(new TypeError("failed")));
    expect(await dead.anglesHtml("now")).toEqual({ refused: expect.stringMatching(/does not answer/) as string });
  });
});

describe("the section", () => {
  const facts = (edits: number): SolutionFacts => ({ digest: `d${edits}`, edits, set: `s${edits}`, verdict: "attention", attentions: 2, rms_mm: 3.21 });
  const idle: AnglesState = { model: "subject.osim", state: "none", said: null, done: 0, of: 0, solutions: { now: null, before: null, recorded: null } };
  const solved: AnglesState = { ...idle, state: "solved", solutions: { now: facts(2), before: facts(1), recorded: facts(0) } };
  const page = `<script type="application/json" id="kinemark-data">${JSON.stringify(simulated()).replaceAll("<", "\\u003c")}</script>`;
  let state: AnglesState | number = idle;
  let posted: string[] = [];
  let redrawn = 0;
  const view = new View(wholeOf(decode(inflated(simulated())).summary));
  const made = () => {
    const channel = new Channel("/api/trial/3", async (url, init) => {
      if (init?.method === "POST") posted.push(String(init.body));
      if (String(url).includes("/angles/")) return new Response(page);
      if (typeof state === "number") return new Response('{"error":"No room."}', { status: state });
      return new Response(JSON.stringify(state), { status: 200 });
    });
    const part: InstanceType<typeof SolvedAngles> = new SolvedAngles(channel, async () => {
      ++redrawn;
      part.show(view, "d2");
      part.start();
      return null;
    }, () => true);
    part.show(view, "d2");
    return part;
  };
  const words = (part: InstanceType<typeof SolvedAngles>): string => fake(part.node).textContent;
  const button = (part: InstanceType<typeof SolvedAngles>, name: string) => fake(part.node).tagged("button").find((b) => b.textContent === name)!;
  const until = (done: () => boolean) => vi.waitFor(() => expect(done()).toBe(true));
  beforeEach(() => {
    [state, posted, redrawn, FakePlot.made] = [idle, [], 0, []];
  });

  it("says which model there is, and why there is none", async () => {
    const part = made();
    await part.lookAgain();
    expect(words(part)).toContain("Not solved yet; the model is subject.osim.");
    expect(button(part, "Solve").disabled).toBe(false);
    state = { ...idle, model: null, said: "No body model is known for walk.c3d." };
    await part.lookAgain();
    expect(words(part)).toContain("No body model is known");
    expect(button(part, "Solve").disabled).toBe(true);
  });
  it("follows what is solved and lays the new angles over those as recorded", async () => {
    const part = made();
    await part.lookAgain();
    state = { ...idle, state: "solving", done: 30, of: 100 };
    button(part, "Solve").fire("click");
    await until(() => words(part).includes("Solving: 30 of 100 frames."));
    expect(posted).toEqual(['{"do":"solve"}']);
    expect(button(part, "Stop").hidden).toBe(false);
    expect(button(part, "Solve").disabled).toBe(true);
    state = solved;
    await until(() => redrawn === 1);
    expect(words(part)).toContain("Solved with 2 edits and subject.osim: markers 3.21 mm from the model RMS, 2 findings need attention.");
    expect(words(part)).toContain("No coordinate differs from the solution as recorded.");
    expect(FakePlot.made.length).toBeGreaterThan(0);
    expect(fake(part.curves).textContent).toContain("the solution as recorded");
    expect(button(part, "Stop").hidden).toBe(true);
  });
  it("says when the recording was edited since", async () => {
    const part = made();
    state = solved;
    await part.lookAgain();
    await until(() => redrawn === 1);
    expect(words(part)).not.toContain("edited since");
    part.show(view, "d3");
    await part.lookAgain();
    expect(words(part)).toContain("The recording was edited since: solve it again.");
    expect(redrawn).toBe(1);
  });
  it("keeps what was there when something is refused or stopped", async () => {
    const part = made();
    state = solved;
    await part.lookAgain();
    await until(() => redrawn === 1);
    state = 503;
    button(part, "Solve").fire("click");
    await until(() => words(part).includes("No room."));
    expect(fake(part.curves).textContent).not.toBe("");
    state = { ...solved, state: "stopped" };
    await part.lookAgain();
    expect(words(part)).toContain("Stopped. What was solved before is still there.");
  });
});
