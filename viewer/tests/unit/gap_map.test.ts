// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { fake, FakeElement, install, nextFrame, resizeAll, type Drawn } from "../fake_dom.ts";

install();
const { GapMap } = await import("../../src/plots/gap_map.ts");
const { View } = await import("../../src/view.ts");

const kind = { group: "test", words: ["good", "made", "gone"], colours: () => ["c0", "c1", "c2"] };
const fit = { group: "fit", words: ["fine"], colours: () => ["f0"] };

/** 100 points over 10 s; of row B points 20 to 39 are made and point 70 is gone. */
function make() {
  install();
  const view = new View([0, 9.9]);
  const box = new FakeElement("div");
  const b = new Uint8Array(100);
  b.fill(1, 20, 40);
  b[70] = 2;
  const rows = [
    { name: "Fit", kind: fit, codes: new Uint8Array(100), marker: -1 },
    { name: "A", kind, codes: null, marker: 0, faint: true },
    { name: "B", kind, codes: b, marker: 1, remark: (i: number) => (i === 70 ? ", look" : "") },
  ];
  const map = new GapMap(box as unknown as HTMLElement, Float64Array.from({ length: 100 }, (_, i) => i / 10), view, rows);
  map.draw();
  const canvas = fake(map.canvas);
  const drawn = (): Drawn[] => canvas.getContext().drawn;
  const rects = (colour: string): number[][] => drawn().filter((d) => d.what === "rect" && d.colour === colour).map((d) => d.numbers);
  return { map, view, box, canvas, drawn, rects, rows };
}

/** The gutter of the names: 40 wide at least, and 12 of margin. The plot is 620 wide in all. */
const gutter = 52;
const x = (share: number): number => gutter + share * (620 - gutter);

describe("GapMap", () => {
  it("draws one run of each state where it is, the bad ones higher", () => {
    const { rects } = make();
    expect(rects("c0").length).toBe(3);
    const [made] = rects("c1");
    expect(made![0]).toBeCloseTo(x(0.2), 6);
    expect(made![2]).toBeCloseTo(x(0.4) - x(0.2), 6);
    expect(made![3]).toBe(12);
    expect(rects("c0")[0]![3]).toBe(8);
    expect(rects("c2")[0]![0]).toBeCloseTo(x(0.7), 6);
  });
  it("shows a single bad frame of a long recording", () => {
    const { map, rects } = make();
    const long = new Uint8Array(100);
    long[99] = 2;
    map.setRows([{ name: "L", kind, codes: long, marker: 0 }]);
    expect(rects("c2")[0]![2]).toBeGreaterThanOrEqual(2);
  });
  it("sets rows of another kind apart and writes all names, faint ones faintly", () => {
    const { drawn } = make();
    const names = drawn().filter((d) => d.what === "text").slice(0, 3);
    expect(names.map((n) => n.words)).toEqual(["Fit", "A", "B"]);
    expect(names.map((n) => n.numbers[1])).toEqual([11, 33, 47]);
    expect(names.map((n) => n.alpha)).toEqual([1, 0.5, 1]);
  });
  it("says what is under the pointer", () => {
    const { map, canvas, view } = make();
    const at = (share: number, y: number): string => {
      canvas.fire("mousemove", { offsetX: x(share), offsetY: y });
      return map.readout.textContent!;
    };
    expect(at(0.305, 47)).toBe("B at 3.000 s: made");
    expect(at(7 / 9.9, 47)).toBe("B at 7.000 s: gone, look");
    expect(at(0.5, 33)).toMatch(/^A at .*: not known$/);
    expect(at(0.5, 8)).toMatch(/^Fit at .*: fine$/);
    expect(view.pointer).toBeCloseTo(4.95);
    canvas.fire("mouseleave");
    expect(map.readout.textContent).toBe("");
    expect(view.pointer).toBeNull();
  });
  it("chooses a marker with a click, and only a time between the rows", () => {
    const { canvas, view } = make();
    canvas.fire("click", { offsetX: x(0.5), offsetY: 47 });
    expect([view.marker, view.focus]).toEqual([1, 4.95]);
    canvas.fire("click", { offsetX: x(1.5), offsetY: 22 });
    expect([view.marker, view.focus]).toEqual([1, 9.9]);
    canvas.fire("click", { offsetX: 3, offsetY: 8 });
    expect([view.marker, view.focus]).toEqual([1, 0]);
  });
  it("follows the range of the view", () => {
    const { view, rects } = make();
    view.set({ range: [2, 3.9] });
    nextFrame();
    expect(rects("c0").length).toBe(0);
    expect(rects("c1")[0]!.map(Math.round)).toEqual([gutter, 33 + 8, 568, 12]);
  });
  it("marks the pointer and the time asked for, if they can be seen, without drawing anew", () => {
    const { view, box, canvas } = make();
    const [pointed, asked] = box.classed("time-line");
    canvas.getContext().drawn = [];
    view.set({ pointer: 4.95, focus: 20 });
    nextFrame();
    expect([pointed!.hidden, asked!.hidden]).toEqual([false, true]);
    expect(pointed!.style["transform"]).toBe(`translateX(${x(0.5).toFixed(1)}px)`);
    view.set({ pointer: null, focus: 9.9 });
    nextFrame();
    expect([pointed!.hidden, asked!.hidden]).toEqual([true, false]);
    expect(canvas.getContext().drawn).toEqual([]);
    view.set({ marker: 1 });
    nextFrame();
    expect(canvas.getContext().drawn.length).toBeGreaterThan(0);
  });
  it("keeps its time axis readable in a narrow window", () => {
    const { box, drawn, canvas } = make();
    const ticks = (): string[] => drawn().filter((d) => d.what === "text" && d.words.endsWith(" s")).map((d) => d.words);
    expect(ticks()).toEqual(["0 s", "2 s", "4 s", "6 s", "8 s"]);
    box.clientWidth = 100;
    resizeAll();
    expect(canvas.width).toBe(2 * 280);
    expect(ticks()).toEqual(["0 s", "5 s"]);
  });
  it("is empty without rows", () => {
    const { map, drawn } = make();
    map.setRows([]);
    expect(drawn().filter((d) => d.what === "rect" && d.numbers[3] !== 4)).toEqual([]);
  });
});
