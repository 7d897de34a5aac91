// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { Solutions } from "../page_types.ts";

/** One operation in the words of a journal; docs/formats/edits.md describes them. */
export type Operation = { do: string } & Record<string, string | number>;

/** Which solution of a recording. */
export type AnglesOf = keyof Solutions;
