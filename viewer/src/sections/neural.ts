// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { NeuralLanes } from "../page_types.ts";
import { decodeBytes, inflateAll } from "../curves.ts";
import { el, section } from "../dom.ts";
import { number, plural } from "../format.ts";
import { LanePlot, type Lanes } from "../plots/lanes.ts";
import type { View } from "../view.ts";

interface Part {
  node: HTMLElement;
  start: () => void;
}

/** What a page holds of spikes, trials and field potentials, inflated. */
export async function unpackLanes(packed: NeuralLanes): Promise<Lanes> {
  await inflateAll(packed);
  return {
    startS: packed.start_s,
    binS: packed.bin_s,
    units: packed.units.map((u) => ({ id: u.id, spikes: u.spikes, counts: decodeBytes(u.counts, packed.bins) })),
    trials: packed.trials.map((t) => ({ label: t.label, startS: t.start_s, stopS: t.stop_s })),
    fields: packed.fields.flatMap((f) =>
      f.channels.map((c) => ({
        name: c.name,
        unit: f.unit,
        startS: f.start_s,
        binS: f.bin_s,
        least: c.least,
        step: c.step,
        low: decodeBytes(c.low, f.bins),
        high: decodeBytes(c.high, f.bins),
      })),
    ),
  };
}

/** "20 units with 9,500 spikes, 4 trials, 4 channels of field potentials". */
export function lanesInWords(lanes: Lanes, unitCount: number): string {
  const spikes = lanes.units.reduce((sum, u) => sum + u.spikes, 0);
  const first = unitCount > lanes.units.length ? `, the first ${number(lanes.units.length)} shown` : "";
  return [
    ...(unitCount > 0 ? [`${plural(unitCount, "unit", "units")} with ${plural(spikes, "spike", "spikes")}${first}`] : []),
    ...(lanes.trials.length > 0 ? [plural(lanes.trials.length, "trial", "trials")] : []),
    ...(lanes.fields.length > 0 ? [`${plural(lanes.fields.length, "channel", "channels")} of field potentials`] : []),
  ].join(", ");
}

/** A raster with trials behind it and field potentials below, on the time of all other plots. */
export function neuralLanes(lanes: Lanes, unitCount: number, view: View): Part {
  const box = el("div", { class: "gap-map lanes", id: "lanes" });
  const plot = new LanePlot(box, view, lanes);
  const lead = `${lanesInWords(lanes, unitCount)}, on the clock of the recording. A mark is a bin of ${number(1e3 * lanes.binS, 1)} ms with spikes, the stronger the more; field potentials span from their least to their largest value.`;
  return { node: section("neural", "Beside the movement", lead, plot.readout, box), start: () => plot.draw() };
}
