// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { problemsOf } from "../../schema/problems.ts";
import type { DeskRequest } from "../../src/desk/channel.ts";
import type { DeskPage, DeskSeen, DeskState } from "../../src/page_types.ts";
import { fake, FakeElement, install } from "../fake_dom.ts";

install();
Object.assign(globalThis, { location: { pathname: "/00/", hash: "" } });
const { DeskChannel } = await import("../../src/desk/channel.ts");
const { countOf, room } = await import("../../src/desk/setup.ts");
const { trouble } = await import("../../src/desk/leds.ts");
const { deskPage } = await import("../../src/pages/desk.ts");

const seen = (more: Partial<DeskSeen> = {}): DeskSeen => ({ light_counts: 800, highest_share: 0.5, noise_counts: 1.25, occluded_share: 0, saturated_share: 0, spots: [[0.5, -0.25], [0.4, -0.25]], ...more });
const wanted = { source: "sim:rig", leds: "2", rate_hz: "", duration_s: "", subject: "", trial: "01" };
const device = { name: "rig 1986", most_leds: 8, cameras: 1, bits: 12, sets_intensity: true, slot_us: 905, highest_rates_hz: [1105, 552.5] };
const source: DeskState = { step: "source", message: "", sources: [{ uri: "sim:rig", name: "Simulated rig", state: "" }, { uri: "serial:/dev/ttyACM0", name: "Arduino", state: "in use" }], device: null, wanted: { ...wanted, source: "" }, granted: null, duration_s: 0, live: null, check: [], kept: [] };
const plan: DeskState = { ...source, step: "plan", device, wanted };
const live: DeskState = {
  ...plan, step: "live", granted: { leds: ["elbow", "wrist"], cameras: ["A"], rate_hz: 138, intensity: [1, 0.8] },
  live: { frames: 1234, acknowledged: 0, dropped_by_device: 0, dropped_here: 0, recorded_s: 0, guide: "roll camera A clockwise by 0.6 deg", seen: [[seen()], [seen({ occluded_share: 1, noise_counts: null, spots: [] })]] },
};
const recording: DeskState = { ...live, step: "recording", duration_s: 20, live: { ...live.live!, acknowledged: 1200, dropped_by_device: 3, dropped_here: 1, recorded_s: 9.94 } };
const check: DeskState = { ...live, step: "check", check: [{ good: true, text: "No frame was lost" }, { good: false, text: "wrist is dark in camera A: look at its wire" }] };

/** A server that answers with these states, one a request, the last again and again. */
function serving(...states: (DeskState | Error | [number, unknown])[]) {
  const asked: (DeskRequest | null)[] = [], waits: number[] = [];
  let again: () => void = () => undefined;
  const ask = ((_url: string, init: RequestInit) => {
    asked.push(init.body === undefined ? null : (JSON.parse(init.body as string) as DeskRequest));
    const next = states.length > 1 ? states.shift()! : states[0]!;
    if (next instanceof Error) return Promise.reject(next);
    const [status, json] = Array.isArray(next) ? next : [200, next];
    return Promise.resolve({ ok: status < 400, status, json: () => Promise.resolve(json) } as Response);
  }) as typeof fetch;
  return { asked, waits, around: { ask, later: (task: () => void, ms: number) => void (waits.push(ms), (again = task)) }, again: () => again() };
}
const settled = (): Promise<void> => new Promise((done) => setTimeout(done));

/** The page after the first answer. */
async function shown(...states: (DeskState | Error | [number, unknown])[]) {
  const server = serving(...states);
  const content = deskPage({ summary: { schema: "kinemark.desk", schema_version: 1, trial: "Acquisition", source: "sim:rig", version: "1", folder: "day" } } satisfies DeskPage, server.around);
  const page = new FakeElement("body");
  page.append(...[content.header, content.bar, ...content.sections].map(fake));
  content.start();
  await settled();
  const click = async (words: string): Promise<void> => {
    page.tagged("button").find((b) => b.textContent === words)!.fire("click");
    await settled();
  };
  const byId = (id: string): FakeElement => page.all((e) => e.getAttribute("id") === id)[0]!;
  return { ...server, page, click, byId, next: async () => { server.again(); await settled(); } };
}

describe("the states that tests show", () => {
  it.each(Object.entries({ source, plan, live, recording, check }))("%s follows the schema", (_, state) => expect(problemsOf(state, "DeskState")).toEqual([]));
});

describe("a step", () => {
  it("source: what is there can be opened, what is not says why, and an address can be typed", async () => {
    const { page, click, asked, byId } = await shown(source);
    expect(page.classed("missed").map((e) => e.textContent)).toEqual(["Arduino: in use"]);
    await click("Look again");
    page.tagged("button")[1]!.fire("click");
    byId("desk-address").value = " sim:rig?leds=2 ";
    page.tagged("form")[0]!.fire("submit");
    expect(asked).toEqual([null, { do: "look" }, { do: "open", uri: "serial:/dev/ttyACM0" }, { do: "open", uri: "sim:rig?leds=2" }]);
  });
  it("source: where nothing is found it is said what to do", async () => {
    const { page } = await shown({ ...source, sources: [] });
    expect(page.tagged("p").find((p) => p.textContent.startsWith("No device was found"))!.hidden).toBe(false);
  });
  it("set-up: lines as typed are sent, and what the LEDs leave room for is told as they are typed", async () => {
    const { page, byId, asked, click } = await shown(plan);
    expect(page.textContent).toContain("rig 1986: up to 8 LEDs, 1 camera, 12 bits");
    expect(byId("desk-room").textContent).toBe("2 LEDs: 552.5 Hz at most, a slot of 905 us for each");
    byId("desk-leds").value = "wrist";
    byId("desk-leds").fire("input");
    expect(byId("desk-room").textContent).toContain("1 LED: 1,105.0 Hz");
    byId("desk-rate_hz").value = "100 ";
    page.tagged("form")[0]!.fire("submit");
    await settled();
    await click("Another source");
    expect(asked.slice(1)).toEqual([{ do: "start", leds: "wrist", rate_hz: "100", duration_s: "", subject: "", trial: "01" }, { do: "leave_source" }]);
  });
  it("live: detectors, levels, what is wrong, and the guide", async () => {
    const { page, byId, click, asked } = await shown(live);
    expect(byId("desk-title").textContent).toBe("Live: 2 LEDs, 1 camera, 138 Hz");
    expect(byId("desk-frames").textContent).toBe("1,234 frames");
    expect(byId("desk-guide").textContent).toBe("Alignment: roll camera A clockwise by 0.6 deg");
    expect(page.tagged("circle").map((c) => [c.getAttribute("cx"), c.getAttribute("cy"), c.getAttribute("visibility")])).toEqual([["0.5", "-0.25", null], ["0", "0", "hidden"]]);
    expect(page.classed("trail").map((t) => t.getAttribute("d"))).toEqual(["M0.5 -0.25h0M0.4 -0.25h0", ""]);
    expect(page.tagged("td").map((td) => td.textContent)).toEqual(["100 %", "1.3", "80 %", "–dark"]);
    expect(page.tagged("meter")[0]!.getAttribute("value")).toBe("0.5");
    await click("Align anew");
    await click("Record 01");
    await click("Set-up");
    expect(asked.slice(1)).toEqual([{ do: "restart_guide" }, { do: "record" }, { do: "set_up" }]);
  });
  it("live: where there is no guide there is nothing to align anew", async () => {
    const { page } = await shown({ ...live, live: { ...live.live!, guide: "" } });
    expect(page.classed("desk-guide")[0]!.hidden).toBe(true);
  });
  it("live: the light of an LED is set by who moves its slider, and stays under his hand", async () => {
    const { page, asked, next } = await shown(live);
    const slider = page.tagged("input")[1]!;
    expect([slider.getAttribute("aria-label"), slider.value]).toEqual(["Light of wrist", "0.8"]);
    slider.value = "0.5";
    slider.fire("input");
    await next();
    expect(slider.value).toBe("0.5");
    slider.fire("change");
    await settled();
    expect(asked).toContainEqual({ do: "intensity", led: 1, value: 0.5 });
    await next();
    expect(slider.value).toBe("0.8");
  });
  it("live: a device that sets no light has no slider", async () => {
    const { page } = await shown({ ...live, device: { ...device, sets_intensity: false } });
    expect(page.tagged("input").length).toBe(0);
    expect(page.tagged("td")[0]!.textContent).toBe("100 %");
  });
  it("recording: how long, what is kept, and who lost what", async () => {
    const { page, click, asked } = await shown(recording);
    expect(page.tagged("dd").map((d) => d.textContent)).toEqual(["9.9", "1,234", "1,200", "3", "1"]);
    expect(page.tagged("dt")[0]!.textContent).toBe("s of 20");
    expect(page.tagged("input").length).toBe(0);
    await click("Stop");
    expect(asked[1]).toEqual({ do: "stop" });
  });
  it("check: a trial is discarded by who says so twice", async () => {
    const { page, click, asked, byId } = await shown(check);
    expect(page.classed("level").map((e) => e.textContent)).toEqual(["Good", "Look"]);
    await click("Discard");
    expect(asked.length).toBe(1);
    expect([byId("desk-sure").textContent, byId("desk-sure").parent!.hidden]).toEqual(["Discard 01? Its frames are gone then.", false]);
    expect(FakeElement.focused?.textContent).toBe("Back");
    await click("Back");
    expect(byId("desk-sure").parent!.hidden).toBe(true);
    await click("Discard");
    await click("Discard it");
    await click("Keep");
    expect(asked.slice(1)).toEqual([{ do: "discard" }, { do: "keep" }]);
  });
});

describe("the page", () => {
  it("goes with the state, marks the step, and takes keyboards to its heading", async () => {
    const { byId, next, page, asked } = await shown(plan, live, { ...live, message: "Kept: day/01.mcap", kept: ["day/01.mcap"] });
    FakeElement.focused = null;
    await next();
    expect(page.all((e) => e.getAttribute("aria-current") === "step").map((e) => e.textContent)).toEqual(["Live"]);
    expect(FakeElement.focused).toBe(byId("desk-title"));
    expect(byId("kept").hidden).toBe(true);
    await next();
    expect([byId("desk-message").textContent, byId("desk-message").getAttribute("class")]).toEqual(["Kept: day/01.mcap", "live-sentence done"]);
    expect([byId("kept").hidden, page.classed("desk-kept")[0]!.textContent]).toEqual([false, "day/01.mcap"]);
    expect(asked).toEqual([null, null, null]);
  });
  it("says that the program has ended", async () => {
    const { page } = await shown({ ...source, step: "ended" });
    expect(page.textContent).toContain("Start 'kinemark serve' again");
  });
  it("refuses a version that it does not know", () => {
    expect(() => deskPage({ summary: { schema: "kinemark.desk", schema_version: 2, trial: "", source: "", version: "", folder: "" } } as unknown as DeskPage)).toThrow("version 2");
  });
});

describe("the channel", () => {
  const channel = (...states: (DeskState | Error | [number, unknown])[]) => {
    const server = serving(...states);
    return { ...server, to: new DeskChannel("/00/api/desk", () => undefined, server.around) };
  };
  it("looks often while a device runs, and rarely otherwise", async () => {
    const { to, waits } = channel(plan, live, recording, check);
    for (let i = 0; i < 4; ++i) await to.look();
    expect(waits).toEqual([1000, 100, 100, 1000]);
  });
  it("says that the connection is lost, and that it is back", async () => {
    const { to, waits } = channel(live, new Error("gone"), live);
    await to.look();
    await to.look();
    expect([to.lost.startsWith("The connection to the server is lost"), to.state?.step]).toEqual([true, "live"]);
    await to.look();
    expect([to.lost, waits]).toEqual(["", [100, 1000, 100]]);
  });
  it("knows that it is no longer let in", async () => {
    const { to } = channel([401, null]);
    await to.look();
    expect(to.lost).toContain("no longer let in");
  });
  it("keeps the sentence of a refusal until something else is asked", async () => {
    const { to } = channel([400, { error: "need the address" }], [503, null], live);
    await to.post({ do: "open", uri: "" });
    expect(to.refused).toBe("need the address");
    await to.post({ do: "look" });
    expect(to.refused).toContain("status 503");
    await to.post({ do: "look" });
    expect([to.refused, to.state?.step]).toEqual(["", "live"]);
  });
  it("takes no answer that is older than what was asked since", async () => {
    const answers: ((state: DeskState) => void)[] = [];
    const ask = (() => new Promise((done) => answers.push((state) => done({ ok: true, status: 200, json: () => Promise.resolve(state) } as Response)))) as unknown as typeof fetch;
    const to = new DeskChannel("/", () => undefined, { ask, later: () => undefined });
    const looked = to.look(), posted = to.post({ do: "record" });
    answers[1]!(recording);
    await posted;
    answers[0]!(live);
    await looked;
    expect(to.state?.step).toBe("recording");
  });
});

describe("words", () => {
  it("LEDs are counted as they are typed", () => {
    expect(["3", " 12 ", "a", "a, b,c"].map(countOf)).toEqual([3, 12, 1, 3]);
    expect(room(device, 3)).toBe("");
  });
  it("what is wrong with an LED is one word, the worst", () => {
    expect([seen(), seen({ occluded_share: 0.123 }), seen({ occluded_share: 0.1, saturated_share: 0.1 }), seen({ occluded_share: 1, saturated_share: 0.1 })].map(trouble)).toEqual(["", "12 %", "clips", "dark"]);
  });
});
