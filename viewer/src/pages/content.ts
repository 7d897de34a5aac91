// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0

/** The parts of a page, whatever it reports on. */
export interface Content {
  /** Where the link goes that keyboards reach first, and its words. */
  skip: [section: string, words: string];
  header: HTMLElement;
  bar: HTMLElement;
  sections: HTMLElement[];
  /** Called once all of it is on the page: plots take the width of their boxes. */
  start: () => void;
  /** Called after that one by one, so that what begins first is seen before all else is drawn. */
  later?: readonly (() => void)[];
  /** Called when something else takes its place. */
  stop?: () => void;
}
