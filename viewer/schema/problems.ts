// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { readFileSync } from "node:fs";
import { Ajv2020, type ValidateFunction } from "ajv/dist/2020.js";
import { files } from "./files.ts";

const ajv = new Ajv2020({ allErrors: true, strictTypes: false, strictTuples: false });
for (const file of files) ajv.addSchema(file);
const idOf = new Map(files.flatMap((file) => Object.keys(file.$defs).map((name) => [name, `${file.$id}#/$defs/${name}`] as const)));

const pages: Record<string, string> = {
  "kinemark.ik_report": "IkPage",
  "kinemark.clean_report": "CleanPage",
  "kinemark.markers_report": "MarkersPage",
  "kinemark.live": "LivePage",
  "kinemark.desk": "DeskPage",
  "kinemark.trials": "TrialsPage",
  "kinemark.facts": "FactsPage",
  "kinemark.notice": "NoticePage",
};
const summaries: Record<string, string> = { "kinemark.ik_report": "IkSummary", "kinemark.clean_report": "CleanSummary", "kinemark.skeleton": "JointsResult" };

interface Named {
  schema?: string;
  kind?: string;
  format?: string;
}

/** Name of the type that a page, or a report file, must follow; null: none that the schema knows. */
export function typeFor(data: unknown): string | null {
  const file = data as (Named & { summary?: Named }) | null;
  const summary = file?.summary;
  if (summary === undefined) return file?.format === "kinemark-scale" ? "ScaleResult" : (summaries[file?.schema ?? ""] ?? null);
  if (summary.schema !== "kinemark.result_report") return pages[summary.schema ?? ""] ?? null;
  const name = `${(summary.kind ?? "").replace(/^./, (c) => c.toUpperCase())}Page`;
  return idOf.has(name) ? name : null;
}

/** What breaks the type of this name, a sentence each. */
export function problemsOf(data: unknown, type = typeFor(data)): string[] {
  if (type === null || !idOf.has(type)) return ["this follows no type of viewer/schema"];
  const valid = ajv.getSchema(idOf.get(type)!) as ValidateFunction;
  if (valid(data)) return [];
  return valid.errors!.map((e) => {
    const more = Object.values(e.params).filter((value) => typeof value !== "object").join(", ");
    return `${type}${e.instancePath}: ${e.message ?? e.keyword}${more === "" ? "" : ` (${more})`}`;
  });
}

/** The data of a page, or of a report file. */
export function dataOf(file: string): unknown {
  const text = readFileSync(file, "utf8");
  if (!file.endsWith(".html")) return JSON.parse(text);
  const found = /<script type="application\/json" id="kinemark-data">(.*?)<\/script>/s.exec(text);
  if (found === null) throw new Error(`${file} is no page with data`);
  return JSON.parse(found[1]!);
}

