# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Helpers of these tests: the program, a simulated recording, scratch folders, the real recordings."""

import csv
import dataclasses
import hashlib
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

PROJECT = Path(__file__).resolve().parent.parent.parent
PROGRAM = os.environ.get("KINEMARK_PROGRAM", str(PROJECT / "build" / "release" / "bin" / "kinemark"))
REAL_DATA = Path(os.environ.get("KINEMARK_TEST_DATA", PROJECT.parent / "shared" / "data"))
SECONDS = 120  # nothing here takes longer; a hang is a failure
LARGEST_READ = 1 << 30  # bytes of a file whose content is compared


def real_file(name):
    """A real recording or model; its test is skipped, and says so, where the files are not there."""
    path = REAL_DATA / name
    if not path.is_file():
        raise unittest.SkipTest(f"NO REAL DATA: {path} is not there; set KINEMARK_TEST_DATA")
    return path


@dataclasses.dataclass
class Ran:
    status: int
    out: str
    err: str


def run(*arguments, cwd, **options):
    done = subprocess.run(
        [PROGRAM, *map(str, arguments)],
        cwd=cwd,
        stdin=subprocess.DEVNULL,
        stdout=options.pop("stdout", subprocess.PIPE),
        stderr=subprocess.PIPE,
        timeout=SECONDS,
        check=False,
        **options,
    )
    return Ran(done.returncode, (done.stdout or b"").decode(), done.stderr.decode())


def content(path):
    """What a file holds; of one that is mostly a hole, and too large to read, what any write to it changes."""
    facts = path.stat()
    return path.read_bytes() if facts.st_size < LARGEST_READ else (facts.st_size, facts.st_blocks, facts.st_mtime_ns)


def listing(folder):
    """Every path below a folder with its content, so that a change of any kind shows."""
    return {path.relative_to(folder).as_posix(): content(path) if path.is_file() else None for path in Path(folder).rglob("*")}


class CommandTest(unittest.TestCase):
    """Each test has an empty folder; `recorded` is a simulated second of the human model, made once."""

    @classmethod
    def setUpClass(cls):
        cls.shared = tempfile.TemporaryDirectory(prefix="kinemark-cli-")
        cls.addClassCleanup(cls.shared.cleanup)
        cls.recorded = Path(cls.shared.name) / "recorded"
        made = run("simulate", "subject", "-o", cls.recorded, "--duration", 1, "--dropout-random", 0.05, cwd=cls.shared.name)
        assert made.status == 0, made.err
        cls.c3d, cls.trc = cls.recorded / "markers.c3d", cls.recorded / "markers.trc"
        cls.model, cls.truth = cls.recorded / "model.osim", cls.recorded / "truth.mot"

    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="kinemark-cli-")
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)

    def run_in(self, *arguments, **options):
        return run(*arguments, cwd=self.folder, **options)

    def good(self, *arguments, status=0, **options):
        ran = self.run_in(*arguments, **options)
        self.assertEqual(ran.status, status, ran.err)
        return ran

    def refused(self, status, words, *arguments, **options):
        """The command fails with that status and one sentence with those words, and leaves the folder as it was."""
        before = listing(self.folder)
        ran = self.run_in(*arguments, **options)
        self.assertEqual(ran.status, status, ran.err)
        self.assertEqual(ran.out, "")
        lines = ran.err.splitlines()
        self.assertEqual(len(lines), 1, ran.err)
        self.assertRegex(lines[0], r"^kinemark: \S")
        for word in [words] if isinstance(words, str) else words:
            self.assertIn(word, lines[0])
        self.assertEqual(listing(self.folder), before, "a failure leaves the folder as it was")
        return lines[0]

    def ik(self, **changes):
        """Arguments of `ik` on the simulated recording, with options replaced or added."""
        options = {"model": self.model, "markers": self.c3d, "output": "q.mot", **changes}
        return ["ik", *(part for name, value in options.items() for part in (f"--{name.replace('_', '-')}", value))]

    def write(self, name, text):
        path = self.folder / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path


def changed_cell(text, line, column, value):
    """Tab-separated text with one cell replaced; line and column count from 1."""
    lines = text.split("\n")
    cells = lines[line - 1].split("\t")
    cells[column - 1] = value
    lines[line - 1] = "\t".join(cells)
    return "\n".join(lines)


def report_data(page):
    """The text of the data that a report page carries. A folder KINEMARK_PAGES keeps it, to be held against the schema."""
    text = re.search(r'<script type="application/json" id="kinemark-data">(.*?)</script>', page, re.DOTALL).group(1)
    if folder := os.environ.get("KINEMARK_PAGES"):
        (Path(folder) / f"{hashlib.sha256(text.encode()).hexdigest()[:16]}.json").write_text(text)
    return text


def table(path):
    """(names, rows of floats) of a MOT or STO file."""
    head, _, body = path.read_text().partition("endheader\n")
    lines = body.splitlines()
    return lines[0].split("\t"), [[float(cell) for cell in line.split("\t")] for line in lines[1:]]


POSITION = ("x_m", "y_m", "z_m")  # columns of CSV files


def converted(recording, path):
    """The rows of a recording as `convert` writes them to a CSV file at `path`."""
    made = run("convert", recording, path, cwd=path.parent)
    assert made.status == 0, made.err
    return read_csv(path)


def read_csv(path):
    """The rows of a CSV file as dictionaries; comment lines are left out."""
    with path.open(newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def write_csv(path, rows, header=None):
    """Writes dictionaries as rows of a CSV file; `header` where there may be no row."""
    with path.open("w", newline="") as file:
        out = csv.DictWriter(file, header or rows[0].keys(), lineterminator="\n")
        out.writeheader()
        out.writerows(rows)
