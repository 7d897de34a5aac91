#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""What smoothing hands on: recording -> clean or reconstruct -> C3D, CSV, NWB, MAT -> read back by the program.

    hand_on.py [seed]                   filters and samples from before, equal to the format's digits
    hand_on.py measures [seed] [count]  intervals of analyze after clean and reconstruct beside those of the raw recording

Finds the program in KINEMARK_PROGRAM; prints rows "PASS|FAIL | check | asked | measured"; exit status 1 when one fails.
"""

import csv
import json
import math
import os
import random
import sys
import tempfile
from pathlib import Path

import rows
from rows import exit_status, row

RATE_HZ, FRAMES = 100, 500
MARKERS = ["hand", "Subject:elbow", "rest/ing"]
RAW = ("unfiltered_x_m", "unfiltered_y_m", "unfiltered_z_m")
FILTER = ("filter", "filter_order", "filter_cutoff_hz", "filter_noise_m")
FORMATS = ("c3d", "csv", "nwb", "mat")
WITHIN = 0.15  # of the raw recording's interval


def run(*words):
    done = rows.run(*words, good=(0, 1))
    return done.stdout + done.stderr


def place(m, t):
    """A signing hand, an elbow on a smaller way, and a marker that rests, sways and moves once; m."""
    if m == 0:
        return [0.20 * math.sin(7 * t), 1.2 + 0.12 * math.cos(7 * t), 0.05 * math.sin(14 * t)]
    if m == 1:
        return [0.3 + 0.06 * math.sin(5 * t), 1.0 + 0.04 * math.sin(5 * t + 1), 0.02 * math.sin(3 * t)]
    s = min(1, max(0, (t - 1.5) / 1.2))
    return [0.4 + 0.3 * (10 * s**3 - 15 * s**4 + 6 * s**5), 0.9, 0.1 + 0.001 * math.sin(2 * t)]


def is_gap(m, frame):
    return m == 1 and 200 <= frame < 208


def write_recording(path, seed):
    noise = random.Random(seed)
    with path.open("w", encoding="utf-8", newline="") as file:
        out = csv.writer(file)
        out.writerow(["frame", "time_s", "marker", "x_m", "y_m", "z_m"])
        for frame in range(FRAMES):
            for m, name in enumerate(MARKERS):
                x = [v + noise.gauss(0, 4e-4) for v in place(m, frame / RATE_HZ)]
                out.writerow([frame + 1, frame / RATE_HZ, name, *(["", "", ""] if is_gap(m, frame) else x)])


def read_csv(path):
    with path.open(encoding="utf-8", newline="") as file:
        return {(int(r["frame"]), r["marker"]): r for r in csv.DictReader(file)}


def as_csv(path, *options):
    target = path.with_name(f"{path.stem}_{path.suffix[1:]}_as.csv")
    run("convert", path, target, "--quiet", "--force", *options)
    return read_csv(target)


def triple(sample, columns):
    return [float(sample[c]) if sample[c] else math.nan for c in columns]


def worst_of(got, wanted, turned=lambda x: x):
    """Largest distance between samples from before the filter and those that were measured; infinite where one lacks."""
    worst = 0.0
    for key, sample in wanted.items():
        raw, was = triple(got[key], RAW), turned(triple(sample, ("x_m", "y_m", "z_m")))
        for a, b in zip(raw, was):
            if math.isnan(a) != math.isnan(b):
                return math.inf
            worst = max(worst, 0.0 if math.isnan(a) else abs(a - b))
    return worst


def filters_of(table):
    return {marker: tuple(sample[c] for c in FILTER) for (_, marker), sample in table.items()}


def check_clean(folder, seed):
    write_recording(folder / "source.csv", seed)
    run("convert", folder / "source.csv", folder / "raw.c3d", "--quiet")
    raw = as_csv(folder / "raw.c3d")  # what a C3D file of single precision holds
    account = None
    for ending in FORMATS:
        cleaned = folder / f"clean.{ending}"
        run("clean", folder / "raw.c3d", cleaned, "--gaps", "cubic", "--quiet")
        (folder / "clean_report.json").unlink()
        table = as_csv(cleaned)
        worst = worst_of(table, raw)
        row(worst == 0.0, f"clean to {ending}: samples from before the filter", "to the last bit of the recording", f"{worst:g} m off")
        stated = filters_of(table)
        account = account or stated
        row(stated == account and all(name == "kalman" for name, *_ in stated.values()), f"clean to {ending}: filter of each marker",
            "kalman, order, cut-off and noise as in the other formats", f"{stated['hand']}")
        noises = [abs(float(n) / 4e-4 - 1) for *_, n in stated.values()]
        row(max(noises) < 0.15, f"clean to {ending}: noise before it", "0.4 mm within 15 %", f"{100 * max(noises):.1f} % off")
        blank = sum(s["state"] == "measured" and s["method"] != "smoothed by kalman" for s in table.values())
        row(blank == 0, f"clean to {ending}: samples that are measured and do not say that they were smoothed", "0", f"{blank}")
        filled = [table[key] for key, s in raw.items() if not s["x_m"]]
        wrong = sum(s["state"] not in ("interpolated", "model_filled") or s[RAW[0]] != "" for s in filled)
        row(wrong == 0 and len(filled) == 8, f"clean to {ending}: filled samples have none from before", "8", f"{len(filled) - wrong}")
        said = run("info", cleaned) + run("validate", cleaned)
        row(said.count("smoothed by kalman") == 2 and said.count("the samples from before are kept") == 2,
            f"clean to {ending}: info and validate say so", "2", f"{said.count('smoothed by kalman')}")
    # On from a cleaned file: turned, cut, cleaned again.
    turned = as_csv(folder / "clean.c3d", "--rotate", "x -90")
    worst = worst_of(turned, raw, lambda x: [x[0], x[2], -x[1]])
    row(worst < 1e-9, "convert --rotate turns samples from before the filter", "to 1e-9 m", f"{worst:.1e} m")
    run("clean", folder / "clean.nwb", folder / "again.csv", "--gaps", "cubic", "--quiet")
    first, again = as_csv(folder / "clean.nwb"), read_csv(folder / "again.csv")
    apart = max(abs(a - b) for key in first for a, b in zip(triple(first[key], ("x_m", "y_m", "z_m")), triple(again[key], ("x_m", "y_m", "z_m"))))
    row(apart == 0.0, "clean of a cleaned recording begins from the samples from before", "the same bits", f"{apart:g} m apart")
    run("clean", folder / "raw.c3d", folder / "without.c3d", "--without-unfiltered", "--quiet")
    said = run("clean", folder / "without.c3d", folder / "twice.csv")
    row("smoothed twice" in said, "clean of one without them says that it smooths twice", "said", "said" if "smoothed twice" in said else said[:80])
    twice = read_csv(folder / "twice.csv")
    row("unfiltered_x_m" not in next(iter(twice.values())) and filters_of(twice)["hand"][0] == "kalman, kalman",
        "and takes no smoothed sample for one from before", "none; both filters named", f"{filters_of(twice)['hand']}")
    said = run("clean", folder / "raw.c3d", folder / "clean.trc")
    row("cannot be stored in a .trc file" in said and "filters" in said, "clean to trc says what is lost", "said", "said" if "filters" in said else "not said")
    said = run("info", folder / "raw.c3d") + run("validate", folder / "raw.c3d")
    row("smoothed" not in said, "info and validate say nothing of a raw recording", "not said", "said" if "smoothed" in said else "not said")


def reconstruct(folder, seed):
    lab = folder / f"lab{seed}"
    run("simulate", "rig", "sign", "-o", lab, "--seed", seed, "--quiet")
    for name, method in (("frames.csv", "frames"), ("smooth.csv", "smoother"), ("smooth.c3d", "smoother"), ("smooth.nwb", "smoother")):
        run("reconstruct", lab / "recording.mcap", "--rig", lab / "rig_true.toml", "--method", method, "-o", lab / name, "--quiet")
    return lab


def check_reconstruct(folder, seed):
    lab = reconstruct(folder, seed)
    frames = read_csv(lab / "frames.csv")
    for ending in ("csv", "c3d", "nwb"):
        table = as_csv(lab / f"smooth.{ending}")
        both = [k for k in table if table[k][RAW[0]] and k in frames and frames[k]["x_m"]]
        # The hand moves at up to some m/s, and light is milliseconds off the frame.
        apart = max(math.dist(triple(table[k], RAW), triple(frames[k], ("x_m", "y_m", "z_m"))) for k in both)
        row(len(both) > 0.9 * len(frames) and 0 < apart < 0.05, f"reconstruct to {ending}: frames from before the smoother",
            "> 90 %, moved by less than 50 mm to their frame", f"{100 * len(both) / len(frames):.0f} %, {1e3 * apart:.1f} mm")
        stated = filters_of(table)
        row(all(t[0] == "kalman" and float(t[2]) > 0 and 1e-6 < float(t[3]) < 0.05 for t in stated.values()),
            f"reconstruct to {ending}: filter and noise of each LED", "kalman, cut-off, noise", f"{next(iter(stated.values()))}")
        blank = sum(s["state"] == "measured" and not s["method"].startswith("smoothed by") for s in table.values())
        row(blank == 0, f"reconstruct to {ending}: measured samples without a word of smoothing", "0", f"{blank}")


def at_frames(lab):
    """The raw frames at the instants of their frames, as analyze counts time: LEDs light up to 4 ms later, and a stretch of
    other instants has another path. Moved by the first and second differences of the smoothed path."""
    frames, smooth = read_csv(lab / "frames.csv"), read_csv(lab / "smooth.csv")
    place = {key: triple(sample, ("x_m", "y_m", "z_m")) for key, sample in smooth.items() if sample["x_m"]}
    rate_hz = 1 / (float(frames[2, next(iter(frames))[1]]["time_s"]) - float(frames[1, next(iter(frames))[1]]["time_s"]))
    with (lab / "at_frames.csv").open("w", encoding="utf-8", newline="") as file:
        out = csv.writer(file)
        out.writerow(["frame", "time_s", "marker", "x_m", "y_m", "z_m"])
        for (frame, marker), sample in frames.items():
            x = triple(sample, ("x_m", "y_m", "z_m"))
            later = rate_hz * float(sample["offset_s"] or 0)  # frames
            # A parabola through three frames, about this one where it has neighbours.
            for middle in (frame, frame + 1, frame - 1):
                near = [place.get((middle + step, marker)) for step in (-1, 0, 1)]
                if all(near) and not math.isnan(x[0]):
                    x = [v - later * ((c - a) / 2 + (frame - middle) * (c - 2 * b + a)) - later**2 * (c - 2 * b + a) / 2
                         for v, a, b, c in zip(x, *near)]
                    break
            out.writerow([frame, sample["time_s"], marker, *(["", "", ""] if math.isnan(x[0]) else x)])
    return lab / "at_frames.csv"


def measured(file):
    found = json.loads(run("analyze", file, "--json", "--quiet"))
    return {(m["subject"], m["measure"], m.get("region"), m.get("cycle")): m["interval"] for m in found["measures"]
            if (m.get("interval") or {}).get("kind") == "two-sided"}


def compare_measures(before, after):
    """Ends of intervals after, off those before, as shares of the intervals' lengths; lost intervals."""
    off, lost = [], 0
    for key, was in before.items():
        length = was["high"] - was["low"]
        if not length > 0:
            continue  # what has no error has no interval that could change
        now = after.get(key)
        if now is None:
            lost += 1
            continue
        off.append(max(abs(now["low"] - was["low"]), abs(now["high"] - was["high"])) / length)
    return sorted(off), lost


def check_measures(folder, seed, count):
    for source, endings in (("clean", FORMATS), ("reconstruct", ("csv", "c3d", "nwb"))):
        for ending in endings:
            off, lost, all_of_them = [], 0, 0
            for one in range(seed, seed + count):
                here = folder / f"{source}_{ending}_{one}"
                here.mkdir()
                if source == "clean":
                    write_recording(here / "source.csv", one)
                    run("convert", here / "source.csv", here / "raw.c3d", "--quiet")
                    run("clean", here / "raw.c3d", here / f"clean.{ending}", "--quiet")
                    before, after = measured(here / "raw.c3d"), measured(here / f"clean.{ending}")
                else:
                    lab = reconstruct(here, one)
                    before, after = measured(at_frames(lab)), measured(lab / f"smooth.{ending}")
                some, gone = compare_measures(before, after)
                off += some
                lost += gone
                all_of_them += len(some) + gone
            off.sort()
            share = sum(v <= WITHIN for v in off) / max(1, all_of_them)
            worst = off[int(0.95 * (len(off) - 1))] if off else math.inf
            row(all_of_them > 0 and share >= 0.95, f"recording -> {source} -> {ending} -> measures, {count} recordings, {all_of_them} intervals",
                "ends within 15 % of the raw interval in 95 %", f"{100 * share:.0f} %; 95 % of the ends within {100 * worst:.0f} %; {lost} lost")


def main():
    words = sys.argv[1:]
    with tempfile.TemporaryDirectory(dir=os.environ.get("KINEMARK_SCRATCH")) as name:
        if words[:1] == ["measures"]:
            seed, count = (int(a) for a in (words[1:] + ["1", "4"][len(words) - 1:])[:2])
            check_measures(Path(name), seed, count)
        else:
            seed = int(words[0]) if words else 1
            check_clean(Path(name), seed)
            check_reconstruct(Path(name), seed)
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
