// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { DeskState, Refusal } from "../page_types.ts";

/** What shall be done, as `/api/desk` takes it. */
export type DeskRequest =
  | { do: "look" | "leave_source" | "set_up" | "restart_guide" | "record" | "stop" | "keep" | "discard" }
  | { do: "open"; uri: string }
  | { do: "start"; leds: string; rate_hz: string; duration_s: string; subject: string; trial: string }
  | { do: "intensity"; led: number; value: number };

/** Ask the server for that; over once its answer is shown. */
export type Act = (request: DeskRequest) => Promise<void>;

export interface Around {
  ask: typeof fetch;
  later: (task: () => void, ms: number) => void;
}

const often_ms = 100;
const rarely_ms = 1000;
const lost = "The connection to the server is lost. A trial that is being recorded goes on there as long as it runs; where it has ended, start 'kinemark serve' again and open its new address.";
const closed = "This page is no longer let in. Open the address that 'kinemark serve' printed last.";

/** How the desk stands, looked at again and again, and what is asked of it. */
export class DeskChannel {
  state: DeskState | null = null;
  /** Why the server does not answer; empty: it does. */
  lost = "";
  /** Why it refused what was asked last; empty: it did not. */
  refused = "";
  #posting = 0;
  #asked = 0;

  constructor(
    readonly url: string,
    readonly changed: () => void,
    readonly around: Around,
  ) {}

  /** Look now, and from then on: often while a device runs. */
  look = async (): Promise<void> => {
    if (this.#posting === 0) await this.#request({});
    const runs = this.lost === "" && (this.state?.step === "live" || this.state?.step === "recording");
    this.around.later(() => void this.look(), runs ? often_ms : rarely_ms);
  };

  post: Act = async (request) => {
    ++this.#posting;
    this.refused = "";
    await this.#request({ method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(request) });
    --this.#posting;
  };

  async #request(init: RequestInit): Promise<void> {
    const number = ++this.#asked;
    let answer: Response;
    let json: (DeskState & Partial<Refusal>) | null = null;
    try {
      answer = await this.around.ask(this.url, { ...init, credentials: "omit", cache: "no-store", redirect: "error" });
      json = await answer.json().catch(() => null) as DeskState & Partial<Refusal>;
    } catch {
      this.lost = lost;
      return this.changed();
    }
    this.lost = answer.status === 401 || answer.status === 421 ? closed : "";
    // What was asked since is newer than this answer.
    if (answer.ok && json !== null && number === this.#asked) this.state = json;
    if (!answer.ok && this.lost === "" && init.method === "POST") this.refused = json?.error ?? `The server answered with status ${answer.status}.`;
    this.changed();
  }
}
