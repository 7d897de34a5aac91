// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { createHash } from "node:crypto";
import { readFileSync } from "node:fs";
import { gzipSync, inflateSync } from "node:zlib";
import { describe, expect, it } from "vitest";
import { packed } from "../../one_file.ts";

const page = readFileSync(new URL("../../dist/report.html", import.meta.url), "utf8");
const first = /<script type="module">([\s\S]*?)<\/script>/.exec(page)![1]!;
const unpacked = (base64: string): string => inflateSync(Buffer.from(base64, "base64")).toString("utf8");
const script = unpacked(/atob\("([^"]*)"\)/.exec(first)![1]!);

describe("the built page", () => {
  it("has one place for data and stays small", () => {
    expect(page.split('<script type="application/json" id="kinemark-data">null</script>').length).toBe(2);
    expect(gzipSync(page).length).toBeLessThan(260_000);
    expect(page.length).toBeLessThan(400_000);
  });
  it("asks for nothing from elsewhere", () => {
    for (const text of [page, script]) {
      expect(text).not.toMatch(/(src|href)="(?!#)/);
      expect(text).not.toMatch(/@import|url\((?!data:|#)/);
    }
  });
  it("allows exactly the scripts and the style that it holds", () => {
    const hash = (text: string): string => `sha256-${createHash("sha256").update(text).digest("base64")}`;
    const style = /<style>([\s\S]*?)<\/style>/.exec(page)![1]!;
    const policy = /Content-Security-Policy" content="([^"]*)"/.exec(page)![1]!;
    expect(policy).toContain("default-src 'none'");
    expect(policy).toContain(`script-src '${hash(first)}' '${hash(script)}';`);
    expect(policy).toContain(`style-src '${hash(style)}'`);
  });
  it("packs its script, letters of all alphabets among it", () => {
    expect(script).toContain("kinemark");
    expect(script.length).toBeGreaterThan(2 * packed(script).length);
    expect(unpacked(packed("Δ = 3°, </script>"))).toBe("Δ = 3°, </script>");
  });
});
