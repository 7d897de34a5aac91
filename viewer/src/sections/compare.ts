// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { EncodedCycles, IkPage } from "../page_types.ts";
import { band } from "../band.ts";
import { coarsest, framesOfPair, inflateAll } from "../curves.ts";
import { decodeCycles, type Overlay } from "../cycles.ts";
import { decode, type CoordinateSeries, type Trial } from "../decode.ts";
import { nearest } from "../downsample.ts";
import { el, section } from "../dom.ts";
import { number } from "../format.ts";
import { pairsOf, type Pair } from "../pairs.ts";
import { TimePlot } from "../plots/time_plot.ts";
import { palette } from "../theme.ts";
import type { View } from "../view.ts";
import { cycleFigure } from "./cycles.ts";

/** Plots that stand there at first. */
const firstShown = 4;

type Curves = readonly (CoordinateSeries | null)[];

/** Values of another clock on this one: the nearest sample, nothing where there is none near. */
export function onClock(time: Float64Array, other: Float64Array, values: Float32Array): Float32Array {
  const step = other.length > 1 ? other[1]! - other[0]! : Infinity;
  return Float32Array.from(time, (t) => {
    const i = nearest(other, t);
    return i >= 0 && Math.abs(other[i]! - t) <= 0.51 * step ? values[i]! : NaN;
  });
}

/** Data of a page that kinemark wrote; throws a sentence where it is none of joint angles. */
export function dataOfPage(html: string): IkPage {
  const text = /<script type="application\/json" id="kinemark-data">(.*?)<\/script>/s.exec(html)?.[1];
  if (text === undefined) throw new Error("this file is no page of kinemark");
  const data = JSON.parse(text) as IkPage | null;
  if (data?.summary?.schema !== "kinemark.ik_report") throw new Error("this page is not one of joint angles");
  return data;
}

/** A result that lies over another one from the start: what it is called, and coordinates to show first. */
export interface Over {
  trial: Trial;
  words: string;
  first: readonly string[];
}

/** Coordinates beside each other, both sides in one plot, over time or over the cycle, and a second result over the first: one that is given, or a file. */
export function compare(trial: Trial, view: View, over: Over | null = null, cycles: EncodedCycles | null = null): { node: HTMLElement; start: () => void } {
  const { coordinates } = trial.summary;
  const pairs = pairsOf(coordinates.map((c) => c.name)).filter((p) => !coordinates[p.right]!.locked);
  const hasTorques = trial.torques.some((t) => t !== null);
  const mass = trial.summary.mass_kg ?? null;
  let torques = false;
  let perMass = false;
  let second: Trial | null = over?.trial ?? null;
  /** Over the cycle; null: over time. */
  let overlays: readonly Overlay[] | null = null;
  // Both sides first: they are what people compare.
  const wanted = (over?.first ?? []).flatMap((name) => pairs.filter((p) => [p.right, p.left].some((i) => i >= 0 && coordinates[i]!.name === name)));
  const chosen = new Set<Pair>([...new Set([...wanted, ...pairs.filter((p) => p.left >= 0), ...pairs.filter((p) => p.left < 0)])].slice(0, firstShown));
  const grid = el("div", { class: "side-by-side" });
  const cycleGrid = el("div", { class: "side-by-side", hidden: true });
  const plots = new Map<Pair, { box: HTMLElement; plot: TimePlot }>();
  const note = el("p", { class: "facts", id: "second-result", "aria-live": "polite" });

  const curvesOf = (of: Trial): Curves => (torques ? of.torques : of.coordinates);
  const unitOf = (pair: Pair): string => {
    const turns = coordinates[pair.right]!.unit === "deg";
    if (!torques) return turns ? "angle (deg)" : "position (m)";
    return `${turns ? "torque (N m" : "force (N"}${perMass ? "/kg)" : ")"}`;
  };
  const scaled = (series: CoordinateSeries): CoordinateSeries => {
    if (!torques || !perMass || mass === null) return series;
    return { ...series, value: series.value.map((v) => v / mass), sd: series.sd?.map((v) => v / mass) ?? null };
  };
  /** Upper edge, lower edge and line of one side; nothing where there is none. */
  const lines = (of: Trial, index: number): (number | null)[][] => {
    const empty = Array.from(trial.time, () => null);
    const series = index < 0 ? null : (curvesOf(of)[index] ?? null);
    if (series === null) return [empty, empty, empty];
    const on = (values: Float32Array): Float32Array => (of === trial ? values : onClock(trial.time, of.time, values));
    const here = scaled({ value: on(series.value), sd: series.sd === null ? null : on(series.sd), undetermined: of === trial ? series.undetermined : null });
    const { lower, middle, upper } = band(here);
    return [[...upper], [...lower], [...middle]];
  };
  const fill = (pair: Pair): void => {
    const entry = plots.get(pair);
    if (entry === undefined) return;
    const other = (side: "right" | "left"): number => {
      const name = pair[side] < 0 ? "" : coordinates[pair[side]]!.name;
      return second === null || name === "" ? -1 : second.summary.coordinates.findIndex((c) => c.name === name);
    };
    const [right, left] = [lines(trial, pair.right), lines(trial, pair.left)];
    const [right2, left2] = second === null ? [lines(trial, -1), lines(trial, -1)] : [lines(second, other("right")), lines(second, other("left"))];
    entry.plot.setData([trial.time, ...right, ...left, right2[2]!, left2[2]!] as never);
  };
  const addCycles = (pair: Pair, of: readonly Overlay[]): void => {
    const names = [pair.right, pair.left].filter((i) => i >= 0).map((i) => coordinates[i]!.name);
    const own = of.filter((o) => names.includes(o.coordinate));
    const unit = coordinates[pair.right]!.unit === "deg" ? "angle (deg)" : "position (m)";
    cycleGrid.append(own.length > 0 ? cycleFigure(pair.title, own, unit) : el("figure", {}, el("figcaption", {}, pair.title), el("p", { class: "facts" }, "No cycle has a value of it.")));
  };
  const layCycles = (): void => {
    cycleGrid.replaceChildren();
    for (const pair of pairs) if (chosen.has(pair) && overlays !== null) addCycles(pair, overlays);
  };
  const add = (pair: Pair): void => {
    const box = el("div", { class: "plot axis" });
    const side = (text: string, kind: string): HTMLElement => el("span", { class: `key ${kind}` }, text);
    const figure = el(
      "figure",
      {},
      el("figcaption", {}, pair.title, ...(pair.left < 0 ? [] : [side("right", ""), side("left", "one")])),
      box,
    );
    grid.append(figure);
    const hidden = { stroke: () => "transparent", width: 0, hidden: true };
    const plot = new TimePlot(box, view, {
      label: `${pair.title} over time${pair.left < 0 ? "" : ", right and left"}`,
      height: 190,
      series: [
        hidden,
        hidden,
        { name: pair.left < 0 ? "this result" : "right", stroke: () => palette().line, width: 1.7 },
        hidden,
        hidden,
        { name: "left", stroke: () => palette().second, width: 1.7 },
        { name: pair.left < 0 ? "second result" : "right, second result", stroke: () => palette().line, width: 1.3, dash: [5, 4] },
        { name: "left, second result", stroke: () => palette().second, width: 1.3, dash: [5, 4] },
      ],
      bands: [{ series: [1, 2], of: 3, fill: () => palette().band }, { series: [4, 5], of: 6, fill: () => palette().secondBand }],
      unit: () => unitOf(pair),
      hatched: () => [],
      precision: () => ({
        step: torques && perMass ? null : coarsest(curvesOf(trial)[pair.right]?.step, curvesOf(trial)[pair.left]?.step),
        framesOfPair: framesOfPair(trial.frameStep),
      }),
      levels: () => (torques ? [] : (coordinates[pair.right]!.limits ?? [])),
    });
    plots.set(pair, { box: figure, plot });
    fill(pair);
  };
  const remove = (pair: Pair): void => {
    plots.get(pair)?.box.remove();
    plots.delete(pair);
  };
  const all = (): void => pairs.forEach((p) => fill(p));
  const toggle = (words: string, change: (on: boolean) => void): HTMLButtonElement => {
    const button = el("button", { type: "button", class: "choice", "aria-pressed": "false", click: () => {
      const on = button.getAttribute("aria-pressed") !== "true";
      button.setAttribute("aria-pressed", String(on));
      change(on);
      all();
    } }, words);
    return button;
  };
  const boxes = pairs.map((pair) => {
    const box = el("input", { type: "checkbox", ...(chosen.has(pair) ? { checked: true } : {}), change: () => {
      if (box.checked) {
        chosen.add(pair);
        add(pair);
      } else {
        chosen.delete(pair);
        remove(pair);
      }
      layCycles();
    } });
    return el("label", { class: "tick" }, box, pair.title, pair.left < 0 ? null : el("small", {}, " right, left"));
  });
  if (over !== null) note.textContent = `Dashed over it: the solution ${over.words}, ${differences(trial, over.trial)}.`;
  const file = el("input", { type: "file", id: "second-file", accept: ".html", change: () => void read() });
  async function read(): Promise<void> {
    const [picked] = file.files ?? [];
    if (picked === undefined) return;
    try {
      const data = dataOfPage(await picked.text());
      await inflateAll(data.series);
      second = decode(data);
      const shared = second.summary.coordinates.filter((c) => coordinates.some((o) => o.name === c.name)).length;
      note.textContent = `${second.summary.trial}, ${second.summary.method}, lies over it dashed: ${number(shared)} coordinates of the same name, ${differences(trial, second)}.`;
    } catch (error) {
      second = null;
      note.textContent = `${picked.name} cannot be laid over this result: ${error instanceof Error ? error.message : String(error)}.`;
    }
    all();
  }
  const overTime = el("div", { class: "controls" },
    hasTorques ? toggle("Torques", (on) => { torques = on; }) : null,
    hasTorques && mass !== null ? toggle(`per kg (${number(mass, 1)} kg)`, (on) => { perMass = on; }) : null,
    ...(over === null ? [el("label", { for: "second-file" }, "Second result"), file] : []),
  );
  const timeWords = el("p", { class: "facts" }, "Each with its band of two standard deviations. Dashed level lines are limits of the model.");
  const cycleWords = el("p", { class: "facts", hidden: true }, "From foot strike to foot strike, as the recording's events mark them. Thin lines are cycles, the thick one is their mean, the band one standard deviation between them. Values that are not determined are left out.");
  let unpacked: Promise<Overlay[]> | null = null;
  const overCycle = async (button: HTMLElement): Promise<void> => {
    const on = overlays === null;
    overlays = on ? await (unpacked ??= decodeCycles(cycles!)) : null;
    button.setAttribute("aria-pressed", String(on));
    for (const node of [overTime, timeWords, note, grid]) node.hidden = on;
    for (const node of [cycleWords, cycleGrid]) node.hidden = !on;
    layCycles();
  };
  const cycleButton = cycles === null ? null : el("button", { type: "button", class: "choice", id: "over-cycle", "aria-pressed": "false", click: () => void overCycle(cycleButton!) }, "Over the cycle");
  const node = section(
    "compare",
    "Side by side",
    "Both sides in one plot.",
    cycleButton === null ? null : el("div", { class: "controls" }, cycleButton),
    overTime,
    timeWords,
    cycleWords,
    note,
    el("details", {}, el("summary", {}, "Choose coordinates"), el("div", { class: "ticks" }, ...boxes)),
    grid,
    cycleGrid,
  );
  return { node, start: () => (over === null ? pairs.filter((p) => chosen.has(p)) : [...chosen]).forEach(add) };
}

/** RMS difference of the coordinates that both results determine, in words. */
export function differences(a: Trial, b: Trial): string {
  let squares = 0;
  let samples = 0;
  a.summary.coordinates.forEach((c, j) => {
    const k = b.summary.coordinates.findIndex((o) => o.name === c.name && o.unit === "deg" && c.unit === "deg");
    if (k < 0 || c.locked) return;
    const other = onClock(a.time, b.time, b.coordinates[k]!.value);
    a.coordinates[j]!.value.forEach((v, i) => {
      const d = v - other[i]!;
      if (!Number.isFinite(d)) return;
      squares += d * d;
      ++samples;
    });
  });
  return samples === 0 ? "none of them angles at the same times" : `angles ${number(Math.sqrt(squares / samples), 2)} deg apart RMS`;
}
