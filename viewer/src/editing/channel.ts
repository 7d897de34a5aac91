// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { AnglesState, EditingState, MarkersPage, Refusal } from "../page_types.ts";
import type { AnglesOf, Operation } from "./types.ts";

/** What became of a request. `state` is there whenever the server told it, after a conflict too. */
export interface Answer<T> {
  value: T | null;
  state: EditingState | null;
  /** Why it was refused, one sentence; null where it was not. */
  refused: string | null;
}

const lost = "The server does not answer, so nothing more is saved. What was saved is in the journal; start 'kinemark serve' again and open its new address.";
const closed = "This page is no longer let in. Open the address that 'kinemark serve' printed last.";

/** Requests about the edits of one trial. */
export class Channel {
  /** @param base as baseOf(): where the server answers about the trial */
  constructor(
    readonly base: string,
    readonly ask: typeof fetch = (...all) => fetch(...all),
  ) {}

  state = (): Promise<Answer<EditingState>> => this.#request("edits", {});
  data = (): Promise<Answer<MarkersPage>> => this.#request("data", {});

  /** One operation, on as many as the page knows of. */
  post(expected: number, edit: Operation): Promise<Answer<EditingState>> {
    return this.#request("edits", { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify({ expected, edit }) });
  }

  angles = (): Promise<Answer<AnglesState>> => this.#request("angles", {});

  /** Begin to solve the recording with its edits, or stop that. */
  askAngles(what: "solve" | "stop"): Promise<Answer<AnglesState>> {
    return this.#request("angles", { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify({ do: what }) });
  }

  /** Where the report of a solution is. */
  anglesPage = (which: AnglesOf): string => `${this.base.replace("/api/", "/")}/angles/${which}`;

  /** Its text. */
  async anglesHtml(which: AnglesOf): Promise<{ html: string } | { refused: string }> {
    try {
      const answer = await this.ask(this.anglesPage(which), { credentials: "omit", cache: "no-store", redirect: "error" });
      if (answer.status === 401 || answer.status === 421) return { refused: closed };
      return answer.ok ? { html: await answer.text() } : { refused: `These angles are no longer there (status ${answer.status}); solve them again.` };
    } catch {
      return { refused: lost };
    }
  }

  async #request<T>(what: string, init: RequestInit): Promise<Answer<T>> {
    let answer: Response;
    try {
      answer = await this.ask(`${this.base}/${what}`, { ...init, credentials: "omit", cache: "no-store", redirect: "error" });
    } catch {
      return { value: null, state: null, refused: lost };
    }
    if (answer.status === 401 || answer.status === 421) return { value: null, state: null, refused: closed };
    if (answer.status === 413) return { value: null, state: null, refused: "The names of this operation are too long for it." };
    try {
      const json = (await answer.json()) as T & Partial<Refusal>;
      if (answer.ok) return { value: json, state: null, refused: null };
      return { value: null, state: json.editing ?? null, refused: json.error ?? `The server answered with status ${answer.status}.` };
    } catch {
      return { value: null, state: null, refused: answer.status === 503 ? "The server is busy; try again in a moment." : `The server answered with status ${answer.status}.` };
    }
  }
}

/**
 * Where a page asks about its trial: "/SESSION/trial/3" becomes "/SESSION/api/trial/3"; null of any other address. The session, which
 * lets in, is in the path alone: cookies would go to every port of this machine.
 */
export function baseOf(path: string): string | null {
  const [, session, trial] = /^(\/[0-9a-f]{32})(\/trial\/[1-9]\d*)$/.exec(path) ?? [];
  return trial === undefined ? null : `${session}/api${trial}`;
}
