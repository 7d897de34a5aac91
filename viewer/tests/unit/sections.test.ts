// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The sections that both kinds of report share, and those of joint angles that need no plot.
import type { Finding } from "../../src/page_types.ts";
import { describe, expect, it, vi } from "vitest";
import { decode } from "../../src/decode.ts";
import { fake, install, nextFrame, type FakeElement } from "../fake_dom.ts";
import { inflated } from "../packed.ts";
import { hostile, simulated } from "../simulated.ts";

install();
const { findingGroups, groupFindings } = await import("../../src/sections/finding_groups.ts");
const { gaps, legend } = await import("../../src/sections/gaps.ts");
const { header } = await import("../../src/sections/header.ts");
const { plain, settings } = await import("../../src/sections/settings.ts");
const { sortableTable } = await import("../../src/sections/table.ts");
const { timeBar } = await import("../../src/sections/time_bar.ts");
const { worstFrames } = await import("../../src/sections/worst_frames.ts");
const { el, section } = await import("../../src/dom.ts");
const { View } = await import("../../src/view.ts");

const words = (nodes: FakeElement[]): string[] => nodes.map((n) => n.textContent);
const button = (node: FakeElement, name: string): FakeElement =>
  node.tagged("button").find((b) => b.textContent === name || b.getAttribute("aria-label") === name)!;

describe("el", () => {
  it("never takes a text for markup", () => {
    const node = fake(el("p", {}, hostile));
    expect(node.textContent).toBe(hostile);
    expect(node.children.length).toBe(1);
    expect(node.tagged("img")).toEqual([]);
  });
  it("leaves out what is false or null, and names a section by its heading", () => {
    const node = fake(el("button", { disabled: true, hidden: false, "data-x": 3 }, null, "a"));
    expect([...node.attributes]).toEqual([["disabled", ""], ["data-x", "3"]]);
    const named = fake(section("id", "Title", "", "text"));
    expect(named.getAttribute("aria-labelledby")).toBe(named.tagged("h2")[0]!.getAttribute("id"));
    expect(named.tagged("p")).toEqual([]);
  });
});

describe("findings", () => {
  const { summary } = simulated();
  const plainWords = { title: "What needs your attention", nothing: "Nothing at all." };
  const finding = (level: "attention" | "note", about: string, text: string): Finding => ({ level, about, subject: "", text, time_s: null });
  it("show level and text, and a way there where there is a place", () => {
    const jump = vi.fn();
    const node = fake(findingGroups(groupFindings(summary.findings), plainWords, jump, summary.gates));
    expect(words(node.classed("level"))).toEqual(["Problem", "Note", "Note"]);
    expect(node.classed("text")[2]!.textContent).toBe(hostile);
    expect(words(node.classed("jump"))).toEqual(["Show 1.000 s", "Show 2.000 s"]);
    node.classed("jump")[1]!.fire("click");
    expect(jump).toHaveBeenCalledExactlyOnceWith(summary.findings[1], 2);
    expect(node.tagged("summary")[0]!.textContent).toBe("1 of 2 quality checks passed");
  });
  it("fold those of a kind into a line that counts them, the serious first", () => {
    const partly = ["a", "b", "c"].map((n) => finding("note", "coordinate", `${n} is not determined in 3 of 9 frames (33 %): ...`));
    const groups = groupFindings([finding("note", "warning", "odd"), ...partly, finding("attention", "coordinate", "d is never determined: ...")]);
    expect(groups.map((g) => [g.level, g.title])).toEqual([
      ["attention", "1 coordinate never determined"],
      ["note", "1 remark"],
      ["note", "3 coordinates partly not determined"],
    ]);
    const node = fake(findingGroups(groups, plainWords, null));
    expect(node.tagged("li").length).toBe(3);
    expect(node.classed("single").length).toBe(2);
  });
  it("do not say of other remarks that a coordinate is not determined", () => {
    expect(groupFindings([finding("note", "coordinate", "knee is odd")])[0]!.title).toBe("1 remark about coordinates");
  });
  it("say so when there are none, and stay readable when there are thousands", () => {
    expect(fake(findingGroups([], plainWords, null)).textContent).toContain("Nothing at all.");
    const many = fake(findingGroups(groupFindings(Array.from({ length: 250 }, () => summary.findings[0]!)), plainWords, vi.fn()));
    expect(many.tagged("li").length).toBe(200);
    expect(many.textContent).toContain("50 more are in the JSON file");
  });
});

describe("sortableTable", () => {
  const rows = [{ n: "b", v: 1 }, { n: "a", v: null }, { n: "c", v: 3 }];
  const table = (onRow?: (row: (typeof rows)[0]) => void) =>
    sortableTable(
      "Rows",
      [
        { title: "Name", key: (r) => r.n, cell: (r) => r.n },
        { title: "Value", unit: "mm", numeric: true, key: (r) => r.v, cell: (r) => String(r.v) },
        { title: "Picture", sortable: false, key: () => null, cell: () => "" },
      ],
      rows,
      { column: 1, direction: "descending" },
      onRow,
    );
  const names = (node: FakeElement): string[] => words(node.tagged("tbody")[0]!.tagged("th"));
  it("begins as it is told and says how it is sorted", () => {
    const node = fake(table().node);
    expect(names(node)).toEqual(["c", "b", "a"]);
    expect(node.tagged("thead")[0]!.tagged("th").map((h) => h.getAttribute("aria-sort"))).toEqual([null, "descending", null]);
  });
  it("sorts by a heading, numbers from the largest, and turns round at the second click", () => {
    const node = fake(table().node);
    const headings = node.tagged("thead")[0]!.tagged("button");
    expect(headings.length).toBe(2);
    headings[0]!.fire("click");
    expect(names(node)).toEqual(["a", "b", "c"]);
    headings[0]!.fire("click");
    expect(names(node)).toEqual(["c", "b", "a"]);
    headings[1]!.fire("click");
    expect(names(node)).toEqual(["c", "b", "a"]);
    headings[1]!.fire("click");
    expect(names(node)).toEqual(["b", "c", "a"]);
  });
  it("tells which row was clicked and marks the one that is chosen", () => {
    const onRow = vi.fn();
    const made = table(onRow);
    const node = fake(made.node);
    node.tagged("tbody")[0]!.tagged("tr")[1]!.fire("click");
    expect(onRow).toHaveBeenCalledExactlyOnceWith(rows[0]);
    made.mark((r) => r.v === 3);
    expect(words(node.classed("chosen"))).toEqual(["c3"]);
    made.mark(() => false);
    expect(node.classed("chosen")).toEqual([]);
    expect(node.classed("link").length).toBe(3);
  });
});

describe("timeBar", () => {
  const make = () => {
    install();
    const view = new View([0, 10]);
    const node = fake(timeBar(view, [["a", "First"], ["b", "Second"]]));
    const range = (): string => {
      nextFrame();
      return node.classed("range")[0]!.textContent;
    };
    return { view, node, range };
  };
  it("links to the sections it is given", () => {
    const { node } = make();
    expect(node.tagged("a").map((a) => [a.getAttribute("href"), a.textContent])).toEqual([["#a", "First"], ["#b", "Second"]]);
  });
  it("zooms, moves, and returns to the whole", () => {
    const { node, range } = make();
    expect(range()).toBe("0.00 to 10.00 s");
    expect(button(node, "Whole trial").disabled).toBe(true);
    button(node, "Zoom in").fire("click");
    expect(range()).toBe("2.50 to 7.50 s");
    button(node, "Later").fire("click");
    expect(range()).toBe("5.00 to 10.00 s");
    button(node, "Earlier").fire("click");
    expect(range()).toBe("2.50 to 7.50 s");
    expect(button(node, "Whole trial").disabled).toBe(false);
    button(node, "Zoom out").fire("click");
    expect(range()).toBe("0.00 to 10.00 s");
  });
  it("writes short ranges to the millisecond", () => {
    const { view, range } = make();
    view.set({ range: [1.2345, 1.5] });
    expect(range()).toBe("1.235 to 1.500 s");
  });
});

describe("header", () => {
  it("tells the verdict and what people look for first", () => {
    const node = fake(header(simulated().summary));
    expect(node.tagged("h1")[0]!.textContent).toBe(`walk ${hostile}`);
    expect(node.classed("verdict")[0]!.textContent).toBe("Needs attention1 problem, 2 notes");
    expect(words(node.classed("tile"))[1]).toBe("100 %frames convergedevery frame");
  });
  it("is content when there is nothing to say, and admits what it does not know", () => {
    const { summary } = simulated();
    const calm = { ...summary, verdict: "good" as const, findings: [], frames_per_s: null, determined_fraction: null, rms_error_mm: null, method: "" };
    const node = fake(header(calm));
    expect(node.classed("verdict")[0]!.textContent).toBe("Goodno problems");
    expect(words(node.classed("tile")).slice(3)).toEqual(["–determinedof 3 coordinates", "– mmRMS marker errorlargest 40.0 mm", "1.50 degmedian SD of an anglenot timed"]);
    expect(node.classed("brand")[0]!.textContent).toContain("inverse kinematics");
  });
});

describe("settings", () => {
  it("hold what it takes to run it again", () => {
    const { summary } = simulated();
    const text = fake(settings(summary, [["Method", "least squares"]], 0.02)).textContent;
    for (const part of [summary.command_line, "kinemark 0.1.0", "Methodleast squares", "1, ran but missed", "Seed7", "0.020 s", "robustnone", "123 kB"]) {
      expect(text).toContain(part);
    }
  });
  it("leave out empty tables", () => {
    expect(plain("Empty", ["A"], [])).toBeNull();
    const bare = { ...simulated().summary, inputs: [], options: {}, command_line: "", exit_status: 5 };
    const node = fake(settings(bare, [], null));
    expect(node.tagged("table").length).toBe(1);
    expect(node.tagged("pre")).toEqual([]);
    expect(node.textContent).toContain("Exit status5");
  });
});

describe("worstFrames", () => {
  it("move all plots to the frame that is clicked, and choose its marker", () => {
    install();
    const view = new View([0, 4]);
    const node = fake(worstFrames(simulated().summary, view));
    node.tagged("tbody")[0]!.tagged("tr")[0]!.fire("click");
    expect([view.focus, view.marker, view.range]).toEqual([1, 2, [0, 2]]);
    expect(location.hash).toBe("markers");
    expect(node.classed("chosen").length).toBe(1);
  });
  it("say that no error is known", () => {
    const { summary } = simulated();
    expect(fake(worstFrames({ ...summary, worst_frames: [] }, new View([0, 1]))).textContent).toContain("No marker error is known.");
  });
});

describe("gaps", () => {
  it("have a row for the fit and for each marker, the left-out ones faint", () => {
    install();
    const { node, start } = gaps(decode(inflated(simulated())), new View([0, 3.99]));
    start();
    const canvas = fake(node).tagged("canvas")[0]!;
    const names = canvas.getContext().drawn.filter((d) => d.what === "text").slice(0, 5);
    expect(names.map((n) => n.words)).toEqual(["Fit", "A", "B", "C", "Left.Out (left out)"]);
    expect(names.map((n) => n.alpha)).toEqual([1, 1, 1, 1, 0.5]);
    canvas.fire("mousemove", { offsetX: 620 * 0.999, offsetY: 33 });
    expect(fake(node).classed("readout")[0]!.textContent).toBe("A at 3.980 s: measured, error 2.0 mm");
  });
  it("explain their colours in words", () => {
    expect(words(fake(legend({ group: "g", words: ["one", "two"], colours: () => [] })).classed("g-1"))).toEqual(["two"]);
  });
});
