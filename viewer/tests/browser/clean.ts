// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What the page of a cleaned recording must do in a browser.
import assert from "node:assert/strict";
import { hostile } from "../simulated.ts";
import { ink, opaqueInColumn, settle, type Check } from "./browser.ts";

/** True of every report that has markers. */
export const alwaysOfClean: Record<string, Check> = {
  "all sections are there, and nothing is broken": async ({ page }) => {
    assert.deepEqual(
      await page.locator("main > section").evaluateAll((all) => all.map((s) => s.id).filter((id) => id !== "space")),
      ["attention", "gaps", "markers", "marker", "recording", "settings"],
    );
    assert.equal(await page.locator(".broken").count(), 0);
  },
  "three axes and the gap map are drawn, with a band": async ({ page }) => {
    await page.selectOption("#marker-name", { index: 0 });
    await settle(page);
    for (const selector of ["#plot-x canvas", "#plot-y canvas", "#plot-z canvas", "#gap-map canvas"]) {
      assert.ok((await ink(page, selector)).drawn > 500, `${selector} is blank`);
    }
  },
  "choosing a marker redraws plots and facts, by list, by row, by arrow and on the map": async ({ page }) => {
    const names = await page.locator("#marker-name option").allTextContents();
    assert.equal(await page.locator("#markers tbody tr").count(), names.length);
    const chosen = (): Promise<number> => page.locator("#marker-name").evaluate((s) => (s as HTMLSelectElement).selectedIndex);
    await page.selectOption("#marker-name", { index: 0 });
    await settle(page);
    const before = await ink(page, "#plot-x canvas");
    await page.getByRole("button", { name: "Next marker" }).click();
    await settle(page);
    assert.equal(await chosen(), 1);
    assert.notEqual((await ink(page, "#plot-x canvas")).hash, before.hash);
    await page.locator("#markers tbody").getByRole("button", { name: names[0]!, exact: true }).click();
    await settle(page);
    assert.equal(await chosen(), 0);
    assert.equal(await page.locator("#markers tr.chosen .name").textContent(), names[0]);
    assert.equal((await ink(page, "#plot-x canvas")).hash, before.hash);
    await page.locator("#gap-map canvas").click({ position: { x: 500, y: 4 + 14 + 7 } });
    await settle(page);
    assert.equal(await chosen(), 1);
    await page.getByRole("button", { name: "Whole trial" }).click({ force: true });
  },
  "every quantity has its unit": async ({ page }) => {
    await page.locator("#plot-x .u-over").hover({ position: { x: 30, y: 40 } });
    for (const [name, unit] of [["Velocity", "m/s"], ["Acceleration", "m/s²"], ["Taken away", "mm"], ["Position", "mm"]] as const) {
      await page.getByRole("button", { name, exact: true }).click();
      await page.locator("#plot-x .u-over").hover({ position: { x: 40, y: 40 } });
      await settle(page);
      assert.match((await page.locator("#marker-readout").textContent()) ?? "", new RegExp(`(${unit}|no value|nothing came in)$`));
      assert.equal(await page.locator('#marker .choice[aria-pressed="true"]').textContent(), name);
    }
    await page.mouse.move(5, 5);
  },
  "the map before is not the map after where something was done": async ({ page }) => {
    const after = await ink(page, "#gap-map canvas");
    await page.getByRole("button", { name: "As it came in" }).click();
    await settle(page);
    const before = await ink(page, "#gap-map canvas");
    await page.getByRole("button", { name: "After cleaning" }).click();
    await settle(page);
    assert.equal((await ink(page, "#gap-map canvas")).hash, after.hash);
    const filled = (await page.locator(".tile").nth(3).textContent()) ?? "";
    if (!filled.startsWith("0 %")) assert.notEqual(before.hash, after.hash);
  },
  "dragging in one plot zooms all, double-click shows everything": async ({ page }) => {
    const range = page.locator(".bar .range");
    const whole = await range.textContent();
    await page.locator("#plot-y").scrollIntoViewIfNeeded();
    const other = await ink(page, "#plot-z canvas");
    const box = (await page.locator("#plot-y .u-over").boundingBox())!;
    await page.mouse.move(box.x + 200, box.y + 60);
    await page.mouse.down();
    await page.mouse.move(box.x + 400, box.y + 60, { steps: 5 });
    await page.mouse.up();
    await settle(page);
    assert.notEqual(await range.textContent(), whole);
    assert.notEqual((await ink(page, "#plot-z canvas")).hash, other.hash);
    await page.mouse.dblclick(box.x + 300, box.y + 60);
    await settle(page);
    assert.equal(await range.textContent(), whole);
  },
  "a narrow window scrolls down, not sideways": async ({ page }) => {
    await page.setViewportSize({ width: 380, height: 800 });
    await settle(page);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth));
    assert.ok((await page.locator("#plot-x canvas").boundingBox())!.width <= 380);
    await page.setViewportSize({ width: 1280, height: 900 });
    await settle(page);
  },
  "another theme redraws everything": async ({ page }) => {
    const light = [await ink(page, "#plot-x canvas"), await ink(page, "#gap-map canvas")];
    await page.emulateMedia({ colorScheme: "dark" });
    await settle(page);
    assert.notEqual((await ink(page, "#plot-x canvas")).hash, light[0]!.hash);
    assert.notEqual((await ink(page, "#gap-map canvas")).hash, light[1]!.hash);
    await page.emulateMedia({ colorScheme: "light" });
    await settle(page);
    assert.equal((await ink(page, "#plot-x canvas")).hash, light[0]!.hash);
  },
  "nothing was asked for and nothing complained": async ({ complaints }) => {
    assert.deepEqual(complaints, []);
  },
};

/** What the simulated recording must show. */
export const ofSimulatedClean: Record<string, Check> = {
  "hostile texts are shown as they are": async ({ page }) => {
    assert.equal(await page.locator("h1").textContent(), `reach ${hostile}`);
    assert.equal(await page.locator("#page img").count(), 0);
    assert.equal(await page.locator(".group").nth(2).locator(".text").textContent(), hostile);
    assert.equal(await page.locator("#marker-name option").nth(3).textContent(), hostile);
    await page.selectOption("#marker-name", { index: 3 });
    await settle(page);
    assert.equal(await page.locator("#page img").count(), 0);
    assert.equal(await page.title(), `reach ${hostile} · kinemark report`);
  },
  "the page opens with the marker of the first finding": async ({ page }) => {
    await page.reload();
    await settle(page);
    assert.equal(await page.locator("#markers tr.chosen .name").textContent(), "B");
    assert.match((await page.locator("#marker-gaps").textContent()) ?? "", /70 % rigid; 30 % cubic/);
  },
  "a finding jumps to its marker and its time": async ({ page }) => {
    await page.locator(".group").nth(1).getByRole("button").click();
    await settle(page);
    assert.equal(await page.locator("#marker-name").evaluate((s) => (s as HTMLSelectElement).value), "C");
    assert.equal(await page.locator(".bar .range").textContent(), "1.00 to 3.00 s");
    assert.match((await page.locator("#marker-readout").textContent()) ?? "", /missing: no value/);
    // Frames 200 to 299 are missing: the right half is striped from top to bottom.
    const plot = (await page.locator("#plot-x .u-over").boundingBox())!;
    const canvas = (await page.locator("#plot-x canvas").boundingBox())!;
    const opaque = (share: number): Promise<number> => opaqueInColumn(page, "#plot-x canvas", plot.x - canvas.x + share * plot.width);
    assert.ok((await opaque(0.72)) > plot.height - 5);
    assert.ok((await opaque(0.33)) < 60);
    await page.getByRole("button", { name: "Whole trial" }).click();
  },
  "the wide error bar of a filled gap can be seen": async ({ page }) => {
    await page.selectOption("#marker-name", { label: "B" });
    await page.getByRole("button", { name: "Taken away" }).click();
    await settle(page);
    assert.ok((await ink(page, "#plot-x canvas")).translucent > 2000);
    await page.getByRole("button", { name: "Position", exact: true }).click();
  },
  "spectrum and autocorrelation are drawn where they are known": async ({ page }) => {
    assert.equal(await page.locator("#spectrum path.raw").count(), 1);
    assert.equal(await page.locator("#autocorrelation rect").count(), 3);
    const box = (await page.locator("#spectrum svg").boundingBox())!;
    assert.ok(box.width > 300 && box.height > 100);
    await page.selectOption("#marker-name", { index: 3 });
    await settle(page);
    assert.equal(await page.locator("#spectrum svg").count(), 0);
  },
  "headings sort the markers by noise": async ({ page }) => {
    await page.locator("#markers thead").getByRole("button", { name: "Noise SD" }).click();
    assert.deepEqual((await page.locator("#markers tbody .name").allTextContents()).slice(0, 3), ["B", "C", "A"]);
  },
};
