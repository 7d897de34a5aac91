#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""LEDs that are dimmer or brighter than those of the calibration: `simulate rig sign` with a light drawn for each LED from 0.2
to 3, calibrated with and without dark slots, reconstructed by each frame and by the smoother.

Held against the truth: light, its 95 % interval, who is named; what the error of a light moves a point (beside the same counts
with the offsets of the true light); and, with the true cameras, how often 95 % intervals of positions hold them.

Arguments: first seed (default 1), number of rigs (default 3). Prints rows "PASS|FAIL | check | asked | measured".
"""

import csv
import json
import math
import random
import statistics
import sys
import tempfile
import tomllib
from pathlib import Path

import rows
from rows import exit_status, output

LEDS = ("shoulder", "elbow", "wrist", "hand")
METHODS = ("frames", "smoother")
RATE_HZ = 100.0
MOVES_M = 0.1
FEWEST = 100  # LEDs by which a share of 95 % can be known
OF_STRENGTH = {True: 0.02, False: 0.06}  # an LED that moves, one at rest


def row(passed, check, asked, measured):
    rows.row(passed, f"light of LEDs, {check}", asked, measured)


def points(path):
    """{(frame, LED): (position, deviations, time)} of samples that are there, m and s."""
    out = {}
    with path.open(newline="") as file:
        for r in csv.DictReader(file):
            if r["x_m"]:
                out[int(r["frame"]), r["marker"]] = ([float(r[f"{a}_m"]) for a in "xyz"], [float(r[f"sd_{a}_m"] or "nan") for a in "xyz"], float(r["time_s"]) + float(r.get("offset_s") or 0.0))
    return out


def truth_of(path):
    """{LED: [positions]} of truth.trc, m, a frame each."""
    out, lines = {led: [] for led in LEDS}, path.read_text().splitlines()
    for line in lines[5:]:
        cells = line.split("\t")
        if len(cells) < 2 + 3 * len(LEDS) or not cells[0]:
            continue
        for i, led in enumerate(LEDS):
            out[led].append([float(v) / 1e3 for v in cells[2 + 3 * i : 5 + 3 * i]])
    return out


def at_time(path, time_s):
    """Position on a path of 100 Hz: Lagrange's cubic through the four frames around."""
    first = min(max(int(time_s * RATE_HZ) - 1, 0), len(path) - 4)
    u = time_s * RATE_HZ - first
    weights = [math.prod((u - j) / (i - j) for j in range(4) if j != i) for i in range(4)]
    return [sum(w * path[first + i][a] for i, w in enumerate(weights)) for a in range(3)]


def simulate(folder, seed, lights, dark_slot, *more):
    words = [w for led, s in lights.items() for w in ("--intensity", f"{led}={s:.6f}")]
    output("simulate", "rig", "sign", "-o", folder, "--seed", seed, *(["--dark-slot"] if dark_slot else []), *words, *more, "--quiet")


def reconstruct(recording, rig, method, out, *options):
    """Points, and what is said of each LED."""
    text = output("reconstruct", recording, "--rig", rig, "--method", method, "-o", out, "--json", "--quiet", *options)
    return points(out), json.loads(text)


class Case:
    """One rig, with or without dark slots."""

    def __init__(self, folder, seed, dark_slot):
        self.dark_slot = dark_slot
        draw = random.Random(f"{seed} {dark_slot}")
        self.lights = {led: math.exp(draw.uniform(math.log(0.2), math.log(3.0))) for led in LEDS}
        plain, lit = folder / "plain", folder / "lit"
        simulate(plain, seed, {}, dark_slot, "--tree-poses")
        simulate(lit, seed, self.lights, dark_slot)
        rig = folder / "rig.toml"
        output("calibrate", plain / "tree_poses.mcap", "--nominal", plain / "rig_nominal.toml", "-o", rig, "--quiet")
        self.truth = truth_of(lit / "truth.trc")
        true = folder / "rig_true.toml"  # as far as a calibration could know it
        true.write_text("".join(line for line in (lit / "rig_true.toml").read_text().splitlines(True) if dark_slot or not line.startswith("dark_")))
        self.found, self.right, self.by_true = {}, {}, {}
        _, self.said_same = reconstruct(plain / "recording.mcap", rig, "frames", folder / "same.csv")
        for method in METHODS:
            self.found[method], self.said = reconstruct(lit / "recording.mcap", rig, method, folder / f"{method}.csv")
            if dark_slot:
                self.right[method] = self.with_right_offsets(folder, rig, lit / "recording.mcap", method)
            self.by_true[method], _ = reconstruct(lit / "recording.mcap", true, method, folder / f"{method}_true.csv")

    def moves(self, led):
        """The largest extent of its path is above 100 mm."""
        path = self.truth[led]
        return max(max(x[a] for x in path) - min(x[a] for x in path) for a in range(3)) >= MOVES_M

    def with_right_offsets(self, folder, rig, recording, method):
        """Points of each LED by the same rig, counts and noise, with the offsets of its true light given."""
        text, out = rig.read_text(), {}
        kept = [line for line in text.splitlines() if not line.startswith(("light_counts", "dark_"))]
        dark = [tomllib.loads(line)["dark_counts"] for line in text.splitlines() if line.startswith("dark_counts")]
        for led in LEDS:
            cameras, lines = iter(dark), []
            for line in kept:
                if line.startswith("offset_counts"):
                    offsets = tomllib.loads(line)["offset_counts"]
                    right = [o + self.lights[led] * (q - o) for q, o in zip(offsets, next(cameras))]
                    line = f"offset_counts = {right}"
                lines.append(line)
            given = folder / f"{led}.toml"
            given.write_text("\n".join(lines) + "\n")
            found, _ = reconstruct(recording, given, method, folder / f"{method}_{led}.csv", "--calibrated-offsets")
            out.update({key: value for key, value in found.items() if key[1] == led})
        return out

    def moved(self, method, led):
        """What an error of its light moves an LED, in the mean over frames, beside the deviation of a sample."""
        both = [k for k in self.found[method] if k[1] == led and k in self.right[method]]
        off = [statistics.mean(self.found[method][k][0][a] - self.right[method][k][0][a] for k in both) for a in range(3)]
        sd = math.sqrt(statistics.median(sum(s * s for s in self.found[method][k][1]) for k in both))
        return math.hypot(*off), sd

    def held(self, method):
        """(intervals that hold the true coordinate, all), the cameras known."""
        held = total = 0
        for (_, led), (x, sd, time_s) in self.by_true[method].items():
            there = at_time(self.truth[led], time_s)
            held += sum(abs(x[a] - there[a]) <= 1.96 * sd[a] for a in range(3))
            total += 3
        return held, total


def leds_of(said):
    return {led["name"]: led for led in said["leds"]}


def named(said, led, word=""):
    return any(f"'{led}'" in w and word in w for w in said["warnings"])


def check_light(cases):
    for moves in (True, False):
        errors = [abs(leds_of(c.said)[led]["light"] / c.lights[led] - 1.0) for c in cases for led in LEDS if c.moves(led) == moves]
        within = sum(e <= OF_STRENGTH[moves] for e in errors)
        row(within >= 0.95 * len(errors), f"strength of LEDs that {'move by 100 mm' if moves else 'rest'}", f"within {100 * OF_STRENGTH[moves]:.0f} %, >= 95 % of them", f"{within} of {len(errors)}, at most {100 * max(errors):.2f} %")


def check_intervals(cases, slots):
    z = [abs(leds_of(c.said)[led]["light"] - c.lights[led]) / leds_of(c.said)[led]["light_sd"] for c in cases for led in LEDS]
    held = sum(v <= 1.96 for v in z) / len(z)
    if len(z) >= FEWEST:
        row(0.9 <= held <= 0.99, f"95 % intervals of the light, {slots}", "90 to 99 %", f"{100 * held:.1f} % of {len(z)}")


def check_named(cases):
    dim = [(c, led) for c in cases for led in LEDS if c.lights[led] < 0.28]
    row(all(named(c.said, led, "it is dim") for c, led in dim), "named below 0.28 (0.3, less the error of the light)", "all", f"{sum(named(c.said, led, 'it is dim') for c, led in dim)} of {len(dim)}")
    other = [(c, led) for c in cases for led in LEDS if not 0.75 <= c.lights[led] <= 1.33]
    row(all(named(c.said, led, "shines") for c, led in other), "named beyond 0.75 to 1.33", "all", f"{sum(named(c.said, led, 'shines') for c, led in other)} of {len(other)}")
    ones = sum(named(c.said_same, led, "shines") for c in cases for led in LEDS)
    row(ones <= 0.02 * len(cases) * len(LEDS), "named though its light is 1", "<= 2 %", f"{ones} of {len(cases) * len(LEDS)}")
    full = [(c, led) for c in cases for led in LEDS if leds_of(c.said)[led]["saturated"] > 0]
    row(all(named(c.said, led, "brighter than the detector") for c, led in full), "named where a detector is full", "all", f"{len(full)}")


def main():
    first, count = (int(a) for a in (sys.argv[1:] + ["1", "3"])[:2])
    cases = {True: [], False: []}
    with tempfile.TemporaryDirectory() as name:
        for seed in range(first, first + count):
            for dark_slot in (True, False):
                folder = Path(name) / f"{seed}{dark_slot}"
                folder.mkdir()
                cases[dark_slot].append(Case(folder, seed, dark_slot))
    check_light(cases[True])
    check_intervals(cases[True], "dark slots")
    check_intervals(cases[False], "without them")
    check_named(cases[True])
    for method in METHODS:
        moved = [c.moved(method, led) for c in cases[True] for led in LEDS]
        within = sum(off <= 0.3 * sd for off, sd in moved)
        row(within >= 0.95 * len(moved), f"{method}, dark slots: what the light moves a point", "<= 0.3 SD, >= 95 % of LEDs", f"{within} of {len(moved)}; median {1e3 * statistics.median(off for off, _ in moved):.3f} mm")
        for dark_slot in (True, False):
            held = [c.held(method) for c in cases[dark_slot]]
            share = sum(h for h, _ in held) / sum(n for _, n in held)
            row(0.9 <= share <= 0.99, f"{method}, {'dark slots' if dark_slot else 'without them'}: 95 % intervals of positions, cameras known", "90 to 99 %", f"{100 * share:.1f} %")
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
