// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Whether the markers of a page stand where the positions in it project to, by another unpacking and by the textbook.
import type { PackedScene, PackedSeries } from "../../src/page_types.ts";
import assert from "node:assert/strict";
import { inflateSync } from "node:zlib";
import { settle, type Check } from "./browser.ts";
import { cameraOf, goTo, pixelsOf, pointOf } from "./space.ts";

/** Series of numbers, as docs/formats/pages.md describes them. */
export function numbersOf({ kind, series, points, offset, step, data }: PackedSeries): number[][] {
  const bytes = inflateSync(Buffer.from(data, "base64"));
  const width = kind === "int16" ? 2 : 4;
  const count = series * points;
  return Array.from({ length: series }, (_, s) => {
    let word = 0;
    return Array.from({ length: points }, (__, p) => {
      let change = 0;
      for (let b = width - 1; b >= 0; --b) change = change * 256 + bytes[b * count + s * points + p]!;
      word = p === 0 ? change : (word + change) % 2 ** (8 * width);
      if (kind === "int16") return offset![s]! + step![s]! * word;
      const cell = Buffer.alloc(4);
      cell.writeUInt32LE(word);
      return cell.readFloatLE();
    });
  });
}

/** Coordinates in which the third axis points up; null where that is none of the laboratory's own. */
function upright(up: readonly number[], x: readonly number[]): number[] | null {
  if (up[2]! > 0.999) return [...x];
  if (up[1]! > 0.999) return [x[2]!, x[0]!, x[1]!];
  if (up[0]! > 0.999) return [x[1]!, x[2]!, x[0]!];
  return null;
}

export const standsWhereItProjects: Check = async ({ page }) => {
  const text = await page.evaluate(() => document.getElementById("kinemark-data")!.textContent);
  const scene = (JSON.parse(text ?? "") as { scene: PackedScene }).scene;
  const x = numbersOf(scene.markers.positions_m);
  const names = page.locator('#space select[aria-label="Names"]');
  await names.selectOption("all");
  for (const share of [0, 0.37, 0.9]) {
    await goTo(page, Math.floor(share * (scene.points - 1)));
    await settle(page);
    const [camera, point] = [await cameraOf(page), await pointOf(page)];
    const box = (await page.locator(".space-canvas").boundingBox())!;
    const tags = await page.locator(".space-labels span.tag").evaluateAll((all) =>
      all.filter((t) => !(t as HTMLElement).hidden).map((t) => [t.textContent ?? "", /translate\(([-\d.]+)px, ([-\d.]+)px\)/.exec((t as HTMLElement).style.transform)!.slice(1).map(Number)] as const),
    );
    for (const [name, at] of tags) {
      // Names may come twice in a file: one of them has to be there.
      const away = scene.names.flatMap((n, m) => {
        const place = n === name ? upright(camera.up, [0, 1, 2].map((k) => x[3 * m + k]![point]!)) : null;
        if (place === null) return [];
        const target = upright(camera.up, camera.target)!;
        const [left, top] = pixelsOf({ ...camera, target }, box.width, box.height, place);
        return [Math.hypot(left - at[0]!, top - at[1]!)];
      });
      if (away.length > 0) assert.ok(Math.min(...away) < 1, `${name} on point ${point}: ${Math.min(...away)} px off`);
    }
  }
  await names.selectOption("none");
};
