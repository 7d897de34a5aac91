// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { CleanPage, DeskPage, IkPage, LivePage, MarkersPage, ResultPage } from "./page_types.ts";
import "uplot/dist/uPlot.min.css";
import "./style.css";
import { inflateAll } from "./curves.ts";
import { el } from "./dom.ts";
import { baseOf, Channel } from "./editing/channel.ts";
import { cleanPage } from "./pages/clean.ts";
import type { Content } from "./pages/content.ts";
import { deskPage } from "./pages/desk.ts";
import { EditedPage } from "./pages/edited.ts";
import { ikPage } from "./pages/ik.ts";
import { livePage } from "./pages/live.ts";
import { markersPage } from "./pages/markers.ts";
import { resultPage } from "./pages/result.ts";

type AnyPage = IkPage | CleanPage | MarkersPage | ResultPage | LivePage | DeskPage;

const isClean = (data: AnyPage): data is CleanPage => data.summary.schema === "kinemark.clean_report";
const isResult = (data: AnyPage): data is ResultPage => data.summary.schema === "kinemark.result_report";
const isLive = (data: AnyPage): data is LivePage => data.summary.schema === "kinemark.live";
const isDesk = (data: AnyPage): data is DeskPage => data.summary.schema === "kinemark.desk";
const isMarkers = (data: AnyPage): data is MarkersPage => data.summary.schema === "kinemark.markers_report";

async function show(page: HTMLElement, data: AnyPage): Promise<void> {
  if ("series" in data) await inflateAll(data.series);
  document.title = `${data.summary.trial} · kinemark report`;
  const base = baseOf(location.pathname);
  if (isMarkers(data) && data.editing !== undefined && !("refused" in data.editing) && base !== null) {
    await new EditedPage(new Channel(base), data.editing, (content) => {
      // Where people have scrolled to is found again on a page that is there as a whole.
      lay(page, content, `kinemark ${data.summary.version} shows the recording with its edits, and talks to nobody but the program on this machine.`);
      for (const run of content.later ?? []) run();
    }).draw(data);
    return;
  }
  const foot = isLive(data) || isDesk(data) ? `kinemark ${data.summary.version}. This page talks with its own server alone.` : `Written by kinemark ${data.summary.version}. This page needs no network and sends nothing.`;
  const content = isLive(data) ? livePage(data) : isDesk(data) ? deskPage(data) : isResult(data) ? await resultPage(data) : isMarkers(data) ? await markersPage(data) : isClean(data) ? await cleanPage(data) : await ikPage(data);
  lay(page, content, foot);
  for (const run of content.later ?? []) {
    await painted();
    run();
  }
}

/** When the browser has had the time to show what was drawn; soon where nobody looks at the page. */
const painted = (): Promise<void> =>
  new Promise((done) => {
    requestAnimationFrame(() => setTimeout(done));
    setTimeout(done, 250);
  });

function lay(page: HTMLElement, content: Content, foot: string): void {
  const [section, words] = content.skip;
  page.replaceChildren(
    el("a", { class: "skip", href: `#${section}` }, words),
    content.header,
    content.bar,
    el("main", {}, ...content.sections),
    el("footer", {}, foot),
  );
  content.start();
}

const page = document.getElementById("page")!;
try {
  const data = JSON.parse(document.getElementById("kinemark-data")!.textContent) as AnyPage | null;
  if (data === null) throw new Error("this page holds no data; kinemark report makes one that does");
  await show(page, data);
  document.documentElement.dataset["ready"] = "yes";
} catch (error) {
  page.replaceChildren(
    el("p", { class: "broken", role: "alert" }, `This report cannot be shown: ${error instanceof Error ? error.message : String(error)}`),
  );
  document.documentElement.dataset["ready"] = "broken";
}
