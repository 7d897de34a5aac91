// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it, vi } from "vitest";
import { decodeClean } from "../../src/clean_decode.ts";
import { fake, install, nextFrame, type FakeElement } from "../fake_dom.ts";
import FakePlot from "../fake_plot.ts";
import { inflated } from "../packed.ts";
import { hostile } from "../simulated.ts";
import { simulatedClean } from "../simulated_clean.ts";

install();
vi.mock("uplot", () => ({ default: FakePlot }));
const { cleanGaps } = await import("../../src/sections/clean_gaps.ts");
const { absent, cleanHeader, filledIn, total } = await import("../../src/sections/clean_header.ts");
const { medianOf } = await import("../../src/sections/header.ts");
const { cleanMarker } = await import("../../src/sections/clean_marker.ts");
const { cleanTable, filterText } = await import("../../src/sections/clean_table.ts");
const { charts, gapTable, probability, why } = await import("../../src/sections/marker_facts.ts");
const { recording } = await import("../../src/sections/recording.ts");
const { View } = await import("../../src/view.ts");

const words = (nodes: FakeElement[]): string[] => nodes.map((n) => n.textContent);
const button = (node: FakeElement, name: string): FakeElement =>
  node.tagged("button").find((b) => b.textContent === name || b.getAttribute("aria-label") === name)!;
const whole = [0, 3.99] as const;

describe("cleanHeader", () => {
  it("tells what was measured, made and left out", () => {
    const node = fake(cleanHeader(simulatedClean().summary));
    expect(node.tagged("h1")[0]!.textContent).toBe(`reach ${hostile}`);
    expect(words(node.classed("tile"))).toEqual([
      "400frames4.00 s at 100 Hz",
      "4markers2 white residuals",
      "90 %measured1,440 of 1,600 samples",
      "3.8 %filled in1 gap, 60 samples",
      "6.3 %left missing1 gap left open",
      "0.60 mmmedian noise SDcleaned at 100 × real time",
    ]);
  });
  it("survives an empty recording", () => {
    const { summary } = simulatedClean();
    const none = { missing: 0, measured: 0, interpolated: 0, model_filled: 0, upsampled: 0, rejected: 0 };
    const node = fake(cleanHeader({ ...summary, markers: [], before: none, after: none, clean_s: null }));
    expect(words(node.classed("tile"))[2]).toBe("–measured0 of 0 samples");
    expect(words(node.classed("tile"))[5]).toBe("– mmmedian noise SDper axis");
  });
  it("adds states up", () => {
    const counts = { missing: 1, measured: 2, interpolated: 4, model_filled: 8, upsampled: 16, rejected: 32 };
    expect([total(counts), filledIn(counts), absent(counts)]).toEqual([63, 12, 33]);
    expect([medianOf([3, null, 1, 2]), medianOf([4, 1]), medianOf([null])]).toEqual([2, 2.5, null]);
  });
});

describe("cleanTable", () => {
  const make = () => {
    install();
    const view = new View(whole);
    const node = fake(cleanTable(simulatedClean().summary, view));
    const names = (): string[] => words(node.tagged("tbody")[0]!.tagged("th"));
    return { view, node, names };
  };
  it("holds the numbers of each marker", () => {
    const rows = make().node.tagged("tbody")[0]!.tagged("tr");
    expect(words(rows[2]!.children as FakeElement[])).toEqual(["B", "0.900", "kalman, order 4", "9.0", "0.380", "white", "15", "12.0", "0"]);
    expect(words(rows[3]!.children as FakeElement[])).toEqual(["C", "0.600", "kalman, order 3", "10.0", "0.380", "not white", "0", "–", "25.3"]);
    expect(rows.at(0)!.tagged("button")[0]!.textContent).toBe(hostile);
  });
  it("sorts by noise from the largest, the unknown last", () => {
    const { node, names } = make();
    node.tagged("thead")[0]!.tagged("button").find((b) => b.textContent.startsWith("Noise SD"))!.fire("click");
    expect(names()).toEqual(["B", "C", "A", hostile]);
  });
  it("chooses the marker that is clicked and marks the one that is chosen elsewhere", () => {
    const { view, node } = make();
    node.tagged("tbody")[0]!.tagged("tr")[3]!.tagged("button")[0]!.fire("click");
    expect(view.marker).toBe(2);
    nextFrame();
    expect(words(node.classed("chosen")[0]!.tagged("th"))).toEqual(["C"]);
  });
  it("names filters as people do", () => {
    const m = simulatedClean().summary.markers[0]!;
    expect(filterText(m)).toBe("kalman, order 3");
    expect(filterText({ ...m, method: "classic", order: 0 })).toBe("classic");
    expect(filterText({ ...m, method: "none" })).toBe("none");
  });
});

describe("cleanGaps", () => {
  it("shows the states after cleaning, and those before on request", () => {
    install();
    const made = cleanGaps(decodeClean(inflated(simulatedClean())), new View(whole));
    made.start();
    const node = fake(made.node);
    const canvas = node.tagged("canvas")[0]!;
    const readout = (): string => {
      canvas.fire("mousemove", { offsetX: 217 + (1.3 / 3.99) * 403, offsetY: 4 + 14 + 5 });
      return node.classed("readout")[0]!.textContent;
    };
    expect(readout()).toBe("B at 1.300 s: filled from other markers");
    button(node, "As it came in").fire("click");
    expect(readout()).toBe("B at 1.300 s: missing");
    expect(node.classed("choice").map((b) => b.getAttribute("aria-pressed"))).toEqual(["true", "false"]);
    button(node, "After cleaning").fire("click");
    expect(readout()).toContain("filled");
    expect(node.tagged("li").length).toBe(6);
  });
});

describe("cleanMarker", () => {
  const make = (change: (data: ReturnType<typeof simulatedClean>) => void = () => undefined) => {
    install();
    FakePlot.made = [];
    const data = simulatedClean();
    change(data);
    const view = new View(whole);
    view.marker = 1;
    const show = vi.fn();
    const { node, start } = cleanMarker(decodeClean(inflated(data)), view, show);
    start();
    return { view, show, node: fake(node), plots: FakePlot.made };
  };
  const column = (plot: FakePlot, k: number): (number | null)[] => plot.data[k] as (number | null)[];

  it("draws one plot per axis: band, what came in, the result", () => {
    const { plots } = make();
    expect(plots.map((p) => p.axes[1]!.label)).toEqual(["x (mm)", "y (mm)", "z (mm)"]);
    const [upper, lower, raw, line] = [1, 2, 3, 4].map((k) => column(plots[0]!, k)[10]!);
    expect(upper! - line!).toBeCloseTo(0.5, 4);
    expect(line! - lower!).toBeCloseTo(0.5, 4);
    expect(raw! - line!).toBeCloseTo(0.5, 4);
    expect(column(plots[0]!, 1)[130]! - column(plots[0]!, 4)[130]!).toBeCloseTo(24, 4);
    expect(column(plots[0]!, 3)[130]).toBeNull();
  });
  it("draws what was filled in another colour, joined to the rest", () => {
    const { plots } = make();
    const filled = column(plots[2]!, 7);
    expect(filled.findIndex((v) => v !== null)).toBe(99);
    expect(filled.filter((v) => v !== null).length).toBe(62);
    expect(column(plots[2]!, 5).every((v) => v === null)).toBe(true);
    const colours = new Set(plots[0]!.drawnSeries().map((s) => s.stroke(plots[0])));
    expect(colours.size).toBe(6);
  });
  it("stripes what is missing or rejected, and draws nothing there", () => {
    const { view, plots } = make();
    view.set({ marker: 2 });
    nextFrame();
    expect(column(plots[0]!, 4)[250]).toBeNull();
    plots[0]!.hook("drawClear");
    const rects = plots[0]!.ctx.drawn.filter((d) => d.what === "rect").map((d) => d.numbers);
    expect(rects.length).toBe(2);
    expect(rects[1]![0]).toBeCloseTo(100 + (1000 * 1.995) / 3.99, 3);
    expect(rects[1]![2]).toBeCloseTo((1000 * 1.0) / 3.99, 3);
  });
  it("shows velocity, acceleration and what was taken away", () => {
    const { node, plots } = make();
    button(node, "Velocity").fire("click");
    expect(plots[1]!.axes[1]!.label).toBe("y (m/s)");
    expect(column(plots[0]!, 4)[0]).toBeCloseTo(0.2, 5);
    expect(column(plots[0]!, 3).every((v) => v === null)).toBe(true);
    button(node, "Acceleration").fire("click");
    expect(column(plots[0]!, 1).every((v) => v === null)).toBe(true);
    button(node, "Taken away").fire("click");
    expect(column(plots[0]!, 4)[10]).toBe(0);
    expect(column(plots[0]!, 3)[10]).toBe(0.5);
    expect(column(plots[0]!, 1)[130]).toBe(24);
    expect(node.classed("choice").map((b) => b.getAttribute("aria-pressed"))).toEqual(["false", "true", "false", "false"]);
  });
  it("says when the result does not have it", () => {
    const { view, node, plots } = make();
    view.set({ marker: 2 });
    nextFrame();
    button(node, "Velocity").fire("click");
    const note = node.all((e) => e.textContent === "The result holds no velocity of this marker.")[0]!;
    expect(note.hidden).toBe(false);
    expect(column(plots[0]!, 4).every((v) => v === null)).toBe(true);
    button(node, "Position").fire("click");
    expect(note.hidden).toBe(true);
  });
  it("reads values under the pointer, with where they come from", () => {
    const { view, node } = make();
    const readout = (time: number | null): string => {
      view.set({ pointer: time });
      nextFrame();
      return node.all((e) => e.getAttribute("id") === "marker-readout")[0]!.textContent;
    };
    expect(readout(null)).toContain("Point at a plot");
    expect(readout(0)).toBe("0.000 s, frame 0, measured: x 200.00 ± 0.25, y 252.07 ± 0.25, z 265.46 ± 0.25 mm");
    expect(readout(1.3)).toMatch(/^1\.300 s, frame 130, filled from other markers: x .* ± 12\.00/);
    button(node, "Taken away").fire("click");
    expect(readout(1.3)).toBe("1.300 s, frame 130, filled from other markers: nothing came in");
    view.set({ marker: 2 });
    expect(readout(2.5)).toBe("2.500 s, frame 250, missing: no value");
  });
  it("goes round with the arrows and follows the list", () => {
    const { view, node } = make();
    button(node, "Next marker").fire("click");
    expect(view.marker).toBe(2);
    for (const expected of [1, 0, 3]) {
      button(node, "Marker before").fire("click");
      expect(view.marker).toBe(expected);
    }
    const picker = node.tagged("select")[0]! as FakeElement & { selectedIndex: number };
    picker.selectedIndex = 1;
    picker.fire("change");
    expect(view.marker).toBe(1);
  });
  it("jumps to a gap from its row", () => {
    const { node, show } = make();
    node.classed("link")[0]!.fire("click");
    expect(show).toHaveBeenCalledExactlyOnceWith("B", 1, 0.6);
  });
  it("says how it was thinned, and nothing of frames it does not have", () => {
    const { node, view } = make((data) => {
      data.series.frame_step = 5;
      data.summary.frames = 2000;
    });
    expect(node.classed("thinned")[0]!.textContent).toContain("every 10 frames (0.100 s)");
    view.set({ pointer: 1 });
    nextFrame();
    expect(node.textContent).toContain("frame ≈ 100");
  });
  it("is quiet without markers", () => {
    const { plots } = make((data) => {
      data.summary.markers = [];
      data.series.markers = [];
    });
    expect(plots).toEqual([]);
  });
});

describe("the facts of a marker", () => {
  const { summary } = simulatedClean();
  const m = summary.markers[1]!;
  it("say why", () => {
    const text = fake(why({ ...m, upsampling_factor: 3, upsampling_kernel: "linear", band: "low-passed", bad_variances: 2 })).textContent;
    for (const part of [
      "the least estimated risk",
      "Noise 0.900 mm per axis, as found in the data.",
      "took away 0.380 mm",
      "consistent with white noise (p = 0.400)",
      "made 2 of 3 samples (linear)",
      "low-passed",
      "2 variances",
      "times 1.10, 1.20, 1.30, 1.40",
    ]) {
      expect(text).toContain(part);
    }
    const silent = fake(why({ ...m, noise_sd_mm: null, residual_rms_mm: null, white: null, white_p: null, bar_scale: [1, 1, 1, 1] })).textContent;
    expect(silent).toContain("could not be tested");
    expect(silent).not.toContain("consistent with white");
    const coloured = fake(why(summary.markers[2]!)).textContent;
    expect(coloured).toContain("not white (p < 0.001). 31 % of the noise power lies too low in frequency");
    expect(coloured).not.toContain("consistent");
    expect(silent).not.toContain("Noise");
    expect(silent).not.toContain("times");
  });
  it("write probabilities as people do", () => {
    expect([0.5, 1e-9, null].map(probability)).toEqual(["p = 0.500", "p < 0.001", "p unknown"]);
  });
  it("hold both charts and the filters that were tried", () => {
    const node = fake(charts(m));
    expect(node.tagged("svg").length).toBe(2);
    expect(words(node.tagged("tbody")[0]!.tagged("tr"))).toEqual(["27.02.000e-8", "38.03.000e-8", "4, taken9.04.000e-8", "510.0–"]);
    const none = fake(charts(summary.markers[3]!));
    expect(none.tagged("svg").length).toBe(0);
    expect(none.textContent).toContain("No span without gaps is long enough");
    expect(fake(charts({ ...m, tried: [] })).tagged("table")).toEqual([]);
  });
  it("tell what became of each gap", () => {
    const row = (k: number): string[] => words(fake(gapTable(summary.markers[k]!, summary, vi.fn())).tagged("tbody")[0]!.tagged("tr")[0]!.children as FakeElement[]);
    expect(row(1)).toEqual(["1.000", "0.600", "filled, auto: 70 % rigid; 30 % cubic", "8.00", "12.00", "40 artificial gaps of 0.60 s", `A, ${hostile}; not trusted: C`]);
    expect(row(2)[2]).toBe(`left open: The gap is too long. ${hostile}`);
    expect(row(2)[5]).toBe("–");
    expect(fake(gapTable(summary.markers[0]!, summary, vi.fn())).textContent).toBe("No gaps.");
  });
  it("admit gaps that are not on the page", () => {
    const cut = { ...summary, gaps: [] };
    const node = fake(gapTable({ ...m, gaps_filled: 3 }, cut, vi.fn()));
    expect(node.textContent).toContain("3 more gaps of this marker");
    expect(node.tagged("table")).toEqual([]);
  });
});

describe("recording", () => {
  it("lists defects and jumps to them", () => {
    const show = vi.fn();
    const node = fake(recording(simulatedClean().summary, show));
    const [row] = node.tagged("tbody")[0]!.tagged("tr");
    expect(words(row!.children as FakeElement[])).toEqual(["0.500", "spike", "C", "1", "97", `C leaves its path. ${hostile}`, "rejected"]);
    row!.fire("click");
    expect(show).toHaveBeenCalledExactlyOnceWith("C", 0.5, 0);
    expect(words(node.tagged("li"))).toEqual(["No stream was interpolated.", hostile]);
  });
  it("names both markers of a swap, and all when it is all", () => {
    const { summary } = simulatedClean();
    const [d] = summary.defects;
    const defects = [{ ...d!, other_marker: "A", first_time_s: 0 }, { ...d!, marker: "", first_time_s: 1 }];
    const node = fake(recording({ ...summary, defects, defect_count: 12 }, vi.fn()));
    const rows = node.tagged("tbody")[0]!.tagged("tr").map((r) => words(r.children as FakeElement[])[2]);
    expect(rows).toEqual(["C and A", "all"]);
    expect(node.textContent).toContain("The 2 longest; 10 more");
  });
  it("says when nothing was found and when nobody looked", () => {
    const { summary } = simulatedClean();
    const node = fake(recording({ ...summary, defects: [], defect_count: 0, upsampling: { looked: false, factor: 1, done: "", handled: false, sentences: [] } }, vi.fn()));
    expect(node.textContent).toContain("Nobody looked");
    expect(node.textContent).toContain("No spike, swap, stuck value");
  });
});
