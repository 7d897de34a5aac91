#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""A Motion-BIDS data set that kinemark convert writes of real recordings, judged by bids-validator, and its tables read by
pandas beside ezc3d's reading of the recordings.

Needs Node and npm, which fetches bids-validator (122 MB) into a scratch folder, and Python with pandas and ezc3d. Finds the
program in KINEMARK_PROGRAM and the recordings in KINEMARK_TEST_DATA; prints rows "PASS|FAIL|SKIP | check | asked |
measured"; exit status 1 when one fails.
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import ezc3d
import numpy
import pandas

from rows import PROGRAM, row

ROOT = Path(__file__).resolve().parent.parent.parent
DATA = Path(os.environ.get("KINEMARK_TEST_DATA", ROOT.parent / "shared/data"))
PACKAGE = "bids-validator@1.15.0"
NOT_OURS = {
    82: "CUSTOM_COLUMN_WITHOUT_DESCRIPTION: it takes the first row of the table without a header for names",
}
RECORDINGS = 4


def environment():
    """With the Node.js that tools/setup puts beside the Python tools."""
    return {**os.environ, "PATH": f"{ROOT / '.venv' / 'bin'}:{os.environ['PATH']}"}


def run(*command, **more):
    return subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False, **more)


def path_of(top, subject):
    return top / f"sub-{subject:02}" / "motion" / f"sub-{subject:02}_task-walk_tracksys-omc_motion.tsv"


def make_dataset(top):
    """[(recording, table)] of what could be converted."""
    made = []
    for source in sorted(DATA.rglob("*.c3d"), key=lambda p: (p.stat().st_size, p.name)):
        if len(made) == RECORDINGS:
            break
        if source.stat().st_size < 200_000:
            continue
        try:
            ezc3d.c3d(str(source))
        except RuntimeError:  # numbers of other processors, which it does not read
            continue
        table = path_of(top, len(made) + 1)
        if run(PROGRAM, "convert", "--quiet", source, table).returncode == 0:
            made.append((source, table))
    return made


class Validator:
    def __init__(self, folder):
        installed = run("npm", "install", "--silent", "--no-audit", "--no-fund", "--prefix", folder, PACKAGE, env=environment())
        self.program = Path(folder) / "node_modules" / ".bin" / "bids-validator"
        if not self.program.exists():
            sys.exit(f"npm could not install {PACKAGE}: {installed.stderr.strip()}")

    def issues(self, top):
        """(errors, warnings that are about what kinemark writes), in words."""
        done = run(self.program, top, "--json", env=environment())
        found = json.loads(done.stdout)["issues"]
        words = [[f"{i['key']} ({i['code']})" for i in found[kind] if i["code"] not in NOT_OURS] for kind in ("errors", "warnings")]
        return words[0], words[1]


def compare(source, table):
    """What differs between pandas' reading of the table and ezc3d's of the recording, in words."""
    stem = str(table).removesuffix("motion.tsv")
    channels = pandas.read_csv(f"{stem}channels.tsv", sep="\t", keep_default_na=False)
    facts = json.loads(Path(f"{stem}motion.json").read_text())
    values = pandas.read_csv(table, sep="\t", header=None, na_values="n/a")
    theirs = ezc3d.c3d(str(source))
    points, labels = theirs["data"]["points"], theirs["parameters"]["POINT"]["LABELS"]["value"]
    unit = {"m": 1.0, "mm": 1e-3, "cm": 1e-2}[theirs["parameters"]["POINT"]["UNITS"]["value"][0].strip() or "mm"]
    if values.shape != (points.shape[2], len(channels)):
        return [f"a table of {values.shape}"]
    wrong, compared = [], 0
    for column, about in channels.iterrows():
        if labels.count(about["tracked_point"]) != 1:
            continue
        compared += 1
        want = points["xyz".index(about["component"]), labels.index(about["tracked_point"]), :]
        ours = values[column].to_numpy()
        seen = ~numpy.isnan(ours)
        scale = unit if about["type"] == "POS" else 1.0
        if numpy.abs(ours[seen] - scale * want[seen]).max(initial=0.0) > 1e-9 * max(1.0, numpy.abs(want[seen]).max(initial=0.0)):
            wrong.append(about["name"])
    if compared == 0 or facts["SamplingFrequency"] != theirs["parameters"]["POINT"]["RATE"]["value"][0]:
        wrong.append(f"{compared} columns, {facts['SamplingFrequency']} Hz")
    return wrong


def check_tables(made):
    wrong = [f"{source.name}: {what}" for source, table in made for what in compare(source, table)]
    return row(len(made) == RECORDINGS and not wrong, "tables read by pandas, beside ezc3d's reading", f"{RECORDINGS} recordings alike",
               "; ".join(wrong[:4]) or f"{len(made)} recordings")


def check_back(made, scratch):
    """The recording and its Motion-BIDS give the same TRC, frame numbers, times and last digit."""
    wrong = []
    for source, table in made:
        texts = []
        for number, file in enumerate((source, table)):
            out = scratch / f"{number}.trc"
            done = run(PROGRAM, "convert", "--quiet", "--force", file, out)
            texts.append(out.read_text().splitlines()[1:] if done.returncode == 0 else done.stderr)
        if texts[0] != texts[1]:
            wrong.append(source.name)
    return row(not wrong, "recordings through Motion-BIDS to TRC, beside recordings to TRC", "same text", ", ".join(wrong) or f"same, {len(made)} of them")


def check_validator(made, top, scratch):
    validator = Validator(scratch / "npm")
    errors, warnings = validator.issues(top)
    good = row(not errors, f"{PACKAGE}: the data set", "no error", ", ".join(errors) or f"no error; warnings: {', '.join(warnings) or 'none'}")
    # That it looks: without its rate a recording is an error.
    broken = Path(str(made[0][1]).removesuffix("motion.tsv") + "motion.json")
    text = broken.read_text()
    broken.write_text(text.replace("SamplingFrequency\"", "Sampling\""))
    errors, _ = validator.issues(top)
    broken.write_text(text)
    return row(bool(errors), f"{PACKAGE}: the same without a rate", "an error", ", ".join(errors) or "none") and good


def main():
    if not DATA.is_dir():
        print("SKIP | recordings as Motion-BIDS | as ezc3d reads them | no recordings")
        return 0
    with tempfile.TemporaryDirectory() as name:
        scratch = Path(name)
        top = scratch / "study"
        made = make_dataset(top)
        good = [check_tables(made), check_back(made, scratch), check_validator(made, top, scratch)]
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main())
