#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Everything that must hold before a change lands, stage by stage. `make test` runs it; so does CI.

    tools/run_tests.py [--only STAGE[,STAGE...]] [--from STAGE] [--jobs N] [--keep-going] [--check-budget] [--list]

Each stage writes build/logs/STAGE.log and tells how long it took and how many processor minutes of its budget; the end
of the log is shown when it fails. The first failing stage ends the run. Where all stages together take more than
BUDGET_MINUTES, it says so, and fails with --check-budget. Tests that lack the real recordings fail their stage, unless
KINEMARK_ALLOW_MISSING_DATA=1 allows it. The last line counts tests: "N passed, N failed".
"""

import argparse
import concurrent.futures
import dataclasses
import hashlib
import os
import re
import resource
import shutil
import subprocess
import sys
import time
import xml.etree.ElementTree as ElementTree
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LOGS = ROOT / "build" / "logs"
HUNT_SECONDS = "60"  # of each target
TIDY_SECONDS = "150"
SHOWN_LINES = 120
LEAST_PAGES = 25  # that tests of the program leave for viewer-pages
BUDGET_MINUTES = 75  # of one processor, from nothing


def search_path(root, path):
    """Where programs are looked for: in .venv first if tools/setup put a Node there, as the machine's is too old."""
    tools = root / ".venv" / "bin"
    return f"{tools}{os.pathsep}{path}" if (tools / "node").exists() else path


ENVIRONMENT = {
    **os.environ,
    "PATH": search_path(ROOT, os.environ.get("PATH", "/usr/bin:/bin")),
    "ASAN_SYMBOLIZER_PATH": "/usr/bin/llvm-symbolizer-19",
    "UBSAN_OPTIONS": "print_stacktrace=1",
    "CTEST_OUTPUT_ON_FAILURE": "1",
    "PYTHONDONTWRITEBYTECODE": "1",
}


@dataclasses.dataclass
class Counts:
    passed: int = 0
    failed: int = 0
    skipped: int = 0

    def add(self, other):
        self.passed += other.passed
        self.failed += other.failed
        self.skipped += other.skipped

    def __str__(self):
        return f"{self.passed} passed, {self.failed} failed" + (f", {self.skipped} skipped" if self.skipped else "")


class Failed(Exception):
    """A stage failed; `counts` are the tests that it ran, where known."""

    def __init__(self, why, counts=None):
        super().__init__(why)
        self.counts = counts or Counts(failed=1)


class Log:
    """Runs commands with their output in a file; `jobs` is how many things they may do at a time."""

    def __init__(self, path, jobs=2):
        self.path = path
        self.jobs = jobs
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self.path.write_text("")

    def run(self, *command, cwd=ROOT, **environment):
        """Exit status of a command."""
        with self.path.open("a", encoding="utf-8") as file:
            file.write(f"$ {' '.join(map(str, command))}\n")
            file.flush()
            return subprocess.run(
                [str(part) for part in command],
                cwd=cwd,
                env={**ENVIRONMENT, **environment},
                stdin=subprocess.DEVNULL,
                stdout=file,
                stderr=subprocess.STDOUT,
                check=False,
            ).returncode

    def write(self, line):
        with self.path.open("a", encoding="utf-8") as file:
            file.write(f"{line}\n")

    def must(self, *command, **options):
        if self.run(*command, **options) != 0:
            raise Failed(f"'{' '.join(map(str, command))}' failed")

    def text(self):
        return self.path.read_text(encoding="utf-8", errors="replace")


def script(*command):
    """A stage that is one command and counts as one test."""

    def stage(log):
        log.must(*command)
        return Counts(passed=1)

    return stage


def data_may_be_missing():
    return os.environ.get("KINEMARK_ALLOW_MISSING_DATA") == "1"


def demand_data(counts, missing):
    """Raise Failed when `missing` tests had no real recordings and that is not allowed."""
    if missing and not data_may_be_missing():
        raise Failed(
            f"{missing} tests lack the real recordings; set KINEMARK_TEST_DATA, or KINEMARK_ALLOW_MISSING_DATA=1", counts
        )
    return counts


def data(log):
    """The real recordings are there, or their absence is allowed."""
    folder = Path(os.environ.get("KINEMARK_TEST_DATA") or ROOT.parent / "shared" / "data")
    there = (folder / "README.md").is_file()
    log.write(f"real recordings: {folder} is {'there' if there else 'not there'}")
    return demand_data(Counts(passed=1) if there else Counts(skipped=1), 0 if there else 1)


def count_unittest(text):
    """Counts of Python's unittest from its last lines."""
    ran = re.findall(r"^Ran (\d+) tests? in", text, re.MULTILINE)
    if not ran:
        return Counts(failed=1)
    total = int(ran[-1])
    numbers = dict(re.findall(r"(failures|errors|skipped)=(\d+)", text.rsplit("\nRan ", 1)[-1]))
    failed = int(numbers.get("failures", 0)) + int(numbers.get("errors", 0))
    skipped = int(numbers.get("skipped", 0))
    return Counts(max(0, total - failed - skipped), failed, skipped)  # parts of one test can fail each


def tools(log):
    status = log.run(sys.executable, "-m", "unittest", "discover", "-s", ROOT / "tests" / "tools")
    counts = count_unittest(log.text())
    if status != 0 or counts.passed == 0:
        raise Failed("a test of the scripts failed", counts)
    return counts


def pages_of(preset):
    """Where tests of the program leave what their pages hold."""
    return ROOT / "build" / preset / "pages"


def cli(preset, *modules):
    """The program from outside, as built before: the modules of tests/cli, or those named, side by side."""

    def stage(log):
        folder = ROOT / "tests" / "cli"
        program = ROOT / "build" / preset / "bin" / "kinemark"
        chosen = modules or sorted(path.stem for path in folder.glob("test_*.py"))

        def run(module):
            own = Log(log.path.with_name(f"{log.path.stem}-{module}.log"))
            status = own.run(
                *(sys.executable, "-m", "unittest", module, "-v"),
                cwd=folder,
                KINEMARK_PROGRAM=str(program),
                KINEMARK_PAGES=str(pages_of(preset)),
            )
            text = own.text()
            own.path.unlink()
            return status, text

        counts, missing, bad = Counts(), 0, []
        pages = pages_of(preset)
        shutil.rmtree(pages, ignore_errors=True)
        pages.mkdir(parents=True)
        with concurrent.futures.ThreadPoolExecutor(log.jobs) as pool:
            for module, (status, text) in zip(chosen, pool.map(run, chosen)):
                here = count_unittest(text)
                counts.add(here)
                missing += len(re.findall(r"\bskipped ['\"]NO REAL DATA", text))
                if status == 0:
                    log.write(text)
                else:
                    bad.append(text)
        for text in bad:  # last, where the log's end is shown
            log.write(text)
        if bad or counts.passed == 0:
            raise Failed("a test of the program failed", counts)
        return demand_data(counts, missing)

    return stage


def build(preset, *options):
    def stage(log):
        log.must("cmake", "--preset", preset)
        log.must("cmake", "--build", "--preset", preset, "--parallel", log.jobs, *options)
        return Counts(passed=1)

    return stage


def cases_without_data(cases):
    """How many GoogleTest cases were skipped because the real recordings are absent."""
    skipped = (
        case.find("skipped")
        for file in cases.glob("*.xml")
        for case in ElementTree.parse(file).getroot().iter("testcase")
    )
    return sum("real recordings are absent" in found.get("message", "") for found in skipped if found is not None)


def count_ctest(junit, cases):
    """Counts of a CTest run: the cases that GoogleTest programs wrote, one for each other CTest entry."""
    counts = Counts()
    for entry in ElementTree.parse(junit).getroot().iter("testcase"):
        details = cases / f"test_{entry.get('name')}.xml"
        passed = entry.get("status") == "run"
        if not details.is_file():
            counts.add(Counts(passed=1) if passed else Counts(failed=1))
            continue
        in_program = Counts()
        for case in ElementTree.parse(details).getroot().iter("testcase"):
            if case.find("failure") is not None:
                in_program.failed += 1
            elif case.get("result") == "skipped":
                in_program.skipped += 1
            else:
                in_program.passed += 1
        if not passed and in_program.failed == 0:
            in_program.failed = 1
        counts.add(in_program)
    return counts


def unit_tests(preset, *chosen):
    def stage(log):
        cases = ROOT / "build" / preset / "cases"
        junit = ROOT / "build" / preset / "ctest.xml"
        shutil.rmtree(cases, ignore_errors=True)
        junit.unlink(missing_ok=True)
        # A program that dies leaves no file of cases; CTest knows that it failed.
        status = log.run(
            *("ctest", "--preset", preset, "--parallel", log.jobs, "--output-junit", junit, "--no-tests=error"),
            *chosen,
            GTEST_OUTPUT=f"xml:{cases}/",
        )
        if not junit.is_file():
            raise Failed("ctest did not run")
        counts = count_ctest(junit, cases)
        if status != 0 or counts.failed or not counts.passed:
            raise Failed("a test failed", counts)
        return demand_data(counts, cases_without_data(cases))

    return stage


def cached_compiler():
    """How a compiler is called so that what did not change comes from the cache, as in CMakePresets.json."""
    launcher = f"env;CCACHE_BASEDIR={ROOT};CCACHE_NOHASHDIR=1;CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime;ccache"
    return f"-DCMAKE_CXX_COMPILER_LAUNCHER={launcher}"


def consumer(log):
    """A stranger's project and the examples, built with both compilers against what `cmake --install` gives. GCC reads each
    example with its own includes; for clang they share a precompiled front header."""
    build, installed = ROOT / "build" / "ci", ROOT / "build" / "ci" / "prefix"
    shutil.rmtree(installed, ignore_errors=True)
    log.must("cmake", "--install", build, "--prefix", installed)
    log.must(sys.executable, ROOT / "tools" / "check_public_headers.py", "--installed", installed / "include")
    counts = Counts(passed=2)
    projects = {"consumer": "tests/consumer", "headers": "tests/consumer/headers", "examples": "examples"}
    for compiler in ("g++", "clang++-19"):
        for name, source in projects.items():
            folder = build / "consumer" / compiler / name
            shutil.rmtree(folder, ignore_errors=True)
            shared = ROOT / "tests" / "consumer" / "shared_headers.cmake"
            log.must(
                *("cmake", "-S", ROOT / source, "-B", folder, "-G", "Ninja", f"-DCMAKE_CXX_COMPILER={compiler}"),
                *("-DCMAKE_BUILD_TYPE=Debug", f"-DCMAKE_PREFIX_PATH={installed}", cached_compiler()),
                *([f"-DCMAKE_PROJECT_TOP_LEVEL_INCLUDES={shared}"] if name == "examples" and compiler != "g++" else []),
            )
            log.must("cmake", "--build", folder, "--parallel", log.jobs)
            counts.passed += 1
        log.must(build / "consumer" / compiler / "consumer" / "consumer")
        log.must("ctest", "--test-dir", build / "consumer" / compiler / "consumer", "--no-tests=error")
        log.must("ctest", "--test-dir", build / "consumer" / compiler / "examples", "--no-tests=error")
        counts.passed += 3
    return counts


def docs(log):
    """The API documentation; a public name without a description fails it."""
    log.must("cmake", "--build", "--preset", "ci", "--target", "docs")
    return Counts(passed=1)


def count_acceptance(text):
    """Counts of acceptance/run.py; a known shortfall is no test that passed."""
    found = re.findall(r"^acceptance: (\d+) passed, (\d+) failed, (\d+) skipped, \d+ known$", text, re.MULTILINE)
    return Counts(*map(int, found[-1])) if found else Counts(failed=1)


def install_viewer(log):
    """npm ci, unless what is there was installed from the same lock file."""
    viewer = ROOT / "viewer"
    wanted = hashlib.sha256((viewer / "package-lock.json").read_bytes()).hexdigest()
    stamp = viewer / "node_modules" / ".installed-from"
    if not stamp.is_file() or stamp.read_text() != wanted:
        log.must("npm", "ci", "--no-audit", "--no-fund", cwd=viewer)
        stamp.write_text(wanted)


def acceptance(log):
    install_viewer(log)  # rows go through pages by the viewer's scripts
    status = log.run(sys.executable, ROOT / "tests" / "acceptance" / "run.py", "--quick", "--jobs", log.jobs, "--build", ROOT / "build" / "ci")
    counts = count_acceptance(log.text())
    if status != 0:
        raise Failed("a row of the acceptance table failed", counts)
    return counts


def fuzz(*how):
    """All targets: the same runs each time, or a hunt by time."""

    def stage(log):
        log.must(sys.executable, ROOT / "tools" / "fuzz", *how, "--jobs", log.jobs)
        found = re.findall(r"^fuzz: (\d+) targets, 0 failed$", log.text(), re.MULTILINE)
        return Counts(passed=int(found[-1]))

    return stage


def tidy(log):
    """What changed, newest first, as far as the time allows; `make accept` looks at all."""
    log.must("cmake", "--preset", "tidy")
    log.must(sys.executable, ROOT / "tools" / "check_tidy", "--jobs", log.jobs, "--seconds", TIDY_SECONDS)
    return Counts(passed=1)


def files_below(folder):
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def viewer_page(log):
    """The committed page is what its sources build."""
    install_viewer(log)
    dist = ROOT / "viewer" / "dist"
    before = files_below(dist)
    log.must("npm", "run", "build", cwd=ROOT / "viewer")
    if files_below(dist) != before:
        raise Failed("viewer/dist is not what viewer/ builds; commit what 'npm run build' wrote there")
    return Counts(passed=1)


def viewer_tests(log):
    status = log.run("npm", "test", "--", "--reporter=verbose", "--no-color", cwd=ROOT / "viewer", NO_COLOR="1")
    found = re.findall(r"^\s*Tests\s+(?:(\d+) failed \| )?(?:(\d+) passed)?", log.text(), re.MULTILINE)
    counts = Counts(int(found[-1][1] or 0), int(found[-1][0] or 0)) if found else Counts(failed=1)
    if status != 0 or not counts.passed:
        raise Failed("a test of the viewer failed", counts)
    return counts


def viewer_browser(log):
    status = log.run("npm", "run", "test:browser", cwd=ROOT / "viewer") or log.run("npm", "run", "test:edits", cwd=ROOT / "viewer")
    text = log.text()
    counts = Counts(len(re.findall(r"^ok ", text, re.MULTILINE)), len(re.findall(r"^FAILED ", text, re.MULTILINE)))
    if status != 0 or not counts.passed:
        raise Failed("the page fails in the browser", counts)
    return counts


def viewer_pages(log):
    """What pages of the program's tests hold, against the schema."""
    pages = sorted(pages_of("ci").glob("*.json"))
    status = log.run("npm", "run", "check:pages", "--", *pages, cwd=ROOT / "viewer")
    text = log.text()
    counts = Counts(len(re.findall(r"^ok ", text, re.MULTILINE)), len(re.findall(r"^FAILED ", text, re.MULTILINE)))
    if status != 0 or counts.passed < LEAST_PAGES:
        raise Failed(f"a page breaks viewer/schema, or there are fewer than {LEAST_PAGES}", counts if counts.failed else None)
    return counts


def demo(log):
    """The newcomer's command, on the program built before; its page is looked at in a browser."""
    out = ROOT / "build" / "ci" / "demo"
    shutil.rmtree(out, ignore_errors=True)
    log.must(sys.executable, ROOT / "tools" / "demo", "--program", ROOT / "build" / "ci" / "bin" / "kinemark", "--out", out)
    log.must("npm", "run", "test:browser", "--", out / "report.html", cwd=ROOT / "viewer")
    return Counts(passed=2)


# Name: (what it does, its budget in processor minutes from nothing). Fast ones first; what each needs is built by an
# earlier one. "tests" are those that no sanitizer looks into, "asan-tests" all others. The budgets together stay below
# BUDGET_MINUTES.
STAGES = {
    "data": (data, 0.1),
    "format": (script("tools/check_format"), 0.5),
    "layers": (script(sys.executable, "tools/check_layers.py"), 0.1),
    "licences": (script(sys.executable, "tools/check_spdx.py"), 0.1),
    "readmes": (script(sys.executable, "tools/check_readmes.py"), 0.1),
    "sentences": (script(sys.executable, "tools/check_sentences.py"), 0.1),
    "lines": (script(sys.executable, "tools/count_lines.py"), 0.1),
    "public-headers": (script(sys.executable, "tools/check_public_headers.py"), 0.1),
    "tools": (tools, 0.5),
    "build": (build("ci"), 25),
    "hardened": (script("tools/check_hardened", "build/ci/bin/kinemark", "build/ci/bin/kinemark-nwb"), 0.1),
    "tests": (unit_tests("ci"), 1),
    "cli": (cli("ci"), 2),
    "consumer": (consumer, 2),
    "docs": (docs, 0.5),
    "acceptance": (acceptance, 4),
    "viewer-page": (viewer_page, 0.5),
    "viewer-tests": (viewer_tests, 0.4),
    "viewer-pages": (viewer_pages, 0.1),
    "viewer-browser": (viewer_browser, 0.5),
    "demo": (demo, 0.5),
    "asan-build": (build("asan"), 20),
    "asan-tests": (unit_tests("asan"), 7),
    "fuzz": (fuzz("--fixed"), 4.5),
    "tidy": (tidy, 5.2),
}

# Too long for every change; `make accept` names them.
LONG_STAGES = {
    "release-tests": (unit_tests("release"), 2),
    "fuzz-hunt": (fuzz("--seconds", HUNT_SECONDS), 14),
    "asan-program": (build("asan", "--target", "kinemark"), 10),
    "asan-cli": (cli("asan", "test_bad_input", "test_hints"), 1.5),
    "threads-build": (build("tsan", "--target", "threads"), 10),
    "threads": (unit_tests("tsan", "--label-regex", "threads"), 2),
}


def choose(stages, only, first):
    """Names of the stages to run; ValueError on a name that does not exist."""
    names = list(stages)
    for name in [*(only.split(",") if only else []), *([first] if first else [])]:
        if name not in stages:
            raise ValueError(f"no stage '{name}'; there are: {', '.join(names)}")
    if only:
        return [name for name in names if name in only.split(",")]
    return names[names.index(first):] if first else names


def processor_minutes():
    """Of all programs that were run and have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return (used.ru_utime + used.ru_stime) / 60


def compilations():
    """(compilations, how many of them came from the cache) of ccache so far; (0, 0) without it."""
    try:
        told = subprocess.run(["ccache", "--print-stats"], capture_output=True, text=True, check=False).stdout
    except OSError:
        return 0, 0
    counts = dict(re.findall(r"^(\w+)\t(\d+)$", told, re.MULTILINE))
    hits = int(counts.get("direct_cache_hit", 0)) + int(counts.get("preprocessed_cache_hit", 0))
    return hits + int(counts.get("cache_miss", 0)), hits


def run_stages(stages, names, logs, jobs=2, keep_going=False, check_budget=False, budget_minutes=BUDGET_MINUTES):
    """Exit status of running the named stages; prints a line for each and the closing line."""
    total, failed, began, first_minutes = Counts(), [], time.monotonic(), processor_minutes()
    first_compilations = compilations()
    for number, name in enumerate(names, 1):
        print(f"[{number:2}/{len(names)}] {name} ...", flush=True)
        run, budget = stages[name]
        log, started, minutes = Log(logs / f"{name}.log", jobs), time.monotonic(), processor_minutes()
        try:
            counts, why = run(log), None
        except Failed as failure:
            counts, why = failure.counts, str(failure)
        except OSError as error:
            counts, why = Counts(failed=1), str(error)
        total.add(counts)
        minutes = processor_minutes() - minutes
        cost = f"{minutes:.1f} of {budget:g} processor minutes" + (", OVER ITS BUDGET" if minutes > budget else "")
        took = f"{time.monotonic() - started:.1f} s, {cost}"
        if why is None:
            print(f"[{number:2}/{len(names)}] {name}: good, {took} ({counts})", flush=True)
            continue
        failed.append(name)
        print("\n".join(log.text().splitlines()[-SHOWN_LINES:]))
        print(f"[{number:2}/{len(names)}] {name}: FAILED after {took}: {why} ({counts}); all of it: {log.path}", flush=True)
        if not keep_going:
            break
    minutes = processor_minutes() - first_minutes
    compiled, cached = (now - before for now, before in zip(compilations(), first_compilations))
    if compiled:
        print(f"{compiled} compilations, {cached} of them from the cache")
    if minutes > budget_minutes:
        print(f"{minutes:.1f} processor minutes, more than the {budget_minutes:g} of a whole run")
        if check_budget:
            failed.append("the budget")
            total.add(Counts(failed=1))
    spent = f"{time.monotonic() - began:.0f} s in all, {minutes:.1f} processor minutes"
    print(spent + (f"; failed: {', '.join(failed)}" if failed else ""))
    print(total, flush=True)
    return 1 if failed else 0


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", metavar="STAGE[,STAGE...]")
    parser.add_argument("--from", dest="first", metavar="STAGE")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 2)
    parser.add_argument("--keep-going", action="store_true")
    parser.add_argument("--check-budget", action="store_true")
    parser.add_argument("--list", action="store_true")
    options = parser.parse_args(arguments)
    if options.list:
        print("\n".join(f"{name:16}{budget:g}" for name, (_, budget) in {**STAGES, **LONG_STAGES}.items()))
        return 0
    try:
        stages = {**STAGES, **LONG_STAGES} if options.only else STAGES
        names = choose(stages, options.only, options.first)
    except ValueError as error:
        print(f"run_tests: {error}", file=sys.stderr)
        return 2
    return run_stages(stages, names, LOGS, options.jobs, options.keep_going, options.check_budget)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
