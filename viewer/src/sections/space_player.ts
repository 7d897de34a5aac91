// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Playing the space view: at any speed, over and over, and once into a film.
import { el } from "../dom.ts";
import { number, seconds } from "../format.ts";
import { canFilm, film } from "../scene/film.ts";
import type { Scene } from "../scene/scene.ts";
import { choice, toggle } from "./space_parts.ts";

const speeds = [0.1, 0.25, 0.5, 1, 2, 4] as const;

export interface PlayerOptions {
  /** Frames that play in a second. */
  playHz: number;
  canvas: HTMLCanvasElement;
  /** The point that is shown. */
  point: () => number;
  goTo: (point: number) => void;
  /** Before the first and after the last picture of a film. */
  filming: (on: boolean) => void;
  filmed: (film: Blob) => void;
}

/** The row under the picture, and what moves the instant on. */
export class SpacePlayer {
  readonly node: HTMLElement;
  /** Makes a film; null where the browser cannot. */
  readonly filmButton: HTMLElement | null;
  playing = false;
  readonly #scene: Scene;
  readonly #options: PlayerOptions;
  readonly #slider: HTMLInputElement;
  readonly #clock = el("span", { class: "clock" });
  readonly #play: HTMLElement;
  #speed = 1;
  #loop = true;
  #began = 0;
  #from = 0;
  #film: { finish: () => Promise<Blob> } | null = null;

  constructor(scene: Scene, options: PlayerOptions) {
    this.#scene = scene;
    this.#options = options;
    const step = (by: number) => () => options.goTo(options.point() + by);
    this.#slider = el("input", { type: "range", min: 0, max: Math.max(0, scene.points - 1), step: 1, value: 0, "aria-label": "Instant" });
    this.#slider.addEventListener("input", () => {
      this.set(false);
      options.goTo(Number(this.#slider.value));
    });
    this.#play = el("button", { type: "button", class: "play", "aria-label": "Play", "aria-pressed": "false", click: () => this.set(!this.playing) }, "▶");
    this.node = el(
      "div",
      { class: "transport" },
      this.#play,
      el("button", { type: "button", "aria-label": "Frame before", click: step(-1) }, "‹"),
      el("button", { type: "button", "aria-label": "Next frame", click: step(1) }, "›"),
      this.#slider,
      this.#clock,
      choice("Speed", speeds.map((s) => [String(s), `${s} ×`] as const), "1", (v) => {
        this.#speed = Number(v);
        if (this.playing) this.set(true);
      }),
      toggle("Loop", true, (on) => void (this.#loop = on)),
    );
    this.filmButton = canFilm() ? el("button", { type: "button", title: "Play the recording once and save it as WebM", click: () => this.#toggleFilm() }, "Save film") : null;
  }

  /** Show which instant it is. */
  tell(): void {
    const { time, firstFrame, frameStep } = this.#scene;
    const point = this.#options.point();
    const instant = seconds(time[point] ?? 0);
    this.#slider.value = String(point);
    this.#clock.textContent = `${instant}  frame ${number(firstFrame + point * frameStep)}`;
    this.#slider.setAttribute("aria-valuetext", instant);
  }

  set(on: boolean): void {
    this.playing = on && this.#scene.points > 1;
    this.#play.textContent = this.playing ? "❚❚" : "▶";
    this.#play.setAttribute("aria-label", this.playing ? "Pause" : "Play");
    this.#play.setAttribute("aria-pressed", String(this.playing));
    if (!this.playing) return;
    const point = this.#options.point();
    this.#began = performance.now();
    this.#from = point >= this.#scene.points - 1 ? 0 : point;
    requestAnimationFrame((now) => this.#tick(now));
  }

  #tick(now: number): void {
    if (!this.playing) return;
    const { points, frameStep } = this.#scene;
    const gone = Math.floor(this.#from + (((now - this.#began) / 1000) * this.#speed * this.#options.playHz) / frameStep);
    if (gone >= points && this.#film !== null) {
      void this.#endFilm();
      return;
    }
    if (gone >= points && !this.#loop) {
      this.#options.goTo(points - 1);
      this.set(false);
      return;
    }
    const next = Math.max(0, gone) % points;
    if (next !== this.#options.point()) this.#options.goTo(next);
    requestAnimationFrame((then) => this.#tick(then));
  }

  /** The whole recording once, from its beginning, at the chosen speed. */
  #toggleFilm(): void {
    if (this.#film !== null) return void this.#endFilm();
    this.set(false);
    this.#options.filming(true);
    this.#film = film(this.#options.canvas, 30);
    this.filmButton!.textContent = "End film";
    this.#options.goTo(0);
    this.set(true);
    this.#from = 0;
  }

  async #endFilm(): Promise<void> {
    const done = this.#film;
    this.#film = null;
    this.set(false);
    this.filmButton!.textContent = "Save film";
    this.#options.filming(false);
    if (done !== null) this.#options.filmed(await done.finish());
  }
}
