// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium, type Page } from "playwright-core";

export interface Opened {
  page: Page;
  /** Everything that the page asked for besides itself, and everything that it complained about. */
  complaints: string[];
  close: () => Promise<void>;
}

/** Something that must be true of an opened page; it throws when it is not. */
export type Check = (opened: Opened) => Promise<void>;

/** Open a file, or an address, in a browser of its own with an empty profile. KINEMARK_CHROMIUM names another browser. */
export function open(file: string, colorScheme: "light" | "dark" = "light", webGl = true): Promise<Opened> {
  if (file.startsWith("http:")) return openAddress(file, (asked) => new URL(asked).host === new URL(file).host, colorScheme, webGl);
  const url = pathToFileURL(file).href;
  return openAddress(url, (asked) => asked.split("#")[0] === url, colorScheme, webGl);
}

/**
 * Open an address likewise, and wait until its page is ready.
 * @param may   what the page may ask for; anything else is a complaint
 * @param then  where to go once the address was opened, from where that led; it need not be a page of ours
 */
export async function openAddress(url: string, may: (asked: string) => boolean, colorScheme: "light" | "dark" = "light", webGl = true, then = url): Promise<Opened> {
  const profile = mkdtempSync(join(tmpdir(), "kinemark-viewer-"));
  const context = await chromium.launchPersistentContext(profile, {
    executablePath: process.env["KINEMARK_CHROMIUM"] ?? "/usr/bin/chromium",
    headless: true,
    colorScheme,
    viewport: { width: 1280, height: 900 },
    args: [
      "--no-sandbox",
      ...(webGl ? ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"] : ["--disable-gpu"]),
      "--disable-quic",
      "--no-first-run",
      "--disable-background-networking",
      "--disable-component-update",
      "--disable-sync",
    ],
  });
  const page = context.pages()[0] ?? (await context.newPage());
  const complaints: string[] = [];
  page.on("request", (r) => {
    if (!may(r.url())) complaints.push(`asked for ${r.url().slice(0, 200)}`);
  });
  page.on("console", (m) => {
    if (m.type() === "error" || m.type() === "warning") complaints.push(`console: ${m.text()}`);
  });
  page.on("pageerror", (e) => complaints.push(`error: ${e.message}`));
  page.on("dialog", (d) => {
    complaints.push(`dialog: ${d.message()}`);
    void d.dismiss();
  });
  if (!webGl) {
    await page.addInitScript(() => {
      const known = HTMLCanvasElement.prototype.getContext as (kind: string, ...rest: unknown[]) => unknown;
      HTMLCanvasElement.prototype.getContext = function (this: HTMLCanvasElement, kind: string, ...rest: unknown[]) {
        return kind.startsWith("webgl") ? null : known.call(this, kind, ...rest);
      } as typeof HTMLCanvasElement.prototype.getContext;
    });
  }
  await page.goto(url);
  if (then !== url) await page.goto(new URL(then, page.url()).href);
  await page.waitForFunction(() => document.documentElement.dataset["ready"] !== undefined);
  await settle(page);
  return {
    page,
    complaints,
    close: async () => {
      await context.close();
      rmSync(profile, { recursive: true, force: true });
    },
  };
}

/** Wait until the page has drawn what it was asked to draw, in space smoothly, unless that goes on. */
export async function settle(page: Page): Promise<void> {
  await page.evaluate(() => new Promise<void>((done) => requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done, 30)))));
  for (let tries = 0; tries < 20 && (await page.locator('.space-canvas[data-still="no"]').count()) > 0; ++tries) await page.waitForTimeout(50);
}

export interface Ink {
  /** Pixels of the canvas that are not transparent. */
  drawn: number;
  /** Of these, the translucent ones, as the band is. */
  translucent: number;
  /** Changes with any pixel. */
  hash: number;
}

/** What a canvas shows. */
export function ink(page: Page, selector: string): Promise<Ink> {
  return page.locator(selector).first().evaluate((node) => {
    // A copy is read, so that reading does not change how the page's own canvas is kept.
    const { width, height } = node as HTMLCanvasElement;
    const copy = new OffscreenCanvas(width, height).getContext("2d", { willReadFrequently: true })!;
    copy.drawImage(node as HTMLCanvasElement, 0, 0);
    const { data } = copy.getImageData(0, 0, width, height);
    let drawn = 0;
    let translucent = 0;
    let hash = 17;
    for (let i = 0; i < data.length; i += 4) {
      const alpha = data[i + 3]!;
      if (alpha > 0) ++drawn;
      if (alpha >= 30 && alpha <= 80 && data[i + 2]! > data[i]! + 60) ++translucent;
      hash = (Math.imul(hash, 31) + data[i]! + 7 * data[i + 1]! + 13 * data[i + 2]! + 29 * alpha) | 0;
    }
    return { drawn, translucent, hash };
  });
}

/** Number of opaque pixels in one column of a canvas. */
export function opaqueInColumn(page: Page, selector: string, x: number): Promise<number> {
  return page.locator(selector).first().evaluate((node, left) => {
    const canvas = node as HTMLCanvasElement;
    const copy = new OffscreenCanvas(1, canvas.height).getContext("2d", { willReadFrequently: true })!;
    copy.drawImage(canvas, -Math.round(left * window.devicePixelRatio), 0);
    const { data } = copy.getImageData(0, 0, 1, canvas.height);
    return data.filter((value, i) => i % 4 === 3 && value === 255).length;
  }, x);
}
