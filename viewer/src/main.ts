// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import "uplot/dist/uPlot.min.css";
import "./style.css";
import type { CleanPageData } from "./clean_types.ts";
import { el } from "./dom.ts";
import { cleanPage } from "./pages/clean.ts";
import { ikPage } from "./pages/ik.ts";
import type { PageData } from "./types.ts";

const isClean = (data: PageData | CleanPageData): data is CleanPageData =>
  data.summary.schema === "kinemark.clean_report";

function show(page: HTMLElement, data: PageData | CleanPageData): void {
  document.title = `${data.summary.trial} · kinemark report`;
  const content = isClean(data) ? cleanPage(data) : ikPage(data);
  const [section, words] = content.skip;
  page.append(
    el("a", { class: "skip", href: `#${section}` }, words),
    content.header,
    content.bar,
    el("main", {}, ...content.sections),
    el("footer", {}, `Written by kinemark ${data.summary.version}. This page needs no network and sends nothing.`),
  );
  content.start();
}

const page = document.getElementById("page")!;
try {
  const data = JSON.parse(document.getElementById("kinemark-data")!.textContent) as PageData | CleanPageData | null;
  if (data === null) throw new Error("this page holds no data; kinemark report makes one that does");
  show(page, data);
} catch (error) {
  page.replaceChildren(
    el("p", { class: "broken", role: "alert" }, `This report cannot be shown: ${error instanceof Error ? error.message : String(error)}`),
  );
}
