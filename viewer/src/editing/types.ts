// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0

/** One operation in the words of a journal; docs/formats/edits.md describes them. */
export type Operation = { do: string } & Record<string, string | number>;

/** An operation of the journal as the server tells it. */
export interface JournalEntry {
  id: string;
  do: string;
  words: string;
  made?: string;
  author?: string;
  /** Absent of undo and redo. */
  in_force?: boolean;
}

/** How a marker differs from another state of the recording. */
export interface MarkerChange {
  marker: string;
  moved: number;
  came: number;
  went: number;
  restated: number;
  largest_mm: number;
  first: number;
  last: number;
}

/** What is in the journal, and what it makes of the recording. */
export interface EditingState {
  journal: string;
  digest: string;
  edits: JournalEntry[];
  regions: { name: string; first: number; last: number }[];
  /** How many operations can be taken back and brought back. */
  undo: number;
  redo: number;
  warnings: string[];
  changes: { last: MarkerChange[]; all: MarkerChange[] };
}

/** With a page of the server; a page that is a file has none. */
export type Editing = EditingState | { refused: string };
