// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { el } from "../dom.ts";
import { csv, fileName, rowsOf, save } from "../save.ts";
import { sorted, type Direction, type Key } from "../sort.ts";

export interface Column<T> {
  title: string;
  unit?: string;
  key: (row: T) => Key;
  cell: (row: T) => Node | string;
  /** Numbers line up on the right and are first sorted from the largest. */
  numeric?: boolean;
  /** False: a picture, which has no order. */
  sortable?: boolean;
}

/** A table whose headings sort it; with column -1 it begins in the order of the rows. Returns the element and a function that marks one row. */
export function sortableTable<T>(
  caption: string,
  columns: Column<T>[],
  rows: readonly T[],
  first: { column: number; direction: Direction },
  onRow?: (row: T) => void,
): { node: HTMLElement; mark: (chosen: (row: T) => boolean) => void } {
  const body = el("tbody");
  const made = new Map(rows.map((row) => [row, tableRow(columns, row, onRow)]));
  const headings = columns.map((c, i) => {
    const name = el("span", {}, c.title, c.unit === undefined ? null : el("small", {}, ` ${c.unit}`));
    const attributes = { scope: "col", class: c.numeric ? "number" : "" };
    if (c.sortable === false) return el("th", attributes, name);
    return el("th", attributes, el("button", { type: "button", click: () => sortBy(i) }, name));
  });
  let current = first;

  function sortBy(column: number): void {
    const same = column === current.column;
    const natural: Direction = columns[column]!.numeric ? "descending" : "ascending";
    const other: Direction = current.direction === "ascending" ? "descending" : "ascending";
    current = { column, direction: same ? other : natural };
    show();
  }

  function show(): void {
    headings.forEach((h, i) => {
      if (i === current.column) h.setAttribute("aria-sort", current.direction);
      else h.removeAttribute("aria-sort");
    });
    const { column, direction } = current;
    const ordered = column < 0 ? rows : sorted(rows, columns[column]!.key, direction);
    body.append(...ordered.map((row) => made.get(row)!));
  }

  show();
  const saveButton = el("button", { type: "button", class: "save", click: () => save(fileName(caption, "csv"), new Blob([csv(rowsOf(table))], { type: "text/csv" })) }, "Save as CSV");
  const table = el("table", {}, el("caption", {}, caption, " ", saveButton), el("thead", {}, el("tr", {}, ...headings)), body);
  const node = el("div", { class: "table" }, table);
  return {
    node,
    mark: (chosen) => {
      for (const [row, tr] of made) tr.classList.toggle("chosen", chosen(row));
    },
  };
}

function tableRow<T>(columns: Column<T>[], row: T, onRow?: (row: T) => void): HTMLTableRowElement {
  const cells = columns.map((c, i) =>
    i === 0 ? el("th", { scope: "row" }, c.cell(row)) : el("td", { class: c.numeric ? "number" : "" }, c.cell(row)),
  );
  return onRow === undefined ? el("tr", {}, ...cells) : el("tr", { class: "link", click: () => onRow(row) }, ...cells);
}
