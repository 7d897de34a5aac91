// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import "uplot/dist/uPlot.min.css";
import "./style.css";
import { decode } from "./decode.ts";
import { el } from "./dom.ts";
import { angles } from "./sections/angles.ts";
import { findings } from "./sections/findings.ts";
import { gaps } from "./sections/gaps.ts";
import { header } from "./sections/header.ts";
import { markers } from "./sections/markers.ts";
import { settings } from "./sections/settings.ts";
import { timeBar } from "./sections/time_bar.ts";
import { worstFrames } from "./sections/worst_frames.ts";
import type { PageData } from "./types.ts";
import { View } from "./view.ts";

function show(page: HTMLElement, data: PageData): void {
  const trial = decode(data);
  const { summary } = trial;
  document.title = `${summary.trial} · kinemark report`;
  const start = summary.first_time_s;
  const view = new View([start, start + Math.max(1, summary.frames - 1) / summary.rate_hz]);
  const plots = [angles(trial, view), markers(trial, view), gaps(trial, view)] as const;
  page.append(
    el("a", { class: "skip", href: "#angles" }, "Skip to the joint angles"),
    header(summary),
    timeBar(view),
    el(
      "main",
      {},
      findings(summary, view),
      ...plots.map((p) => p.node),
      worstFrames(summary, view),
      settings(summary),
    ),
    el("footer", {}, `Written by kinemark ${summary.version}. This page needs no network and sends nothing.`),
  );
  // Plots take the width of their boxes, which they only have once they are on the page.
  for (const plot of plots) plot.start();
}

const page = document.getElementById("page")!;
try {
  const data = JSON.parse(document.getElementById("kinemark-data")!.textContent) as PageData | null;
  if (data === null) throw new Error("this page holds no data; kinemark report makes one that does");
  show(page, data);
} catch (error) {
  page.replaceChildren(
    el("p", { class: "broken", role: "alert" }, `This report cannot be shown: ${error instanceof Error ? error.message : String(error)}`),
  );
}
