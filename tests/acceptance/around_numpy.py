#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Averages around events (`measure --around`) beside NumPy, trials as spans, and what is said of files that do not fit.

    around_numpy.py SESSIONS SEED

Sessions are written by pynwb: a marker with gaps on an even clock that does not begin at 0, units of Poisson spikes, trials with two
condition columns, an LFP of int16 with a conversion; and by `simulate macaque --units`. Means, standard deviations, counts and Student's
intervals are computed again with NumPy and SciPy from the file as h5py and pynwb read it. Prints rows "PASS|FAIL | check | asked |
measured"; exit status 1 when one fails.
"""

import csv
import datetime
import sys
import tempfile
from pathlib import Path

import h5py
import numpy
import pynwb
import scipy.stats
from pynwb.ecephys import LFP, ElectricalSeries

from rows import exit_status, output, row, run

WINDOW, BIN, LEVEL = (-0.3, 0.5), 0.02, 0.95
BINS = 40


def session(path, random, offset=0.0, shuffled=False):
    """An NWB of another make; its markers, spikes and trials."""
    rate, frames, start = 120.0, 2400, 3.0
    time = start + numpy.arange(frames) / rate
    slow = sum(random.normal(size=3) * numpy.sin(2 * numpy.pi * f * time[:, None] + random.uniform(0, 6, 3)) for f in (0.3, 0.7, 1.3))
    x = 0.1 * slow + random.normal(scale=1e-4, size=(frames, 3))
    for first in random.integers(100, frames - 100, 6):
        x[first : first + random.integers(1, 30)] = numpy.nan
    nwb = pynwb.NWBFile("a session", f"around-{path.stem}", datetime.datetime(2024, 5, 6, 7, 8, 9, tzinfo=datetime.timezone.utc))
    position = pynwb.behavior.Position(name="Position")
    position.create_spatial_series(name="hand", data=x, starting_time=start, rate=rate, reference_frame="laboratory", unit="meters")
    nwb.create_processing_module("behavior", "movement").add(position)
    nwb.add_unit_column("quality", "by a person")
    spikes = []
    for u in range(5):
        times = numpy.sort(random.uniform(start - 0.5, time[-1] + 0.5, random.poisson(15 * 21))) + offset
        spikes.append(times)
        nwb.add_unit(spike_times=times[::-1] if shuffled and u == 2 else times, quality="good" if u % 2 else "mua")
    nwb.add_trial_column("target", "where to")
    nwb.add_trial_column("load", "kg")
    trials = [(start + 0.2 + 2.4 * i, start + 0.2 + 2.4 * i + 2.0, ["left", "right"][i % 2], 0.5 * i) for i in range(8)]
    for first, last, target, load in trials:
        nwb.add_trial(start_time=first, stop_time=last, target=target, load=load)
    device = nwb.create_device("array")
    group = nwb.create_electrode_group("g", "shank", "M1", device)
    for _ in range(3):
        nwb.add_electrode(location="M1", group=group)
    region = nwb.create_electrode_table_region([0, 2], "two of three")
    lfp = ElectricalSeries(name="lfp", data=random.integers(-3000, 3000, (10000, 2)).astype("int16"), electrodes=region, starting_time=start, rate=500.0, conversion=1e-7)
    nwb.create_processing_module("ecephys", "potentials").add(LFP(electrical_series=lfp))
    with pynwb.NWBHDF5IO(str(path), "w") as io:
        io.write(nwb)
    return time, x, spikes, trials


def mean_in_bins(time, value, events):
    """Events x bins: means over bins of the lines that join samples; NaN where a line has a missing end."""
    edges = WINDOW[0] + BIN * numpy.arange(BINS + 1)
    out = numpy.full((len(events), BINS), numpy.nan)
    for e, event in enumerate(events):
        for k in range(BINS):
            low, high = event + edges[k], event + edges[k + 1]
            inside = time[(time > low) & (time < high)]
            knots = numpy.concatenate([[low], inside, [high]])
            # Lines from the samples around, so that one missing end takes the whole line.
            left = numpy.clip(numpy.searchsorted(time, 0.5 * (knots[:-1] + knots[1:]), side="right") - 1, 0, len(time) - 2)
            slope = (value[left + 1] - value[left]) / (time[left + 1] - time[left])
            middle = value[left] + slope * (0.5 * (knots[:-1] + knots[1:]) - time[left])
            out[e, k] = numpy.sum(middle * numpy.diff(knots)) / (high - low)
    return out


def rates(spikes, events):
    edges = WINDOW[0] + BIN * numpy.arange(BINS + 1)
    return numpy.array([[numpy.count_nonzero((spikes >= e + a) & (spikes < e + b)) / BIN for a, b in zip(edges[:-1], edges[1:])] for e in events])


def statistics(values):
    """Columns of the table for events x bins."""
    count = numpy.sum(numpy.isfinite(values), axis=0)
    with numpy.errstate(invalid="ignore", divide="ignore"):
        mean = numpy.nansum(values, axis=0) / count
        sd = numpy.sqrt(numpy.nansum((values - mean) ** 2, axis=0) / (count - 1))
        half = scipy.stats.t.ppf(0.5 + LEVEL / 2, count - 1) * sd / numpy.sqrt(count)
    return {"mean": mean, "sd": sd, "low": mean - half, "high": mean + half, "count": count, "missing": len(values) - count}


def table(path, *words):
    output("measure", path, "--window", f"{WINDOW[0]},{WINDOW[1]}", "--bin", BIN, "-o", path.with_suffix(".csv"), "--force", *words)
    with open(path.with_suffix(".csv"), newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    out = {}
    for one in rows:
        out.setdefault((one["events"], one["subject"], one["curve"]), []).append(one)
    return out


def worst(rows, expected, factor=1.0):
    """The largest difference of a curve's columns from NumPy's, in the table's unit; infinite where one is missing."""
    most = 0.0
    for name, values in expected.items():
        scale = 1.0 if name in ("count", "missing") else factor
        for got, value in zip((r[name] for r in rows), scale * values, strict=True):
            if (got == "") != (not numpy.isfinite(value)):
                return numpy.inf
            if got != "":
                most = max(most, abs(float(got) - value))
    return most


def within(events, span):
    events = numpy.asarray(events)
    return events[(events + WINDOW[0] >= span[0] - 1e-9) & (events + WINDOW[1] <= span[1] + 1e-9)]


def compare(folder, sessions, random):
    around_spikes = around_trials = 0.0
    outside = bins = 0
    for s in range(sessions):
        path = folder / f"session{s}.nwb"
        time, x, spikes, trials = session(path, random)
        span = (time[0], time[-1])
        got = table(path, "--around", "units", "--doubtful", "keep")
        for u, times in enumerate(spikes):
            used = within(times, span)
            for k, axis in enumerate("xyz"):
                rows = got[f"unit {u}", "hand", axis]
                around_spikes = max(around_spikes, worst(rows, statistics(mean_in_bins(time, x[:, k], used)), 1e3))
                outside += int(rows[0]["outside"]) != len(times) - len(used) or int(rows[0]["used"]) != len(used)
                bins += len(rows)
        for words, chosen in (("trials", trials), ("trials:target", [t for t in trials if t[2] == "left"])):
            got = table(path, "--around", words)
            name = "trials" if words == "trials" else "trials target=left"
            for u, times in enumerate(spikes):
                rows = got[name, str(u), "rate"]
                around_trials = max(around_trials, worst(rows, statistics(rates(times, within([t[0] for t in chosen], span)))))
                bins += len(rows)
    row(around_spikes <= 1e-9, f"positions around spikes, {sessions} sessions of pynwb", "NumPy within 1e-9 mm", f"{around_spikes:.1e} mm")
    row(around_trials <= 1e-9, "rates around trial starts, all and by condition", "NumPy within 1e-9 Hz", f"{around_trials:.1e} Hz, {bins} bins in all")
    row(outside == 0, "events whose window leaves the recording", "counted as by NumPy", f"{outside} counts differ")


def movements(folder, seed):
    """Our own monkey: rates around the starts that `--write-events` writes; speeds of `clean --derivatives` around spikes."""
    output("simulate", "macaque", "-o", folder / "monkey", "--duration", 30, "--units", 6, "--trials", 4, "--lfp", "--all-seen", "--seed", seed)
    path = folder / "monkey" / "session.nwb"
    with pynwb.NWBHDF5IO(str(path), "r") as io:
        units = io.read().units
        spikes = [numpy.array(units["spike_times"][u]) for u in range(6)]
    time = numpy.arange(1800) / 60.0
    output("measure", path, "--select", "f7", "--trials", "none", "--measures", "path_length", "--write-events", folder / "events.csv", "--events", "movement", "-o", folder / "x.csv")
    with open(folder / "events.csv", newline="", encoding="utf-8") as file:
        starts = [float(r["time_s"]) for r in csv.DictReader(file) if r["label"] == "Movement Start"]
    got = table(path, "--around", "movement", "--select", "f7")
    # Times of the table of events have nine digits: a spike that near an edge may fall to the other side.
    differ = [worst(got["f7 Movement Start", str(u), "rate"], statistics(rates(spikes[u], within(starts, (0.0, time[-1]))))) for u in range(6)]
    row(len(starts) >= 5 and max(differ) <= 1e-9, "rates around movement starts", "NumPy within 1e-9 Hz, by the starts that --write-events writes", f"{len(starts)} starts, {max(differ):.1e} Hz")
    output("clean", path, folder / "clean.nwb", "--derivatives", "--gaps", "none", "--select", "f7")
    with h5py.File(folder / "clean.nwb") as file:
        speed = numpy.linalg.norm(file["processing/behavior/Velocity/f7/data"][:], axis=1)
    got = table(path, "--around", "unit:2", "--select", "f7")
    differ = worst(got["unit 2", "f7", "speed"], statistics(mean_in_bins(time, speed, within(spikes[2], (0.0, time[-1])))), 1e3)
    row(differ <= 1e-9, "speeds around spikes", "those of clean --derivatives by NumPy within 1e-9 mm/s", f"{differ:.1e} mm/s")


def motion(folder, random):
    """Angles of a .mot beside spikes of an .nwb on another clock."""
    path = folder / "q.mot"
    session_path = folder / "other.nwb"
    time, _, spikes, _ = session(session_path, random, offset=100.0)
    angle = 20 * numpy.sin(time) + random.normal(size=time.size)
    lines = "".join(f"{t!r}\t{a!r}\n" for t, a in zip(time.tolist(), angle.tolist(), strict=True))
    path.write_text(f"q\nversion=1\nnRows={time.size}\nnColumns=2\ninDegrees=yes\nendheader\ntime\telbow\n{lines}", encoding="utf-8")
    two = run("measure", path, "--spikes", session_path, "--around", "units")
    row(two.returncode == 3 and "lie outside the recording" in two.stderr, "two clocks", "one sentence, exit status 3", f"{two.returncode}: {two.stderr.strip()[:60]}")
    got = table(path, "--spikes", session_path, "--around", "units", "--clock-offset", -100)
    span = (time[0], time[-1])
    differ = max(worst(got[f"unit {u}", "elbow", "angle"], statistics(mean_in_bins(time, angle, within(spikes[u] - 100.0, span)))) for u in range(5))
    row(differ <= 1e-9, "angles of a .mot around spikes of an .nwb, --clock-offset", "NumPy within 1e-9 deg", f"{differ:.1e} deg")


def spans(folder, random):
    path = folder / "spans.nwb"
    _, _, _, trials = session(path, random)
    output("measure", path, "--refits", 0, "--measures", "path_length", "-o", folder / "spans.csv")
    with open(folder / "spans.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    same = [r["region"] == f"trial {i + 1}" and r["target"] == t[2] and float(r["load"]) == t[3] and abs(float(r["start_s"]) - t[0]) < 0.5 / 120 + 1e-9 for i, (r, t) in enumerate(zip(rows, trials, strict=True))]
    row(len(rows) == 8 and all(same), "trials of the file are spans with their conditions", "8 rows", f"{len(rows)} rows, {sum(same)} as in the file")


def bad(folder, random):
    path = folder / "shuffled.nwb"
    session(path, random, shuffled=True)
    done = run("measure", path, "--around", "units")
    row(done.returncode == 3 and "must be numbers that ascend" in done.stderr, "spikes that do not ascend", "one sentence, exit status 3", f"{done.returncode}: {done.stderr.strip()[-70:]}")
    good = folder / "good.nwb"
    session(good, random)
    for words, status, text in ((("--around", "unit:9"), 2, "there is no unit '9'"), (("--around", "trails"), 2, "nearest: trials"), (("--around", "trials:tagret"), 2, "nearest: target")):
        done = run("measure", good, *words, "-o", folder / "none.csv")
        row(done.returncode == status and text in done.stderr and not (folder / "none.csv").exists(), f"{' '.join(words)}", f"one sentence, exit status {status}, nothing written", f"{done.returncode}: {done.stderr.strip()[-60:]}")


def main():
    sessions, seed = int(sys.argv[1]), int(sys.argv[2])
    random = numpy.random.default_rng(seed)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        compare(folder, sessions, random)
        movements(folder, seed % 1000)
        motion(folder, random)
        spans(folder, random)
        bad(folder, random)
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
