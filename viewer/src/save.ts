// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { el } from "./dom.ts";

/** A name that every file system takes. */
export const fileName = (words: string, ending: string): string =>
  `${words.replaceAll(/[^\p{L}\p{N}._-]+/gu, "_").replaceAll(/^[_.]+|_+$/g, "").slice(0, 80) || "kinemark"}.${ending}`;

/** Hand a file to whoever looks at the page. */
export function save(name: string, content: Blob): void {
  const url = URL.createObjectURL(content);
  const link = el("a", { href: url, download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

/** Rows as RFC 4180 has them. A cell that a spreadsheet would take for a formula gets an apostrophe in front. */
export function csv(rows: readonly (readonly string[])[]): string {
  const cell = (text: string): string => {
    const safe = /^[=+@\t\r]|^-(?![\d.])/.test(text) ? `'${text}` : text;
    return /[",\r\n]/.test(safe) ? `"${safe.replaceAll('"', '""')}"` : safe;
  };
  return rows.map((row) => row.map(cell).join(",") + "\r\n").join("");
}

/** What a table shows, heading first; a real minus becomes a hyphen and thousands have no commas. */
export function rowsOf(table: HTMLTableElement): string[][] {
  const plainNumber = /^−?\d{1,3}(,\d{3})*(\.\d+)?$|^−?\d+(\.\d+)?$/;
  return [...table.rows].map((row) =>
    [...row.cells].map((cell) => {
      const text = (cell.textContent ?? "").replaceAll(/\s+/g, " ").trim();
      return plainNumber.test(text) ? text.replace("−", "-").replaceAll(",", "") : text === "–" ? "" : text;
    }),
  );
}
