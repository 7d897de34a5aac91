// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// npm run test:browser            the built page with simulated data
// npm run test:browser -- FILE    a page that the program wrote
import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { dataOf, problemsOf } from "../../schema/problems.ts";
import { hostile, simulated, simulatedSensors } from "../simulated.ts";
import { simulatedClean } from "../simulated_clean.ts";
import { ink, opaqueInColumn, open, settle, type Check } from "./browser.ts";
import { simulatedMarkers, simulatedScene, simulatedWalk } from "../simulated_markers.ts";
import { alwaysOfClean, ofSimulatedClean } from "./clean.ts";
import { simulatedBodies } from "../simulated_meshes.ts";
import { simulatedResults } from "../simulated_results.ts";
import { alwaysOfResults, foldsFindings, ofGait, ofJoints, ofSimulatedResults, savesFigures } from "./results.ts";
import { standsWhereItProjects } from "./projection.ts";
import { ofCameras, ofPair, ofRecording, ofRegions, simulatedPair } from "./features.ts";
import { showsMeshes } from "./meshes.ts";
import { alwaysOfMarkers, comparesInSpace, ofSimulatedMarkers, walksInCycles, withoutWebGl } from "./space.ts";

/** True of every report that has angles with SDs and markers. */
const always: Record<string, Check> = {
  "all sections are there, and nothing is broken": async ({ page }) => {
    assert.deepEqual(
      await page.locator("main > section").evaluateAll((all) => all.map((s) => s.id).filter((id) => id !== "space")),
      ["attention", "angles", "compare", "markers", "gaps", "worst", "settings"],
    );
    assert.equal(await page.locator(".broken").count(), 0);
  },
  "all plots are drawn": async ({ page }) => {
    for (const selector of ["#angle-plot canvas", "#error-plot canvas", "#gap-map canvas", ".cell canvas"]) {
      assert.ok((await ink(page, selector)).drawn > 500, `${selector} is blank`);
    }
  },
  "the band is visible": async ({ page }) => {
    assert.ok((await ink(page, "#angle-plot canvas")).translucent > 300);
  },
  "choosing a coordinate redraws the plot, by list, by stamp and by arrow": async ({ page }) => {
    const names = await page.locator("#coordinate option").allTextContents();
    assert.equal(await page.locator(".cell").count(), names.length);
    await page.selectOption("#coordinate", { index: 0 });
    await settle(page);
    let before = await ink(page, "#angle-plot canvas");
    const steps: [() => Promise<unknown>, number][] = [
      [() => page.selectOption("#coordinate", { index: 1 }), 1],
      [() => page.locator(".cell").nth(2).click(), 2],
      [() => page.getByRole("button", { name: "Coordinate before" }).click(), 1],
    ];
    for (const [choose, index] of steps) {
      await choose();
      await settle(page);
      const after = await ink(page, "#angle-plot canvas");
      assert.notEqual(after.hash, before.hash);
      assert.equal(await page.locator('.cell[aria-pressed="true"] .name').textContent(), names[index]);
      assert.equal(await page.locator("#coordinate").evaluate((s) => (s as HTMLSelectElement).selectedIndex), index);
      before = after;
    }
  },
  "the pointer reads values in both plots": async ({ page }) => {
    await page.selectOption("#coordinate", { index: 0 });
    await page.locator("#angle-plot .u-over").hover({ position: { x: 200, y: 80 } });
    await settle(page);
    assert.match((await page.locator("#angle-readout").textContent()) ?? "", /^[\d.]+ s, frame .*: .*(±|not determined)/);
    assert.match((await page.locator("#error-readout").textContent()) ?? "", /^[\d.]+ s: All markers, RMS/);
    await page.mouse.move(5, 5);
  },
  "headings sort the table of markers": async ({ page }) => {
    const values = async (column: number): Promise<number[]> => {
      const texts = await page.locator(`#markers tbody tr > :nth-child(${column})`).allTextContents();
      return texts.map((t) => Number(t.replaceAll(",", ""))).filter((v) => !Number.isNaN(v));
    };
    const descending = (v: number[]): boolean => v.every((x, i) => i === 0 || x <= v[i - 1]!);
    assert.ok(descending(await values(3)), "worst marker first at the start");
    await page.locator("#markers thead").getByRole("button", { name: "Largest" }).click();
    assert.ok(descending(await values(4)));
    await page.locator("#markers thead").getByRole("button", { name: "Largest" }).click();
    assert.ok(descending((await values(4)).reverse()));
  },
  "a worst frame moves all plots and Whole trial moves them back": async ({ page }) => {
    const range = page.locator(".bar .range");
    const whole = await range.textContent();
    const map = await ink(page, "#gap-map canvas");
    await page.locator("#worst tbody tr").first().click();
    await settle(page);
    assert.notEqual(await range.textContent(), whole);
    assert.notEqual((await ink(page, "#gap-map canvas")).hash, map.hash);
    assert.equal(await page.locator("#markers tr.chosen").count(), 1);
    await page.getByRole("button", { name: "Whole trial" }).click();
    await settle(page);
    assert.equal(await range.textContent(), whole);
  },
  "dragging zooms, double-click shows everything": async ({ page }) => {
    const range = page.locator(".bar .range");
    const whole = await range.textContent();
    await page.locator("#angle-plot").scrollIntoViewIfNeeded();
    const box = (await page.locator("#angle-plot .u-over").boundingBox())!;
    await page.mouse.move(box.x + 200, box.y + 60);
    await page.mouse.down();
    await page.mouse.move(box.x + 400, box.y + 60, { steps: 5 });
    await page.mouse.up();
    await settle(page);
    assert.notEqual(await range.textContent(), whole);
    await page.mouse.dblclick(box.x + 300, box.y + 60);
    await settle(page);
    assert.equal(await range.textContent(), whole);
  },
  "nothing was asked for and nothing complained": async ({ complaints }) => {
    assert.deepEqual(complaints, []);
  },
};

/** What the simulated trial must show. */
const ofSimulated: Record<string, Check> = {
  "hostile texts are shown as they are": async ({ page }) => {
    assert.equal(await page.locator("h1").textContent(), `walk ${hostile}`);
    assert.equal(await page.locator("#page img").count(), 0);
    assert.equal(await page.locator(".group").nth(2).locator(".text").textContent(), hostile);
    assert.equal(await page.title(), `walk ${hostile} · kinemark report`);
  },
  "the header tells the verdict and the numbers": async ({ page }) => {
    assert.match((await page.locator("#verdict").textContent()) ?? "", /Needs attention.*1 problem, 2 notes/);
    const tiles = await page.locator(".tile").allTextContents();
    assert.deepEqual(tiles, [
      "400frames4.00 s at 100 Hz",
      "100 %frames convergedevery frame",
      "3 of 4markers used1 left out",
      "95 %determinedof 3 coordinates",
      "4.2 mmRMS marker errorlargest 40.0 mm",
      "1.50 degmedian SD of an anglesolved at 200 × real time",
    ]);
  },
  "undetermined spans are striped, not drawn": async ({ page }) => {
    await page.selectOption("#coordinate", { label: "wrist" });
    await page.locator(".group").nth(1).getByRole("button").click();
    await settle(page);
    assert.match((await page.locator("#angle-readout").textContent()) ?? "", /not determined/);
    // The focus is at 2 s with one second to each side, so the stripes fill 2.0 to 2.6 s.
    const plot = (await page.locator("#angle-plot .u-over").boundingBox())!;
    const canvas = (await page.locator("#angle-plot canvas").boundingBox())!;
    // Between two lines of the grid, which are opaque too.
    const opaque = (share: number): Promise<number> =>
      opaqueInColumn(page, "#angle-plot canvas", plot.x - canvas.x + share * plot.width);
    const [inside, outside] = [await opaque(0.64), await opaque(0.87)];
    assert.ok(inside > plot.height - 5, `striped from top to bottom: ${inside}`);
    assert.ok(outside < 60, `a line and a band: ${outside}`);
    await page.getByRole("button", { name: "Whole trial" }).click();
    await settle(page);
  },
  "coordinates over the cycle, both feet, with their number": async ({ page }) => {
    await page.locator("#over-cycle").click();
    await settle(page);
    assert.equal(await page.locator("#over-cycle").getAttribute("aria-pressed"), "true");
    const figure = page.locator(".cycle-figure");
    assert.equal(await figure.count(), 1);
    assert.equal(await figure.locator("path.cycle").count(), 6);
    assert.match((await figure.textContent()) ?? "", /right: 3 cycles, 1 cycle with missing values, so that the mean is of 2 to 3/);
    const top = async (foot: string): Promise<number> => (await figure.locator(`path.cycle-mean.${foot}`).boundingBox())!.y;
    assert.ok((await top("left")) < (await top("right")) - 10, "4 deg higher");
    assert.equal(await page.locator("#compare .u-over:visible").count(), 0);
    await page.locator("#over-cycle").click();
    await settle(page);
    assert.ok((await page.locator("#compare .u-over:visible").count()) > 0);
  },
  "tables hold the trial's numbers": async ({ page }) => {
    assert.deepEqual(await page.locator("#worst tbody tr").first().locator("th,td").allTextContents(),
      ["1.000", "100", "23.3", "C", "40.0", "3", "converged"]);
    assert.match((await page.locator("#settings").textContent()) ?? "", /walk\.trc123 kBXXH3-64 00ff00ff00ff00ff/);
    assert.match((await page.locator("#markers").textContent()) ?? "", /Left\.Out left out/);
  },
};

/** Of a page of a recording that the program wrote: a file may hold frames without a marker, and then there is nothing to draw. */
function ofRecorded(file: string): Record<string, Check> {
  const { scene } = dataOf(file) as { scene: { names: string[] } };
  const needed = ["all sections are there, and nothing is broken", "nothing is wider than a phone", "nothing was asked for and nothing complained"];
  if (scene.names.length === 0) return Object.fromEntries(Object.entries(alwaysOfMarkers).filter(([name]) => needed.includes(name)));
  return { "names stand where positions project to, to a pixel": standsWhereItProjects, ...alwaysOfMarkers };
}

/** What the program put into a page. */
const follows = (file: string): Record<string, Check> => ({
  "its data follow the schema": async () => assert.deepEqual(problemsOf(dataOf(file)).slice(0, 5), []),
});

/** A page of a later version. */
const ofUnknown: Record<string, Check> = {
  "what cannot be read is said, not half shown": async ({ page, complaints }) => {
    assert.equal(await page.locator(".broken").textContent(), "This report cannot be shown: this page cannot read kinemark.other version 9");
    assert.equal(await page.locator("section").count(), 0);
    assert.deepEqual(complaints, []);
  },
};

async function run(file: string, checks: Record<string, Check>, webGl = true): Promise<number> {
  const opened = await open(file, "light", webGl);
  let failed = 0;
  for (const [name, check] of Object.entries(checks)) {
    try {
      await check(opened);
      console.log(`ok      ${name}`);
    } catch (error) {
      ++failed;
      console.log(`FAILED  ${name}\n${error instanceof Error ? error.message : String(error)}`);
    }
  }
  await opened.close();
  return failed;
}

const ofSensors: Record<string, Check> = {
  "a sensor that is chosen stands beside all of them": async ({ page }) => {
    await page.locator("#sensors tbody tr", { hasText: "shank_imu" }).last().click();
    await page.waitForFunction(() => document.querySelector("#sensor-readout")?.textContent?.includes("shank_imu"));
    if ((await page.locator("#markers").count()) > 0) throw new Error("there are no markers, and a section of them");
  },
};

const given = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "kinemark-page-"));
let failed = 0;
if (given.length === 0) {
  const template = readFileSync(new URL("../../dist/report.html", import.meta.url), "utf8");
  const page = (name: string, data: unknown): string => {
    const text = JSON.stringify(data).replaceAll("<", "\\u003c");
    const file = join(folder, name);
    writeFileSync(file, template.replace('id="kinemark-data">null', () => `id="kinemark-data">${text}`));
    return file;
  };
  failed += await run(page("ik.html", { ...simulated(), scene: simulatedScene() }), { ...comparesInSpace("Model", "on the model; the tie is the error"), ...ofSimulated, ...always });
  failed += await run(page("sensors.html", simulatedSensors(true)), ofSensors);
  failed += await run(page("bodies.html", { ...simulated(), scene: { ...simulatedScene(), bodies: simulatedBodies(400) } }), showsMeshes);
  const second = page("second.html", simulatedPair(1));
  failed += await run(page("pair.html", simulatedPair()), ofPair(second));
  failed += await run(page("clean.html", simulatedClean()), { ...comparesInSpace("Before", "as it came in"), ...ofSimulatedClean, ...alwaysOfClean });
  const recording = page("markers.html", simulatedMarkers());
  failed += await run(recording, { "names stand where positions project to, to a pixel": standsWhereItProjects, ...ofSimulatedMarkers, ...alwaysOfMarkers });
  failed += await run(recording, withoutWebGl, false);
  failed += await run(page("walk.html", simulatedWalk()), { ...walksInCycles, ...alwaysOfMarkers });
  failed += await run(recording, ofRecording);
  for (const [kind, data] of Object.entries(simulatedResults())) {
    const checks = { ...ofSimulatedResults, ...savesFigures, ...(kind === "gait" ? ofGait : foldsFindings), ...(kind === "joints" ? { ...ofRegions, ...ofJoints } : kind === "calibrate" || kind === "reconstruct" ? ofCameras : {}), ...alwaysOfResults };
    failed += await run(page(`${kind}.html`, data), checks);
  }
  failed += await run(page("unknown.html", { summary: { schema: "kinemark.other", schema_version: 9 }, series: {} }), ofUnknown);
} else {
  for (const file of given) {
    const holds = (schema: string): boolean => readFileSync(file, "utf8").includes(`"schema":"kinemark.${schema}"`);
    const checks = holds("result_report") ? alwaysOfResults : holds("markers_report") ? ofRecorded(file) : holds("clean_report") ? alwaysOfClean : always;
    failed += await run(resolve(file), { ...follows(file), ...checks });
  }
}
rmSync(folder, { recursive: true });
process.exitCode = failed === 0 ? 0 : 1;
