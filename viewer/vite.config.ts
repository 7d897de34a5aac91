// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { defineConfig } from "vitest/config";
import { oneFile } from "./one_file.ts";

const target = { target: "es2022", modulePreload: false } as const;
const report = { plugins: [oneFile()], build: { ...target, assetsInlineLimit: 0, rollupOptions: { input: "report.html" } } };
/** The script of served.html, beside the report. */
const served = { build: { ...target, emptyOutDir: false, rollupOptions: { input: "src/served/main.ts", output: { entryFileNames: "served.js" } } } };

export default defineConfig(({ mode }) => ({ ...(mode === "served" ? served : report), test: { include: ["tests/unit/**/*.test.ts"] } }));
