// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What the space view and the page of a recording must do in a browser.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import type { Page } from "playwright-core";
import { hostile } from "../simulated.ts";
import { markerNames, middleStates, placeOf } from "../simulated_markers.ts";
import { ink, settle, type Check } from "./browser.ts";

export interface Seen {
  target: number[];
  up: number[];
  azimuth: number;
  elevation: number;
  distance: number;
  perspective: boolean;
}

export const cameraOf = async (page: Page): Promise<Seen> => JSON.parse((await page.locator(".space-frame").getAttribute("data-camera"))!) as Seen;
export const pointOf = async (page: Page): Promise<number> => Number(await page.locator(".space-frame").getAttribute("data-point"));

/** Show a frame of the recording in every plot. */
export async function goTo(page: Page, frame: number): Promise<void> {
  await page.locator("#space .transport input[type=range]").evaluate((node, value) => {
    (node as HTMLInputElement).value = String(value);
    node.dispatchEvent(new Event("input"));
  }, frame);
  await settle(page);
}

type Row = [number, number, number, number];
const times = (a: Row[], b: Row[]): Row[] => a.map((row) => [0, 1, 2, 3].map((c) => row.reduce((sum, v, k) => sum + v * b[k]![c]!, 0)) as Row);

/**
 * Pixels of a place by the textbook: a look-at matrix, a projection matrix, the division by w. Written apart from
 * the page's own code, for z up.
 */
export function pixelsOf(camera: Seen, width: number, height: number, x: readonly number[]): [number, number] {
  const [ce, se, ca, sa] = [Math.cos(camera.elevation), Math.sin(camera.elevation), Math.cos(camera.azimuth), Math.sin(camera.azimuth)];
  const eye = [camera.target[0]! + camera.distance * ce * ca, camera.target[1]! + camera.distance * ce * sa, camera.target[2]! + camera.distance * se];
  const back = [ce * ca, ce * sa, se];
  const right = [-sa, ca, 0];
  const up = [-se * ca, -se * sa, ce];
  const minus = (axis: number[]): number => -axis.reduce((sum, v, k) => sum + v * eye[k]!, 0);
  const view: Row[] = [right, up, back].map((axis) => [axis[0]!, axis[1]!, axis[2]!, minus(axis)]);
  view.push([0, 0, 0, 1]);
  const f = 1 / Math.tan((35 * Math.PI) / 360);
  const [near, far, aspect] = [0.02, 400, width / height];
  const half = camera.distance / f;
  const lens: Row[] = camera.perspective
    ? [[f / aspect, 0, 0, 0], [0, f, 0, 0], [0, 0, (far + near) / (near - far), (2 * far * near) / (near - far)], [0, 0, -1, 0]]
    : [[1 / (half * aspect), 0, 0, 0], [0, 1 / half, 0, 0], [0, 0, -2 / (far - near), 0], [0, 0, 0, 1]];
  const clip = times(lens, view).map((row) => row[0] * x[0]! + row[1] * x[1]! + row[2] * x[2]! + row[3]);
  return [((clip[0]! / clip[3]! + 1) / 2) * width, ((1 - clip[1]! / clip[3]!) / 2) * height];
}

/** Middle of the pixels within `reach` of a place that are no floor, and the mean colour of the middle ones. */
const blobAt = (page: Page, left: number, top: number, reach = 7): Promise<{ x: number; y: number; count: number; colour: number[] }> =>
  page.locator(".space-canvas").evaluate((node, at) => {
    const canvas = node as HTMLCanvasElement;
    const ratio = canvas.width / canvas.clientWidth;
    const side = Math.ceil(2 * at.reach * ratio) + 1;
    const corner = [Math.round((at.left - at.reach) * ratio), Math.round((at.top - at.reach) * ratio)] as const;
    const copy = new OffscreenCanvas(side, side).getContext("2d", { willReadFrequently: true })!;
    copy.drawImage(canvas, -corner[0], -corner[1]);
    const { data } = copy.getImageData(0, 0, side, side);
    let [x, y, count] = [0, 0, 0];
    const colour = [0, 0, 0];
    for (let i = 0; i < side * side; ++i) {
      const [r, g, b] = [data[4 * i]!, data[4 * i + 1]!, data[4 * i + 2]!];
      if (Math.max(r, g, b) - Math.min(r, g, b) < 40 && Math.max(r, g, b) > 110) continue;
      x += corner[0] + (i % side) + 0.5;
      y += corner[1] + Math.floor(i / side) + 0.5;
      [r, g, b].forEach((v, k) => (colour[k]! += v));
      ++count;
    }
    return { x: x / count / ratio, y: y / count / ratio, count, colour: colour.map((v) => v / count) };
  }, { left, top, reach });

const boxOf = async (page: Page): Promise<{ x: number; y: number; width: number; height: number }> => (await page.locator(".space-canvas").boundingBox())!;

async function select(page: Page, label: string, value: string): Promise<void> {
  await page.locator(`#space select[aria-label="${label}"]`).selectOption(value);
  await settle(page);
}

/** True of every page of a recording that has markers. */
export const alwaysOfMarkers: Record<string, Check> = {
  "all sections are there, and nothing is broken": async ({ page }) => {
    assert.deepEqual(
      await page.locator("main > section").evaluateAll((all) => all.map((s) => s.id).filter((id) => id !== "ground" && id !== "cycles" && id !== "neural")),
      ["attention", "space", "marker", "gaps", "markers", "rest", "settings"],
    );
    assert.equal(await page.locator(".broken").count(), 0);
  },
  "spikes, trials and potentials are drawn under space, where the file has them": async ({ page }) => {
    if ((await page.locator("#neural").count()) === 0) return;
    assert.ok((await ink(page, "#lanes canvas")).drawn > 500, "the raster is blank");
    assert.match((await page.locator("#neural .lead").textContent())!, /on the clock of the recording/);
  },
  "space, curves and the map of gaps are drawn": async ({ page }) => {
    for (const selector of [".space-canvas", "#plot-x canvas", "#gap-map canvas"]) {
      assert.ok((await ink(page, selector)).drawn > 500, `${selector} is blank`);
    }
    const calls = Number(await page.locator(".space-frame").getAttribute("data-calls"));
    assert.ok(calls > 2 && calls <= 20, `${calls} draw calls: one a kind`);
  },
  "play, scrub and step show the same instant in every plot": async ({ page }) => {
    const last = Number(await page.locator("#space .transport input[type=range]").getAttribute("max"));
    await goTo(page, Math.floor(last / 2));
    const lineIn = (box: string): Promise<number> => page.locator(`${box} .time-line.asked`).evaluate((node) => node.getBoundingClientRect().left);
    const [space, curve, map] = [await ink(page, ".space-canvas"), await lineIn("#plot-x"), await lineIn("#gap-map")];
    const before = await pointOf(page);
    assert.equal(before, Math.floor(last / 2));
    await page.locator(".space-canvas").focus();
    await page.keyboard.press("ArrowRight");
    await settle(page);
    assert.equal(await pointOf(page), Math.min(before + 1, last));
    await page.keyboard.press("Home");
    await settle(page);
    assert.equal(await pointOf(page), 0);
    // A recording of one frame has no other instant.
    if (last > 0) {
      assert.ok((await lineIn("#plot-x")) < curve - 100, "the curves follow");
      assert.ok((await lineIn("#gap-map")) < map - 100, "the map follows");
    }
    await page.keyboard.press(" ");
    for (const begun = Date.now(); (await pointOf(page)) === 0 && last > 0 && Date.now() - begun < 20_000; ) await page.waitForTimeout(20);
    // A recording of a few frames has come to its end by now, where the key would begin anew.
    if ((await page.locator('#space .transport button[aria-label="Pause"]').count()) > 0) await page.keyboard.press(" ");
    await settle(page);
    const played = await pointOf(page);
    assert.ok(played > 0 || last === 0, "it plays");
    await page.waitForTimeout(150);
    assert.equal(await pointOf(page), played, "it stops");
    await goTo(page, Math.floor(last / 2));
    assert.equal((await ink(page, ".space-canvas")).hash, space.hash, "the same instant is the same picture");
  },
  "turning, moving, coming nearer and the standard views change the picture": async ({ page }) => {
    const box = await boxOf(page);
    const hashes = new Set<number>([(await ink(page, ".space-canvas")).hash]);
    const middle = [box.x + box.width / 2, box.y + box.height / 2] as const;
    const see = async (): Promise<void> => {
      await settle(page);
      const { hash } = await ink(page, ".space-canvas");
      assert.ok(!hashes.has(hash), "another picture");
      hashes.add(hash);
    };
    await page.mouse.move(...middle);
    await page.mouse.down();
    await page.mouse.move(middle[0] + 60, middle[1] + 20, { steps: 4 });
    await page.mouse.up();
    await see();
    await page.keyboard.down("Shift");
    await page.mouse.down();
    await page.mouse.move(middle[0], middle[1] - 30, { steps: 4 });
    await page.mouse.up();
    await page.keyboard.up("Shift");
    await see();
    await page.locator(".space-canvas").focus();
    await page.mouse.wheel(0, -200);
    await see();
    for (const key of ["1", "2", "3"]) {
      await page.keyboard.press(key);
      await see();
    }
    await page.getByRole("button", { name: "Perspective" }).click();
    await see();
    await page.getByRole("button", { name: "Perspective" }).click();
    await page.locator(".space-canvas").focus();
    await page.keyboard.press("0");
    await settle(page);
  },
  "nothing is wider than a phone": async ({ page }) => {
    await page.setViewportSize({ width: 390, height: 800 });
    await settle(page);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth));
    await page.setViewportSize({ width: 1280, height: 720 });
    await settle(page);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth));
  },
  "another theme redraws space, print is light": async ({ page }) => {
    await page.locator(".space-canvas").focus();
    await page.keyboard.press("0");
    await settle(page);
    const light = await ink(page, ".space-canvas");
    await page.emulateMedia({ colorScheme: "dark" });
    await settle(page);
    assert.notEqual((await ink(page, ".space-canvas")).hash, light.hash);
    await page.emulateMedia({ colorScheme: "light" });
    await settle(page);
    assert.equal((await ink(page, ".space-canvas")).hash, light.hash);
  },
  "the picture and the tables can be saved": async ({ page }) => {
    const picture = page.waitForEvent("download");
    await page.getByRole("button", { name: "Save picture" }).click();
    const png = readFileSync((await (await picture).path())!);
    assert.equal(png.subarray(1, 4).toString(), "PNG");
    assert.ok(png.length > 3000);
    const table = page.waitForEvent("download");
    await page.locator("#markers").getByRole("button", { name: "Save as CSV" }).click();
    const text = readFileSync((await (await table).path())!, "utf8");
    assert.match(text, /^Marker,Measured %,/);
    assert.equal(text.trimEnd().split("\r\n").length, 1 + (await page.locator("#markers tbody tr").count()));
    const figure = page.waitForEvent("download");
    await page.locator("#marker").getByRole("button", { name: "SVG" }).first().click();
    const drawing = readFileSync((await (await figure).path())!, "utf8");
    assert.match(drawing, /^<svg xmlns="http:\/\/www.w3.org\/2000\/svg"/);
    assert.match(drawing, /<path/);
  },
  "nothing was asked for and nothing complained": async ({ complaints }) => {
    assert.deepEqual(complaints, []);
  },
};

/** What the made-up recording must show. */
export const ofSimulatedMarkers: Record<string, Check> = {
  "hostile names are shown as they are": async ({ page }) => {
    assert.equal(await page.locator("h1").textContent(), `walk ${hostile}`);
    await select(page, "Names", "all");
    assert.ok((await page.locator(".space-labels span").allTextContents()).includes(hostile));
    assert.equal(await page.locator("#page img").count(), 0);
    assert.equal(await page.title(), `walk ${hostile} · kinemark report`);
  },
  "the header tells the numbers and findings are folded": async ({ page }) => {
    assert.deepEqual(await page.locator(".tile").allTextContents(), [
      "8markers7 named",
      "200frames2.00 s at 100 Hz",
      "84.4 %measuredof 1,600 samples",
      "9.4 %filled150 samples",
      "6.3 %missing2 gaps",
      "2channels1 event",
    ]);
    assert.equal(await page.locator("#attention summary .text").textContent(), "2 markers partly missing");
    assert.equal(await page.locator("#attention li").first().isVisible(), false);
    await page.locator("#attention summary").click();
    await page.locator("#attention li").first().getByRole("button").click();
    await settle(page);
    assert.match((await page.locator("#space-readout").textContent()) ?? "", /^E, missing: no value/);
  },
  "markers are where an independent projection has them, to a pixel": async ({ page }) => {
    await select(page, "Names", "none");
    await select(page, "Paths", "none");
    const lines = page.getByRole("button", { name: "Lines", exact: true });
    if ((await lines.count()) > 0 && (await lines.getAttribute("aria-pressed")) === "true") await lines.click();
    for (const perspective of [true, false]) {
      for (const frame of [0, 137]) {
        await goTo(page, frame);
        await page.locator(".space-canvas").focus();
        await page.keyboard.press("1");
        await settle(page);
        const [camera, box] = [await cameraOf(page), await boxOf(page)];
        assert.equal(camera.perspective, perspective);
        for (const m of [0, 1, 2, 3, 5, 6]) {
          const [x, y] = pixelsOf(camera, box.width, box.height, placeOf(m, frame));
          const blob = await blobAt(page, x, y);
          assert.ok(blob.count > 20, `marker ${m} is drawn`);
          assert.ok(Math.hypot(blob.x - x, blob.y - y) < 1, `marker ${m}: drawn at ${blob.x}, ${blob.y}, projected to ${x}, ${y}`);
        }
      }
      await page.getByRole("button", { name: "Perspective" }).click();
      await settle(page);
    }
    assert.equal((await cameraOf(page)).perspective, true);
  },
  "names stand at their markers": async ({ page }) => {
    await select(page, "Names", "all");
    await goTo(page, 20);
    const [camera, box] = [await cameraOf(page), await boxOf(page)];
    const tags = await page.locator(".space-labels span.tag").evaluateAll((all) =>
      all.filter((t) => !(t as HTMLElement).hidden).map((t) => ({ text: t.textContent, at: new DOMMatrix(getComputedStyle(t).transform) })).map((t) => ({ text: t.text, x: t.at.e, y: t.at.f })),
    );
    assert.equal(tags.length, 7, "all but the one that nobody named");
    for (const tag of tags) {
      const [x, y] = pixelsOf(camera, box.width, box.height, placeOf(markerNames.indexOf(tag.text!), 20));
      assert.ok(Math.hypot(tag.x - x, tag.y - y) < 1, `${tag.text}: ${tag.x}, ${tag.y}, projected to ${x}, ${y}`);
    }
    await select(page, "Names", "none");
  },
  "each state has a look of its own": async ({ page }) => {
    await goTo(page, 75);
    await page.locator(".space-canvas").focus();
    await page.keyboard.press("1");
    await settle(page);
    const [camera, box] = [await cameraOf(page), await boxOf(page)];
    const looks: { state: number; colour: number[]; count: number }[] = [];
    for (const m of [0, 1, 2, 3, 4, 5]) {
      const [x, y] = pixelsOf(camera, box.width, box.height, placeOf(m, m >= 4 ? 49 : 75));
      const blob = await blobAt(page, x, y);
      assert.ok(blob.count > 15, `marker ${m}`);
      looks.push({ state: middleStates[m]!, colour: blob.colour, count: blob.count });
    }
    for (const a of looks) {
      for (const b of looks) {
        if (a.state >= b.state) continue;
        const apart = Math.hypot(...a.colour.map((v, k) => v - b.colour[k]!));
        assert.ok(apart > 25, `states ${a.state} and ${b.state} differ by ${apart.toFixed(0)}`);
      }
    }
    assert.deepEqual(await page.locator("#space .legend li").allTextContents(),
      ["measured", "made by the recorder", "interpolated from its own path", "filled from other markers", "missing: where it was last", "rejected"]);
  },
  "a click picks a marker and its curve": async ({ page }) => {
    await goTo(page, 10);
    const [camera, box] = [await cameraOf(page), await boxOf(page)];
    const curve = await ink(page, "#plot-x canvas");
    const [x, y] = pixelsOf(camera, box.width, box.height, placeOf(2, 10));
    await page.locator(".space-canvas").click({ position: { x: x + 2, y: y - 2 } });
    await settle(page);
    assert.match((await page.locator("#space-readout").textContent()) ?? "", /^C, measured/);
    assert.equal(await page.locator("#marker-name").evaluate((s) => (s as HTMLSelectElement).value), "C");
    assert.notEqual((await ink(page, "#plot-x canvas")).hash, curve.hash);
    await page.locator(".space-canvas").click({ position: { x: 6, y: 6 } });
    await settle(page);
    assert.match((await page.locator("#space-readout").textContent()) ?? "", /^Click a marker/);
    await page.selectOption("#marker-name", { index: 0 });
    await settle(page);
  },
  "an event and a click in a curve lead to their instants": async ({ page }) => {
    await page.locator("#rest").getByRole("button", { name: "1.750" }).click();
    await settle(page);
    assert.equal(await pointOf(page), 75);
    const plot = (await page.locator("#plot-y .u-over").boundingBox())!;
    await page.locator("#plot-y .u-over").click({ position: { x: plot.width / 2, y: 30 } });
    await settle(page);
    assert.ok(Math.abs((await pointOf(page)) - 99.5) <= 1.5);
    await page.mouse.move(5, 5);
  },
};

/** The space view of a page that compares two positions of each marker. */
export const comparesInSpace = (name: string, legend: string): Record<string, Check> => ({
  [`space shows both, and "${name}" takes the other away`]: async ({ page }) => {
    assert.ok((await ink(page, ".space-canvas")).drawn > 500);
    assert.ok((await page.locator("#space .legend li").allTextContents()).includes(legend));
    const both = await ink(page, ".space-canvas");
    await page.locator("#space").getByRole("button", { name, exact: true }).click();
    await settle(page);
    const one = await ink(page, ".space-canvas");
    assert.notEqual(one.hash, both.hash);
    await page.locator("#space").getByRole("button", { name, exact: true }).click();
    await settle(page);
    assert.equal((await ink(page, ".space-canvas")).hash, both.hash);
  },
  "space is on the instant of the plots": async ({ page }) => {
    await page.locator("#space .transport input[type=range]").evaluate((node) => {
      (node as HTMLInputElement).value = "150";
      node.dispatchEvent(new Event("input"));
    });
    await settle(page);
    assert.equal(await pointOf(page), 150);
    const there = await ink(page, ".space-canvas");
    await page.locator("#gap-map canvas").click({ position: { x: 300, y: 8 } });
    await page.mouse.move(5, 5);
    await settle(page);
    assert.notEqual(await pointOf(page), 150);
    assert.notEqual((await ink(page, ".space-canvas")).hash, there.hash);
    await page.reload();
    await page.waitForFunction(() => document.documentElement.dataset["ready"] !== undefined);
    await settle(page);
  },
});

/** A recording whose events mark cycles. */
export const walksInCycles: Record<string, Check> = {
  "the picked marker is drawn over the cycles of each foot, with their number": async ({ page }) => {
    const figures = page.locator("#cycles .cycle-figure");
    assert.equal(await figures.count(), 3, "x, y and z");
    assert.match((await figures.first().textContent()) ?? "", /^A x/);
    assert.equal(await figures.first().locator("path.cycle").count(), 3);
    assert.match((await figures.first().textContent()) ?? "", /left: 3 cycles/);
    assert.equal(await figures.first().locator("path.cycle-mean.right").count(), 0, "the right foot strikes once");
    // One swing of a sine: highest at a quarter of the cycle, lowest at three.
    const mean = figures.first().locator("path.cycle-mean.left");
    const places = ((await mean.getAttribute("d")) ?? "").match(/-?[\d.]+/g)!.map(Number);
    const heights = places.filter((_, i) => i % 2 === 1);
    assert.equal(heights.length, 101);
    assert.ok(Math.abs(heights.indexOf(Math.min(...heights)) - 25) <= 1 && Math.abs(heights.indexOf(Math.max(...heights)) - 75) <= 1);
  },
  "another marker is another figure": async ({ page }) => {
    await page.selectOption("#marker-name", { index: 1 });
    await settle(page);
    assert.match((await page.locator("#cycles .cycle-figure").first().textContent()) ?? "", /^B x/);
    await page.selectOption("#marker-name", { index: 0 });
    await settle(page);
  },
};

/** Without WebGL2 the rest of the page works. */
export const withoutWebGl: Record<string, Check> = {
  "one sentence says what is missing, and the curves are there": async ({ page, complaints }) => {
    assert.match((await page.locator("#space .broken").textContent()) ?? "", /needs WebGL2/);
    assert.ok((await ink(page, "#plot-x canvas")).drawn > 500);
    assert.ok((await ink(page, "#gap-map canvas")).drawn > 500);
    assert.deepEqual(complaints, []);
  },
};
