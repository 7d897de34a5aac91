// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// npm run test:looks            how the built page looks with simulated data of every kind
// npm run test:looks -- FILE... the same of pages that the program wrote
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join, resolve } from "node:path";
import { simulatedClean } from "../simulated_clean.ts";
import { simulated, simulatedSensors } from "../simulated.ts";
import { simulatedMarkers, simulatedScene } from "../simulated_markers.ts";
import { simulatedResults } from "../simulated_results.ts";
import { judgeLooks } from "./looks.ts";

const folder = mkdtempSync(join(tmpdir(), "kinemark-looks-"));
const template = readFileSync(new URL("../../dist/report.html", import.meta.url), "utf8");
const page = (name: string, data: unknown): string => {
  const file = join(folder, name);
  writeFileSync(file, template.replace('id="kinemark-data">null', () => `id="kinemark-data">${JSON.stringify(data).replaceAll("<", "\\u003c")}`));
  return file;
};
const given = process.argv.slice(2).map((f) => resolve(f));
const files =
  given.length > 0
    ? given
    : [
        page("ik.html", { ...simulated(), scene: simulatedScene() }),
        page("sensors.html", simulatedSensors(true)),
        page("clean.html", simulatedClean()),
        page("markers.html", simulatedMarkers()),
        ...Object.entries(simulatedResults()).map(([kind, data]) => page(`${kind}.html`, data)),
      ];
let failed = 0;
for (const file of files) {
  const wrong = await judgeLooks(file, basename(file, ".html"));
  console.log(wrong.length === 0 ? `ok      ${basename(file)}` : `FAILED  ${basename(file)}\n${wrong.join("\n")}`);
  failed += wrong.length;
}
rmSync(folder, { recursive: true });
process.exitCode = failed === 0 ? 0 : 1;
