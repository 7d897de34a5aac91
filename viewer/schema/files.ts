// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { readFileSync } from "node:fs";

/** A part of a schema: as much of JSON Schema 2020-12 as the files here use. */
export interface Part {
  description?: string;
  title?: string;
  type?: string | string[];
  const?: string | number;
  enum?: (string | number | null)[];
  $ref?: string;
  anyOf?: Part[];
  oneOf?: Part[];
  allOf?: Part[];
  items?: Part;
  minItems?: number;
  maxItems?: number;
  required?: string[];
  properties?: Record<string, Part>;
  additionalProperties?: boolean | Part;
}

export interface SchemaFile extends Part {
  $id: string;
  title: string;
  description: string;
  $defs: Record<string, Part>;
}

/** In the order of the documentation: what pages are made of comes last. */
export const names = ["page", "ik", "clean", "markers", "live", "desk", "served", "results", "joints", "scale", "rig", "measures", "gait", "serve", "scene", "shared", "curves"] as const;

export const files: readonly SchemaFile[] = names.map((name) => JSON.parse(readFileSync(new URL(`${name}.json`, import.meta.url), "utf8")) as SchemaFile);

/** Name of the type that a reference ends with. */
export const typeOf = (ref: string): string => ref.slice(ref.lastIndexOf("/") + 1);
