// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { createHash } from "node:crypto";
import { strToU8, zlibSync } from "three/examples/jsm/libs/fflate.module.js";
import type { Plugin } from "vite";

const sha256 = (text: string): string => `'sha256-${createHash("sha256").update(text).digest("base64")}'`;

/** A script's text, packed. By a compressor in JavaScript, whose bytes are the same on every machine. */
export const packed = (text: string): string => Buffer.from(zlibSync(strToU8(text), { level: 9, mem: 12 })).toString("base64");

/**
 * A script that unpacks another and runs it: written out, that one is half of a page. A server's header asks for a
 * nonce, which it gives to the first; the second has it from there.
 */
const unpacking = (script: string): string =>
  `const own = document.querySelector("script[type=module]");
try {
  const bytes = Uint8Array.from(atob("${packed(script)}"), (c) => c.charCodeAt(0));
  const text = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  const script = document.createElement("script");
  script.type = "module";
  script.nonce = own.nonce;
  script.textContent = await new Response(text).text();
  document.body.append(script);
} catch (error) {
  document.getElementById("page").textContent = "This report cannot be shown: " + error.message;
  document.documentElement.dataset.ready = "broken";
}`;

/**
 * Put the script and the style into the page itself, so that it opens from a folder without a server, and forbid
 * everything else: no connection to anywhere, no script but those whose hashes are written in the page.
 */
export function oneFile(): Plugin {
  return {
    name: "one-file",
    enforce: "post",
    generateBundle(_options, bundle) {
      const files = Object.values(bundle);
      const html = files.find((f) => f.type === "asset" && f.fileName.endsWith(".html"));
      const chunks = files.filter((f) => f.type === "chunk");
      const styles = files.filter((f) => f.type === "asset" && f.fileName.endsWith(".css"));
      if (html?.type !== "asset" || chunks.length !== 1 || styles.length !== 1 || files.length !== 3) {
        this.error(`expected one page, one script and one style; found ${files.map((f) => f.fileName).join(", ")}`);
      }
      const [chunk] = chunks;
      const [style] = styles;
      if (chunk?.type !== "chunk" || style?.type !== "asset") this.error("unreachable");
      const script = chunk.code.trim();
      const first = unpacking(script);
      const css = String(style.source).trim();
      const policy = [
        "default-src 'none'",
        `script-src ${sha256(first)} ${sha256(script)}`,
        `style-src ${sha256(css)}`,
        // A drawing becomes a picture by way of an image that the page itself holds.
        "img-src data:",
        "base-uri 'none'",
        "form-action 'none'",
      ].join("; ");
      const page = String(html.source)
        .replace(/\s*<script type="module"[^>]*><\/script>/, "")
        .replace(/\s*<link rel="stylesheet"[^>]*>/, "")
        .replace(
          "<!-- style -->",
          () => `<meta http-equiv="Content-Security-Policy" content="${policy}">\n<style>${css}</style>`,
        )
        .replace("<!-- script -->", () => `<script type="module">${first}</script>`);
      html.source = page;
      delete bundle[chunk.fileName];
      delete bundle[style.fileName];
    },
  };
}
