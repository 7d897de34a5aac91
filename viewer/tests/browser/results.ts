// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { hostile } from "../simulated.ts";
import { centreOf } from "../simulated_results.ts";
import type { Camera } from "../../src/scene/camera.ts";
import { settle, type Check } from "./browser.ts";

const validator = createRequire(import.meta.url)("gltf-validator") as { validateBytes: (bytes: Uint8Array) => Promise<{ issues: { numErrors: number; numWarnings: number } }> };

/** True of every page of a result. */
export const alwaysOfResults: Record<string, Check> = {
  "the answer comes first: verdict, six tiles, findings": async ({ page }) => {
    assert.equal(await page.locator("#verdict").count(), 1);
    assert.equal(await page.locator(".tile").count(), 6);
    assert.equal(await page.locator("main > section").first().getAttribute("id"), "attention");
    assert.equal(await page.locator(".broken").count(), 0);
  },
  "nothing was asked for and nothing complained": async ({ complaints }) => {
    assert.deepEqual(complaints, []);
  },
};

/** Whatever a simulated result is of. */
export const ofSimulatedResults: Record<string, Check> = {
  "hostile texts are shown as they are": async ({ page }) => {
    assert.ok(((await page.locator("h1").textContent()) ?? "").endsWith(hostile));
    assert.equal(await page.locator("#page img, #page script").count(), 0);
  },
};

/** All but a gait report, which is printed. */
export const foldsFindings: Record<string, Check> = {
  "findings of a kind are folded, a single one is not": async ({ page }) => {
    assert.equal(await page.locator(".group.single .text").first().textContent(), `too far ${hostile}`);
    assert.equal(await page.locator("details.group summary .text").textContent(), "2 remarks");
    assert.equal(await page.locator("details.group li").first().isVisible(), false);
    await page.locator("details.group summary").click();
    assert.equal(await page.locator("details.group li").first().isVisible(), true);
  },
};

/** What only a gait report has. */
export const ofGait: Record<string, Check> = {
  "what needs attention comes first, remarks are open, as it is printed": async ({ page }) => {
    assert.equal(await page.locator("#attention .group.single .text").first().textContent(), `too far ${hostile}`);
    assert.equal(await page.locator("#attention details").count(), 0);
    assert.equal(await page.locator("#remarks li").count(), 2);
  },
  "sections are those that the walk has, and links lead to them": async ({ page }) => {
    const shown = await page.locator("main > section").evaluateAll((all) => all.map((s) => s.id));
    assert.deepEqual(shown, ["attention", "figures", "measures", "deviation", "events", "remarks", "reading", "settings"]);
    assert.deepEqual(await page.locator("nav.bar a").evaluateAll((all) => all.map((a) => a.getAttribute("href")!.slice(1))), shown);
  },
  "a value outside of the norm stands out, one within does not": async ({ page }) => {
    assert.equal(await page.locator("#measures small.outside").allTextContents().then((all) => all.join()), "below");
    assert.match((await page.locator("#measures .lead").textContent())!, /95 % interval\. Norm: B\. On a treadmill/);
    assert.equal(await page.locator(".tile").nth(3).locator("dd").last().textContent(), "1 of 1 outside the norm");
  },
  "a score that is not known says what it lacks": async ({ page }) => {
    assert.match((await page.locator("#deviation").textContent())!, /No Gait Profile Score of both sides: .* are Hip rotation\./);
  },
};

export const savedBy = async (page: Parameters<Check>[0]["page"], press: () => Promise<void>): Promise<{ name: string; bytes: Buffer }> => {
  const [download] = await Promise.all([page.waitForEvent("download"), press()]);
  return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
};

/** Figures and tables as files. */
export const savesFigures: Record<string, Check> = {
  "a drawing is saved as SVG that stands alone and as PNG": async ({ page }) => {
    const figure = page.locator("figure.drawn").first();
    await figure.hover();
    const drawn = await savedBy(page, () => figure.getByRole("button", { name: "SVG" }).click());
    assert.match(drawn.name, /\.svg$/);
    const text = drawn.bytes.toString();
    assert.ok(text.startsWith("<svg") && text.includes('xmlns="http://www.w3.org/2000/svg"') && !text.includes("class="), text.slice(0, 200));
    assert.ok(/stroke="rgb/.test(text) || /stroke="#/.test(text), "colours stand in the file");
    const picture = await savedBy(page, () => figure.getByRole("button", { name: "PNG" }).click());
    assert.deepEqual([...picture.bytes.subarray(0, 4)], [0x89, 0x50, 0x4e, 0x47]);
    assert.ok(picture.bytes.length > 2000);
  },
  "a table is saved as CSV": async ({ page }) => {
    const table = await savedBy(page, () => page.getByRole("button", { name: "Save as CSV" }).first().click());
    assert.match(table.name, /\.csv$/);
    assert.ok(table.bytes.toString().split("\r\n").length >= 3);
  },
};

/** What only a page of joints has. */
export const ofJoints: Record<string, Check> = {
  "centres are where the program put them, to a pixel": async ({ page }) => {
    await page.locator("#space").scrollIntoViewIfNeeded();
    await settle(page);
    const frame = page.locator(".space-frame");
    const camera = JSON.parse((await frame.getAttribute("data-camera"))!) as Camera;
    const { poseOf, project } = await import("../../src/scene/camera.ts");
    const box = (await frame.boundingBox())!;
    const [x, y] = project(camera, poseOf(camera), box.width - 2, box.height - 2, centreOf(0, 0));
    const shown = (await page.locator(".space-labels .joint").first().evaluate((n) => /translate\(([-\d.]+)px, ([-\d.]+)px\)/.exec((n as HTMLElement).style.transform)!.slice(1).map(Number))) as [number, number];
    assert.ok(Math.hypot(shown[0] - x, shown[1] - y) < 1, `${shown.join()} against ${x}, ${y}`);
  },
  "the picture takes one draw call a kind": async ({ page }) => {
    const calls = Number(await page.locator(".space-frame").getAttribute("data-calls"));
    assert.ok(calls > 3 && calls <= 24, String(calls));
  },
  "the animation is a valid GLB": async ({ page }) => {
    const file = await savedBy(page, () => page.getByRole("button", { name: "Save GLB" }).click());
    assert.match(file.name, /\.glb$/);
    const report = await validator.validateBytes(new Uint8Array(file.bytes));
    assert.deepEqual([report.issues.numErrors, report.issues.numWarnings], [0, 0]);
  },
  "a film is WebM": async ({ page }) => {
    await page.getByLabel("Speed").selectOption("1");
    const film = await savedBy(page, () => page.getByRole("button", { name: "Save film" }).click());
    assert.match(film.name, /\.webm$/);
    assert.deepEqual([...film.bytes.subarray(0, 4)], [0x1a, 0x45, 0xdf, 0xa3]);
    assert.ok(film.bytes.length > 3000, String(film.bytes.length));
  },
  "the plane of a path is told with its box": async ({ page }) => {
    await page.getByRole("button", { name: "Plane" }).click();
    await settle(page);
    assert.match((await page.locator("#plane-facts").textContent()) ?? "", /Click a marker first|RMS off it, box/);
    await page.getByRole("button", { name: "Plane" }).click();
  },
};
