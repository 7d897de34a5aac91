// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { AnglesState, SolutionFacts } from "../page_types.ts";
import { inflateAll } from "../curves.ts";
import { decode, type Trial } from "../decode.ts";
import { el, section } from "../dom.ts";
import type { Channel } from "../editing/channel.ts";
import { coordinateChanges, type CoordinateChange } from "../editing/differences.ts";
import { isOurs, keyOf } from "../editing/keys.ts";
import type { AnglesOf } from "../editing/types.ts";
import { number, plural } from "../format.ts";
import type { View } from "../view.ts";
import { compare, dataOfPage } from "./compare.ts";

/** How often the server is asked while it solves, ms. */
const askEvery = 250;
/** Coordinates that are listed. */
const mostListed = 6;

const isBusy = (state: AnglesState | null): boolean => state?.state === "waiting" || state?.state === "solving";

/** A sentence on a coordinate that is another one now. */
export function changeWords(c: CoordinateChange): string {
  const size = c.unit === "deg" ? `${number(Math.abs(c.largest), 2)} deg` : `${number(1e3 * Math.abs(c.largest), 1)} mm`;
  return [
    c.largest === 0 ? "" : `at most ${size} ${c.largest > 0 ? "more" : "less"}`,
    c.beyond === 0 ? "" : `beyond two standard deviations in ${number(c.beyond)} of ${plural(c.shared, "frame")}`,
    c.came === 0 ? "" : `determined in ${plural(c.came, "more frame")}`,
    c.went === 0 ? "" : `no longer determined in ${plural(c.went, "frame")}`,
  ]
    .filter((t) => t !== "")
    .join("; ");
}

/** Joint angles of a recording that is edited: solved by the server when that is asked for, and laid over those from before. */
export class SolvedAngles {
  readonly node: HTMLElement;
  /** The curves; empty where there are none. */
  readonly curves = el("div", { class: "solved-curves" });
  #state: AnglesState | null = null;
  #digest = "";
  #view: View | null = null;
  #over: AnglesOf = "recorded";
  readonly #trials = new Map<string, Trial>();
  #start: (() => void) | null = null;
  #said = "";
  #timer: ReturnType<typeof setTimeout> | undefined;

  readonly #solve: HTMLButtonElement;
  readonly #stop: HTMLButtonElement;
  readonly #other = el("select", { id: "solved-over", change: () => void this.#chose() });
  readonly #otherBox = el("label", { class: "pick", for: "solved-over" }, el("span", {}, "dashed over them"), this.#other);
  readonly #report = el("a", { class: "jump plain", target: "_blank", rel: "noopener" }, "Report of these angles");
  readonly #bar = el("progress", { max: 1, "aria-label": "Frames solved" });
  readonly #words = el("p", { class: "edit-said", role: "status", id: "solved-said" });
  readonly #facts = el("p", { class: "facts", id: "solved-facts" });
  readonly #changes = el("div", { class: "edit-changed", id: "solved-changes" });
  readonly #keys: () => boolean;

  /** @param redraw  draw the page anew, which calls show() and start() @param keys  whether letters are ours */
  constructor(
    readonly channel: Channel,
    readonly redraw: () => Promise<string | null>,
    keys: () => boolean,
  ) {
    this.#keys = keys;
    this.#solve = el("button", { type: "button", title: "Joint angles of the recording as it is edited now (a)", "aria-keyshortcuts": "a", click: () => void this.#ask("solve") }, "Solve");
    this.#stop = el("button", { type: "button", title: "Stop solving", click: () => void this.#ask("stop") }, "Stop");
    this.#report.href = channel.anglesPage("now");
    this.node = section(
      "solved",
      "Angles",
      "Joint angles of the recording as it is edited now, by least squares over all its frames. Nothing is written.",
      el(
        "div",
        { class: "controls" },
        this.#solve,
        this.#stop,
        this.#bar,
        this.#otherBox,
        this.#report,
      ),
      this.#words,
      this.#facts,
      this.#changes,
    );
    document.addEventListener("keydown", (e) => {
      if (keyOf(e) === "a" && this.#keys() && isOurs(e) && this.node.isConnected && !this.#solve.disabled) this.#solve.click();
    });
    this.#write();
  }

  /** Go on with a recording as it is drawn now, and its edits. */
  show(view: View, digest: string): void {
    this.#view = view;
    this.#digest = digest;
    this.#draw();
  }

  /** Once all of it is on the page. */
  start(): void {
    this.#start?.();
    this.#start = null;
  }

  /** Ask how far the server is. */
  async lookAgain(): Promise<void> {
    if (this.#timer === undefined) this.#take(await this.channel.angles());
  }

  async #ask(what: "solve" | "stop"): Promise<void> {
    this.#solve.disabled = true;
    this.#take(await this.channel.askAngles(what));
  }

  #take({ value, refused }: { value: AnglesState | null; refused: string | null }): void {
    const had = this.#state?.solutions.now?.set;
    if (value !== null) this.#state = value;
    this.#said = refused ?? "";
    clearTimeout(this.#timer);
    this.#timer = undefined;
    if (value !== null && isBusy(value)) {
      this.#timer = setTimeout(() => {
        this.#timer = undefined;
        void this.lookAgain();
      }, askEvery);
    } else if (value?.solutions.now != null && (value.solutions.now.set !== had || !this.#trials.has(value.solutions.now.set))) {
      void this.#load();
    }
    this.#write();
  }

  async #chose(): Promise<void> {
    this.#over = this.#other.value as AnglesOf;
    await this.#load();
  }

  /** Fetch the solutions that are to be seen, and draw them with the page. */
  async #load(): Promise<void> {
    const kept = new Set<string>();
    for (const which of ["now", this.#otherOf()] as const) {
      const facts = which === null ? null : (this.#state?.solutions[which] ?? null);
      if (facts === null || which === null) continue;
      kept.add(facts.set);
      if (this.#trials.has(facts.set)) continue;
      const answer = await this.channel.anglesHtml(which);
      if ("refused" in answer) {
        this.#said = answer.refused;
        return this.#write();
      }
      try {
        const data = dataOfPage(answer.html);
        await inflateAll(data.series);
        this.#trials.set(facts.set, decode(data));
      } catch (error) {
        this.#said = `These angles cannot be shown: ${error instanceof Error ? error.message : String(error)}`;
        return this.#write();
      }
    }
    for (const set of [...this.#trials.keys()]) if (!kept.has(set)) this.#trials.delete(set);
    const refused = await this.redraw();
    if (refused !== null) this.#said = refused;
    this.#write();
  }

  /** What lies over the newest solution: another one, or nothing. */
  #otherOf(): AnglesOf | null {
    const solutions = this.#state?.solutions;
    const now = solutions?.now ?? null;
    const isOther = (which: AnglesOf): boolean => solutions?.[which] != null && solutions[which]!.set !== now?.set;
    if (now === null) return null;
    if (isOther(this.#over)) return this.#over;
    return (["recorded", "before"] as const).find(isOther) ?? null;
  }

  #trial(facts: SolutionFacts | null | undefined): Trial | null {
    return facts == null ? null : (this.#trials.get(facts.set) ?? null);
  }

  #nameOf(which: AnglesOf): string {
    return which === "recorded" ? "as recorded" : `with ${plural(this.#state?.solutions[which]?.edits ?? 0, "edit")}, as solved before`;
  }

  #draw(): void {
    this.#start = null;
    const solutions = this.#state?.solutions;
    const now = this.#trial(solutions?.now);
    const which = this.#otherOf();
    const other = which === null ? null : this.#trial(solutions?.[which]);
    if (now === null || this.#view === null) {
      this.curves.replaceChildren();
      this.#changes.replaceChildren();
      return;
    }
    const changes = other === null ? [] : coordinateChanges(now, other);
    const over = other === null || which === null ? null : { trial: other, words: this.#nameOf(which), first: changes.map((c) => c.name) };
    const { node, start } = compare(now, this.#view, over);
    this.curves.replaceChildren(node);
    this.#start = start;
    const beyond = changes.filter((c) => c.beyond > 0).length;
    const rows = changes.slice(0, mostListed).map((c) => el("li", {}, Number.isNaN(c.time) ? el("b", {}, c.name) : this.#jump(c), ` ${changeWords(c)}`));
    this.#changes.replaceChildren(
      ...(other === null || which === null
        ? []
        : changes.length === 0
          ? [el("p", { class: "facts" }, `No coordinate differs from the solution ${this.#nameOf(which)}.`)]
          : [el("p", { class: "facts" }, `${plural(changes.length, "coordinate")} differ${changes.length === 1 ? "s" : ""} from the solution ${this.#nameOf(which)}, ${beyond === 0 ? "none" : number(beyond)} by more than two standard deviations${changes.length > mostListed ? `; the ${mostListed} that differ most:` : ":"}`), el("ul", { class: "changes" }, ...rows)]),
    );
  }

  #jump(c: CoordinateChange): HTMLElement {
    return el("button", { type: "button", class: "jump plain", title: `Show ${number(c.time, 2)} s`, click: () => this.#view?.jumpTo(c.time, "compare") }, c.name);
  }

  #write(): void {
    const state = this.#state;
    const busy = isBusy(state);
    const now = state?.solutions.now ?? null;
    this.#solve.disabled = state?.model == null || busy;
    this.#stop.hidden = this.#bar.hidden = !busy;
    if (state !== null && state.of > 0 && state.state === "solving") this.#bar.value = state.done / state.of;
    else this.#bar.removeAttribute("value");
    this.#report.hidden = now === null;
    const others = (["recorded", "before"] as const).filter((w) => state?.solutions[w] != null && state.solutions[w]!.set !== now?.set);
    this.#other.replaceChildren(...others.map((w) => el("option", { value: w }, this.#nameOf(w))));
    const which = this.#otherOf();
    if (which !== null) this.#other.value = which;
    this.#otherBox.hidden = others.length === 0;
    const wrong = this.#said !== "" ? this.#said : (state?.said ?? "");
    this.#words.className = wrong === "" ? "edit-said" : "edit-said refused";
    this.#words.setAttribute("role", wrong === "" ? "status" : "alert");
    this.#words.textContent = wrong !== "" ? wrong : this.#progressWords();
    this.#facts.textContent = now === null ? "" : this.#factsOf(now);
  }

  #progressWords(): string {
    const state = this.#state;
    if (state === null) return "";
    if (state.state === "waiting") return "Waits for another recording that is being solved.";
    if (state.state === "solving") return state.of > 0 ? `Solving: ${number(state.done)} of ${plural(state.of, "frame")}.` : "Solving: the recording is read.";
    if (state.state === "stopped") return "Stopped. What was solved before is still there.";
    if (state.state === "none") return `Not solved yet; the model is ${state.model ?? "not known"}.`;
    return "";
  }

  #factsOf(now: SolutionFacts): string {
    const old = now.digest === this.#digest ? "" : " The recording was edited since: solve it again.";
    const verdict = now.verdict === "good" ? "nothing needs attention" : `${plural(now.attentions, "finding")} ${now.attentions === 1 ? "needs" : "need"} attention`;
    return `Solved with ${plural(now.edits, "edit")} and ${this.#state?.model ?? "a model"}: markers ${number(now.rms_mm, 2)} mm from the model RMS, ${verdict}.${old}`;
  }
}
