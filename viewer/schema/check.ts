// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// npm run check:pages -- FILE...    pages (.html) and report files (.json) against the schema
import { dataOf, problemsOf, typeFor } from "./problems.ts";

const most = 5;
const given = process.argv.slice(2);
let failed = given.length === 0 ? 1 : 0;
for (const file of given) {
  const data = dataOf(file);
  const problems = problemsOf(data);
  console.log(`${problems.length === 0 ? "ok     " : "FAILED "} ${typeFor(data) ?? "?"} ${file}`);
  for (const problem of problems.slice(0, most)) console.log(`        ${problem}`);
  if (problems.length > 0) ++failed;
}
process.exitCode = failed === 0 ? 0 : 1;
