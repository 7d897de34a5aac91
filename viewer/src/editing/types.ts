// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0

/** One operation in the words of a journal; docs/formats/edits.md describes them. */
export type Operation = { do: string } & Record<string, string | number>;

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
