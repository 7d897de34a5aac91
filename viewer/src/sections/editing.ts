// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { EditingState, MarkerChange, MarkersSummary } from "../page_types.ts";
import { el, section } from "../dom.ts";
import type { Channel } from "../editing/channel.ts";
import { isOurs, keyOf } from "../editing/keys.ts";
import * as make from "../editing/operations.ts";
import type { Operation } from "../editing/types.ts";
import { number, plural } from "../format.ts";
import type { View } from "../view.ts";

/** What the section is about now: it stays while the recording around it is drawn anew. */
export interface Shown {
  summary: MarkersSummary;
  view: View;
}

const changeWords = (c: MarkerChange): string =>
  [
    c.moved > 0 ? `${plural(c.moved, "sample")} moved, ${number(c.largest_mm, 1)} mm at most` : "",
    c.came > 0 ? `${number(c.came)} came` : "",
    c.went > 0 ? `${number(c.went)} went` : "",
    c.restated > 0 ? `${number(c.restated)} got another state` : "",
  ]
    .filter((t) => t !== "")
    .join("; ");

const changeList = (changes: readonly MarkerChange[]): HTMLElement =>
  el("ul", { class: "changes" }, ...changes.map((c) => el("li", {}, el("b", {}, c.marker), ` frames ${number(c.first)} to ${number(c.last)}: ${changeWords(c)}`)));

/** Operations on the recording, undo and redo, and the list of what was done. */
export class EditBar {
  readonly node: HTMLElement;
  #state: EditingState;
  #shown: Shown | null = null;
  #busy = false;

  readonly #markers = el("select", { id: "edit-markers", multiple: true, size: 5, change: () => this.#chose() });
  readonly #from = el("input", { type: "number", id: "edit-from", step: 1, placeholder: "start", change: () => this.#tellStretch() });
  readonly #to = el("input", { type: "number", id: "edit-to", step: 1, placeholder: "end", change: () => this.#tellStretch() });
  readonly #method = el("select", { id: "edit-method" }, ...make.methods.map((m) => el("option", {}, m)));
  readonly #other = el("select", { id: "edit-other" });
  readonly #name = el("input", { type: "text", id: "edit-name", list: "edit-names", autocomplete: "off", spellcheck: false });
  readonly #names = el("datalist", { id: "edit-names" });
  readonly #region = el("input", { type: "text", id: "edit-region", autocomplete: "off", spellcheck: false });
  readonly #label = el("input", { type: "text", id: "edit-label", list: "edit-labels", value: "Foot Strike", autocomplete: "off" });
  readonly #labels = el("datalist", { id: "edit-labels" });
  readonly #side = el("select", { id: "edit-side" }, ...["", "Left", "Right", "General"].map((s) => el("option", { value: s }, s === "" ? "no side" : s)));
  readonly #event = el("select", { id: "edit-event" });
  readonly #keys = el("input", { type: "checkbox", id: "edit-keys", checked: true });
  readonly #said = el("p", { class: "edit-said", role: "status", id: "edit-said" });
  readonly #list = el("ol", { class: "edit-list", id: "edit-list" });
  readonly #changed = el("div", { class: "edit-changed", id: "edit-changed" });
  readonly #undo: HTMLButtonElement;
  readonly #redo: HTMLButtonElement;

  /** @param reload  fetch the recording and draw it anew; gives why not, or null */
  constructor(
    readonly channel: Channel,
    state: EditingState,
    readonly reload: () => Promise<string | null>,
  ) {
    this.#state = state;
    const button = (words: string, key: string, title: string, click: () => void): HTMLButtonElement =>
      el("button", { type: "button", title: key === "" ? title : `${title} (${key})`, ...(key.length === 1 ? { "aria-keyshortcuts": key } : {}), click }, words);
    const field = (words: string, control: HTMLElement): HTMLElement => el("label", { class: "pick", for: control.id }, el("span", {}, words), control);
    const group = (title: string, ...all: (HTMLElement | null)[]): HTMLElement => el("div", { class: "edit-group", role: "group", "aria-label": title }, ...all);
    this.#undo = button("Undo", "Ctrl+Z", "Take the last operation back", () => void this.#make(make.undo()));
    this.#redo = button("Redo", "Ctrl+Y", "Bring it back", () => void this.#make(make.redo()));
    this.node = section(
      "edit",
      "Edit",
      `The recording itself stays as it is: each operation is saved at once in ${state.journal} beside it. Hold Shift and drag over a curve to choose frames.`,
      el(
        "div",
        { class: "edit-bar" },
        el(
          "div",
          { class: "edit-choice" },
          el("label", { for: "edit-markers" }, "Markers"),
          this.#markers,
        ),
        el(
          "div",
          { class: "edit-tools" },
          group(
            "Frames",
            field("From frame", this.#from),
            field("to frame", this.#to),
            button("From here", "[", "The frames begin at the instant", () => this.#bound(this.#from)),
            button("To here", "]", "The frames end at the instant", () => this.#bound(this.#to)),
            button("Everywhere", "Esc", "All frames", () => this.#everywhere()),
          ),
          group(
            "Samples",
            button("Cut", "c", "Samples become rejected", () => this.#ask(make.cut(this.#choice()))),
            button("Fill", "f", "Gaps are filled", () => this.#ask(make.fill(this.#choice(), this.#method.value))),
            field("by", this.#method),
            button("Unfill", "u", "Filled samples become missing", () => this.#ask(make.unfill(this.#choice()))),
            button("Crop", "x", "Other frames are left out", () => this.#ask(make.crop(this.#choice()))),
          ),
          group(
            "Labels",
            button("Swap", "s", "Two markers exchange their samples", () => this.#ask(make.swap(this.#choice(), this.#other.value))),
            field("with", this.#other),
            button("Relabel", "r", "The samples become those of another marker", () => this.#ask(make.relabel(this.#choice(), this.#name.value))),
            field("to", this.#name),
            this.#names,
          ),
          group(
            "Events and regions",
            button("Mark", "e", "A new event at the instant", () => this.#mark()),
            field("event", this.#label),
            this.#labels,
            field("side", this.#side),
            button("Move", "m", "The event chosen goes to the instant", () => this.#ask(make.moveEvent(this.#moment(), this.#instant()))),
            button("Delete", "", "The event chosen is left out", () => this.#ask(make.deleteEvent(this.#moment()))),
            field("which", this.#event),
          ),
          group(
            "Regions",
            button("Name region", "g", "The frames get a name", () => this.#ask(make.region(this.#choice(), this.#region.value, this.#clock()))),
            field("name", this.#region),
          ),
          group("History", this.#undo, this.#redo, el("label", { class: "pick", for: "edit-keys" }, this.#keys, el("span", {}, "letter keys"))),
        ),
      ),
      this.#said,
      this.#changed,
      this.#list,
    );
    document.addEventListener("keydown", (e) => this.#press(e));
  }

  /** Whether letters are keys. */
  get takesLetters(): boolean {
    return this.#keys.checked;
  }

  get state(): EditingState {
    return this.#state;
  }

  /** Begin with, or go on with, a recording as it is drawn now. */
  show(shown: Shown, state: EditingState): void {
    const chosen = new Set([...this.#markers.selectedOptions].map((o) => o.value));
    this.#shown = shown;
    this.#state = state;
    const { summary, view } = shown;
    const names = summary.markers.map((m) => m.name);
    const other = this.#other.value;
    this.#markers.replaceChildren(...names.map((n) => el("option", { value: n }, n)));
    this.#other.replaceChildren(...names.map((n) => el("option", { value: n }, n)));
    if (names.includes(other)) this.#other.value = other;
    else if (names.length > 1) this.#other.selectedIndex = 1;
    this.#names.replaceChildren(...names.map((n) => el("option", { value: n })));
    const known = [...new Set(["Foot Strike", "Foot Off", ...summary.events.map((e) => e.label)])];
    this.#labels.replaceChildren(...known.map((n) => el("option", { value: n })));
    this.#event.replaceChildren(...summary.events.map((e, i) => el("option", { value: i }, `${e.label}${e.context === "" ? "" : `, ${e.context}`}, ${number(e.time_s, 3)} s`)));
    for (const option of this.#markers.options) option.selected = chosen.has(option.value);
    if (this.#markers.selectedIndex < 0) this.#markers.selectedIndex = view.marker;
    let drawn = view.marker;
    view.onChange(() => {
      if (view.marker !== drawn && !this.#markers.options[view.marker]?.selected) this.#markers.selectedIndex = view.marker;
      drawn = view.marker;
      if (view.stretch === this.#told || view.stretch === null) return;
      const [from, to] = make.framesWithin(this.#clock(), view.stretch);
      [this.#from.value, this.#to.value] = [String(from), String(to)];
      this.#tellStretch();
    });
    this.#tellStretch();
    this.#write();
  }
  /** The stretch that stands in the fields. */
  #told: readonly [number, number] | null = null;

  /** A sentence for everybody; a refusal is told at once. */
  #say(sentence: string, refused = false): void {
    this.#said.className = refused ? "edit-said refused" : "edit-said";
    this.#said.setAttribute("role", refused ? "alert" : "status");
    this.#said.textContent = sentence;
  }

  #clock(): make.Frames {
    const { summary } = this.#shown!;
    return { firstFrame: summary.first_frame, frames: summary.frames, rateHz: summary.rate_hz, startS: summary.first_time_s };
  }

  #instant(): number {
    const { view } = this.#shown!;
    return make.timeOf(this.#clock(), make.frameAt(this.#clock(), view.focus ?? view.range[0]));
  }

  #choice(): make.Choice {
    const frame = (input: HTMLInputElement): number | null => (input.value.trim() === "" ? null : Number(input.value));
    return { markers: [...this.#markers.selectedOptions].map((o) => o.value), first: frame(this.#from), last: frame(this.#to) };
  }

  #moment(): make.Moment | undefined {
    return this.#shown!.summary.events[this.#event.selectedIndex];
  }

  #mark(): void {
    this.#ask(make.markEvent({ label: this.#label.value, context: this.#side.value, time_s: this.#instant() }));
  }

  #chose(): void {
    if (this.#markers.selectedIndex >= 0) this.#shown?.view.set({ marker: this.#markers.selectedIndex });
  }

  #bound(input: HTMLInputElement): void {
    input.value = String(make.frameAt(this.#clock(), this.#instant()));
    this.#tellStretch();
  }

  #everywhere(): void {
    this.#from.value = this.#to.value = "";
    this.#tellStretch();
  }

  /** The plots show the frames that are chosen. */
  #tellStretch(): void {
    if (this.#shown === null) return;
    const { first, last } = this.#choice();
    const { view } = this.#shown;
    const clock = this.#clock();
    const half = 0.5 / clock.rateHz;
    this.#told = first === null && last === null ? null : [first === null ? view.whole[0] - half : make.timeOf(clock, first) - half, last === null ? view.whole[1] + half : make.timeOf(clock, last) + half];
    view.set({ stretch: this.#told });
  }

  #ask(asked: make.Asked): void {
    if (typeof asked === "string") this.#say(asked, true);
    else void this.#make(asked);
  }

  /** Operations one after the other; the first that is refused ends them. */
  async #make(operations: readonly Operation[]): Promise<void> {
    if (this.#busy) return;
    this.#setBusy(true);
    let refused: string | null = null;
    let made = 0;
    let changed = false;
    for (const operation of operations) {
      const answer = await this.channel.post(this.#state.edits.length, operation);
      const state = answer.value ?? answer.state;
      if (state !== null) {
        changed = changed || state.digest !== this.#state.digest;
        this.#state = state;
      }
      refused = answer.refused;
      if (refused !== null) break;
      ++made;
    }
    const last = this.#state.edits.at(-1);
    const unseen = changed ? await this.reload() : null;
    this.#write();
    this.#setBusy(false);
    if (unseen !== null) this.#say(`Saved, but what it made cannot be shown: ${unseen}`, true);
    else if (refused !== null) this.#say(made > 0 ? `${plural(made, "operation")} made, then: ${refused}` : refused, true);
    else if (last !== undefined) this.#say(made > 1 ? `${plural(made, "operation")} made and saved; the last: ${last.words}.` : `Made and saved: ${last.words}.`);
  }

  /** Ask whether somebody else has edited the recording. */
  async lookAgain(): Promise<void> {
    if (this.#busy || this.#shown === null) return;
    const answer = await this.channel.state();
    if (this.#busy) return;
    if (answer.refused !== null) {
      // Told once, not every few seconds.
      if (!this.#lost) this.#say(answer.refused, true);
      this.#lost = true;
      return;
    }
    if (answer.value === null || (answer.value.edits.length === this.#state.edits.length && answer.value.digest === this.#state.digest)) {
      if (this.#lost) this.#say("The server answers again.");
      this.#lost = false;
      return;
    }
    this.#state = answer.value;
    this.#lost = false;
    const unseen = await this.reload();
    if (unseen !== null) return this.#say(unseen, true);
    this.#say(`Somebody else has edited this recording; it is shown as it is now. The last operation: ${this.#state.edits.at(-1)?.words ?? "none"}.`);
  }
  #lost = false;

  #setBusy(on: boolean): void {
    this.#busy = on;
    this.node.setAttribute("aria-busy", String(on));
  }

  #write(): void {
    const { edits, undo, redo, changes, regions, warnings } = this.#state;
    // What waits for an answer keeps the focus.
    this.#undo.disabled = undo === 0;
    this.#redo.disabled = redo === 0;
    this.#undo.textContent = undo === 0 ? "Undo" : `Undo (${undo})`;
    this.#redo.textContent = redo === 0 ? "Redo" : `Redo (${redo})`;
    let behind = edits.filter((e) => e.in_force === true).length;
    const rows = edits.flatMap((e) => {
      if (e.in_force === undefined) return [];
      const count = e.in_force ? behind-- : 0;
      const back = count === 0 ? el("small", {}, "undone") : el("button", { type: "button", class: "plain", title: `Undo ${plural(count, "operation")}, down to this one`, click: () => void this.#make(make.undo(count)) }, "Undo to here");
      return [el("li", { value: Number(e.id) || 0, ...(e.in_force ? {} : { class: "undone" }) }, el("span", { class: "words" }, e.words), " ", el("small", {}, [e.made?.replace("T", " ").replace("Z", "") ?? "", e.author ?? ""].filter((t) => t !== "").join(", ")), " ", back)];
    });
    this.#list.replaceChildren(...rows.reverse());
    this.#list.hidden = rows.length === 0;
    const region = regions.map((r) => `${r.name}: frames ${number(r.first)} to ${number(r.last)}`).join("; ");
    this.#changed.replaceChildren(
      ...(changes.last.length === 0 ? [] : [el("details", { open: true }, el("summary", {}, "What the last operation changed"), changeList(changes.last))]),
      ...(changes.all.length === 0 ? [] : [el("details", {}, el("summary", {}, `${plural(changes.all.length, "marker")} differ${changes.all.length === 1 ? "s" : ""} from what was recorded`), changeList(changes.all))]),
      ...(region === "" ? [] : [el("p", { class: "facts" }, "Regions: ", el("b", {}, region))]),
      ...warnings.map((w) => el("p", { class: "facts" }, w)),
    );
  }

  /** Letters work wherever nobody is typing; undo and redo there too. */
  #press(event: KeyboardEvent): void {
    if (this.#shown === null || !this.node.isConnected || !isOurs(event)) return;
    const acts: Record<string, () => void> = {
      undo: () => !this.#undo.disabled && this.#undo.click(),
      redo: () => !this.#redo.disabled && this.#redo.click(),
      "[": () => this.#bound(this.#from),
      "]": () => this.#bound(this.#to),
      Escape: () => this.#everywhere(),
      c: () => this.#ask(make.cut(this.#choice())),
      f: () => this.#ask(make.fill(this.#choice(), this.#method.value)),
      u: () => this.#ask(make.unfill(this.#choice())),
      x: () => this.#ask(make.crop(this.#choice())),
      s: () => this.#other.focus(),
      r: () => this.#name.focus(),
      e: () => this.#mark(),
      m: () => this.#ask(make.moveEvent(this.#moment(), this.#instant())),
      g: () => this.#region.focus(),
    };
    const key = keyOf(event);
    const wanted = acts[key];
    if (wanted === undefined || (key !== "undo" && key !== "redo" && !this.#keys.checked)) return;
    event.preventDefault();
    wanted();
  }
}
