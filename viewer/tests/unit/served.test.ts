// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Pages of the server's own. In a browser: tests/browser/edit_run.ts.
import { readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import { fake, install, type FakeElement } from "../fake_dom.ts";
import { hostile } from "../simulated.ts";
import { simulatedFacts, simulatedNotice, simulatedRow, simulatedTrials } from "../simulated_served.ts";
import type { TrialRow } from "../../src/page_types.ts";

install();
const { factsPage, isReading, measured, noticePage, summary, trialsMain, trialsPage } = await import("../../src/served/pages.ts");

const words = (nodes: FakeElement[]): string[] => nodes.map((n) => n.textContent);
const row = (change: Partial<TrialRow> = {}): TrialRow => ({ ...simulatedRow(1, "a.c3d"), ...change });
const mainOf = (...trials: TrialRow[]): FakeElement => fake(trialsMain({ trials, notes: [] }, "/s/"));

describe("the list of trials", () => {
  it("has a line for each trial with a link to its page", () => {
    const { title, header, main } = trialsPage(simulatedTrials());
    expect(title).toBe("Trials");
    expect(fake(header).classed("model")[0]!.textContent).toBe("study");
    expect(fake(main).tagged("a").map((a) => [a.getAttribute("href"), a.textContent])).toEqual([["/s/trial/1", "a.c3d"], ["/s/trial/7", "b.trc"]]);
    expect(words(fake(main).tagged("td")).slice(0, 8)).toEqual(["", "markers", "40", "1000", "240", "4.17", "98.8 %", ""]);
    expect(fake(main).tagged("thead")[0]!.tagged("th").length).toBe(9);
  });
  it("says in words how far it is with each, and what there is in all", () => {
    const trials = [row({ verdict: "good" }), row({ verdict: "attention" }), row({ state: "unreadable", said: "c: is empty" }), row({ state: "reading" }), row()];
    expect(words(mainOf(...trials).classed("tag"))).toEqual(["Good", "Needs attention", "not readable", "being read"]);
    expect(mainOf(...trials).classed("said")[2]!.textContent).toBe("c: is empty");
    expect(summary(trials)).toBe("5 trials, 1 in need of attention, 1 not readable, 1 being read: this page fills in by itself");
    expect(summary([row()])).toBe("1 trial");
    expect([isReading({ trials, notes: [] }), isReading({ trials: [row()], notes: [] })]).toEqual([true, false]);
  });
  it("calls only all of them a hundred per cent, and leaves out what is not known", () => {
    expect([0.99999, 1, 0, null].map(measured)).toEqual(["99.9 %", "100 %", "0.0 %", ""]);
    expect(words(mainOf(row({ rate_hz: 59.94006, duration_s: null, frames: null })).tagged("td")).slice(2, 6)).toEqual(["40", "", "59.94", ""]);
  });
  it("shows folders where there are several", () => {
    expect(words(mainOf(row(), row({ folder: "second" })).tagged("small"))).toEqual(["study", "second"]);
    expect(mainOf(row()).tagged("small")).toEqual([]);
    expect(fake(trialsPage(simulatedTrials([row(), row({ folder: "second" })])).header).classed("model")).toEqual([]);
  });
  it("says why there is no trial", () => {
    const main = fake(trialsMain({ trials: [], notes: ["study: the folder holds no file"] }, "/s/"));
    expect(words(main.tagged("p"))).toEqual(["0 trials", "study: the folder holds no file"]);
    expect(main.tagged("table")).toEqual([]);
  });
});

describe("names and sentences", () => {
  it("are text on every page", () => {
    const bad = row({ name: hostile, folder: hostile, kind: hostile, said: hostile });
    for (const { header, main } of [trialsPage(simulatedTrials([bad], [hostile])), factsPage(simulatedFacts()), noticePage(simulatedNotice())])
      for (const node of [fake(header), fake(main)]) {
        expect(node.textContent).toContain(hostile);
        expect(node.tagged("img").length + node.tagged("script").length).toBe(0);
      }
    expect(mainOf(row({ name: "" })).tagged("a")[0]!.textContent).toBe("(no name)");
  });
});

describe("what a file holds, and what is wrong", () => {
  it("is a table, lists, and what is odd", () => {
    const page = factsPage(simulatedFacts());
    expect(page.title).toBe(hostile);
    const main = fake(page.main);
    expect(words(main.tagged("h2"))).toEqual(["What is odd", "What it holds", "columns 2"]);
    expect(words(main.tagged("tr"))).toEqual(["rate, Hznot known", `software${hostile}`]);
    expect(words(main.classed("names")[0]!.tagged("li"))).toEqual(["time", hostile]);
    expect(words(fake(factsPage({ ...simulatedFacts(), warnings: [] }).main).tagged("h2"))).not.toContain("What is odd");
  });
  it("is a sentence and the way back", () => {
    const page = noticePage(simulatedNotice());
    expect(fake(page.main).textContent).toBe(`${hostile} is gone`);
    expect(fake(page.header).tagged("a").map((a) => [a.getAttribute("href"), a.textContent])).toEqual([["/s/", "All trials"]]);
  });
});

describe("the built page", () => {
  const [page, script] = ["../../served.html", "../../dist/served.js"].map((file) => readFileSync(new URL(file, import.meta.url), "utf8"));
  it("has one place for data and asks for files of its server alone", () => {
    expect(page!.split(">null<").length).toBe(2);
    expect([...page!.matchAll(/(?:src|href)="([^"]*)"/g)].map((m) => m[1])).toEqual(["data:,", "@root@style.css", "@root@list.css", "@root@list.js"]);
    expect(page).not.toMatch(/<style|\sstyle=|\son\w+=/);
  });
  it("has a small script that writes no markup", () => {
    expect(script!.length).toBeLessThan(20_000);
    expect(script).not.toMatch(/innerHTML|import[ {"]|eval/);
  });
});
