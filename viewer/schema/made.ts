// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { readFileSync } from "node:fs";
import { files, typeOf, type Part, type SchemaFile } from "./files.ts";

const project = new URL("../../", import.meta.url);
const [begin, end] = ["<!-- made by `npm run schema` in viewer/ -->", "<!-- end -->"];
const doc = (part: Part): string => `/** ${part.description!} */`;
const repeated = (n: number, type: string): string => `[${Array.from({ length: n }, () => type).join(", ")}]`;

/** A type as TypeScript has it. */
function type(part: Part): string {
  if (part.$ref !== undefined) return typeOf(part.$ref);
  if (part.const !== undefined) return JSON.stringify(part.const);
  if (part.enum !== undefined) return part.enum.map((value) => JSON.stringify(value)).join(" | ");
  if (part.allOf !== undefined) return part.allOf.map(type).join(" & ");
  const alternatives = part.anyOf ?? part.oneOf;
  if (alternatives !== undefined) return alternatives.map(type).join(" | ");
  if (part.properties !== undefined) return `{ ${members(part).map(([, member]) => member).join("; ")} }`;
  if (part.type === "array") {
    const item = type(part.items!);
    return part.minItems === undefined ? `${item.includes(" ") ? `(${item})` : item}[]` : repeated(part.minItems, item);
  }
  if (typeof part.additionalProperties === "object") return `Record<string, ${type(part.additionalProperties)}>`;
  return [part.type!].flat().map((name) => (name === "integer" ? "number" : name)).join(" | ");
}

const members = (part: Part): [Part, string][] =>
  Object.entries(part.properties!).map(([name, member]) => [member, `${name}${part.required?.includes(name) ? "" : "?"}: ${type(member)}`]);

function declaration(name: string, part: Part): string {
  if (part.properties === undefined) return `${doc(part)}\nexport type ${name} = ${type(part)};`;
  return `${doc(part)}\nexport interface ${name} {\n${members(part).map(([member, text]) => `  ${doc(member)} ${text};\n`).join("")}}`;
}

/** All types of the schema as TypeScript. */
function types(): string {
  const head = "// SPDX-FileCopyrightText: 2026 The kinemark authors\n// SPDX-License-Identifier: Apache-2.0\n// Made by `npm run schema` from viewer/schema; change that.";
  return `${[head, ...files.flatMap((file) => Object.entries(file.$defs)).map(([name, part]) => declaration(name, part))].join("\n\n")}\n`;
}

const list = (names: readonly string[]): string => names.join(" or ");

/** A type in words: "number or null", "list of Finding". */
function words(part: Part): string {
  if (part.$ref !== undefined) return `[${typeOf(part.$ref)}](#${typeOf(part.$ref).toLowerCase()})`;
  if (part.const !== undefined) return `\`${JSON.stringify(part.const)}\``;
  if (part.enum !== undefined) return list(part.enum.map((value) => (value === null ? "null" : `\`${JSON.stringify(value)}\``)));
  const alternatives = part.anyOf ?? part.oneOf;
  if (alternatives !== undefined) return list(alternatives.map(words));
  if (part.allOf !== undefined) return words(part.allOf[0]!);
  if (part.type === "array") return `${part.minItems === undefined ? "list" : part.minItems} of ${words(part.items!)}`;
  if (typeof part.additionalProperties === "object") return `object of ${words(part.additionalProperties)}`;
  return list([part.type!].flat());
}

function table(part: Part): string[] {
  const rows = Object.entries(part.properties!).map(([name, member]) => {
    const absent = part.required?.includes(name) ? "" : ", may be absent";
    return `| \`${name}\` | ${words(member)}${absent} | ${member.description!} |`;
  });
  return ["", "| member | type | what |", "|---|---|---|", ...rows];
}

const section = (name: string, part: Part): string[] => [
  "", `### ${name}`, part.description!,
  ...(part.properties !== undefined ? table(part) : ["", `${words(part)}.`]),
  ...(part.properties !== undefined && part.additionalProperties !== false ? ["", "It may have other members."] : []),
];

const chapter = (file: SchemaFile): string[] => ["", `## ${file.title}`, file.description, ...Object.entries(file.$defs).flatMap(([name, part]) => section(name, part))];

/** `text` with the tables between its two marks. */
function withTables(text: string): string {
  const [first, last] = [text.indexOf(begin), text.lastIndexOf(end)];
  if (first < 0 || last < first) throw new Error(`the page of documentation lacks '${begin}' or '${end}'`);
  return `${text.slice(0, first)}${begin}\n${files.flatMap(chapter).join("\n").trimStart()}\n${text.slice(last)}`;
}

/** Files that follow from the schema, with what they must hold. */
export function made(): Map<URL, string> {
  const documentation = new URL("docs/formats/pages.md", project);
  return new Map([
    [new URL("viewer/src/page_types.ts", project), types()],
    [documentation, withTables(readFileSync(documentation, "utf8"))],
  ]);
}
