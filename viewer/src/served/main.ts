// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { FactsPage, NoticePage, Trials, TrialsPage } from "../page_types.ts";
import { el } from "../dom.ts";
import { factsPage, isReading, noticePage, trialsMain, trialsPage, type Served } from "./pages.ts";

type AnyPage = TrialsPage | FactsPage | NoticePage;

const each_ms = 1000;

const isTrials = (data: AnyPage): data is TrialsPage => data.summary.schema === "kinemark.trials";
const isFacts = (data: AnyPage): data is FactsPage => data.summary.schema === "kinemark.facts";
const served = (data: AnyPage): Served => (isTrials(data) ? trialsPage(data) : isFacts(data) ? factsPage(data) : noticePage(data));

/** While trials are being read, ask again each second and put the new list where the old one is. */
async function renew(shown: HTMLElement, root: string): Promise<void> {
  try {
    const answer = await fetch(`${root}api/trials`, { cache: "no-store" });
    if (!answer.ok) throw new Error(String(answer.status));
    const list = (await answer.json()) as Trials;
    const next = trialsMain(list, root);
    shown.replaceWith(next);
    if (isReading(list)) setTimeout(() => void renew(next, root), each_ms);
  } catch {
    shown.querySelector("[role=status]")!.textContent = "The server has ended; start 'kinemark serve' again.";
  }
}

const data = JSON.parse(document.getElementById("kinemark-data")!.textContent) as AnyPage;
const { title, header, main } = served(data);
document.title = `${title} - kinemark`;
document.getElementById("page")!.replaceChildren(header, main, el("footer", {}, `kinemark ${data.summary.version}`));
document.documentElement.dataset["ready"] = "yes";
if (isTrials(data) && isReading(data.list)) setTimeout(() => void renew(main, data.summary.root), each_ms);
