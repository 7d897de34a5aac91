// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { readFileSync } from "node:fs";
import { beforeEach, describe, expect, it, vi } from "vitest";
import { install } from "../fake_dom.ts";

const style = readFileSync(new URL("../../src/style.css", import.meta.url), "utf8");

async function load(dark: boolean) {
  vi.resetModules();
  install(dark);
  return import("../../src/theme.ts");
}

/** Contrast of two colours, 1 to 21 (WCAG 2.2). */
function contrast(a: string, b: string): number {
  const light = (hex: string): number => {
    const [r, g, bl] = [1, 3, 5].map((i) => {
      const c = parseInt(hex.slice(i, i + 2), 16) / 255;
      return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
    });
    return 0.2126 * r! + 0.7152 * g! + 0.0722 * bl!;
  };
  const [high, low] = [light(a), light(b)].sort((x, y) => y - x);
  return (high! + 0.05) / (low! + 0.05);
}

describe.each([["light", false], ["dark", true]] as const)("the %s palette", (_name, dark) => {
  let colours: Awaited<ReturnType<typeof load>>["palette"];
  beforeEach(async () => ({ palette: colours } = await load(dark)));

  it("is the one of the screen", () => {
    expect(colours().background).toBe(dark ? "#141b21" : "#ffffff");
  });
  it("can be read on its background", () => {
    const p = colours();
    expect(contrast(p.ink, p.background)).toBeGreaterThan(7);
    for (const colour of [p.muted, p.line, p.second, p.focus]) expect(contrast(colour, p.background)).toBeGreaterThan(4.5);
  });
  it("tells the states apart", () => {
    const { states, background } = colours();
    expect(new Set(states).size).toBe(6);
    // What was made is drawn as a line, so it must stand out by itself; measured is the quiet one.
    for (const made of states.slice(1)) expect(contrast(made, background)).toBeGreaterThan(2);
  });
  it("is the same in the legends", () => {
    const { states, gaps } = colours();
    const part = dark ? style.slice(style.indexOf("prefers-color-scheme: dark")) : style;
    const value = (name: string): string => new RegExp(`--${name}: (#[0-9a-f]{6})`).exec(part)![1]!;
    expect([1, 2, 3].map((i) => value(`made-${i}`))).toEqual(states.slice(1, 4));
    expect([0, 1, 2, 3].map((i) => value(`gap-${i}`))).toEqual(gaps);
    expect([states[0], states[4], states[5]]).toEqual([gaps[0], gaps[2], gaps[3]]);
  });
});
