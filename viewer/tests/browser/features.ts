// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// One check for each thing that a page offers, on the page as a person sees it.
import type { IkPage, PackedCurve } from "../../src/page_types.ts";
import assert from "node:assert/strict";
import type { Page } from "playwright-core";
import { packedCurve } from "../packed.ts";
import { simulated } from "../simulated.ts";
import { placeOf } from "../simulated_markers.ts";
import { ink, settle, type Check } from "./browser.ts";
import { savedBy } from "./results.ts";
import { cameraOf, goTo, pixelsOf, pointOf } from "./space.ts";

/** Two knees and a root; the right knee lies at its limit, both have torques, the body weighs 60 kg. */
export function simulatedPair(higher = 0): IkPage {
  const data = simulated();
  const { frames } = data.summary;
  const line = (value: (f: number) => number): PackedCurve => packedCurve(Array.from({ length: frames }, (_, f) => value(f)));
  ["knee_angle_r", "knee_angle_l", "root_tx"].forEach((name, i) => (data.summary.coordinates[i]!.name = name));
  Object.assign(data.summary.coordinates[0]!, { limits: [-120, 9], at_limit_frames: 12 });
  data.summary.mass_kg = 60;
  data.series.coordinates[0]!.value = line((f) => 10 * Math.sin(f / 30) + higher);
  data.series.torques = [30, 42].map((value) => ({ value: line(() => value), sd: line(() => 2) }));
  data.series.torques.push(null);
  return data;
}

const press = async (page: Page, name: string): Promise<void> => {
  await page.locator("main").getByRole("button", { name, exact: true }).first().click();
  await settle(page);
};
const picture = async (page: Page): Promise<number> => (await ink(page, ".space-canvas")).hash;

/** Whether something changes the picture in space, and doing it again brings it back. */
async function switches(page: Page, name: string): Promise<void> {
  const before = await picture(page);
  await press(page, name);
  assert.notEqual(await picture(page), before, `${name} changes the picture`);
  await press(page, name);
  assert.equal(await picture(page), before, `${name} again brings it back`);
}

/** Pixels of a drawing, or of a part of one, that have a colour of the style sheet. */
const coloured = (page: Page, selector: string, variable: string): Promise<number> =>
  page.locator(selector).first().evaluate((node, name) => {
    const canvas = node as HTMLCanvasElement;
    const probe = document.createElement("span");
    probe.style.color = `var(${name})`;
    document.body.append(probe);
    const wanted = getComputedStyle(probe).color.match(/[\d.]+/g)!.slice(0, 3).map(Number);
    probe.remove();
    const { data } = canvas.getContext("2d")!.getImageData(0, 0, canvas.width, canvas.height);
    let count = 0;
    for (let i = 0; i < data.length; i += 4) if (data[i + 3]! > 200 && wanted.every((v, k) => Math.abs(v - data[i + k]!) < 24)) ++count;
    return count;
  }, variable);

const numbersOf = async (page: Page, figure: string): Promise<string> => {
  const box = page.locator(figure).first();
  await box.scrollIntoViewIfNeeded();
  await box.hover();
  return (await savedBy(page, () => box.getByRole("button", { name: "CSV" }).click())).bytes.toString();
};

/** @param second  a page of another result of the same coordinates, the right knee 1 deg higher */
export const ofPair = (second: string): Record<string, Check> => ({
  "both sides lie in one plot, in two colours": async ({ page }) => {
    const figure = page.locator("#compare figure").first();
    await figure.scrollIntoViewIfNeeded();
    assert.match((await figure.locator("figcaption").textContent()) ?? "", /right.*left/);
    assert.ok((await coloured(page, "#compare figure canvas", "--accent")) > 100, "right");
    assert.ok((await coloured(page, "#compare figure canvas", "--second")) > 100, "left");
  },
  "coordinates are chosen by name": async ({ page }) => {
    const count = await page.locator("#compare figure").count();
    await page.locator("#compare summary").click();
    await page.locator("#compare .tick input").first().uncheck();
    assert.equal(await page.locator("#compare figure").count(), count - 1);
    await page.locator("#compare .tick input").first().check();
    await settle(page);
    assert.equal(await page.locator("#compare figure").count(), count);
  },
  "a coordinate that lies at its limit is marked, and how often is said": async ({ page }) => {
    assert.match((await page.locator(".cell").first().textContent()) ?? "", /at a limit/);
    assert.doesNotMatch((await page.locator(".cell").nth(1).textContent()) ?? "", /at a limit/);
    assert.match((await page.locator("#angles").textContent()) ?? "", /At a limit of its range \(dashed\) in 12 of 400 frames/);
  },
  "torques are shown, and per kg of body mass if asked": async ({ page }) => {
    await press(page, "Torques");
    const plain = await numbersOf(page, "#compare figure:has(figcaption:has-text('knee'))");
    assert.match(plain.split("\r\n")[0]!, /N m\)/);
    assert.match(plain.split("\r\n")[1]!, /,30(\.0+)?(,|$)/);
    await press(page, "per kg (60.0 kg)");
    const perKg = await numbersOf(page, "#compare figure:has(figcaption:has-text('knee'))");
    assert.match(perKg.split("\r\n")[0]!, /N m\/kg/);
    assert.match(perKg.split("\r\n")[1]!, /,0\.50*(,|$)/);
    await press(page, "per kg (60.0 kg)");
    await press(page, "Torques");
  },
  "a second result lies dashed over the first, and how far they are apart is said": async ({ page }) => {
    const before = await ink(page, "#compare figure canvas");
    await page.setInputFiles("#second-file", second);
    await settle(page);
    // One of two angles differs by 1 deg; the other one has 60 frames fewer.
    assert.match((await page.locator("#second-result").textContent()) ?? "", /lies over it dashed: 3 coordinates of the same name, angles 0\.7\d deg apart RMS/);
    assert.notEqual((await ink(page, "#compare figure canvas")).hash, before.hash);
  },
  "what is no result is refused in words": async ({ page }) => {
    await page.setInputFiles("#second-file", { name: "notes.html", mimeType: "text/html", buffer: Buffer.from("<p>notes</p>") });
    await settle(page);
    assert.equal(await page.locator("#second-result").textContent(), "notes.html cannot be laid over this result: this file is no page of kinemark.");
  },
});

/** What the page of a recording with a force plate offers. */
export const ofRecording: Record<string, Check> = {
  "ground reactions are shown, and divided by a body mass": async ({ page }) => {
    const plain = await numbersOf(page, "#ground figure");
    assert.match(plain.split("\r\n")[1]!, /,700(\.0+)?$/);
    await page.locator("#body-mass").fill("70");
    await page.locator("#body-mass").press("Tab");
    await settle(page);
    const perKg = await numbersOf(page, "#ground figure");
    assert.match(perKg.split("\r\n")[0]!, /N\/kg/);
    assert.match(perKg.split("\r\n")[1]!, /,10(\.0+)?$/);
    await page.locator("#body-mass").fill("");
    await page.locator("#body-mass").press("Tab");
  },
  "a force is an arrow from where it acts, a metre for 1,000 N": async ({ page }) => {
    for (const name of ["Names", "Paths"]) await page.locator(`#space select[aria-label="${name}"]`).selectOption("none");
    await goTo(page, 10);
    await page.locator(".space-canvas").focus();
    await page.keyboard.press("2");
    await settle(page);
    const [camera, box] = [await cameraOf(page), (await page.locator(".space-canvas").boundingBox())!];
    const colourAt = (x: readonly number[]): Promise<number[]> => {
      const [left, top] = pixelsOf(camera, box.width, box.height, x);
      return page.locator(".space-canvas").evaluate((node, at) => {
        const canvas = node as HTMLCanvasElement;
        const ratio = canvas.width / canvas.clientWidth;
        const copy = new OffscreenCanvas(1, 1).getContext("2d")!;
        copy.drawImage(canvas, -Math.round(at.left * ratio), -Math.round(at.top * ratio));
        return [...copy.getImageData(0, 0, 1, 1).data].slice(0, 3);
      }, { left, top });
    };
    const isOrange = ([r, g, b]: number[]): boolean => r! > 1.5 * g! && r! > 2 * b!;
    assert.ok(isOrange(await colourAt([0.2, 0.3, 0.35])), "halfway");
    assert.ok(isOrange(await colourAt([0.2, 0.3, 0.67])), "just below its tip at 0.7 m");
    assert.ok(!isOrange(await colourAt([0.2, 0.3, 0.75])), "nothing above it");
  },
  "paths of all markers are drawn, coloured by time": async ({ page }) => {
    const paths = page.locator('#space select[aria-label="Paths"]');
    await goTo(page, 120);
    const none = await picture(page);
    await paths.selectOption("all");
    await settle(page);
    assert.notEqual(await picture(page), none);
    await paths.selectOption("none");
    await settle(page);
    assert.equal(await picture(page), none);
  },
  "what is nearest is cut away": async ({ page }) => {
    const whole = await ink(page, ".space-canvas");
    const cut = page.getByLabel("Cut away what is nearest, per cent");
    await cut.fill("60");
    await settle(page);
    assert.notEqual((await ink(page, ".space-canvas")).hash, whole.hash);
    await cut.fill("0");
    await settle(page);
    assert.equal((await ink(page, ".space-canvas")).hash, whole.hash);
  },
  "a marker that is followed stays where it is in the picture": async ({ page }) => {
    await page.selectOption("#marker-name", { index: 1 });
    await goTo(page, 20);
    await press(page, "Follow");
    const at = async (frame: number): Promise<[number, number]> => {
      await goTo(page, frame);
      const [camera, box] = [await cameraOf(page), (await page.locator(".space-canvas").boundingBox())!];
      return pixelsOf(camera, box.width, box.height, placeOf(1, frame));
    };
    const [a, b] = [await at(20), await at(180)];
    assert.ok(Math.hypot(a[0] - b[0], a[1] - b[1]) < 0.5, `${a.join()} and ${b.join()}`);
    await press(page, "Follow");
  },
  "the plane of a path has its axes and its box, and is said in numbers": async ({ page }) => {
    await page.selectOption("#marker-name", { index: 0 });
    await settle(page);
    const before = await picture(page);
    await press(page, "Plane");
    assert.notEqual(await picture(page), before);
    // x swings by 0.2 m about a line along y of 0.2 m; z stays.
    assert.match((await page.locator("#plane-facts").textContent()) ?? "", /^A: plane of 200 samples from 1\.000 s to 2\.990 s; 0\.0\d mm RMS off it, box .* × 0\.0 mm along its axes, normal \(.*1\.000\)\.$/);
    await press(page, "Plane");
    assert.equal(await picture(page), before);
  },
  "it plays at the rate that is chosen, and ends without Loop": async ({ page }) => {
    await goTo(page, 0);
    await page.getByLabel("Speed").selectOption("4");
    await press(page, "Loop");
    await page.getByRole("button", { name: "Play" }).click();
    await page.waitForFunction(() => document.querySelector(".play")!.getAttribute("aria-pressed") === "false", undefined, { timeout: 20_000 });
    await settle(page);
    assert.equal(await pointOf(page), 199, "two seconds at fourfold speed, and it stays at the last frame");
    await press(page, "Loop");
    await page.getByLabel("Speed").selectOption("1");
  },
};

/** What a scene with joint centres offers. */
export const ofRegions: Record<string, Check> = {
  "regions of joint centres are drawn, larger if asked, and not": async ({ page }) => {
    const regions = page.locator('#space select[aria-label="95 % regions"]');
    const seen = new Set([await picture(page)]);
    for (const size of ["0", "3", "10"]) {
      await regions.selectOption(size);
      await settle(page);
      seen.add(await picture(page));
    }
    assert.equal(seen.size, 4);
    await regions.selectOption("1");
    await settle(page);
  },
};

/** What a scene with cameras offers. */
export const ofCameras: Record<string, Check> = {
  "cameras stand there by name, with rays to what they see": async ({ page }) => {
    assert.deepEqual((await page.locator(".space-labels .tag.picked").allTextContents()).filter((t) => t.length === 1), ["A", "B"]);
    await switches(page, "Rays");
  },
};
