// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0

/** Colours of everything drawn on a canvas; style.css holds those of the text around it. */
export interface Palette {
  ink: string;
  muted: string;
  grid: string;
  background: string;
  line: string;
  /** Instead of a line whose swings are narrower than a pixel. */
  dense: string;
  band: string;
  second: string;
  /** The band around the second line. */
  secondBand: string;
  focus: string;
  hatch: string;
  hatchBackground: string;
  /** measured, filled, missing, rejected */
  gaps: [string, string, string, string];
  /** measured, upsampled, interpolated, filled from others, missing, rejected */
  states: [string, string, string, string, string, string];
  /** The same in space: strong enough to stand alone on the background. */
  marks: [string, string, string, string, string, string];
  stick: string;
  /** Joint centres, and what joins them. */
  joint: string;
  bone: string;
  /** The bodies of a model. */
  body: string;
  /** Surfaces of a model's own meshes. */
  mesh: string;
  shadow: string;
  floor: string;
  floorStrong: string;
  force: string;
  /** x, y, z */
  axes: [string, string, string];
  /** long ago, between, now */
  trail: [string, string, string];
  /** Goals by their level. */
  levels: [string, string, string, string, string, string];
  /** Samples as they came in, under the result. */
  raw: string;
  /** converged, not all determined, not converged, no markers */
  status: [string, string, string, string];
}

const light: Palette = {
  ink: "#1b2730",
  muted: "#5c6b76",
  grid: "#e6ebee",
  background: "#ffffff",
  line: "#0b6583",
  dense: "rgba(11, 101, 131, 0.45)",
  band: "rgba(11, 101, 131, 0.18)",
  second: "#b4530a",
  secondBand: "rgba(180, 83, 10, 0.16)",
  focus: "#b4530a",
  hatch: "#b3bec6",
  hatchBackground: "#f3f5f7",
  gaps: ["#a9d3df", "#e3a62f", "#33414c", "#d2401c"],
  states: ["#a9d3df", "#7d6bc4", "#e3a62f", "#1f8a5f", "#33414c", "#d2401c"],
  marks: ["#0b6583", "#6a55c0", "#d98a00", "#12804f", "#33414c", "#d2401c"],
  stick: "#9fb0bb",
  joint: "#7a2a8a",
  bone: "#c9a0d2",
  body: "#c8ccd0",
  mesh: "#e4dac6",
  shadow: "#dbe1e5",
  floor: "#e9edf0",
  floorStrong: "#d3dade",
  force: "#b4530a",
  axes: ["#c2410c", "#19703f", "#2450c8"],
  trail: ["#e3c778", "#5aa08e", "#0b4a66"],
  levels: ["#b4530a", "#6a3fb8", "#12703f", "#b0175f", "#2450c8", "#6b5d00"],
  raw: "#8b97a0",
  status: ["#a9d3df", "#c3ccd2", "#d2401c", "#33414c"],
};

const dark: Palette = {
  ink: "#e4eaee",
  muted: "#9aa9b4",
  grid: "#26323b",
  background: "#141b21",
  line: "#5cc3e2",
  dense: "rgba(92, 195, 226, 0.45)",
  band: "rgba(92, 195, 226, 0.24)",
  second: "#f2a65a",
  secondBand: "rgba(242, 166, 90, 0.2)",
  focus: "#f2a65a",
  hatch: "#465662",
  hatchBackground: "#1b242b",
  gaps: ["#2a6377", "#d9a036", "#dbe3e8", "#f0653f"],
  states: ["#2a6377", "#a99be6", "#d9a036", "#3fbf8a", "#dbe3e8", "#f0653f"],
  marks: ["#5cc3e2", "#b3a6f0", "#f0b43c", "#4fd09a", "#dbe3e8", "#f0653f"],
  stick: "#647683",
  joint: "#e6a8f2",
  bone: "#8a5c96",
  body: "#56646f",
  mesh: "#a89c86",
  shadow: "#0a0e12",
  floor: "#202b33",
  floorStrong: "#2f3d47",
  force: "#f2a65a",
  axes: ["#f2856a", "#72d19a", "#86a8f5"],
  trail: ["#5a4a1e", "#3f8f8c", "#c4f0fb"],
  levels: ["#f2a65a", "#b99cf5", "#4fd09a", "#f58fbf", "#86a8f5", "#d9c95a"],
  raw: "#7d8b96",
  status: ["#2a6377", "#56656f", "#f0653f", "#dbe3e8"],
};

const prefersDark = window.matchMedia("(prefers-color-scheme: dark)");
let printing = false;

export const palette = (): Palette => (prefersDark.matches && !printing ? dark : light);

let drawn = new AbortController();

/** What was drawn is gone from the page: nothing of it is drawn again. */
export function forgetDrawn(): void {
  drawn.abort();
  drawn = new AbortController();
}

/** Paper is white whatever the screen is. */
export function onThemeChange(redraw: () => void): void {
  const { signal } = drawn;
  prefersDark.addEventListener("change", redraw, { signal });
  for (const [event, value] of [["beforeprint", true], ["afterprint", false]] as const) {
    window.addEventListener(event, () => {
      printing = value;
      redraw();
    }, { signal });
  }
}

/** Diagonal stripes, for "not determined": readable without colour. */
export function hatch(context: CanvasRenderingContext2D, ratio = 1): CanvasPattern {
  const { hatch: stroke, hatchBackground } = palette();
  const size = Math.round(8 * ratio);
  const tile = document.createElement("canvas");
  tile.width = tile.height = size;
  const pen = tile.getContext("2d")!;
  pen.fillStyle = hatchBackground;
  pen.fillRect(0, 0, size, size);
  pen.strokeStyle = stroke;
  pen.lineWidth = Math.max(1, 1.2 * ratio);
  pen.beginPath();
  for (const shift of [-size, 0, size]) {
    pen.moveTo(shift - 1, size + 1);
    pen.lineTo(shift + size + 1, -1);
  }
  pen.stroke();
  return context.createPattern(tile, "repeat")!;
}
