// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// npm run test:speed   how fast space is drawn without a graphics card: rows "PASS|FAIL | check | asked | measured"
import type { MarkersPage } from "../../src/page_types.ts";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import type { Page } from "playwright-core";
import { deflated } from "../packed.ts";
import { pack, simulatedMarkers } from "../simulated_markers.ts";
import { open, settle } from "./browser.ts";

let failed = false;
const row = (passed: boolean, check: string, asked: string, measured: string): void => {
  failed ||= !passed;
  console.log(`${passed ? "PASS" : "FAIL"} | ${check} | ${asked} | ${measured}`);
};

/** So many markers that move, and so many bodies. */
function crowd(markers: number, bodies: number, frames: number, rate: number, length: number): MarkersPage {
  const data = simulatedMarkers(8);
  const names = Array.from({ length: markers }, (_, m) => `M${m}`);
  const place = (m: number, f: number, k: number): number => [0.04 * m - 1, 0.4 * (m % 5), 0.3 + 0.2 * (m % 7)][k]! + 0.2 * Math.sin(0.02 * f + m + k);
  const lines = (count: number, off: number): number[][] => Array.from({ length: 3 * count }, (_, s) => Array.from({ length: frames }, (__, f) => place(2 * Math.floor(s / 3), f, s % 3) + (s % 3 === 2 ? off : 0)));
  const axes = Array.from({ length: 3 * markers }, (_, s) => Array.from({ length: frames }, (__, f) => place(Math.floor(s / 3), f, s % 3)));
  const states = { measured: length, interpolated: 0, model_filled: 0, upsampled: 0, missing: 0, rejected: 0 };
  return {
    summary: {
      ...data.summary, frames: length, rate_hz: rate, groups: [],
      markers: names.map((name) => ({ name, labelled: true, states, gaps: 0, longest_gap_s: null, longest_gap_time_s: null })),
    },
    scene: {
      ...data.scene, points: frames, frame_step: Math.max(1, Math.floor(length / frames)), names, plates: [], forces: [],
      markers: { positions_m: pack(axes, 1e-4), states: deflated(new Uint8Array(markers * frames)) },
      worst: length > frames ? deflated(new Uint8Array(markers * frames)) : null,
      ...(bodies > 0 ? { bodies: { names: names.slice(0, bodies), mass_kg: Array.from({ length: bodies }, () => 3), origin_m: pack(lines(bodies, 0), 1e-4), end_m: pack(lines(bodies, 0.3), 1e-4) } } : {}),
    },
  };
}

/** Milliseconds of script of each animation frame from now on, in the page. */
const watch = (page: Page): Promise<void> =>
  page.evaluate(() => {
    const known = window.requestAnimationFrame.bind(window);
    const times: number[] = [];
    (window as unknown as { scripts: number[] }).scripts = times;
    window.requestAnimationFrame = (run) =>
      known((now) => {
        const began = performance.now();
        run(now);
        times.push(performance.now() - began);
      });
  });

const share = (values: number[], part: number): number => [...values].sort((a, b) => a - b)[Math.min(values.length - 1, Math.floor(part * values.length))] ?? NaN;

const folder = mkdtempSync(join(tmpdir(), "kinemark-speed-"));
const template = readFileSync(new URL("../../dist/report.html", import.meta.url), "utf8");
const write = (name: string, data: unknown): string => {
  const file = join(folder, name);
  writeFileSync(file, template.replace('id="kinemark-data">null', () => `id="kinemark-data">${JSON.stringify(data).replaceAll("<", "\\u003c")}`));
  return file;
};

{
  // An hour of 16 markers at 240 Hz, as a page holds it: every so many-th of 864,000 frames.
  const { page, close } = await open(write("hour.html", crowd(16, 0, 18_000, 240, 864_000)));
  const first = await page.evaluate(() => performance.getEntriesByType("paint").map((e) => e.startTime).at(-1) ?? performance.now());
  row(first <= 1000, "an hour of 16 markers at 240 Hz: first picture", "<= 1 s after the data are there", `${first.toFixed(0)} ms`);
  if ((await page.locator(".broken").count()) > 0) throw new Error((await page.locator(".broken").first().textContent()) ?? "");
  await watch(page);
  await page.evaluate(async () => {
    const slider = document.querySelector<HTMLInputElement>("#space .transport input[type=range]")!;
    let seed = 7;
    for (let i = 0; i < 120; ++i) {
      seed = (seed * 48271) % 2147483647;
      slider.value = String(Math.floor((seed / 2147483647) * Number(slider.max)));
      slider.dispatchEvent(new Event("input"));
      await new Promise((done) => setTimeout(done, 60));
    }
  });
  const scripts = await page.evaluate(() => (window as unknown as { scripts: number[] }).scripts);
  row(share(scripts, 0.95) <= 10, "an hour of 16 markers at 240 Hz: scrubbing, script of a frame, p95", "<= 10 ms", `${share(scripts, 0.95).toFixed(1)} ms, median ${share(scripts, 0.5).toFixed(1)} (${scripts.length} frames)`);
  const heap = await page.evaluate(() => (performance as unknown as { memory: { usedJSHeapSize: number } }).memory.usedJSHeapSize / 1e6);
  row(heap <= 250, "an hour of 16 markers at 240 Hz: heap", "<= 250 MB", `${heap.toFixed(0)} MB`);
  await close();
}
{
  const { page, close } = await open(write("crowd.html", crowd(60, 30, 1500, 100, 1500)));
  await page.setViewportSize({ width: 1280, height: 720 });
  await page.locator("#space").scrollIntoViewIfNeeded();
  await page.getByLabel("Paths").selectOption("all");
  await settle(page);
  const perSecond = await page.evaluate(async () => {
    const frame = document.querySelector<HTMLElement>(".space-frame")!;
    let drawn = 0;
    const watcher = new MutationObserver(() => ++drawn);
    watcher.observe(frame, { attributes: true, attributeFilter: ["data-point"] });
    document.querySelector<HTMLElement>(".play")!.click();
    const began = performance.now();
    await new Promise((done) => setTimeout(done, 6000));
    watcher.disconnect();
    return (1000 * drawn) / (performance.now() - began);
  });
  row(perSecond >= 20, "60 markers, 30 bodies, trails, no graphics card, 1280 x 720", ">= 20 frames/s", `${perSecond.toFixed(1)} frames/s`);
  const calls = Number(await page.locator(".space-frame").getAttribute("data-calls"));
  row(calls <= 16, "60 markers, 30 bodies, trails: draw calls", "one a kind: <= 16", String(calls));
  await close();
}
rmSync(folder, { recursive: true });
process.exitCode = failed ? 1 : 0;
