// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0

const kinds = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm"] as const;

/** Whether this browser can write a film. */
export const canFilm = (): boolean => typeof MediaRecorder !== "undefined" && kinds.some((kind) => MediaRecorder.isTypeSupported(kind));

/**
 * Record a canvas while something plays on it. `finish` of what comes back ends the film and hands it over.
 * Throws where the browser cannot.
 */
export function film(canvas: HTMLCanvasElement, framesPerSecond: number): { finish: () => Promise<Blob> } {
  const kind = kinds.find((k) => MediaRecorder.isTypeSupported(k));
  if (kind === undefined) throw new Error("this browser cannot write WebM");
  const stream = canvas.captureStream(framesPerSecond);
  const recorder = new MediaRecorder(stream, { mimeType: kind, videoBitsPerSecond: 8_000_000 });
  const parts: Blob[] = [];
  recorder.addEventListener("dataavailable", (e) => parts.push(e.data));
  const stopped = new Promise<void>((done) => recorder.addEventListener("stop", () => done()));
  recorder.start();
  return {
    finish: async () => {
      recorder.stop();
      await stopped;
      for (const track of stream.getTracks()) track.stop();
      return new Blob(parts, { type: "video/webm" });
    },
  };
}
