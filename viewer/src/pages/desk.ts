// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { DeskPage, DeskState } from "../page_types.ts";
import { DeskChannel, type Around } from "../desk/channel.ts";
import { checkPanel } from "../desk/check.ts";
import { livePanel } from "../desk/live.ts";
import { heading, panel, tell, type Panel } from "../desk/panel.ts";
import { recordingPanel } from "../desk/recording.ts";
import { setupPanel } from "../desk/setup.ts";
import { sourcesPanel } from "../desk/sources.ts";
import { el } from "../dom.ts";
import type { Content } from "./content.ts";

const browser: Around = {
  ask: (...all) => fetch(...all),
  later: (task, ms) => void setTimeout(task, ms),
};
const steps = [["source", "Source"], ["plan", "Set-up"], ["live", "Live"], ["recording", "Recording"], ["check", "Check"]] as const;

/** A device on the desk: one step at a time, from its source to trials that are kept. */
export function deskPage({ summary }: DeskPage, around = browser): Content {
  if (summary.schema_version !== 1) throw new Error(`this page cannot read ${summary.schema} version ${summary.schema_version}`);
  const channel = new DeskChannel(`${location.pathname}api/desk`, () => show(), around);
  const badge = el("p", { class: "verdict live", id: "desk-state", role: "status" }, el("b", {}, "Connecting"));
  const message = el("p", { class: "live-sentence", id: "desk-message", role: "alert", hidden: true });
  const title = el("h1", {}, summary.trial);
  const below = el("p", { class: "model" }, `${summary.source}, trials go to ${summary.folder}`);
  const marks = new Map(steps.map(([step, words]) => [step as string, el("li", {}, words)]));
  const spot = el("div", { id: "desk-spot" }, panel("none", heading("Connecting")));
  const keptList = el("ul", { class: "desk-kept" });
  const kept = el("section", { id: "kept", "aria-labelledby": "kept-title", hidden: true }, el("h2", { id: "kept-title" }, "Kept trials"), keptList);
  let step = "";
  let part: Panel | null = null;

  function make(state: DeskState): Panel {
    if (state.step === "source") return sourcesPanel(channel.post);
    if (state.step === "plan") return setupPanel(channel.post, state);
    if (state.step === "live") return livePanel(channel.post, state);
    if (state.step === "recording") return recordingPanel(channel.post, state);
    if (state.step === "check") return checkPanel(channel.post, state);
    return { node: panel("ended", heading("Ended"), el("p", { class: "facts" }, "The program has ended, and the device is closed. Start 'kinemark serve' again to go on.")), update: () => undefined };
  }

  /** Another step takes the place of the last one; keyboards go on at its heading. */
  function enter(state: DeskState): void {
    const first = step === "";
    step = state.step;
    part = make(state);
    spot.replaceChildren(part.node);
    for (const [name, mark] of marks) {
      if (name === step) mark.setAttribute("aria-current", "step");
      else mark.removeAttribute("aria-current");
    }
    const name = marks.get(step)?.textContent ?? "Ended";
    document.title = `${name} · kinemark acquire`;
    if (!first) (part.node.firstChild as HTMLElement | null)?.focus();
  }

  function show(): void {
    const { state } = channel;
    const sentence = channel.lost || channel.refused || (state?.message ?? "");
    message.hidden = sentence === "";
    message.classList.toggle("done", channel.lost === "" && channel.refused === "" && /^(Kept|Discarded): /.test(sentence));
    tell(message, sentence);
    if (state === null) return;
    if (state.step !== step) enter(state);
    part?.update(state);
    tell(title, state.device?.name ?? summary.trial);
    tell(below, [state.wanted.source === "" ? summary.source : state.wanted.source, `trials go to ${summary.folder}`].join(", "));
    tell(badge, channel.lost !== "" ? "Connection lost" : (marks.get(step)?.textContent ?? "Ended"));
    badge.classList.toggle("attention", channel.lost !== "" || step === "recording");
    badge.classList.toggle("good", channel.lost === "" && step === "live");
    kept.hidden = state.kept.length === 0;
    if (keptList.children.length !== state.kept.length) keptList.replaceChildren(...state.kept.map((file) => el("li", {}, file)));
  }

  return {
    skip: ["desk-title", "Skip to this step"],
    header: el(
      "header",
      {},
      el("div", { class: "title" }, el("div", {}, el("p", { class: "brand" }, el("b", {}, "kinemark"), " acquire"), title, below), badge),
      message,
    ),
    bar: el("nav", { class: "bar", "aria-label": "Steps" }, el("ol", { class: "desk-steps" }, ...marks.values())),
    sections: [spot, kept],
    start: () => void channel.look(),
  };
}
