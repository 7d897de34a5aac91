// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { install } from "../fake_dom.ts";

install();
const { csv, fileName, rowsOf } = await import("../../src/save.ts");
const { figureCsv, figureSvg, ticks } = await import("../../src/plots/figure.ts");

describe("fileName", () => {
  it("is one that every file system takes", () => {
    expect(fileName("../a b/<c>:\u0000d", "png")).toBe("a_b_c_d.png");
    expect(fileName("", "csv")).toBe("kinemark.csv");
    expect(fileName("Gehen schräg", "svg")).toBe("Gehen_schräg.svg");
  });
});

describe("csv", () => {
  it("quotes what needs it and makes no formula", () => {
    expect(csv([["a", 'b"c', "d,e"], ["=1+1", "-3.5", "-x"]])).toBe(`a,"b""c","d,e"\r\n'=1+1,-3.5,'-x\r\n`);
  });
  it("takes numbers out of their dress", () => {
    const cell = (text: string): unknown => ({ textContent: text });
    const table = { rows: [{ cells: [cell("Noise  SD mm"), cell("–"), cell("−1,234.5"), cell("1,2,3")] }] };
    expect(rowsOf(table as never)).toEqual([["Noise SD mm", "", "-1234.5", "1,2,3"]]);
  });
});

describe("ticks", () => {
  it("are round and inside", () => {
    expect(ticks(0.13, 0.97, 5).map((t) => Number(t.toFixed(6)))).toEqual([0.2, 0.4, 0.6, 0.8]);
    expect(ticks(5, 5, 5)).toEqual([]);
    expect(ticks(0, Infinity, 5)).toEqual([]);
  });
});

describe("a saved figure", () => {
  const figure = {
    title: "x of <script>",
    unit: "x (mm)",
    x: [0, 1, 2, 3],
    range: [0, 2] as const,
    height: [0, 10] as const,
    bands: [{ colour: "#ccc", upper: [1, 2, null, 4], lower: [0, 1, null, 3] }],
    lines: [{ colour: "red", width: 2, values: [1, null, 5, 7] }],
    striped: [[0.5, 1.5] as const],
  };
  it("is a drawing with breaks where there is no value", () => {
    const svg = figureSvg(figure);
    expect(svg).toContain("x of &lt;script&gt;");
    expect(svg.match(/stroke="red"/g)?.length).toBe(1);
    const d = /d="([^"]*)" fill="none" stroke="red"/.exec(svg)![1]!;
    expect(d.match(/M/g)?.length).toBe(2);
    expect(d).not.toContain("L");
    expect(svg).toContain('fill="url(#stripes)"');
    expect(svg).not.toMatch(/NaN|undefined/);
  });
  it("is the numbers of the range that is shown", () => {
    expect(figureCsv(figure)).toBe("time (s),x (mm)\r\n0,1\r\n1,\r\n2,5\r\n");
  });
  it("has the SD that a band of two to each side shows, beside its line, and no column of what has no value", () => {
    const lines = [{ name: "left", colour: "red", width: 1, values: [null, null, null] }, { name: "right", colour: "red", width: 1, values: [7, null, 9] }];
    const bands = [{ colour: "", upper: [9, null, 9.5], lower: [5, null, 8.5], of: 1 }];
    expect(figureCsv({ ...figure, lines, bands })).toBe('time (s),"x (mm), right","SD of x (mm), right"\r\n0,7,1\r\n1,,\r\n2,9,0.25\r\n');
  });
});

describe("the numbers of a packed figure", () => {
  const figure = { title: "", unit: "x (mm)", x: [0, 1], range: [0, 1] as const, height: [0, 10] as const, bands: [], lines: [{ colour: "red", width: 2, values: [1.2300000191, -0.5] }], striped: [] };
  it("have the decimals that they are held to, and the heading says so", () => {
    expect(figureCsv({ ...figure, precision: { step: 0.01, framesOfPair: 1 } })).toBe('time (s),"x (mm), rounded to 0.01"\r\n0,1.23\r\n1,-0.5\r\n');
  });
  it("say of how many frames they are the extremes", () => {
    expect(figureCsv({ ...figure, precision: { step: null, framesOfPair: 30 } })).toContain('"x (mm), smallest and largest of 30 frames each"');
    expect(figureCsv({ ...figure, precision: { step: null, framesOfPair: 1 } })).toContain("time (s),x (mm)\r\n");
  });
});
