// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { LivePage } from "../page_types.ts";
import { el, section } from "../dom.ts";
import { number, plural } from "../format.ts";
import { LiveBody } from "../live/body.ts";
import { LiveCurves } from "../live/curves.ts";
import { PushHand } from "../live/push.ts";
import { LiveStream, type Surroundings } from "../live/stream.ts";
import { LiveWindow } from "../live/window.ts";
import type { Vec } from "../scene/vec.ts";
import { liveAngles } from "../sections/live_angles.ts";
import { livePush } from "../sections/live_push.ts";
import { space, type SpacePush } from "../sections/space.ts";
import { View } from "../view.ts";
import type { Content } from "./content.ts";

const secondsBeforePicture = 0.5;
const tilesEvery_ms = 250;
const curvesEvery_ms = 150;

const browser: Surroundings = {
  connect: (url) => new WebSocket(url),
  now: () => performance.now(),
  later: (task, ms) => void setTimeout(task, ms),
};

/** A source that is running: markers in space, angles of its model, and how frames come. */
export function livePage({ summary }: LivePage, around = browser): Content {
  if (summary.schema_version !== 1) throw new Error(`this page cannot read ${summary.schema} version ${summary.schema_version}`);
  const shown = new LiveWindow(summary);
  const curves = new LiveCurves(summary.coordinates.length);
  const body = summary.bodies.length === 0 ? null : new LiveBody(summary, shown.scene.points);
  const push = body === null ? null : pushing(body);
  const angles = summary.coordinates.length === 0 ? null : liveAngles(summary.coordinates, curves);
  const view = new View([0, 1]);
  let [tilesAt, curvesAt, drawing, built] = [-Infinity, -Infinity, false, false];

  const badge = el("p", { class: "verdict live", id: "live-state", role: "status" }, el("b", {}, "Connecting"));
  const sentence = el("p", { class: "live-sentence", id: "live-sentence", role: "alert", hidden: true });
  const figure = (id: string, label: string, detail: string): { node: HTMLElement; value: HTMLElement; detail: HTMLElement } => {
    const [value, more] = [el("dd", { id }, "–"), el("dd", { class: "detail" }, detail)];
    return { node: el("div", { class: "tile" }, value, el("dt", {}, label), more), value, detail: more };
  };
  const tiles = {
    time: figure("live-time", "s of the source", "no frame yet"),
    rate: figure("live-rate", "frames/s received", `${number(summary.rate_hz, Number.isInteger(summary.rate_hz) ? 0 : 2)} Hz at the source`),
    latency: figure("live-latency", "ms until drawn", "from when a frame is due, and back"),
    dropped: figure("live-dropped", "frames dropped", "this page was too slow for"),
    missed: figure("live-missed", "frames missed", "without a connection"),
    markers: figure("live-markers", `of ${plural(summary.markers.length, "marker")}`, "in the newest frame"),
  };
  const spot = el("div", { id: "space-spot" }, section("space", "Space", "", el("p", { class: "facts" }, "No frame has come yet.")));

  /** The space view, once it is seen which markers keep their distances. */
  function build(): void {
    built = true;
    const part = space(shown.scene, view, {
      trial: summary.trial,
      others: null,
      live: { seen: shown.seen, ...(body === null || push === null ? {} : { point: () => shown.pointOf(body.frame), push }) },
    });
    spot.replaceChildren(part.node);
    part.start();
  }

  /** What drags, keys and controls do to the body. */
  function pushing(of: LiveBody): SpacePush & { hand: PushHand; tell: () => void } {
    shown.scene.bodies = of.bodies;
    shown.scene.goals = of.goals;
    let [isOn, directions] = [false, (): { right: Vec; up: Vec } => ({ right: [1, 0, 0], up: summary.up })];
    const hand = new PushHand(of, (which, point, force) => stream.push(which, point, force));
    const part = livePush(summary, of, { hand, picture: () => directions(), dragging: (on) => (isOn = on), changed: () => wake() });
    return { isOn: () => isOn, hand, seenBy: (to) => (directions = to), ...part };
  }

  function tell(now: number): void {
    tilesAt = now;
    push?.tell();
    const words = { connecting: "Connecting", open: "Live", lost: "Connection lost", ended: "Ended" };
    badge.replaceChildren(el("b", {}, words[stream.state]));
    badge.classList.toggle("good", stream.state === "open");
    badge.classList.toggle("attention", stream.state === "lost");
    sentence.hidden = stream.sentence === "";
    if (sentence.textContent !== stream.sentence) sentence.textContent = stream.sentence;
    const { scene } = shown;
    tiles.rate.value.textContent = number(stream.rateHz());
    tiles.latency.value.textContent = stream.answer_s === null ? "–" : number(1e3 * stream.answer_s, 1);
    tiles.dropped.value.textContent = number(stream.dropped);
    tiles.missed.value.textContent = number(stream.missed);
    if (stream.lastFrame < 0) return;
    tiles.time.value.textContent = number(scene.time[scene.points - 1], 1);
    tiles.time.detail.textContent = `frame ${number(stream.lastFrame)}`;
    tiles.markers.value.textContent = number(scene.names.filter((_, m) => scene.markers.states[(m + 1) * scene.points - 1]! < 4).length);
  }

  /** Once a picture: what came since is drawn, and the server hears of it. */
  function draw(): void {
    drawing = false;
    const now = around.now();
    if (body !== null && built) {
      push?.hand.tick(now);
      body.putAt(shown.pointOf(body.frame));
    }
    if (built) view.set({ focus: shown.scene.time[shown.scene.points - 1]! });
    if (now - tilesAt >= tilesEvery_ms) tell(now);
    if (angles !== null && now - curvesAt >= curvesEvery_ms) {
      curvesAt = now;
      angles.draw();
    }
    stream.drawn();
  }
  const wake = (): void => {
    if (drawing) return;
    drawing = true;
    requestAnimationFrame(draw);
  };

  const stream = new LiveStream(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}${location.pathname}live/socket`, {
    markers: (message) => {
      shown.push(message);
      if (!built && stream.frames >= secondsBeforePicture * summary.rate_hz) build();
      wake();
    },
    angles: (message) => {
      curves.push(message);
      body?.push(message);
      wake();
    },
    changed: () => tell(around.now()),
  }, around);

  const below = [summary.source, summary.recording === null ? "not recorded" : `recorded in ${summary.recording}`].join(", ");
  return {
    skip: ["space", "Skip to the space view"],
    header: el(
      "header",
      {},
      el("div", { class: "title" }, el("div", {}, el("p", { class: "brand" }, el("b", {}, "kinemark"), " live"), el("h1", {}, summary.trial), el("p", { class: "model" }, below)), badge),
      sentence,
      el("dl", { class: "tiles" }, ...Object.values(tiles).map((t) => t.node)),
    ),
    bar: el("nav", { class: "bar", "aria-label": "Sections" }, el("div", { class: "links" }, el("a", { href: "#space" }, "Space"), angles === null ? null : el("a", { href: "#angles" }, "Angles"))),
    sections: [spot, ...(angles === null ? [] : [angles.node])],
    start: () => stream.start(),
  };
}
