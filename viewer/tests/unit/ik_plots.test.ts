// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it, vi } from "vitest";
import { decode } from "../../src/decode.ts";
import { fake, FakeElement, install, nextFrame, type Drawn } from "../fake_dom.ts";
import FakePlot from "../fake_plot.ts";
import { inflated } from "../packed.ts";
import { simulated } from "../simulated.ts";

install();
vi.mock("uplot", () => ({ default: FakePlot }));
const { drawSmallMultiple } = await import("../../src/plots/small_multiple.ts");
const { angles } = await import("../../src/sections/angles.ts");
const { markers } = await import("../../src/sections/markers.ts");
const { palette } = await import("../../src/theme.ts");
const { View } = await import("../../src/view.ts");

const withId = (node: FakeElement, id: string): FakeElement => node.all((e) => e.getAttribute("id") === id)[0]!;
const column = (plot: FakePlot, k: number): (number | null)[] => plot.data[k] as (number | null)[];

describe("angles", () => {
  const make = (change: (data: ReturnType<typeof simulated>) => void = () => undefined) => {
    install();
    FakePlot.made = [];
    const data = simulated();
    change(data);
    const view = new View([0, 3.99]);
    const made = angles(decode(inflated(data)), view);
    made.start();
    return { view, node: fake(made.node), plot: FakePlot.made[0]! };
  };
  it("draw the chosen coordinate with its band and its unit", () => {
    const { view, plot } = make();
    expect(plot.axes[1]!.label).toBe("angle (deg)");
    expect(column(plot, 1)[0]! - column(plot, 3)[0]!).toBeCloseTo(3, 5);
    expect(column(plot, 3)[0]! - column(plot, 2)[0]!).toBeCloseTo(3, 5);
    view.set({ coordinate: 2 });
    nextFrame();
    expect(plot.axes[1]!.label).toBe("position (m)");
    expect(column(plot, 3)[7]).toBe(0.5);
    expect(column(plot, 1)[7]).toBeNull();
  });
  it("stripe what is not determined and draw nothing there", () => {
    const { view, plot } = make();
    view.set({ coordinate: 1 });
    nextFrame();
    expect(column(plot, 3).slice(199, 261).filter((v) => v !== null).length).toBe(2);
    plot.hook("drawClear");
    const [stripe] = plot.ctx.drawn;
    expect(stripe!.numbers[0]).toBeCloseTo(100 + (1000 * 1.995) / 3.99, 6);
    expect(stripe!.numbers[2]).toBeCloseTo((1000 * 0.6) / 3.99, 6);
  });
  it("read the value and its SD under the pointer", () => {
    const { view, node } = make();
    const readout = (coordinate: number, pointer: number): string => {
      view.set({ coordinate, pointer });
      nextFrame();
      return withId(node, "angle-readout").textContent;
    };
    expect(readout(0, 0)).toBe("0.000 s, frame 0: 0.00 deg ± 1.50 deg (1 SD)");
    expect(readout(1, 2.3)).toBe("2.300 s, frame 230: not determined: the visible markers do not fix it here");
    expect(readout(2, 1)).toBe("1.000 s, frame 100: 0.5000 m (SD not known)");
  });
  it("count frames as the recording's file does", () => {
    const { view, node } = make((data) => (data.summary.first_frame = 363));
    view.set({ coordinate: 2, pointer: 1 });
    nextFrame();
    expect(withId(node, "angle-readout").textContent).toBe("1.000 s, frame 463: 0.5000 m (SD not known)");
  });
  it("find coordinates by any of their words, and choose by stamp and arrow", () => {
    const { view, node } = make();
    const filter = node.tagged("input")[0]!;
    filter.value = "RI st";
    filter.fire("input");
    expect(node.classed("cell").map((c) => c.hidden)).toEqual([true, false, true]);
    node.classed("cell")[1]!.fire("click");
    nextFrame();
    expect(view.coordinate).toBe(1);
    expect(node.classed("cell").map((c) => c.getAttribute("aria-pressed"))).toEqual(["false", "true", "false"]);
    const arrow = node.tagged("button").find((b) => b.getAttribute("aria-label") === "Coordinate before")!;
    for (const expected of [0, 2, 1]) {
      arrow.fire("click");
      expect(view.coordinate).toBe(expected);
    }
  });
  it("say of a coordinate that is held fixed, and of a thinned recording, what they are", () => {
    const { node } = make((data) => {
      data.summary.coordinates[0]!.locked = true;
      data.series.frame_step = 3;
    });
    expect(node.classed("facts")[0]!.textContent).toBe("shoulder is held fixed.");
    expect(node.classed("thinned")[0]!.textContent).toContain("every 6 frames");
    expect(node.classed("remark")[0]!.textContent).toBe("held fixed");
    expect(node.classed("remark")[1]!.textContent).toBe("85 % determined");
  });
});

describe("markers", () => {
  const make = () => {
    install();
    FakePlot.made = [];
    const view = new View([0, 3.99]);
    const made = markers(decode(inflated(simulated())), view);
    made.start();
    return { view, node: fake(made.node), plot: FakePlot.made[0]! };
  };
  it("draw the chosen marker beside all of them, and stop when it is chosen again", () => {
    const { view, node, plot } = make();
    expect(column(plot, 1)[100]).toBeCloseTo(23.3, 4);
    expect(column(plot, 2).every((v) => v === null)).toBe(true);
    const row = node.tagged("tbody")[0]!.tagged("tr").find((r) => r.textContent.startsWith("C"))!;
    row.fire("click");
    nextFrame();
    expect(view.marker).toBe(2);
    expect(column(plot, 2)[100]).toBe(40);
    expect(node.classed("chosen")).toEqual([row]);
    row.fire("click");
    expect(view.marker).toBe(-1);
  });
  it("do not choose one that was left out", () => {
    const { view, node } = make();
    node.tagged("tbody")[0]!.tagged("tr").find((r) => r.textContent.startsWith("Left.Out"))!.fire("click");
    expect(view.marker).toBe(-1);
  });
  it("jump to the largest error without choosing and unchoosing", () => {
    const { view, node } = make();
    node.classed("jump").find((b) => b.textContent === "40.0")!.fire("click");
    expect([view.marker, view.focus]).toEqual([2, 1]);
  });
  it("read both errors, and say when the marker was not seen", () => {
    const { view, node } = make();
    const readout = (): string => {
      nextFrame();
      return withId(node, "error-readout").textContent;
    };
    expect(readout()).toContain("Choose a marker");
    view.set({ pointer: 1, marker: 2 });
    expect(readout()).toBe("1.000 s: All markers, RMS 23.3 mm  C 40.0 mm");
    view.set({ pointer: 2.3, marker: 1 });
    expect(readout()).toBe("2.300 s: All markers, RMS 3.6 mm  B not seen");
  });
  it("show each marker's errors as a line with breaks", () => {
    const { node } = make();
    const line = (name: string): string => {
      const row = node.tagged("tbody")[0]!.tagged("tr").find((r) => r.textContent.startsWith(name))!;
      return row.tagged("path")[0]!.getAttribute("d")!;
    };
    expect(line("B").match(/M/g)!.length).toBe(2);
    expect(line("A").match(/M/g)!.length).toBe(1);
    expect(line("C")).toMatch(/L25\.5 1\.0/);
  });
});

describe("drawSmallMultiple", () => {
  const draw = (values: number[], sd: number | null, undetermined: Uint8Array | null = null, width = 100): Drawn[] => {
    const canvas = new FakeElement("canvas");
    const time = Float64Array.from(values, (_, i) => i);
    const series = { value: Float32Array.from(values), sd: sd === null ? null : new Float32Array(values.length).fill(sd), undetermined };
    drawSmallMultiple(canvas as unknown as HTMLCanvasElement, series, time, [0, values.length - 1], width, 50);
    return canvas.getContext().drawn;
  };
  it("fills the band and draws the line inside it", () => {
    const [band, line] = draw([0, 1, 2, 3], 0.5);
    expect([band!.what, band!.colour, line!.what, line!.colour]).toEqual(["fill", palette().band, "stroke", palette().line]);
    expect(band!.numbers.length).toBe(16);
    const heights = line!.numbers.filter((_, i) => i % 2 === 1);
    expect(heights).toEqual([...heights].sort((a, b) => b - a));
    expect(Math.max(...heights)).toBeLessThan(50);
  });
  it("breaks the line where there is no value and hatches it", () => {
    const drawn = draw([0, 1, NaN, NaN, 2, 3], null, Uint8Array.of(0, 0, 1, 1, 0, 0));
    expect(drawn.filter((d) => d.what === "rect").map((d) => d.colour)).toEqual(["pattern", "pattern"]);
    expect(drawn.filter((d) => d.what === "stroke").length).toBe(2);
  });
  it("draws a block instead of a thousand swings to the pixel, and keeps the peak", () => {
    const values = Array.from({ length: 5000 }, (_, i) => (i === 2501 ? 9 : Math.sin(i)));
    const drawn = draw(values, null);
    const block = drawn.filter((d) => d.what === "fill").at(-1)!;
    expect(block.colour).toBe(palette().dense);
    const heights = block.numbers.filter((_, i) => i % 2 === 1);
    expect(heights.filter((h) => h < 10).length).toBe(1);
  });
});
