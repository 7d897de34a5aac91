// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { createHash } from "node:crypto";
import { readFileSync } from "node:fs";
import { gzipSync } from "node:zlib";
import { describe, expect, it } from "vitest";

const page = readFileSync(new URL("../../dist/report.html", import.meta.url), "utf8");

describe("the built page", () => {
  it("has one place for data and stays small", () => {
    expect(page.split('<script type="application/json" id="kinemark-data">null</script>').length).toBe(2);
    expect(gzipSync(page).length).toBeLessThan(260_000);
    expect(page.length).toBeLessThan(900_000);
  });
  it("asks for nothing from elsewhere", () => {
    expect(page).not.toMatch(/(src|href)="(?!#)/);
    expect(page).not.toMatch(/@import|url\((?!data:|#)/);
  });
  it("allows exactly the script and the style that it holds", () => {
    const hash = (text: string): string => `sha256-${createHash("sha256").update(text).digest("base64")}`;
    const script = /<script type="module">([\s\S]*?)<\/script>/.exec(page)![1]!;
    const style = /<style>([\s\S]*?)<\/style>/.exec(page)![1]!;
    const policy = /Content-Security-Policy" content="([^"]*)"/.exec(page)![1]!;
    expect(policy).toContain("default-src 'none'");
    expect(policy).toContain(`script-src '${hash(script)}'`);
    expect(policy).toContain(`style-src '${hash(style)}'`);
  });
});
