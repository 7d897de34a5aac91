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

/** Which solution of a recording: with the edits of now, with those of when it was solved before, without any. */
export type AnglesOf = "now" | "before" | "recorded";

/** What the server tells of a solution. */
export interface SolutionFacts {
  digest: string;
  edits: number;
  /** The set that the files of the command would name. */
  set: string;
  verdict: "good" | "attention";
  attentions: number;
  rms_mm: number;
}

/** How far the server is with the joint angles of a recording. */
export interface AnglesState {
  /** File of the body model; null: none is known, and `said` tells why. */
  model: string | null;
  state: "none" | "waiting" | "solving" | "solved" | "failed" | "stopped";
  said: string | null;
  /** Frames. */
  done: number;
  of: number;
  solutions: Record<AnglesOf, SolutionFacts | null>;
}

/** With a page of the server; a page that is a file has none. */
export type Editing = EditingState | { refused: string };
