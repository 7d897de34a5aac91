// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { defineConfig } from "vitest/config";
import { oneFile } from "./one_file.ts";

export default defineConfig({
  plugins: [oneFile()],
  build: {
    target: "es2022",
    modulePreload: false,
    assetsInlineLimit: 0,
    rollupOptions: { input: "report.html" },
  },
  test: { include: ["tests/unit/**/*.test.ts"] },
});
