// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// npm run test:live   the page of a live source, from `KINEMARK_PROGRAM serve`, as a person sees it.
// KINEMARK_SCREENSHOTS names a folder for pictures.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { join } from "node:path";
import { createInterface } from "node:readline";
import type { Page } from "playwright-core";
import { ink, open, settle, type Opened } from "./browser.ts";
import { clipped, violations } from "./looks.ts";
import { problemsOf } from "../../schema/problems.ts";

const program = process.env["KINEMARK_PROGRAM"] ?? "build/release/bin/kinemark";
const pictures = process.env["KINEMARK_SCREENSHOTS"];

interface Served {
  address: string;
  kill: () => Promise<void>;
}

/** A server of that source, which goes with this program. */
async function serve(source: string, ...more: string[]): Promise<Served> {
  const child = spawn(program, ["serve", source, "--no-open", ...more], { stdio: ["ignore", "pipe", "ignore"] });
  const end = (): boolean => child.kill("SIGKILL");
  process.once("exit", end);
  const address = await new Promise<string>((done, failed) => {
    createInterface({ input: child.stdout! }).once("line", done);
    child.once("exit", () => failed(new Error("the server ended")));
  });
  const gone = new Promise<void>((done) => child.once("exit", () => done()));
  return { address, kill: () => { process.off("exit", end); end(); return gone; } };
}

const value = async (page: Page, id: string): Promise<number> => Number(((await page.locator(`#${id}`).textContent()) ?? "").replaceAll(/[^\d.]/g, ""));
const until = (page: Page, what: (page: Page) => Promise<boolean>): Promise<void> => (async () => {
  for (let i = 0; i < 600; ++i) {
    if (await what(page)) return;
    await page.waitForTimeout(100);
  }
  throw new Error("it did not happen within a minute");
})();
const running = (page: Page): Promise<void> => until(page, async () => (await page.locator(".space-canvas").count()) > 0 && (await value(page, "live-rate")) > 0);
const keep = async (page: Page, name: string): Promise<void> => {
  if (pictures !== undefined) await page.screenshot({ path: join(pictures, `live_${name}.png`), fullPage: true });
};

const checks: Record<string, (opened: Opened, server: Served) => Promise<void>> = {
  "its data follow the schema": async ({ page }) => {
    await running(page);
    const data = await page.evaluate(() => document.getElementById("kinemark-data")?.textContent ?? "");
    assert.deepEqual(problemsOf(JSON.parse(data)), []);
  },
  "markers move in space and angles in their curves": async ({ page }) => {
    await running(page);
    assert.equal(await page.locator("#live-state").textContent(), "Live");
    assert.equal(await value(page, "live-markers") > 30, true);
    await until(page, async () => !((await page.locator("#angles .cell .range").first().textContent()) ?? "").includes("not yet"));
    const look = async (): Promise<number[]> => [(await ink(page, ".space-canvas")).hash, (await ink(page, "#angles .cell canvas")).hash];
    const before = await look();
    await until(page, async () => (await look()).every((hash, i) => hash !== before[i]));
    assert.ok((await ink(page, "#angles .cell canvas")).translucent > 20, "the band is drawn");
  },
  "frame rate, time until drawn and frame number are shown": async ({ page }) => {
    await running(page);
    const frame = async (): Promise<number> => Number(((await page.locator("#live-time + dt + dd").textContent()) ?? "").replaceAll(/\D/g, ""));
    const first = await frame();
    await until(page, async () => (await frame()) > first);
    await until(page, async () => (await value(page, "live-latency")) > 0);
  },
  "a page that is busy drops frames and counts them": async ({ page }) => {
    await running(page);
    const before = await value(page, "live-dropped");
    await page.evaluate(() => {
      const until = performance.now() + 2000;
      while (performance.now() < until);
    });
    await until(page, async () => (await value(page, "live-dropped")) > before);
    assert.equal(await page.locator("#live-state").textContent(), "Live");
  },
  "readable by everybody in light, on a phone, in the dark and on paper": async ({ page }) => {
    await running(page);
    await page.waitForTimeout(3000);
    for (const [name, width, scheme] of [["light", 1280, "light"], ["phone", 390, "light"], ["dark", 1280, "dark"], ["paper", 794, "light"]] as const) {
      await page.setViewportSize({ width, height: 900 });
      await page.emulateMedia({ colorScheme: scheme, media: name === "paper" ? "print" : "screen" });
      await settle(page);
      await keep(page, name);
      assert.deepEqual([...(await violations(page)), ...(await clipped(page))], [], name);
    }
  },
  "turning and choosing a marker work while frames come": async ({ page }) => {
    await running(page);
    const camera = (): Promise<string | undefined> => page.locator(".space-frame").evaluate((n) => n.dataset["camera"]);
    const before = await camera();
    const box = (await page.locator(".space-canvas").boundingBox())!;
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width / 2 + 120, box.y + box.height / 2, { steps: 4 });
    await page.mouse.up();
    await until(page, async () => (await camera()) !== before);
    assert.equal(await page.locator(".transport").count(), 0, "nothing to play");
  },
  "a lost connection is a sentence, and nothing breaks": async ({ page }, server) => {
    await running(page);
    await server.kill();
    await page.locator("#live-sentence").waitFor({ state: "visible" });
    assert.match((await page.locator("#live-sentence").textContent()) ?? "", /connection to the server is lost/);
    assert.equal(await page.locator("#live-state").textContent(), "Connection lost");
    await keep(page, "lost");
    assert.deepEqual(await violations(page), []);
  },
};

let failed = 0;
async function check(name: string, source: string, task: (opened: Opened, server: Served) => Promise<void>, mayComplain = false, more: readonly string[] = []): Promise<void> {
  const server = await serve(source, ...more);
  const opened = await open(server.address);
  try {
    await task(opened, server);
    if (!mayComplain) assert.deepEqual(opened.complaints, []);
    console.log(`ok     ${name}`);
  } catch (error) {
    ++failed;
    console.log(`FAILED ${name}: ${error instanceof Error ? error.message : String(error)}`);
  }
  await opened.close();
  await server.kill();
}

for (const [name, task] of Object.entries(checks)) await check(name, "sim:walk?rate=240&seconds=120&missing=0.03", task, name.includes("lost"));
await check("the end of the source is a sentence", "sim:reach?rate=100&seconds=6", async ({ page }) => {
  await page.locator("#live-sentence").waitFor({ state: "visible", timeout: 60_000 });
  assert.match((await page.locator("#live-sentence").textContent()) ?? "", /^The source has ended after 600 frames\. What you see is the last frame\.$/);
  assert.equal(await page.locator("#live-state").textContent(), "Ended");
});

const pushed = async (page: Page): Promise<number> => Number((await page.locator("#live-push").getAttribute("data-pushed-mm")) ?? "");
const isBack = (page: Page): Promise<void> => until(page, async () => (await page.locator("#push-status").textContent()) === "Nobody pushes the body.");
const soft = ["--level", "LASI,RASI,LPSI,RPSI", "--level", "*", "--omega", "30"];
await check("goals have their levels, and a body that is dragged goes and comes back", "sim:reach?rate=240&seconds=120", async ({ page }) => {
  await running(page);
  await until(page, async () => /^Level 1: LASI, RASI, LPSI, RPSI, [\d.]+ mm RMSLevel 2: all others, [\d.]+ mm RMS$/.test((await page.locator("#live-levels").textContent()) ?? ""));
  await isBack(page);
  const camera = (): Promise<string | undefined> => page.locator(".space-frame").evaluate((n) => n.dataset["camera"]);
  await page.locator("#live-push button", { hasText: "Drag pushes" }).click();
  await page.locator(".space-canvas").scrollIntoViewIfNeeded();
  const box = (await page.locator(".space-canvas").boundingBox())!;
  const before = await camera();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2 + 90, box.y + box.height / 2 - 20, { steps: 4 });
  await until(page, async () => (await pushed(page)) > 5);
  assert.equal(await camera(), before, "the picture is not turned");
  assert.match((await page.locator("#push-status").textContent()) ?? "", /^Pushed: \d+ N at \w+.* no measurement/);
  await keep(page, "pushed");
  if (pictures !== undefined) await page.locator("#space").screenshot({ path: join(pictures, "live_pushed_near.png") });
  assert.deepEqual([...(await violations(page)), ...(await clipped(page))], []);
  await page.mouse.up();
  await isBack(page);
  assert.equal(await page.locator("#live-state").textContent(), "Live");
}, false, soft);
await check("a body is pushed by keys, and by a finger", "sim:reach?rate=240&seconds=120", async ({ page }) => {
  await running(page);
  await isBack(page);
  const names = await page.locator("#push-body option").allTextContents();
  await page.locator("#push-body").selectOption({ index: names.findIndex((n) => /hand|forearm|ulna|radius|lower_arm/i.test(n)) });
  await page.locator("#push-force").fill("300");
  await page.locator("#push-keys").focus();
  await page.keyboard.down("ArrowRight");
  await until(page, async () => (await pushed(page)) > 5);
  assert.match((await page.locator("#push-status").textContent()) ?? "", /^Pushed: 300 N at /);
  await page.keyboard.up("ArrowRight");
  await isBack(page);
  await page.locator("#live-push button", { hasText: "Drag pushes" }).click();
  const canvas = page.locator(".space-canvas");
  await canvas.scrollIntoViewIfNeeded();
  const box = (await canvas.boundingBox())!;
  const wire = await page.context().newCDPSession(page);
  const touch = (type: string, dx: number): Promise<unknown> =>
    wire.send("Input.dispatchTouchEvent", { type: type as "touchMove", touchPoints: type === "touchEnd" ? [] : [{ x: box.x + box.width / 2 + dx, y: box.y + box.height / 2 }] });
  await touch("touchStart", 0);
  await touch("touchMove", 60);
  await touch("touchMove", 120);
  await until(page, async () => (await pushed(page)) > 5);
  await touch("touchEnd", 120);
  await isBack(page);
}, false, soft);
await check("without a lost connection a page that goes away lets go", "sim:reach?rate=240&seconds=120", async ({ page }, server) => {
  await running(page);
  const other = await open(server.address);
  await running(other.page);
  await other.page.locator("#push-keys").focus();
  await other.page.keyboard.down("ArrowUp");
  await until(page, async () => ((await page.locator("#push-status").textContent()) ?? "").startsWith("Pushed, by another page"));
  await other.close();
  await isBack(page);
}, false, soft);
process.exit(failed === 0 ? 0 : 1);
