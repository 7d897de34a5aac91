// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { describe, expect, it } from "vitest";
import { files, type Part } from "../../schema/files.ts";
import { made } from "../../schema/made.ts";
import { dataOf, problemsOf, typeFor } from "../../schema/problems.ts";
import { simulated, simulatedSensors } from "../simulated.ts";
import { simulatedPair } from "../browser/features.ts";
import { simulatedClean } from "../simulated_clean.ts";
import { simulatedMarkers, simulatedScene, simulatedWalk } from "../simulated_markers.ts";
import { simulatedBodies } from "../simulated_meshes.ts";
import { simulatedResults } from "../simulated_results.ts";
import { simulatedFacts, simulatedNotice, simulatedTrials } from "../simulated_served.ts";

const live = {
  summary: {
    schema: "kinemark.live", schema_version: 1, trial: "sim:walk", source: "sim:walk", version: "0.1.0", recording: null, rate_hz: 100,
    markers: ["A"], up: [0, 0, 1], up_from: "", extent_m: [[0, 0, 0], [1, 1, 1]], coordinates: [{ name: "knee", unit: "deg" }],
    bodies: [{ name: "shank", parent: -1, mass_kg: 3, com_m: [0, 0, 0] }], targets: [{ marker: 0, body: 0, point_m: [0, 0, 0], level: 0 }], levels: ["all markers"], strict: false,
  },
};
const changes = [{ marker: "A", moved: 1, came: 0, went: 0, restated: 0, largest_mm: 2.5, first: 101, last: 101 }];
const editing = {
  journal: "walk.edits.jsonl", digest: "00ff", regions: [{ name: "reach", first: 1, last: 9 }], undo: 1, redo: 0, warnings: [], changes: { last: changes, all: changes },
  edits: [{ id: "1", do: "rename", from: "A", to: "B", words: "A is B", made: "2026-01-01T00:00:00Z", author: "x", in_force: true }],
};
const pages: Record<string, unknown> = {
  IkPage: simulated(),
  "IkPage of sensors alone": simulatedSensors(true),
  "IkPage of sensors and markers": simulatedSensors(false),
  "IkPage with a scene": { ...simulated(), scene: { ...simulatedScene(), bodies: simulatedBodies(400) } },
  "IkPage with torques": simulatedPair(),
  CleanPage: simulatedClean(),
  MarkersPage: simulatedMarkers(),
  "MarkersPage with cycles": simulatedWalk(),
  "MarkersPage with edits": { ...simulatedMarkers(), editing },
  "MarkersPage without edits": { ...simulatedMarkers(), editing: { refused: "The journal is damaged." } },
  LivePage: live,
  DeskPage: { summary: { schema: "kinemark.desk", schema_version: 1, trial: "Acquisition", source: "sim:rig", version: "0.1.0", folder: "day" } },
  TrialsPage: simulatedTrials(),
  FactsPage: simulatedFacts(),
  NoticePage: simulatedNotice(),
  ...Object.fromEntries(Object.entries(simulatedResults()).map(([kind, page]) => [`${kind[0]!.toUpperCase()}${kind.slice(1)}Page`, page])),
};

/** A copy of a page in which one thing is changed. */
function changed<T>(page: T, change: (page: T) => unknown): T {
  const copy = structuredClone(page);
  change(copy);
  return copy;
}

describe("what follows from the schema", () => {
  it.each([...made()].map(([file, text]) => [file.pathname.split("/").pop()!, file, text] as const))("%s is up to date: npm run schema", (_, file, text) => {
    expect(readFileSync(file, "utf8")).toBe(text);
  });
});

describe("the schema", () => {
  const parts = files.flatMap((file) => Object.entries(file.$defs));
  it("has every name once, and describes every member", () => {
    const names = parts.map(([name]) => name);
    expect(new Set(names).size).toBe(names.length);
    const mute = parts.flatMap(([name, part]) => [[name, part] as const, ...Object.entries(part.properties ?? {}).map(([member, p]) => [`${name}.${member}`, p] as const)]).filter(([, part]) => !part.description?.endsWith("."));
    expect(mute.map(([name]) => name)).toEqual([]);
  });
  it("closes every type but those that say that they are open", () => {
    const open = parts.filter(([, part]) => part.properties !== undefined && part.additionalProperties !== false).map(([name]) => name);
    expect(open).toEqual(["JournalEntry"]);
    const free = parts.flatMap(([name, part]) => Object.entries(part.properties ?? {}).filter(([, p]) => /"type":(\["object","null"\]|"object")\}/.test(JSON.stringify(p))).map(([member]) => `${name}.${member}`));
    expect(free).toEqual(["JointsResult.segmentation", "JointsResult.topology", "ScaleResult.static_trials"]);
  });
  it("has no type that nothing refers to, but answers of the server, and no member that is required and not described", () => {
    const referred = new Set(JSON.stringify(files).match(/\$defs\/\w+/g)!.map((ref) => ref.slice(6)));
    expect(parts.map(([name]) => name).filter((name) => !referred.has(name))).toEqual(["DeskState", "Refusal", "AnglesState"]);
    const lacking = (part: Part): string[] => (part.required ?? []).filter((name) => part.properties?.[name] === undefined);
    expect(parts.flatMap(([, part]) => lacking(part))).toEqual([]);
  });
});

describe("a page", () => {
  it.each(Object.entries(pages))("%s follows its type", (name, page) => {
    expect(typeFor(page)).toBe(name.split(" ")[0]);
    expect(problemsOf(page)).toEqual([]);
    expect(problemsOf(page, "Page")).toEqual([]);
  });
  it.each(Object.entries(pages))("%s is refused with a member too many, or with one too few", (_, page) => {
    const first = Object.keys((page as { summary: object }).summary)[2]!;
    expect(problemsOf(changed(page, (p) => Object.assign(p as object, { more: 1 })))).toEqual([`${typeFor(page)}: must NOT have additional properties (more)`]);
    expect(problemsOf(changed(page, (p) => delete (p as { summary: Record<string, unknown> }).summary[first]))).toContain(`${typeFor(page)}/summary: must have required property '${first}' (${first})`);
  });
  it("is refused with a wrong kind of number, unit or code, and it is said where", () => {
    const bad: [string, (page: ReturnType<typeof simulatedPair>) => unknown][] = [
      ["/summary/frames: must be integer", (p) => (p.summary.frames = 1.5)],
      ["/summary/rate_hz: must be number", (p) => Object.assign(p.summary, { rate_hz: "100 Hz" })],
      ["/summary/coordinates/0/unit: must be equal to one of the allowed values", (p) => Object.assign(p.summary.coordinates[0]!, { unit: "rad" })],
      ["/summary/coordinates/0/limits: must NOT have fewer than 2 items", (p) => Object.assign(p.summary.coordinates[0]!, { limits: [1] })],
      ["/series/status/kind: must be equal to constant", (p) => Object.assign(p.series.status, { kind: "rounded" })],
      ["/series/rms_error_mm: must have required property 'step'", (p) => delete (p.series.rms_error_mm as { step?: number }).step],
      ["/summary/findings/0: must NOT have additional properties", (p) => Object.assign(p.summary.findings[0]!, { frame: 3 })],
    ];
    for (const [where, change] of bad) expect(problemsOf(changed(simulatedPair(), change)).join("\n")).toContain(`IkPage${where}`);
  });
  it("has steps of packed series where they are words of 16 bits, and nowhere else", () => {
    const series = simulatedScene().markers.positions_m;
    expect(problemsOf(series, "PackedSeries")).toEqual([]);
    expect(problemsOf({ ...series, kind: "float32" }, "PackedSeries").length).toBeGreaterThan(0);
    expect(problemsOf(changed(series, (s) => delete s.step), "PackedSeries").join()).toContain("'step'");
  });
  it("of another kind of result is not taken for the right one", () => {
    const { scale, joints } = simulatedResults();
    expect(problemsOf({ ...scale, result: joints.result }).length).toBeGreaterThan(0);
    expect(problemsOf({ summary: { schema: "kinemark.other" } })).toEqual(["this follows no type of viewer/schema"]);
    expect(problemsOf({ summary: { schema: "kinemark.result_report", kind: "constructor" } })).toEqual(["this follows no type of viewer/schema"]);
    expect(problemsOf(null)).toEqual(["this follows no type of viewer/schema"]);
  });
});

describe("a file", () => {
  it("is a page, or a report beside results", () => {
    const folder = mkdtempSync(join(tmpdir(), "kinemark-schema-"));
    const written = (name: string, text: string): unknown => {
      writeFileSync(join(folder, name), text);
      return dataOf(join(folder, name));
    };
    const text = JSON.stringify(simulated()).replaceAll("<", "\\u003c");
    expect(written("a.html", `<p><script type="application/json" id="kinemark-data">${text}</script>`)).toEqual(simulated());
    const report = written("Q_report.json", JSON.stringify({ kinemark_set: "0123456789abcdef", ...simulated().summary }));
    expect([typeFor(report), problemsOf(report)]).toEqual(["IkSummary", []]);
    expect(() => written("b.html", "<p>")).toThrow("no page with data");
    rmSync(folder, { recursive: true });
  });
});
