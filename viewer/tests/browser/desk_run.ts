// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// npm run test:desk   trials of a simulated rig, recorded from the page of `KINEMARK_PROGRAM serve sim:rig`, as a person does it.
// KINEMARK_SCREENSHOTS names a folder for pictures of every step.
import assert from "node:assert/strict";
import { mkdtempSync, readdirSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import type { Page } from "playwright-core";
import { problemsOf } from "../../schema/problems.ts";
import { open, settle } from "./browser.ts";
import { clipped, violations } from "./looks.ts";
import { serve } from "./serving.ts";

const pictures = process.env["KINEMARK_SCREENSHOTS"];
const folder = mkdtempSync(join(tmpdir(), "kinemark-desk-"));
const trials = (): string[] => readdirSync(folder).filter((name) => name.endsWith(".mcap")).sort();
const server = await serve("sim:rig?scene=tree&speed=4", "--record", folder);
const { page, complaints, close } = await open(server.address);

const heading = (words: string): Promise<void> => page.locator("#desk-title", { hasText: words }).waitFor();
const press = (words: string): Promise<void> => page.getByRole("button", { name: words, exact: true }).click();
const fill = (label: string, text: string): Promise<void> => page.getByLabel(label, { exact: true }).fill(text);
const message = async (): Promise<string> => (await page.locator("#desk-message").textContent()) ?? "";
const count = async (id: string): Promise<number> => Number(((await page.locator(id).textContent()) ?? "").replaceAll(/\D/g, ""));
async function until(what: () => Promise<boolean>, why: string): Promise<void> {
  for (let i = 0; i < 600; ++i) {
    if (await what()) return;
    await page.waitForTimeout(50);
  }
  throw new Error(`it did not happen within 30 s: ${why}`);
}

/** What is wrong with how a step looks, in light, in the dark and at 390 px. */
async function looks(name: string): Promise<void> {
  for (const [kind, width, scheme] of [["light", 1280, "light"], ["dark", 1280, "dark"], ["phone", 390, "light"]] as const) {
    if (pictures === undefined && kind === "phone") continue;
    await page.setViewportSize({ width, height: 900 });
    await page.emulateMedia({ colorScheme: scheme });
    await settle(page);
    if (pictures !== undefined) await page.screenshot({ path: join(pictures, `desk_${name}_${kind}.png`), fullPage: true });
    assert.deepEqual([...(await violations(page)), ...(await clipped(page))], [], `${name}, ${kind}`);
  }
  await page.setViewportSize({ width: 390, height: 844 });
  await settle(page);
  assert.deepEqual(await clipped(page), [], `${name}, 390 px`);
  await page.setViewportSize({ width: 1280, height: 900 });
}

/** The next control is reached by Tab and pressed by Enter. */
async function tabTo(page_: Page, words: string): Promise<void> {
  await page_.keyboard.press("Tab");
  assert.equal(await page_.evaluate(() => document.activeElement?.textContent), words);
  await page_.keyboard.press("Enter");
}

const checks: Record<string, () => Promise<void>> = {
  "its data and the state follow the schema": async () => {
    assert.deepEqual(problemsOf(JSON.parse(await page.evaluate(() => document.getElementById("kinemark-data")?.textContent ?? ""))), []);
    const state = await page.evaluate(async () => (await fetch("api/desk")).json() as Promise<unknown>);
    assert.deepEqual(problemsOf(state, "DeskState"), []);
  },
  "a rate that does not fit is refused with the highest that does": async () => {
    await heading("Set-up of");
    await fill("LEDs", "3");
    assert.match((await page.locator("#desk-room").textContent()) ?? "", /^3 LEDs: [\d.,]+ Hz at most, a slot of [\d,]+ us for each$/);
    await fill("Rate, Hz", "5000");
    await press("Start");
    await until(async () => /frames per second at most/.test(await message()), "the refusal");
    await heading("Set-up of");
    await looks("plan");
  },
  "a trial is recorded and kept by keys alone": async () => {
    await fill("Rate, Hz", "");
    await page.getByLabel("Rate, Hz", { exact: true }).press("Enter");
    await heading("Live: 3 LEDs, 2 cameras");
    assert.equal(await message(), "");
    await until(async () => (await count("#desk-frames")) > 100, "frames");
    const state = await page.evaluate(async () => (await fetch("api/desk")).json() as Promise<unknown>);
    assert.deepEqual(problemsOf(state, "DeskState"), []);
    const spots = (): Promise<string> => page.locator(".detector").first().evaluate((n) => n.innerHTML);
    const before = await spots();
    await until(async () => (await spots()) !== before, "detectors that move");
    await tabTo(page, "Record 01");
    await heading("Recording 01");
    await until(async () => (await count("#desk-acknowledged")) > 20, "frames that are kept");
    assert.deepEqual([await count("#desk-dropped-by-device"), await count("#desk-dropped-here")], [0, 0]);
    await looks("recording");
    await page.locator("#desk-title").focus();
    await tabTo(page, "Stop");
    await heading("Check of 01");
    assert.ok((await page.locator(".findings li").count()) > 0, "lines of the check");
    await looks("check");
    await page.locator("#desk-title").focus();
    await tabTo(page, "Keep");
    await heading("Live");
    assert.match(await message(), /^Kept: .*01\.mcap$/);
    assert.deepEqual(trials(), ["01.mcap"]);
    assert.equal(await page.locator("#kept li").count(), 1);
    await looks("live");
  },
  "the light of an LED is set": async () => {
    const slider = page.getByRole("slider").nth(1);
    await slider.focus();
    await slider.press("Home");
    await until(async () => (await page.locator("tbody tr").nth(1).locator("td").first().textContent()) === "10 %", "the light");
    const lights = await page.evaluate(async () => ((await (await fetch("api/desk")).json()) as { granted: { intensity: number[] } }).granted.intensity);
    assert.deepEqual(lights, [1, 0.1, 1]);
  },
  "a trial whose time is up ends by itself, and is discarded by who says so twice": async () => {
    await press("Set-up");
    await fill("Duration, s", "1");
    await press("Start");
    await heading("Live");
    await press("Record 02");
    await heading("Check of 02");
    assert.deepEqual(trials(), ["01.mcap", "02.mcap"]);
    await press("Discard");
    await press("Back");
    await press("Discard");
    await press("Discard it");
    await heading("Live");
    assert.equal(await message(), "Discarded: 02");
    assert.deepEqual(trials(), ["01.mcap"]);
  },
  "another source is chosen, and an address of none is refused": async () => {
    await press("Set-up");
    await press("Another source");
    await heading("Source");
    await fill("Address", "replay:/etc/passwd");
    await press("Open the address");
    await until(async () => /no device that is attached/.test(await message()), "the refusal");
    await looks("source");
    await press("Open sim:rig");
    await heading("Set-up of");
    assert.equal(await message(), "");
  },
  "a lost connection is a sentence": async () => {
    assert.deepEqual(complaints.filter((c) => !c.includes("400")), []);
    server.process.kill("SIGINT");
    await until(async () => /connection to the server is lost/.test(await message()), "the sentence");
    assert.equal(await page.locator("#desk-state").textContent(), "Connection lost");
  },
};

let failed = 0;
for (const [name, check] of Object.entries(checks)) {
  try {
    await check();
    console.log(`ok     ${name}`);
  } catch (error) {
    ++failed;
    console.log(`FAILED ${name}: ${error instanceof Error ? error.message : String(error)}`);
    break; // the next one goes on where this one ends
  }
}
await close();
server.process.kill("SIGKILL");
rmSync(folder, { recursive: true, force: true });
process.exit(failed === 0 ? 0 : 1);
