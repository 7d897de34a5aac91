#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Five recordings, each as 80 texts that differ in separator, decimal sign, header, encoding, quotes and blank columns:
read to the same bits as the plain text of its kind, or refused.

Nothing of kinemark is used but the program."""

import itertools
import os
import random
from pathlib import Path

from rows import run

SCRATCH = Path(os.environ.get("KINEMARK_SCRATCH", ".")) / "dialects"
SEEDS = (11, 12, 13, 14, 15)
OF_EACH = 80
MARKERS, FRAMES = 12, 60


def recording(seed):
    """Names, times and positions (mm as text, empty where not seen) of a simulated walk."""
    folder = SCRATCH / f"s{seed}"
    run("simulate", "subject", "-o", folder, "--duration", 0.6, "--rate", 100, "--noise", 0.5, "--dropout-random", 0.03, "--seed", seed, "--force")
    lines = (folder / "markers.trc").read_text().splitlines()
    names = [name for name in lines[3].split("\t")[2:] if name][:MARKERS]
    rows = [line.split("\t") for line in lines[5:] if line.strip()][:FRAMES]
    cells = [(row[1], [f"{float(v):.5f}" if v else "" for v in row[2 : 2 + 3 * len(names)]]) for row in rows]
    return names, cells


def trc(names, cells):
    head = [
        ["PathFileType", "4", "(X/Y/Z)", "walk.trc"],
        ["DataRate", "CameraRate", "NumFrames", "NumMarkers", "Units", "OrigDataRate", "OrigDataStartFrame", "OrigNumFrames"],
        ["100.00", "100.00", str(len(cells)), str(len(names)), "mm", "100.00", "1", str(len(cells))],
        ["Frame#", "Time", *itertools.chain.from_iterable([name, "", ""] for name in names)],
        ["", "", *(f"{axis}{i + 1}" for i in range(len(names)) for axis in "XYZ")],
    ]
    return head + [[str(i + 1), time, *values] for i, (time, values) in enumerate(cells)]


def coordinates(names, cells):
    return [["Time", *(f"{name}_{axis} (mm)" for name in names for axis in "XYZ")]] + [[time, *values] for time, values in cells]


def vicon(names, cells):
    head = [["Trajectories"], ["100"], ["", "", *itertools.chain.from_iterable([name, "", ""] for name in names)],
            ["Frame", "Sub Frame", *"XYZ" * len(names)], ["", "", *["mm"] * (3 * len(names))]]  # fmt: skip
    return head + [[str(i + 1), "0", *values] for i, (_, values) in enumerate(cells)]


def table(names, cells):
    head = [["markers"], ["version=3"], ["Units=mm"], ["endheader"], ["time", *(f"{name}_t{axis}" for name in names for axis in "xyz")]]
    return head + [[time, *(value or "nan" for value in values)] for time, values in cells]


KINDS = {".trc": (trc, "\t"), ".csv": (coordinates, ","), ".vicon.csv": (vicon, ","), ".sto": (table, "\t")}


def is_number(cell):
    try:
        float(cell)
    except ValueError:
        return False
    return True


def written(rows, ending, separator, decimal, line_end, blank_columns, quoted, first_line):
    """The text; None where nobody writes it so: a decimal comma between commas without quotes, a gap between blanks."""
    out = []
    for number, row in enumerate(rows):
        cells = [cell.replace(".", decimal) if is_number(cell) else cell for cell in row]
        if quoted:
            cells = [f'"{cell}"' if cell and len(row) > 1 else cell for cell in cells]
        elif separator == decimal:
            return None
        between = separator
        if number == 0 and ending == ".trc" and first_line:
            if quoted:
                return None  # quotes come from spreadsheets, which know one separator
            out.append(first_line.join(cells[:2]) + separator + separator.join(cells[2:]))
            continue
        if separator == " " and (len(row) > 3 and ("" in cells and number >= 5)):
            return None
        tail = between * blank_columns if len(row) > 3 and separator != " " else ""
        out.append((between.join(cell for cell in cells if cell) if separator == " " else between.join(cells)) + tail)
    return line_end.join(out) + line_end


def main():
    SCRATCH.mkdir(parents=True, exist_ok=True)
    chance = random.Random(2026)
    same, refused, wrong, made = 0, 0, [], 0
    for seed in SEEDS:
        names, cells = recording(seed)
        full = [(time, [value or "1.00000" for value in values]) for time, values in cells]
        plain = {}
        for ending, (kind, usual) in KINDS.items():
            for holes, part in ((True, cells), (False, full)):
                path = SCRATCH / f"plain{ending}"
                path.write_text(written(kind(names, part), ending, usual, ".", "\n", 0, False, ""))
                done = run("convert", path, SCRATCH / "plain_read.csv", "--force", "--edits", "none")
                if done.returncode != 0:
                    wrong.append(f"plain {ending}: {done.stderr.strip()}")
                plain[ending, holes] = (SCRATCH / "plain_read.csv").read_bytes() if done.returncode == 0 else None
        choices = list(itertools.product(KINDS, (True, False), ("\t", ";", ",", " "), (".", ","), ("\n", "\r\n", "\r"), (0, 1, 300),
                                         (False, True), ("", " ", "  "), ("utf-8", "utf-8-sig", "utf-16", "utf-16-le", "cp1252")))  # fmt: skip
        chance.shuffle(choices)
        count = 0
        for ending, holes, separator, decimal, line_end, blank_columns, quoted, first_line, encoding in choices:
            kind, usual = KINDS[ending]
            if ending in (".trc", ".sto") and separator == ",":
                continue  # nobody writes these with commas: a decimal comma and a separator would be one
            if ending in (".csv", ".vicon.csv") and separator == " ":
                continue
            text = written(kind(names, cells if holes else full), ending, separator, decimal, line_end, blank_columns, quoted, first_line)
            if text is None:
                continue
            path = SCRATCH / f"text{ending}"
            path.write_bytes(text.encode(encoding))
            done = run("convert", path, SCRATCH / "read.csv", "--force", "--edits", "none")
            said = done.stderr.strip().splitlines()[-1] if done.stderr.strip() else ""
            what = f"{ending} {separator!r} {decimal!r} {line_end!r} {blank_columns} blank, quoted {quoted}, {first_line!r}, {encoding}, holes {holes}"
            if done.returncode == 0 and (SCRATCH / "read.csv").read_bytes() == plain[ending, holes]:
                same += 1
            elif done.returncode in (2, 3) and said:
                refused += 1
                print(f"refused: {what}: {said}")
            else:
                wrong.append(f"{what}: status {done.returncode}")
            made += 1
            count += 1
            if count == OF_EACH:
                break
    for one in wrong[:20]:
        print(f"wrong: {one}")
    print(f"{'PASS' if made >= 400 and not wrong else 'FAIL'} | dialects, texts of five recordings that are read wrongly | 0 of 400 | {len(wrong)} of {made}")
    share = 100 * same / made
    print(f"{'PASS' if share >= 95 else 'FAIL'} | dialects, read to the same bits | >= 95 % of them, the others refused | {share:.1f} %, {refused} refused")


if __name__ == "__main__":
    main()
