// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { EditingState, MarkersPage } from "../page_types.ts";
import type { Channel } from "../editing/channel.ts";
import { EditBar } from "../sections/editing.ts";
import { SolvedAngles } from "../sections/solved.ts";
import { forgetDrawn } from "../theme.ts";
import type { Content } from "./content.ts";
import { markersPage, type Editor, type Kept } from "./markers.ts";

/** How often a page that is seen asks whether somebody else has edited the recording, ms. */
const lookEvery = 3000;

/** The page of a recording that is edited where it is shown: drawn anew after each edit, the bar stays. */
export class EditedPage {
  readonly bar: EditBar;
  readonly angles: SolvedAngles;
  readonly #kept: Kept = { view: null, marker: null, camera: null };
  #content: Content | null = null;
  #editing: EditingState;

  constructor(
    readonly channel: Channel,
    editing: EditingState,
    readonly put: (content: Content) => void,
  ) {
    this.#editing = editing;
    this.bar = new EditBar(channel, editing, () => this.#reload());
    this.angles = new SolvedAngles(channel, () => this.#reload(), () => this.bar.takesLetters);
    const look = (): void => {
      if (document.visibilityState !== "visible") return;
      void this.bar.lookAgain();
      void this.angles.lookAgain();
    };
    void this.angles.lookAgain();
    setInterval(look, lookEvery);
    document.addEventListener("visibilitychange", look);
  }

  async draw(data: MarkersPage): Promise<void> {
    const focused = document.activeElement;
    const top = window.scrollY;
    this.#content?.stop?.();
    const editor: Editor = {
      node: this.bar.node,
      further: [this.angles.node, this.angles.curves],
      kept: this.#kept,
      show: (summary, view) => {
        this.bar.show({ summary, view }, this.#editing);
        this.angles.show(view, this.#editing.digest);
      },
    };
    forgetDrawn();
    const content = await markersPage(data, editor);
    this.put(content);
    this.angles.start();
    this.#content = content;
    if (top > 0) window.scrollTo(0, top);
    if (focused instanceof HTMLElement && focused.isConnected) focused.focus({ preventScroll: true });
  }

  /** Why the recording could not be fetched; null when it is drawn. */
  async #reload(): Promise<string | null> {
    const answer = await this.channel.data();
    if (answer.value === null) return answer.refused;
    const { editing } = answer.value;
    if (editing !== undefined && !("refused" in editing)) this.#editing = editing;
    try {
      await this.draw(answer.value);
    } catch (error) {
      return error instanceof Error ? error.message : String(error);
    }
    return null;
  }
}
