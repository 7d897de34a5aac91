#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Run the acceptance checks and print one table: what was asked, what was measured.

    tests/acceptance/run.py [--quick] [--build FOLDER] [NAME...]

checks.toml beside this file lists the checks. A check is a program of FOLDER/bin or a Python script of this folder
that prints one row per bound on stdout,

    PASS | what is checked | asked | measured

with FAIL or SKIP in place of PASS; other lines are notes, shown when the check fails. A check that prints no row,
ends with a status other than 0 without a FAIL row, or runs too long has failed; so has an `accept_*` program that
checks.toml does not list. It finds the kinemark program in KINEMARK_PROGRAM, the real recordings in
KINEMARK_TEST_DATA, and a folder that it may fill in KINEMARK_SCRATCH. Exit status 1 when a row fails.
"""

import argparse
import os
import subprocess
import sys
import tempfile
import time
import tomllib
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
VERDICTS = ("PASS", "FAIL", "SKIP")
DEFAULT_SECONDS = 1800
KEYS = {"program", "script", "arguments", "quick", "oracles", "seconds"}


def read_checks(path):
    """{name: settings} of checks.toml; ValueError names what is wrong in it."""
    checks = tomllib.loads(path.read_text(encoding="utf-8"))
    for name, settings in checks.items():
        unknown = set(settings) - KEYS
        if unknown:
            raise ValueError(f"{path.name}: [{name}] has an unknown key {sorted(unknown)[0]!r}")
        if ("program" in settings) == ("script" in settings):
            raise ValueError(f"{path.name}: [{name}] needs either a program or a script")
    return checks


def parse_row(line):
    """(verdict, check, asked, measured), or None when the line is no row."""
    cells = [cell.strip() for cell in line.split("|")]
    if len(cells) < 4 or cells[0] not in VERDICTS:
        return None
    return cells[0], cells[1], cells[2], " | ".join(cells[3:])


def unlisted(checks, binaries):
    listed = {settings.get("program") for settings in checks.values()}
    return sorted(path.name for path in binaries.glob("accept_*") if os.access(path, os.X_OK) and path.name not in listed)


def command_of(settings, binaries, here):
    """The command line of a check; FileNotFoundError when what it runs is not there."""
    if "program" in settings:
        path, start = binaries / settings["program"], []
    else:
        path = here / settings["script"]
        oracles = ROOT / ".venv" / "bin" / "python"
        start = [str(oracles) if settings.get("oracles") else sys.executable]
    if not path.is_file():
        raise FileNotFoundError(f"{path} is not there; build it first")
    return [*start, str(path), *settings.get("arguments", [])]


def run_check(name, settings, binaries, here):
    """(rows, notes) of one check. Whatever goes wrong becomes a FAIL row."""
    seconds = settings.get("seconds", DEFAULT_SECONDS)
    with tempfile.TemporaryDirectory(prefix="kinemark-accept-") as scratch:
        environment = {
            "KINEMARK_TEST_DATA": str(ROOT.parent / "shared" / "data"),
            **os.environ,
            "KINEMARK_PROGRAM": str(binaries / "kinemark"),
            "KINEMARK_SCRATCH": scratch,
        }
        try:
            ran = subprocess.run(
                command_of(settings, binaries, here),
                env=environment,
                cwd=scratch,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                errors="replace",
                timeout=seconds,
                check=False,
            )
        except FileNotFoundError as error:
            return [("FAIL", name, "runs", str(error))], []
        except subprocess.TimeoutExpired:
            return [("FAIL", name, f"ends within {seconds} s", "still running")], []
    lines = ran.stdout.splitlines()
    rows = [row for line in lines if (row := parse_row(line))]
    notes = [line for line in lines if parse_row(line) is None]
    if not rows:
        rows.append(("FAIL", name, "prints a row", f"printed none, exit status {ran.returncode}"))
    elif ran.returncode != 0 and all(row[0] != "FAIL" for row in rows):
        rows.append(("FAIL", name, "exit status 0", str(ran.returncode)))
    return rows, notes


def print_table(rows):
    headings = ("", "check", "asked", "measured")
    widths = [max(len(row[i]) for row in [headings, *rows]) for i in range(3)]
    for row in [headings, *rows]:
        print(" | ".join([*(cell.ljust(width) for cell, width in zip(row, widths)), row[3]]).rstrip())


def main(arguments, here=HERE):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="only the checks that are marked quick")
    parser.add_argument("--build", type=Path, default=ROOT / "build" / "release")
    parser.add_argument("names", nargs="*")
    options = parser.parse_args(arguments)
    binaries = options.build.resolve() / "bin"
    try:
        checks = read_checks(here / "checks.toml")
    except ValueError as error:
        print(f"acceptance: {error}", file=sys.stderr)
        return 2
    unknown = sorted(set(options.names) - set(checks))
    if unknown:
        print(f"acceptance: no check {', '.join(unknown)}; there are: {', '.join(checks)}", file=sys.stderr)
        return 2

    rows = [("FAIL", program, "is listed in checks.toml", "is not") for program in unlisted(checks, binaries)]
    chosen = {
        name: settings
        for name, settings in checks.items()
        if name in options.names or (not options.names and (settings.get("quick") or not options.quick))
    }
    if any(settings.get("oracles") for settings in chosen.values()):
        subprocess.run([str(ROOT / "tools" / "setup"), "--oracles"], check=True)
    for name, settings in chosen.items():
        started = time.monotonic()
        found, notes = run_check(name, settings, binaries, here)
        failed = any(row[0] == "FAIL" for row in found)
        print(f"{name}: {'FAILED' if failed else 'good'}, {time.monotonic() - started:.1f} s", flush=True)
        if failed:
            print("\n".join(f"    {line}" for line in notes[-40:]))
        rows += found

    print()
    print_table(rows)
    counts = {verdict: sum(row[0] == verdict for row in rows) for verdict in VERDICTS}
    print(f"acceptance: {counts['PASS']} passed, {counts['FAIL']} failed, {counts['SKIP']} skipped")
    return 1 if counts["FAIL"] else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
