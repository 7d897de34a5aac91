// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { Vec } from "../scene/vec.ts";
import { decodeMessage, drawnMessage, pushMessage, type AnglesMessage, type MarkersMessage } from "./message.ts";

export type LiveState = "connecting" | "open" | "lost" | "ended";

/** What a stream needs of its surroundings. */
export interface Surroundings {
  connect: (url: string) => WebSocket;
  /** ms */
  now: () => number;
  later: (task: () => void, ms: number) => void;
}

/** What the page hears. */
export interface Listener {
  markers: (message: MarkersMessage) => void;
  angles: (message: AnglesMessage) => void;
  /** Connection, sentence or counts have changed. */
  changed: () => void;
}

const slowest_ms = 5000;
const rateOver_ms = 2000;
const triesBeforeAdvice = 3;

/** The connection to a live source: taken up again when it is lost, and everything counted. */
export class LiveStream {
  state: LiveState = "connecting";
  /** What people should know; empty: nothing. */
  sentence = "";
  frames = 0;
  lastFrame = -1;
  /** Frames that the server did not send to this page as it was too slow. */
  dropped = 0;
  /** Frames that came while there was no connection. */
  missed = 0;
  answer_s: number | null = null;
  #socket: WebSocket | null = null;
  #handled = 0;
  #said = 0;
  #tries = 0;
  #droppedBefore = 0;
  #droppedNow = 0;
  readonly #arrivals: number[] = [];

  constructor(
    readonly url: string,
    readonly listener: Listener,
    readonly around: Surroundings,
  ) {}

  start(): void {
    const socket = this.around.connect(this.url);
    socket.binaryType = "arraybuffer";
    this.#socket = socket;
    this.#handled = this.#said = 0;
    this.#droppedBefore += this.#droppedNow;
    this.#droppedNow = 0;
    socket.onopen = () => {
      this.#set("open", "");
    };
    socket.onmessage = (event: MessageEvent<ArrayBuffer>) => this.#take(event.data);
    socket.onclose = (event: CloseEvent) => this.#over(event);
  }

  /** Frames that came in a second, over the last two. */
  rateHz(): number {
    const since = this.around.now() - rateOver_ms;
    while (this.#arrivals.length > 0 && this.#arrivals[0]! < since) this.#arrivals.shift();
    return (1000 * this.#arrivals.length) / rateOver_ms;
  }

  /** All that came so far is drawn: the server may send more. */
  drawn(): void {
    if (this.state !== "open" || this.#said === this.#handled) return;
    this.#said = this.#handled;
    this.#socket?.send(drawnMessage(this.#handled));
  }

  /** Push the body of the model, as pushMessage(). */
  push(body: number, point: Vec, force: Vec): void {
    if (this.state === "open") this.#socket?.send(pushMessage(body, point, force));
  }

  #take(data: ArrayBuffer): void {
    let message;
    try {
      message = decodeMessage(data);
    } catch (error) {
      this.#set("ended", `${error instanceof Error ? error.message : String(error)}; reload the page`);
      this.#socket?.close();
      return;
    }
    ++this.#handled;
    this.#tries = 0;
    if (message.kind === "sentence") this.#set(this.state, message.text);
    else if (message.kind === "angles") this.listener.angles(message);
    else {
      const step = message.frame - this.lastFrame - 1 - (message.dropped - this.#droppedNow);
      if (this.lastFrame >= 0) this.missed += Math.max(0, step);
      this.lastFrame = message.frame;
      this.#droppedNow = message.dropped;
      this.dropped = this.#droppedBefore + message.dropped;
      this.answer_s = message.answer_s ?? this.answer_s;
      ++this.frames;
      this.#arrivals.push(this.around.now());
      this.listener.markers(message);
    }
  }

  #over(event: CloseEvent): void {
    if (this.state === "ended") return;
    if (event.code === 1000) {
      this.#set("ended", `${event.reason.charAt(0).toUpperCase()}${event.reason.slice(1)}. What you see is the last frame.`);
      return;
    }
    const wait = Math.min(slowest_ms, 500 * 2 ** this.#tries++);
    const advice = this.#tries > triesBeforeAdvice ? " If the server was started again, open the address that it printed." : "";
    this.#set("lost", `The connection to the server is lost; what you see is the last frame. Trying again.${advice}`);
    this.around.later(() => this.start(), wait);
  }

  #set(state: LiveState, sentence: string): void {
    this.state = state;
    this.sentence = sentence;
    this.listener.changed();
  }
}
