// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { FactsPage, NoticePage, TrialRow, TrialsPage } from "../src/page_types.ts";
import { hostile } from "./simulated.ts";

const summary = { schema_version: 1, version: "0.1.0", root: "/s/" } as const;

export const simulatedRow = (number: number, name: string): TrialRow => ({
  number, name, folder: "study", page: `/trial/${number}`, state: "read", kind: "markers",
  markers: 40, frames: 1000, rate_hz: 240, duration_s: 1000 / 240, measured: 0.9876, verdict: null, said: null,
});

export const simulatedTrials = (trials: TrialRow[] = [simulatedRow(1, "a.c3d"), simulatedRow(7, "b.trc")], notes: string[] = []): TrialsPage => ({
  summary: { schema: "kinemark.trials", ...summary },
  list: { trials, notes },
});

export const simulatedFacts = (): FactsPage => ({
  summary: { schema: "kinemark.facts", ...summary, trial: hostile, kind: "table" },
  warnings: [`the label ${hostile} is odd`],
  facts: [{ name: "rate, Hz", value: "not known" }, { name: "software", value: hostile }],
  lists: [{ name: "columns", values: ["time", hostile] }],
});

export const simulatedNotice = (): NoticePage => ({ summary: { schema: "kinemark.notice", ...summary, trial: hostile }, sentence: `${hostile} is gone` });
