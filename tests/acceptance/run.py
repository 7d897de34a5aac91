#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Run the acceptance checks and print one table: what was asked, what was measured.

    tests/acceptance/run.py [--quick] [--build FOLDER] [--jobs N] [NAME...]

checks.toml beside this file lists the checks. A check is a program of FOLDER/bin or a Python script of this folder
that prints one row per bound on stdout,

    PASS | what is checked | asked | measured

with FAIL or SKIP in place of PASS, or NOTE for a number of which nothing is asked; other lines are shown when the
check fails. A check that prints no row (notes apart), ends with a status other than 0 without a FAIL row, or runs too
long has failed; so has a check of an `accept_*` program that checks.toml does not list, and so has a SKIP row (it
lacks the real recordings), unless KINEMARK_ALLOW_MISSING_DATA=1. A known shortfall stands in checks.toml as an
[[expected_failures]]: its rows are run like all others and shown as KNOWN; it fails once its rows pass (take it out
then), are not printed, or are more than a tenth worse than the figure kept there. A check finds the kinemark program
in KINEMARK_PROGRAM, the real recordings in KINEMARK_TEST_DATA, and a folder that it may fill in KINEMARK_SCRATCH.
N checks run side by side (default 1: some measure speed).
Exit status 1 when a row fails.
"""

import argparse
import concurrent.futures
import os
import re
import subprocess
import sys
import tempfile
import time
import tomllib
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
VERDICTS = ("PASS", "FAIL", "SKIP", "NOTE")
DEFAULT_SECONDS = 1800
KEYS = {"program", "script", "arguments", "quick", "oracles", "seconds"}
EXPECTED_KEYS = {"check", "row", "reason", "figure", "measured", "better"}
SLACK = 0.1  # a known shortfall may become so much worse, of its figure


def read_expected(tables, checks, name):
    """The known shortfalls of checks.toml; ValueError names what is wrong in one."""
    for table in tables:
        if set(table) != EXPECTED_KEYS:
            odd = sorted(set(table) ^ EXPECTED_KEYS)[0]
            raise ValueError(f"{name}: an expected failure has {', '.join(sorted(EXPECTED_KEYS))}; see {odd!r}")
        if table["check"] not in checks:
            raise ValueError(f"{name}: an expected failure names no check: {table['check']!r}")
        if table["better"] not in ("lower", "higher"):
            raise ValueError(f"{name}: 'better' is lower or higher, not {table['better']!r}")
        if re.compile(table["figure"]).groups != 1:
            raise ValueError(f"{name}: the figure {table['figure']!r} needs one group, the number")
        re.compile(table["row"])
    return tables


def read_checks(path):
    """({name: settings}, known shortfalls) of checks.toml; ValueError names what is wrong in it."""
    checks = tomllib.loads(path.read_text(encoding="utf-8"))
    expected = checks.pop("expected_failures", [])
    for name, settings in checks.items():
        unknown = set(settings) - KEYS
        if unknown:
            raise ValueError(f"{path.name}: [{name}] has an unknown key {sorted(unknown)[0]!r}")
        if ("program" in settings) == ("script" in settings):
            raise ValueError(f"{path.name}: [{name}] needs either a program or a script")
    return checks, read_expected(expected, checks, path.name)


def parse_row(line):
    """(verdict, check, asked, measured), or None when the line is no row."""
    cells = [cell.strip() for cell in line.split("|")]
    if len(cells) < 4 or cells[0] not in VERDICTS:
        return None
    return cells[0], cells[1], cells[2], " | ".join(cells[3:])


def is_worse(known, measured):
    """Why a failed row is no longer the known shortfall, or None."""
    figures = [float(found) for found in re.findall(known["figure"], measured)]
    if not figures:
        return f"no figure {known['figure']!r}"
    slack = SLACK * abs(known["measured"])
    worse = max(figures) - known["measured"] if known["better"] == "lower" else known["measured"] - min(figures)
    return f"worse than the known {known['measured']:g} by more than a tenth" if not worse <= slack else None


def judge_expected(name, rows, expected):
    """`rows` of the check `name` with its known shortfalls as KNOWN; a FAIL row for each that is one no longer."""
    judged = list(rows)
    for known in (known for known in expected if known["check"] == name):
        matching = [i for i, row in enumerate(rows) if re.fullmatch(known["row"], row[1])]
        failing = [i for i in matching if rows[i][0] == "FAIL"]
        if any(rows[i][0] == "SKIP" for i in matching):
            continue
        if not failing:
            what = "passes now; take it out of expected_failures" if matching else "prints no such row"
            judged.append(("FAIL", f"{name}: {known['row']}", "is a known shortfall", what))
        for i in failing:
            _, check, asked, measured = rows[i]
            worse = is_worse(known, measured)
            verdict, why = ("FAIL", worse) if worse else ("KNOWN", known["reason"])
            judged[i] = (verdict, check, asked, f"{measured} ({why})")
    return judged


def refuse_skips(rows):
    """SKIP rows as FAIL rows, unless the recordings may be missing."""
    if os.environ.get("KINEMARK_ALLOW_MISSING_DATA") == "1":
        return rows
    return [
        ("FAIL", *row[1:3], f"{row[3]}, or KINEMARK_ALLOW_MISSING_DATA=1") if row[0] == "SKIP" else row for row in rows
    ]


def unlisted(checks, binaries):
    """"PROGRAM CHECK" of what the acceptance programs offer and no table asks for."""
    listed = {(settings["program"], *settings.get("arguments", [])[:1]) for settings in checks.values() if "program" in settings}
    found = []
    for path in sorted(binaries.glob("accept_*")):
        if os.access(path, os.X_OK):
            ran = subprocess.run([path, "--list"], stdout=subprocess.PIPE, text=True, check=False)
            found += [f"{path.name} {name}" for name in ran.stdout.split() if (path.name, name) not in listed]
    return found


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
    if all(row[0] == "NOTE" for row in rows):
        rows.append(("FAIL", name, "prints a row", f"printed none, exit status {ran.returncode}"))
    elif ran.returncode not in (0, 1) or (ran.returncode == 1 and all(row[0] != "FAIL" for row in rows)):
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
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("names", nargs="*")
    options = parser.parse_args(arguments)
    binaries = options.build.resolve() / "bin"
    try:
        checks, expected = read_checks(here / "checks.toml")
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

    def run(name):
        started = time.monotonic()
        found, notes = run_check(name, chosen[name], binaries, here)
        return found, notes, time.monotonic() - started

    with concurrent.futures.ThreadPoolExecutor(max(1, options.jobs)) as pool:
        for name, (found, notes, seconds) in zip(chosen, pool.map(run, chosen)):
            found = refuse_skips(judge_expected(name, found, expected))
            failed = any(row[0] == "FAIL" for row in found)
            print(f"{name}: {'FAILED' if failed else 'good'}, {seconds:.1f} s", flush=True)
            if failed:
                print("\n".join(f"    {line}" for line in notes[-40:]))
            rows += found

    print()
    print_table([row for row in rows if row[0] != "KNOWN"])
    shortfalls = [row for row in rows if row[0] == "KNOWN"]
    if shortfalls:
        print("\nKnown shortfalls:")
        print_table(shortfalls)
    counts = {verdict: sum(row[0] == verdict for row in rows) for verdict in ("PASS", "FAIL", "SKIP", "KNOWN")}
    summary = f"{counts['PASS']} passed, {counts['FAIL']} failed, {counts['SKIP']} skipped, {counts['KNOWN']} known"
    print(f"acceptance: {summary}")
    return 1 if counts["FAIL"] else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
