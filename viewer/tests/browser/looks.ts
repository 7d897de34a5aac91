// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// How a page looks, whatever it is about: readable by everybody, on a screen, a phone and paper.
// KINEMARK_SCREENSHOTS names a folder for the pictures.
import assert from "node:assert/strict";
import { createRequire } from "node:module";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import type { Page } from "playwright-core";
import { open, settle } from "./browser.ts";

const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

interface Violation {
  id: string;
  help: string;
  nodes: { html: string; failureSummary?: string }[];
}

/** What axe has against the page as it is shown now. */
export async function violations(page: Page): Promise<string[]> {
  await page.evaluate(axe);
  const found = await page.evaluate(async () => {
    const run = (globalThis as unknown as { axe: { run: (root: Document, options: object) => Promise<{ violations: Violation[] }> } }).axe;
    return (await run.run(document, { resultTypes: ["violations"] })).violations;
  });
  return found.map((v) => `${v.id}: ${v.help}: ${v.nodes.slice(0, 3).map((n) => `${n.html.slice(0, 160)} ${n.failureSummary?.split("\n")[1] ?? ""}`).join(" | ")}`);
}

/** Elements that reach out of the page, or out of a box that does not scroll. */
export const clipped = (page: Page): Promise<string[]> =>
  page.evaluate(() => {
    const width = document.documentElement.clientWidth;
    const out: string[] = [];
    if (document.documentElement.scrollWidth > width + 1) out.push(`the page is ${document.documentElement.scrollWidth} px wide, its window ${width}`);
    for (const table of document.querySelectorAll("table")) {
      const box = table.parentElement!;
      const scrolls = ["auto", "scroll"].includes(getComputedStyle(box).overflowX);
      const inside = box.scrollWidth <= box.clientWidth + 1;
      const onPaper = matchMedia("print").matches;
      if (!inside && (onPaper || !scrolls)) out.push(`table "${table.caption?.textContent ?? ""}" is ${box.scrollWidth} px wide in ${box.clientWidth}`);
    }
    return out;
  });

/** Open all folds and show cycles, so that what is inside is judged too. */
const unfold = (page: Page): Promise<void> => page.evaluate(() => {
    document.querySelectorAll("details").forEach((d) => (d.open = true));
    document.querySelector<HTMLElement>('#over-cycle[aria-pressed="false"]')?.click();
  });

/** Light, dark, print, 390 px: no violation, nothing clipped. Gives what is wrong. */
export async function judgeLooks(file: string, name: string): Promise<string[]> {
  const folder = process.env["KINEMARK_SCREENSHOTS"];
  const wrong: string[] = [];
  const keep = async (page: Page, kind: string): Promise<void> => {
    if (folder !== undefined) await page.screenshot({ path: join(folder, `${name}_${kind}.png`), fullPage: true });
  };
  for (const scheme of ["light", "dark"] as const) {
    const { page, close } = await open(file, scheme);
    await keep(page, scheme);
    await unfold(page);
    if ((await page.locator(".broken").count()) > 0) wrong.push(`broken: ${(await page.locator(".broken").first().textContent()) ?? ""}`);
    wrong.push(...(await violations(page)).map((v) => `${scheme}: ${v}`), ...(await clipped(page)).map((c) => `${scheme}: ${c}`));
    if (scheme === "light") {
      await page.setViewportSize({ width: 390, height: 844 });
      await settle(page);
      await keep(page, "phone");
      wrong.push(...(await clipped(page)).map((c) => `390 px: ${c}`), ...(await violations(page)).map((v) => `390 px: ${v}`));
      await page.setViewportSize({ width: 794, height: 1123 });
      await page.emulateMedia({ media: "print" });
      await page.evaluate(() => window.dispatchEvent(new Event("beforeprint")));
      await settle(page);
      await keep(page, "print");
      wrong.push(...(await clipped(page)).map((c) => `print: ${c}`));
    }
    await close();
  }
  return wrong;
}

/** The same as a check that throws. */
export async function looksWell(file: string, name: string): Promise<void> {
  assert.deepEqual(await judgeLooks(file, name), []);
}
