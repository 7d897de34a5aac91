// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// npm run check:pages -- FILE...    pages (.html) and report files (.json) against the schema
import { dataOf, problemsOf, typeFor } from "./problems.ts";

const most = 5;

/** The type that a file should follow, and what is wrong with it. */
function judged(file: string): { type: string | null; problems: string[] } {
  try {
    const data = dataOf(file);
    return { type: typeFor(data), problems: problemsOf(data) };
  } catch (error) {
    return { type: null, problems: [error instanceof Error ? error.message : String(error)] };
  }
}

const given = process.argv.slice(2);
let failed = given.length === 0 ? 1 : 0;
for (const file of given) {
  const { type, problems } = judged(file);
  console.log(`${problems.length === 0 ? "ok     " : "FAILED "} ${type ?? "?"} ${file}`);
  for (const problem of problems.slice(0, most)) console.log(`        ${problem}`);
  if (problems.length > 0) ++failed;
}
process.exitCode = failed === 0 ? 0 : 1;
