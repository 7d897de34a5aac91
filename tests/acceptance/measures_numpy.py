#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Intervals of path length, mean speed and peak speed on movements and noise of another make: minimum-jerk submovements, Lissajous
figures and spirals of a damped oscillator, drawn by numpy; white and autoregressive noise by numpy, recordings low-passed by SciPy's
filtfilt, splrep and make_smoothing_spline. Each is a file that `kinemark measure` reads.

    measures_numpy.py [MOVEMENTS [SEED]]

MOVEMENTS of each colour, 80 of each family unless given. Needs Python with numpy and scipy. Finds the program in KINEMARK_PROGRAM;
prints rows "PASS|FAIL|NOTE | check | asked | measured"; exit status 1 when one fails.
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy
from scipy import interpolate, signal

ROOT = Path(__file__).resolve().parent.parent.parent
PROGRAM = os.environ.get("KINEMARK_PROGRAM", str(ROOT / "build/release/bin/kinemark"))
MEASURES = ("path_length", "mean_speed", "peak_speed")
FINE = 20  # instants of the truth for each frame


def minimum_jerk(random):
    """Three to six reaches to anywhere that overlap by a fifth or less, one after another."""
    count = random.integers(3, 7)
    lasts, steps = random.uniform(0.6, 1.2, count), random.normal(0.0, 0.15, (count, 3))
    begins = 0.3 + numpy.concatenate([[0.0], numpy.cumsum(lasts * random.uniform(0.8, 1.0, count))[:-1]])

    def at(t):
        u = numpy.clip((t[:, None] - begins) / lasts, 0.0, 1.0)
        return (u**3 * (10.0 - 15.0 * u + 6.0 * u**2)) @ steps

    return begins[-1] + lasts[-1] + 0.3, at


def lissajous(random):
    """Three sines of unrelated pace and phase."""
    pace, phase, size = random.uniform(0.4, 1.6, 3), random.uniform(0.0, 2.0 * numpy.pi, 3), random.uniform(0.03, 0.2, 3)
    return random.uniform(4.0, 8.0), lambda t: size * numpy.sin(2.0 * numpy.pi * pace * t[:, None] + phase)


def spiral(random):
    """A damped oscillator in a plane that turns slowly, carried along a line."""
    pace, damping, size = random.uniform(0.6, 1.5), random.uniform(0.05, 0.4), random.uniform(0.08, 0.25)
    axes, carried = numpy.linalg.qr(random.normal(size=(3, 3)))[0], random.normal(0.0, 0.03, 3)

    def at(t):
        angle = 2.0 * numpy.pi * pace * t
        plane = size * numpy.exp(-damping * t)[:, None] * numpy.stack([numpy.cos(angle), numpy.sin(angle), 0.0 * t], 1)
        return plane @ axes.T + t[:, None] * carried

    return random.uniform(4.0, 8.0), at


def white(x, sd, _rate, random):
    return x + sd * random.normal(size=x.shape)


def autoregressive(coefficient):
    def spoil(x, sd, _rate, random):
        fresh = random.normal(size=(len(x) + 1000, 3)) * numpy.sqrt(1.0 - coefficient**2)
        return x + sd * signal.lfilter([1.0], [1.0, -coefficient], fresh, axis=0)[1000:]

    return spoil


def butterworth(x, sd, rate, random):
    cut_off = random.uniform(6.0, 15.0)
    return signal.filtfilt(*signal.butter(2, cut_off, fs=rate), white(x, sd, rate, random), axis=0)


def splrep(x, sd, rate, random):
    """A cubic spline on as few knots as leave a mean square of the noise's variance."""
    t = numpy.arange(len(x)) / rate
    return numpy.stack([interpolate.splev(t, interpolate.splrep(t, y, s=len(t) * sd**2)) for y in white(x, sd, rate, random).T], 1)


def smoothing_spline(x, sd, rate, random):
    """A cubic smoothing spline with its -3 dB point at 6 to 15 Hz."""
    cut_off = random.uniform(6.0, 15.0)
    lam = (numpy.sqrt(2.0) - 1.0) / ((2.0 * numpy.pi * cut_off) ** 4) * rate
    t = numpy.arange(len(x)) / rate
    return numpy.stack([interpolate.make_smoothing_spline(t, y, lam=lam)(t) for y in white(x, sd, rate, random).T], 1)


# A spline on few knots leaves no noise between them: docs/stages/measures.md, limits.
FIGURE_ALONE = "splrep"
FAMILIES = {"minimum jerk": minimum_jerk, "Lissajous": lissajous, "spiral": spiral}
COLOURS = {"white": white, "AR 0.7": autoregressive(0.7), "AR 0.9": autoregressive(0.9), "filtfilt": butterworth,
           "splrep": splrep, "smoothing spline": smoothing_spline}


def write(path, x, rate):
    lines = ["frame,time_s,marker,x_m,y_m,z_m"]
    lines += [f"{i},{i / rate:.9f},A,{p[0]:.9f},{p[1]:.9f},{p[2]:.9f}" for i, p in enumerate(x)]
    path.write_text("\n".join(lines) + "\n")


def truth(at, start_s, end_s, rate):
    t = numpy.linspace(start_s, end_s, 1 + FINE * round((end_s - start_s) * rate))
    steps = numpy.linalg.norm(numpy.diff(at(t), axis=0), axis=1)
    length = 1e3 * steps.sum()
    return {"path_length": length, "mean_speed": length / (end_s - start_s), "peak_speed": 1e3 * steps.max() / (t[1] - t[0])}


def measure(folder, x, rate):
    write(folder / "made.csv", x, rate)
    done = subprocess.run([PROGRAM, "measure", "made.csv", "--measures", ",".join(MEASURES), "-o", "made.json"], cwd=folder,
                          capture_output=True, text=True, check=False)
    if done.returncode == 3 and "were made by the recorder" in done.stderr:
        return []  # interpolated between few knots, to the program: refused with these words
    if done.returncode != 0:
        raise SystemExit(f"kinemark measure: {done.stderr}")
    found = json.loads((folder / "made.json").read_text())["measures"]
    (folder / "made.json").unlink()
    return found


def one(folder, family, colour, random):
    """(measure, kind of interval, whether it holds the truth, relative error) of one recording."""
    lasts, at = FAMILIES[family](random)
    rate, sd = float(random.choice([100.0, 120.0, 200.0])), 1e-3 * numpy.exp(random.uniform(numpy.log(0.3), numpy.log(2.0)))
    t = numpy.arange(round(lasts * rate)) / rate
    for each in measure(folder, COLOURS[colour](at(t), sd, rate, random), rate):
        right = truth(at, each["start_s"], each["end_s"], rate)[each["measure"]]
        interval = each["interval"] or {"kind": "none"}
        low, high = (interval.get(end) for end in ("low", "high"))
        holds = (low is None or low <= right) and (high is None or right <= high)
        yield each["measure"], interval["kind"], holds, each["value"] / right - 1.0 if each["value"] is not None else numpy.nan


def share(rows):
    return 100.0 * sum(holds for _, _, holds, _ in rows) / max(len(rows), 1)


def report(good, what, asked, measured):
    print(f"{'PASS' if good else 'FAIL'} | measures_numpy, {what} | {asked} | {measured}", flush=True)
    return good


def judge(colour, rows, asked):
    print(f"NOTE | measures_numpy, {colour}: refused | - | {asked - len(rows) // len(MEASURES)} of {asked} recordings", flush=True)
    two = [row for row in rows if row[1] == "two-sided"]
    ended = [row for row in rows if row[1] in ("at most", "at least")]
    each = {name: [row for row in two if row[0] == name] for name in MEASURES}
    words = ", ".join(f"{name} {share(found):.1f}" for name, found in each.items())
    if colour == FIGURE_ALONE:
        wrong = sum(not row[2] for row in two + ended)
        print(f"NOTE | measures_numpy, {colour}: intervals | - | {wrong} of {len(two) + len(ended)} miss the truth, "
              f"{len(rows) - len(two) - len(ended)} are withdrawn", flush=True)
        return True
    errors = 100.0 * numpy.sqrt(numpy.nanmean(numpy.square([row[3] for row in rows])))
    good = report(91.0 <= share(two) <= 98.0, f"{colour}: intervals with two ends", "91 to 98 %",
                  f"{share(two):.1f} % of {len(two)} ({words}); error {errors:.2f} % RMS")
    for name, found in each.items():
        if len(found) >= 50:
            good &= report(share(found) >= 85.0, f"{colour}: {name}", "85 %", f"{share(found):.1f} % of {len(found)}")
    if ended:
        good &= report(share(ended) >= 97.0, f"{colour}: intervals with one end", "97 %", f"{share(ended):.1f} % of {len(ended)}")
    print(f"NOTE | measures_numpy, {colour}: without interval | - | {len(rows) - len(two) - len(ended)} of {len(rows)}", flush=True)
    return good


def main():
    movements = int(sys.argv[1]) if len(sys.argv) > 1 else 80
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else 1
    good = True
    with tempfile.TemporaryDirectory(prefix="kinemark-numpy-") as scratch:
        for number, colour in enumerate(COLOURS):
            rows = []
            for index, family in enumerate(FAMILIES):
                for k in range(movements):
                    random = numpy.random.default_rng([seed, number, index, k])
                    rows += one(Path(scratch), family, colour, random)
            good &= judge(colour, rows, movements * len(FAMILIES))
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
