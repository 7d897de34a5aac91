// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { Operation } from "./types.ts";

/** Frames by the file's own numbers. */
export interface Frames {
  firstFrame: number;
  frames: number;
  rateHz: number;
  startS: number;
}

/** What people chose to edit; null and "": not chosen. */
export interface Choice {
  markers: readonly string[];
  first: number | null;
  last: number | null;
}

export const methods = ["auto", "linear", "cubic", "pchip", "walk", "rigid", "regression", "pca"] as const;

/** Number of the frame at or nearest to a time, within the recording. */
export function frameAt(clock: Frames, time: number): number {
  const frame = Math.round((time - clock.startS) * clock.rateHz);
  return clock.firstFrame + Math.min(Math.max(0, clock.frames - 1), Math.max(0, frame));
}

/** Time of a frame, s. */
export const timeOf = (clock: Frames, frame: number): number => clock.startS + (frame - clock.firstFrame) / clock.rateHz;

/** The frames within a stretch of time; at least the one nearest to its beginning. */
export function framesWithin(clock: Frames, [from, to]: readonly [number, number]): [first: number, last: number] {
  const slack = 1e-6;
  const first = Math.ceil((from - clock.startS) * clock.rateHz - slack);
  const last = Math.floor((to - clock.startS) * clock.rateHz + slack);
  if (last < first) return [frameAt(clock, from), frameAt(clock, from)];
  const clamp = (f: number): number => clock.firstFrame + Math.min(Math.max(0, clock.frames - 1), Math.max(0, f));
  return [clamp(first), clamp(last)];
}

const range = ({ first, last }: Choice): Record<string, number> => ({ ...(first === null ? {} : { first }), ...(last === null ? {} : { last }) });

/** Operations, or the sentence that says what is missing. */
export type Asked = Operation[] | string;

const needsMarkers = (choice: Choice, make: (marker: string) => Operation): Asked =>
  choice.markers.length === 0 ? "Choose a marker first." : choice.markers.map(make);

export const cut = (choice: Choice): Asked => needsMarkers(choice, (marker) => ({ do: "cut", marker, ...range(choice) }));
export const unfill = (choice: Choice): Asked => needsMarkers(choice, (marker) => ({ do: "unfill", marker, ...range(choice) }));
export const fill = (choice: Choice, method: string): Asked => needsMarkers(choice, (marker) => ({ do: "fill", marker, method, ...range(choice) }));

const needsOne = (choice: Choice, make: (marker: string) => Asked): Asked =>
  choice.markers.length === 1 ? make(choice.markers[0]!) : "Choose one marker for this.";

export const swap = (choice: Choice, other: string): Asked =>
  needsOne(choice, (marker) => (marker === other ? "Choose another marker to swap with." : [{ do: "swap", marker, with: other, ...range(choice) }]));

export const relabel = (choice: Choice, to: string): Asked =>
  needsOne(choice, (marker) => (to.trim() === "" ? "Give the name that the marker shall have." : [{ do: "relabel", marker, to: to.trim(), ...range(choice) }]));

export const crop = (choice: Choice): Asked =>
  choice.first === null && choice.last === null ? "Choose the frames that shall stay." : [{ do: "crop", ...range(choice) }];

export const region = (choice: Choice, name: string, clock: Frames): Asked =>
  name.trim() === ""
    ? "Give the region a name."
    : [{ do: "region", name: name.trim(), first: choice.first ?? clock.firstFrame, last: choice.last ?? clock.firstFrame + clock.frames - 1 }];

/** An event as the summary of a page has it. */
export interface Moment {
  label: string;
  context: string;
  time_s: number;
}

const ofEvent = ({ label, context, time_s }: Moment): Record<string, string | number> => ({ label, ...(context === "" ? {} : { context }), time_s });

export const markEvent = (event: Moment): Asked => (event.label.trim() === "" ? "Give the event a name." : [{ do: "mark", ...ofEvent({ ...event, label: event.label.trim() }) }]);
export const moveEvent = (event: Moment | undefined, to_s: number): Asked => (event === undefined ? "Choose an event first." : [{ do: "move", ...ofEvent(event), to_s }]);
export const deleteEvent = (event: Moment | undefined): Asked => (event === undefined ? "Choose an event first." : [{ do: "delete", ...ofEvent(event) }]);

export const undo = (count = 1): Operation[] => [{ do: "undo", count }];
export const redo = (count = 1): Operation[] => [{ do: "redo", count }];
