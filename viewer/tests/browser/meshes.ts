// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The meshes of a model's bodies as a person sees them.
import assert from "node:assert/strict";
import { boneOf } from "../simulated_meshes.ts";
import { ink, settle, type Check } from "./browser.ts";
import { cameraOf, goTo, pixelsOf } from "./space.ts";

/** y up into z up, which pixelsOf() is written for. */
const turned = ([x, y, z]: readonly number[]): number[] => [z!, x!, y!];

/** Width and height of what is warm and bright, as bones are and nothing else, around a place of the picture. */
async function boneAt(page: Parameters<typeof cameraOf>[0], left: number, top: number): Promise<{ x: number; y: number; width: number; height: number; count: number }> {
  return page.locator(".space-canvas").evaluate((node, at) => {
    const canvas = node as HTMLCanvasElement;
    const ratio = canvas.width / canvas.clientWidth;
    const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d", { willReadFrequently: true })!;
    copy.drawImage(canvas, 0, 0);
    const { data } = copy.getImageData(0, 0, canvas.width, canvas.height);
    let [low, high, count] = [[Infinity, Infinity], [-Infinity, -Infinity], 0] as [number[], number[], number];
    for (let y = 0; y < canvas.height; ++y) {
      for (let x = 0; x < canvas.width; ++x) {
        const i = 4 * (y * canvas.width + x);
        if (data[i]! - data[i + 2]! < 3 || data[i]! > 240 || Math.hypot(x / ratio - at.left, y / ratio - at.top) > 90) continue;
        low = [Math.min(low[0]!, x), Math.min(low[1]!, y)];
        high = [Math.max(high[0]!, x), Math.max(high[1]!, y)];
        ++count;
      }
    }
    return { x: (low[0]! + high[0]! + 1) / 2 / ratio, y: (low[1]! + high[1]! + 1) / 2 / ratio, width: (high[0]! - low[0]!) / ratio, height: (high[1]! - low[1]!) / ratio, count };
  }, { left, top });
}

/** A page of a solved trial whose model has a mesh for one of two bodies. */
export const showsMeshes: Record<string, Check> = {
  "a mesh stands where its body is, to a pixel, and turns with it": async ({ page }) => {
    for (const name of ["Names", "Paths"]) await page.locator(`#space select[aria-label="${name}"]`).selectOption("none");
    await page.locator("#space").getByRole("button", { name: "Model", exact: true }).click();
    const sizes: number[] = [];
    for (const frame of [0, 199, 399]) {
      await goTo(page, frame);
      await page.locator(".space-canvas").focus();
      await page.keyboard.press("2");
      const perspective = page.locator("#space").getByRole("button", { name: "Perspective" });
      if ((await perspective.getAttribute("aria-pressed")) === "true") await perspective.click();
      await settle(page);
      const [camera, box] = [await cameraOf(page), (await page.locator(".space-canvas").boundingBox())!];
      const [left, top] = pixelsOf({ ...camera, target: turned(camera.target) }, box.width, box.height, turned(boneOf(frame)));
      const bone = await boneAt(page, left, top);
      assert.ok(bone.count > 100, "it is drawn");
      assert.ok(Math.hypot(bone.x - left, bone.y - top) < 1.5, `frame ${frame}: drawn about ${bone.x}, ${bone.y}, projected to ${left}, ${top}`);
      sizes.push(bone.height / bone.width);
    }
    assert.ok(sizes[0]! > 1.5, `upright at first: ${sizes[0]}`);
  },
  "the sentence says what is a mesh and what is not": async ({ page }) => {
    assert.match((await page.locator("#space > .facts").last().textContent()) ?? "", /1 body drawn from the model's meshes; 1 body is an ellipsoid/);
  },
  "\"Bodies\" takes both away": async ({ page }) => {
    const shown = await ink(page, ".space-canvas");
    const button = page.locator("#space").getByRole("button", { name: "Bodies", exact: true });
    await button.click();
    await settle(page);
    assert.notEqual((await ink(page, ".space-canvas")).hash, shown.hash);
    await button.click();
    await settle(page);
    assert.equal((await ink(page, ".space-canvas")).hash, shown.hash);
  },
  "the picture takes one draw call a kind": async ({ page }) => {
    assert.ok(Number(await page.locator(".space-frame").getAttribute("data-calls")) <= 16);
  },
  "nothing was asked for and nothing complained": async ({ complaints }) => {
    assert.deepEqual(complaints, []);
  },
};
