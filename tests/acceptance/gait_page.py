#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""The gait report beside what it should show: the pixels of its curves back in degrees beside the cycles that
--write-cycles writes, means, deviations and scores computed again, on real walking trials and a simulated one.

Nothing of kinemark is used but the program: pictures are read as SVG, by the numbers at their axes."""

import csv
import json
import math
import os
import re
import struct
import sys
from pathlib import Path

import rows

DATA = Path(os.environ["KINEMARK_TEST_DATA"]) if "KINEMARK_TEST_DATA" in os.environ else None
SCRATCH = Path(os.environ.get("KINEMARK_SCRATCH", "."))
PIXEL_TOLERANCE = 0.02  # coordinates are written with two digits
COLOURS = {"Left": "#d55e00", "Right": "#0072b2"}
NINE = (
    "pelvis_tilt",
    "pelvis_obliquity",
    "pelvis_rotation",
    "hip_flexion",
    "hip_adduction",
    "hip_rotation",
    "knee_flexion",
    "ankle_dorsiflexion",
    "foot_progression",
)


def row(passed, what, asked, measured):
    rows.row(passed, f"gait_page, {what}", asked, measured)


def run(*arguments):
    done = rows.run(*arguments)
    if done.returncode != 0:
        print(done.stderr)
    return done


def table(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def number(text):
    return float(text) if text else math.nan


def linear(pairs):
    """Value of a pixel from two ticks of an axis."""
    (p0, v0), (p1, v1) = min(pairs), max(pairs)
    return lambda p: v0 + (v1 - v0) * (p - p0) / (p1 - p0), abs((v1 - v0) / (p1 - p0))


def panels_of(svg):
    """Title and drawing of each panel of a grid."""
    parts = re.split(r'<text x="[\d.]+" y="[\d.]+" font-size="12" font-weight="bold"[^>]*>([^<]*)</text>', svg)
    return list(zip(parts[1::2], parts[2::2]))


def ticks_of(drawing):
    found = {"middle": [], "end": []}
    for x, y, anchor, text in re.findall(
        r'<text x="([\d.]+)" y="([\d.]+)" font-size="10" text-anchor="(middle|end)"[^>]*>([−\d.e+]+)</text>', drawing
    ):
        value = float(text.replace("−", "-"))
        found[anchor].append((float(x) if anchor == "middle" else float(y) - 0.37 * 10.0, value))
    return found["middle"], found["end"]


def means_of(drawing, colour):
    """Points of the thick line of a colour, pixels."""
    points = []
    for path in re.findall(rf'stroke="{colour}" stroke-width="2"(?: stroke-dasharray="6 4")? d="([^"]+)"', drawing):
        points += [tuple(map(float, pair)) for pair in re.findall(r"[ML]([\d.-]+) ([\d.-]+)", path)]
    return points


def drawn_beside_numbers(svg, rows):
    """Largest difference, in pixels, of each mean curve from its numbers, and how many curves there are."""
    worst, curves, points = 0.0, 0, 0
    means = {}
    for r in rows:
        if r["cycle"] == "mean":
            means.setdefault((r["quantity"], r["context"]), []).append((number(r["percent"]), number(r["value"])))
    by_title = {}
    for r in rows:
        by_title.setdefault(r["quantity"], None)
    titles = {q: q for q in by_title}
    for title, drawing in panels_of(svg):
        key = re.sub(r" \(.*", "", title).lower().replace("pelvic", "pelvis").replace(" ", "_")
        if key not in titles:
            continue
        across, up = ticks_of(drawing)
        if len(across) < 2 or len(up) < 2:
            continue
        to_percent, per_x = linear(across)
        to_value, per_y = linear(up)
        for side, colour in COLOURS.items():
            pixels = means_of(drawing, colour)
            wanted = [(p, v) for p, v in means.get((key, side), []) if math.isfinite(v)]
            if not wanted and not pixels:
                continue
            curves += 1
            if len(pixels) != len(wanted):
                return math.inf, curves, points
            points += len(pixels)
            for (x, y), (p, v) in zip(pixels, wanted):
                worst = max(worst, abs(to_percent(x) - p) / per_x, abs(to_value(y) - v) / per_y)
    return worst, curves, points


def same_as_written(drawn, written):
    key = lambda r: (r["curve"], r["context"], r["cycle"], number(r["percent"]))
    numbers = {key(r): r for r in written}
    worst, missing, compared = 0.0, 0, 0
    for r in drawn:
        if r["unit"] != "deg":
            continue
        other = numbers.get(key(r))
        if other is None:
            missing += 1
            continue
        a, b = number(r["value"]), number(other["value"])
        if math.isnan(a) != math.isnan(b):
            missing += 1
        elif math.isfinite(a):
            worst, compared = max(worst, abs(a - b)), compared + 1
    return worst, missing, compared


def statistics_again(rows):
    """Largest difference of means and deviations from those of the cycles in the same table."""
    cycles = {}
    for r in rows:
        if r["cycle"] != "mean" and math.isfinite(number(r["value"])):
            cycles.setdefault((r["curve"], r["context"], r["percent"]), []).append((number(r["value"]), number(r["own_sd"])))
    worst = 0.0
    for r in rows:
        if r["cycle"] != "mean":
            continue
        found = cycles.get((r["curve"], r["context"], r["percent"]), [])
        if len(found) != int(r["cycles"]):
            return math.inf
        if not found:
            continue
        values = [v for v, _ in found]
        scale = max(1.0, max(map(abs, values)))
        mean = sum(values) / len(values)
        worst = max(worst, abs(mean - number(r["value"])) / scale)
        if len(values) > 1:
            sd = math.sqrt(sum((v - mean) ** 2 for v in values) / (len(values) - 1))
            worst = max(worst, abs(sd - number(r["sd"])) / scale)
        own = [s for _, s in found if math.isfinite(s)]
        if own:
            worst = max(worst, abs(math.sqrt(sum(s * s for s in own) / len(own)) - number(r["own_sd"])) / scale)
    return worst


def shown(page):
    """What a page shows."""
    data = re.search(r'id="kinemark-data">(.*?)</script>', page.read_text(encoding="utf-8"), re.DOTALL)[1]
    return json.loads(data)["result"]


def png_size(path):
    head = path.read_bytes()[:24]
    return struct.unpack(">II", head[16:24]) if head[:8] == b"\x89PNG\r\n\x1a\n" else (0, 0)


def check_drawing(name, arguments, norm=None):
    """Draw, then hold the pictures against the numbers."""
    folder, page, cycles = SCRATCH / name, SCRATCH / f"{name}.html", SCRATCH / f"{name}.csv"
    extra = ("--norm", norm) if norm else ()
    done = run(*arguments, *extra, "--refits", 0, "--figures", folder, "--report", page, "--write-cycles", cycles, "--force")
    row(done.returncode == 0, f"{name}, drawn", "exit status 0", f"exit status {done.returncode}")
    if done.returncode != 0:
        return None
    rows, svg = table(folder / "gait_curves.csv"), (folder / "gait_kinematics.svg").read_text(encoding="utf-8")
    worst, missing, compared = same_as_written(rows, table(cycles))
    row(worst < 1e-6 and missing == 0 and compared > 0, f"{name}, numbers beside --write-cycles", "1e-6 deg, none missing", f"{worst:.1g} deg of {compared}, {missing} missing")
    worst, curves, points = drawn_beside_numbers(svg, rows)
    row(worst <= PIXEL_TOLERANCE and curves > 0, f"{name}, pixels of the means beside the numbers", f"{PIXEL_TOLERANCE} pixels", f"{worst:.3f} pixels of {points} points, {curves} curves")
    worst = statistics_again(rows)
    row(worst < 1e-6, f"{name}, means and deviations computed again", "1e-6", f"{worst:.1g}")
    figures = {figure["name"] for figure in shown(page)["figures"]}
    pictures = {p.stem for p in folder.glob("*.svg")}
    small = [p.name for p in folder.glob("*.png") if min(png_size(p)) < 1000]
    row(figures == pictures and not small, f"{name}, every figure of the page as SVG, and as PNG of 1000 dots", "all", f"{len(figures)} of {len(pictures)}, {len(small)} too small")
    return rows


def check_scores(name, arguments, rows):
    """A norm that is this walk's mean shifted by known amounts: the scores are known."""
    shift = {key: 1.0 + i for i, key in enumerate(NINE)}
    norm = SCRATCH / f"{name}_norm.csv"
    with open(norm, "w", encoding="utf-8") as file:
        file.write("curve,percent,mean,sd,unit\n")
        for r in rows:
            if r["cycle"] == "mean" and r["quantity"] in shift:
                file.write(f"{r['curve']},{r['percent']},{number(r['value']) + shift[r['quantity']]:.9f},5,deg\n")
    page = SCRATCH / f"{name}_scores.html"
    done = run(*arguments, "--refits", 0, "--norm", norm, "--report", page, "--force")
    if done.returncode != 0:
        row(False, f"{name}, Gait Profile Score", "computed", "not drawn")
        return
    squares = [shift[k] ** 2 for k in NINE] + [shift[k] ** 2 for k in NINE[3:]]
    expected = math.sqrt(sum(squares) / 15)
    value = shown(page)["deviation"]["both_deg"]
    value = math.nan if value is None else value
    row(abs(value - expected) <= 1e-6, f"{name}, Gait Profile Score beside known shifts", f"{expected:.9g} deg", f"{value:.9g} deg")


def check_pairs(folder, rows):
    means = {(r["quantity"], r["context"], r["percent"]): number(r["value"]) for r in rows if r["cycle"] == "mean"}
    worst = 0.0
    pairs = table(folder / "gait_pairs.csv")
    for r in pairs:
        for axis in "xy":
            a, b = number(r[f"{axis}_mean"]), means[r[axis], r["context"], r["percent"]]
            if math.isfinite(a) or math.isfinite(b):
                worst = max(worst, abs(a - b))
    row(worst < 1e-6 and len(pairs) > 0, "angle against angle, means beside those of the curves", "1e-6 deg", f"{worst:.1g} deg of {len(pairs)}")


def main():
    if DATA is None or not (DATA / "btk-others").is_dir():
        print("SKIP | gait_page | the real recordings | NO REAL DATA: set KINEMARK_TEST_DATA")
        return 0
    btk = DATA / "btk-others"
    trials = {
        "PiG_Motion3": ("analyze", btk / "PiG_Motion3_FF.c3d", "--segments", "pig", "--static", btk / "PiG_Calibration3_FF.c3d"),
        "PiG_Motion3_own": ("analyze", btk / "PiG_Motion3_FF.c3d", "--measures", "gait"),
    }
    for name, arguments in trials.items():
        rows = check_drawing(name, arguments)
        if rows is None:
            continue
        check_scores(name, arguments, rows)
        check_pairs(SCRATCH / name, rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
