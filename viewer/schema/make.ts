// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// npm run schema    writes what follows from the schema
import { writeFileSync } from "node:fs";
import { made } from "./made.ts";

for (const [file, text] of made()) writeFileSync(file, text);
