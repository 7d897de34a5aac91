#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Trials of the simulated rig through `kinemark acquire`: nothing lost, or counted, whatever happens meanwhile.

    acquire_rig.py [all]

Without `all` the same in short. Prints rows "PASS|FAIL | check | asked | measured"; exit status 1 when one fails.
"""

import json
import os
import random
import re
import resource
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from rows import PROGRAM, exit_status, row, run

ALL = sys.argv[1:2] == ["all"]
RATE = 1 / (8 * 904e-6)  # the highest with 8 LEDs at 2 cameras
MESSAGE, METADATA = 0x05, 0x0C

STEP_BACK = """
#define _GNU_SOURCE
#include <dlfcn.h>
#include <time.h>
int clock_gettime(clockid_t id, struct timespec* t) {
  static int (*real)(clockid_t, struct timespec*);
  static time_t begin;
  struct timespec now;
  if (!real) real = (int (*)(clockid_t, struct timespec*))dlsym(RTLD_NEXT, "clock_gettime");
  if (id != CLOCK_REALTIME) return real(id, t);
  real(CLOCK_MONOTONIC, &now);
  if (!begin) begin = now.tv_sec;
  const int done = real(id, t);
  if (now.tv_sec - begin > 3) t->tv_sec -= 3600;
  return done;
}
"""


def text_at(data, at):
    """A string of a record, and where it ends."""
    length = struct.unpack_from("<I", data, at)[0]
    return data[at + 4 : at + 4 + length].decode(), at + 4 + length


def contents(path):
    """(frames: {number: (log time in ns, bytes)}, metadata: [(name, {key: value})]) of as much of a recording as is whole."""
    data, frames, notes = Path(path).read_bytes(), {}, []
    at = 8
    while at + 9 <= len(data):
        kind, length = data[at], struct.unpack_from("<Q", data, at + 1)[0]
        begin, at = at + 9, at + 9 + length
        if at > len(data) or kind == 0x0F:
            break
        if kind == MESSAGE:
            _, number, log_ns, _ = struct.unpack_from("<HIQQ", data, begin)
            frames[number] = (log_ns, data[begin + 22 : at])
        if kind == METADATA:
            name, place = text_at(data, begin)
            end, values = place + 4 + struct.unpack_from("<I", data, place)[0], {}
            place += 4
            while place < end:
                key, place = text_at(data, place)
                values[key], place = text_at(data, place)
            notes.append((name, values))
    return frames, notes


def note(notes, name):
    """The last metadata of a name."""
    return next((values for said, values in reversed(notes) if said == name), {})


class Acquire:
    """A command that runs; its lines of progress as they come."""

    def __init__(self, source, path, *words, **options):
        self.path, self.begun = path, time.monotonic()
        self.process = subprocess.Popen([PROGRAM, "acquire", source, "-o", path, "--json", "--quiet", *map(str, words)],
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options)

    def line(self):
        """The next line as JSON; None at the end."""
        text = self.process.stdout.readline()
        return json.loads(text) if text.endswith("\n") else None

    def finish(self):
        """(exit status, last line of JSON, seconds of the processor, seconds that passed)."""
        last, line = {}, self.line()
        while line is not None:
            last, line = line, self.line()
        _, status, usage = os.wait4(self.process.pid, 0)
        self.process.returncode = os.waitstatus_to_exitcode(status)
        passed = time.monotonic() - self.begun
        self.process.stdout.close()
        self.error = self.process.stderr.read()
        self.process.stderr.close()
        return self.process.returncode, last, usage.ru_utime + usage.ru_stime, passed


def resident_kb(pid):
    """Memory that a process has now."""
    for line in Path(f"/proc/{pid}/status").read_text().splitlines():
        if line.startswith("VmRSS:"):
            return int(line.split()[1])
    return 0


def missing(frames, count):
    """Frames of `count` that a file does not hold."""
    return count - len(frames)


def whole_trial(folder):
    """The rig at its highest rate, two busy loops beside it."""
    seconds, busy = (60, 2) if ALL else (8, 0)
    loops = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(busy)]
    try:
        took = Acquire("sim:rig?clock_ppm=300", folder / "whole.mcap", "--duration", seconds)
        status, last, processor_s, passed_s = took.finish()
    finally:
        for loop in loops:
            loop.kill()
            loop.wait()
    frames, notes = contents(folder / "whole.mcap")
    asked = round(seconds * RATE)
    row(status == 0 and list(frames) == list(range(asked)), f"8 LEDs, 2 cameras, {seconds} s, {busy} busy loops beside: frames", str(asked),
        f"{len(frames)}, exit status {status}")
    worst_us = max(abs(ns - 1e9 * f / RATE) for f, (ns, _) in frames.items()) / 1000
    row(worst_us <= 1, "times against the schedule", "1 us at most", f"{worst_us:.4f} us")
    row(processor_s <= 0.1 * passed_s, "processor", "10 % of a core at most", f"{100 * processor_s / passed_s:.1f} %")
    end = note(notes, "acquisition_end")
    ppm, sd = float(end.get("clock_fast_ppm", "nan")), float(end.get("clock_fast_sd_ppm", "nan"))
    bound = 1 if ALL else 20
    row(abs(ppm - 300) <= bound, f"a clock 300 ppm fast, after {seconds} s", f"within {bound} ppm", f"{ppm:.3f} +- {sd:.3f} ppm")
    row(abs(ppm - 300) <= 4 * sd, "its error in SDs", "4 at most", f"{abs(ppm - 300) / sd:.2f}")
    row(last.get("dropped_here") == 0 and last.get("dropped_by_device") == 0, "dropped by the device, and here", "0, 0",
        f"{last.get('dropped_by_device')}, {last.get('dropped_here')}")


def clock_set_back(folder):
    """The time of day goes back by an hour in mid-recording."""
    (folder / "step.c").write_text(STEP_BACK)
    built = subprocess.run(["cc", "-shared", "-fPIC", "-o", folder / "step.so", folder / "step.c", "-ldl"], check=False)
    if built.returncode != 0:
        row(False, "the time of day set back by 1 h in mid-recording", "a C compiler", "none")
        return
    status, last, _, _ = Acquire("sim:rig?clock_ppm=300", folder / "step.mcap", "--duration", 8,
                                 env={**os.environ, "LD_PRELOAD": str(folder / "step.so")}).finish()
    times = [ns for ns, _ in contents(folder / "step.mcap")[0].values()]
    rising = all(a < b for a, b in zip(times, times[1:]))
    ppm = (last.get("clock") or {}).get("fast_ppm", float("nan"))
    row(status == 0 and rising and abs(ppm - 300) < 20, "the time of day set back by 1 h in mid-recording: times rise, rate found",
        "rise, within 20 ppm", f"{'rise' if rising else 'fall'}, {ppm:.2f} ppm, exit status {status}")


def kills(folder, count):
    """kill -9 at random moments; what is in the file is compared with a recording that was let be."""
    rig, moments = "sim:rig?leds=2&rate=500&seed=3", random.Random(5)
    source = rig + "&speed=40"
    run("acquire", rig + "&fast", "-o", folder / "reference.mcap", "--frames", 80_000, "--quiet", good=(0,))
    reference, _ = contents(folder / "reference.mcap")
    lost = wrong = unrecovered = acknowledged_in_all = 0
    for i in range(count):
        path = folder / f"killed_{i}.mcap"
        took = Acquire(source, path, "--sync", ("background", "never")[i % 2])
        acknowledged = 0
        time.sleep(moments.uniform(0.02, 2.4))  # the pipe holds what is said meanwhile
        took.process.kill()
        took.process.wait()
        said = took.process.stdout.read()
        took.process.stdout.close()
        took.process.stderr.close()
        for line in said[: said.rfind("\n") + 1].splitlines():
            acknowledged = json.loads(line)["acknowledged"]
        if not path.exists():
            continue
        frames, _ = contents(path)
        acknowledged_in_all += acknowledged
        lost += max(0, acknowledged - len(frames))
        wrong += any(reference.get(f) != frame for f, frame in frames.items())
        if frames:
            whole = folder / "whole_again.mcap"
            done = run("recover", path, whole, "--force", "--quiet")
            unrecovered += done.returncode not in (0, 1) or len(contents(whole)[0]) != len(frames)
        path.unlink()
    row(lost == 0 and acknowledged_in_all > 0, f"kill -9 at {count} random moments: acknowledged frames lost", "0", f"{lost} of {acknowledged_in_all}")
    row(wrong == 0, "files with a frame that is not the device's", "0", f"{wrong} of {count}")
    row(unrecovered == 0, "files that recover does not make whole", "0", f"{unrecovered} of {count}")
    cuts = random.Random(6)
    data, short = (folder / "reference.mcap").read_bytes()[:3_000_000], folder / "short.mcap"
    bad = 0
    for _ in range(count):
        short.write_bytes(data[: cuts.randint(2000, len(data))])
        done = run("recover", short, folder / "whole_again.mcap", "--force", "--quiet")
        kept = contents(folder / "whole_again.mcap")[0] if done.returncode in (0, 1) else {}
        bad += not kept or list(kept) != list(range(len(kept))) or any(reference[f] != frame for f, frame in kept.items())
    row(bad == 0, f"cut at {count} random places: not the beginning of what was recorded", "0", f"{bad}")


def stopped_for_a_while(folder):
    """SIGSTOP: the device's second of memory runs over; all that is missing is counted, and nothing else."""
    seconds = 10 if ALL else 3
    took = Acquire("sim:rig", folder / "stopped.mcap", "--duration", seconds + 4)
    took.line()
    os.kill(took.process.pid, signal.SIGSTOP)
    time.sleep(seconds)
    os.kill(took.process.pid, signal.SIGCONT)
    status, last, _, _ = took.finish()
    frames, notes = contents(folder / "stopped.mcap")
    asked = round((seconds + 4) * RATE)
    counted = last.get("dropped_by_device", -1) + last.get("dropped_here", -1)
    expected = (seconds - 1) * RATE
    row(status == 1 and missing(frames, asked) == counted and abs(counted - expected) < 0.3 * RATE, f"SIGSTOP for {seconds} s: missing in the file, counted",
        f"the same, about {expected:.0f}", f"{missing(frames, asked)}, {counted}")
    gaps = sum(int(values["frames"]) for name, values in notes if name == "gap")
    row(gaps == counted, "in the notes on gaps", str(counted), str(gaps))


def full_disk(folder):
    """A file that cannot grow beyond a limit stands for the full disk."""
    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (300_000, 300_000))

    status, last, _, _ = Acquire("sim:rig?fast", folder / "full.mcap", preexec_fn=limit).finish()
    frames, _ = contents(folder / "full.mcap")
    row(status == 4 and last.get("acknowledged") == len(frames) > 1000, "a full disk: exit status, frames acknowledged and in the file", "4, the same",
        f"{status}, {last.get('acknowledged')} and {len(frames)}")


def plug(folder):
    """The plug is pulled for two seconds."""
    status, last, _, _ = Acquire("sim:rig?unplug_at=1&unplug_for=2", folder / "plug.mcap", "--duration", 5).finish()
    frames, _ = contents(folder / "plug.mcap")
    lost = missing(frames, round(5 * RATE))
    row(status == 1 and last.get("reopened") == 1 and lost == last.get("dropped_by_device") and abs(lost - 2 * RATE) < 0.5 * RATE,
        "unplugged for 2 s: goes on in the same file; missing, counted", f"the same, about {2 * RATE:.0f}", f"{lost}, {last.get('dropped_by_device')}")


def memory(folder):
    """A source that is accelerated: memory after one minute's worth and at the end."""
    hours = 10 if ALL else 0.5
    took = Acquire("sim:rig?leds=2&rate=100&fast", folder / "long.mcap", "--frames", round(hours * 360_000), "--sync", "never")
    first, most, line = None, 0, took.line()
    while line is not None and "written" not in line:
        most = max(most, resident_kb(took.process.pid))
        if first is None and line["frames"] >= 6000:
            first = resident_kb(took.process.pid)
        line = took.line()
    status = took.process.wait()
    took.process.stdout.close()
    took.process.stderr.close()
    grown = most - (first or 0)
    row(status == 0 and first is not None and grown <= 1024, f"memory at {hours} hours' worth against the first minute's", "1 MB more at most",
        f"{grown} kB more than {first} kB")
    (folder / "long.mcap").unlink()


def downstream(folder):
    """What was acquired is reconstructed with the rig that the seed draws."""
    run("simulate", "rig", "wheel", "--leds", 8, "--highest-rate", "--seed", 4, "-o", folder / "rig", "--quiet", good=(0,))
    run("acquire", "sim:rig?seed=4&fast", "-o", folder / "wheel.mcap", "--duration", 3, "--quiet", good=(0,))
    done = run("reconstruct", folder / "wheel.mcap", "--rig", folder / "rig" / "rig_true.toml", "-o", folder / "wheel.trc", "--json", "--quiet")
    located = sum(led["located"] for led in json.loads(done.stdout)["leds"]) if done.returncode == 0 else 0
    asked = 8 * round(3 * RATE)
    row(located > 0.95 * asked, "reconstruct of an acquired wheel: LEDs located", f"95 % of {asked}", f"{located}, exit status {done.returncode}")


def crosstalk(seeds):
    """The check-up of rigs with and without an LED that glows on: % of its light in the slot after it, and SD."""
    percent = 1.0
    accused = off = found = 0
    for seed in seeds:
        for planted in (0.0, percent):
            checked = run("acquire", f"sim:rig?scene=sign&dark&fast&seed={seed}&afterglow={planted / 100}", "--check", "--rate", 100, "--json", "--quiet")
            for text in json.loads(checked.stdout.splitlines()[-1])["notes"]:
                named = re.match(r"([\d.]+) \+- ([\d.]+) % of the light of LED 'hand'", text)
                if named is None:
                    continue
                accused += planted == 0.0
                found += planted > 0.0
                off += planted > 0.0 and abs(float(named[1]) - planted) > 4 * float(named[2]) + 0.01  # of two digits
    row(accused == 0, f"crosstalk of {len(seeds)} rigs without any: cameras accused", "0", accused)
    row(found == 2 * len(seeds) and off == 0, f"crosstalk of {percent:g} %: found within 4 SD", f"{2 * len(seeds)} cameras", f"{found} found, {off} beyond")


def main():
    with tempfile.TemporaryDirectory(dir=os.environ.get("KINEMARK_SCRATCH")) as scratch:
        folder = Path(scratch)
        whole_trial(folder)
        stopped_for_a_while(folder)
        full_disk(folder)
        plug(folder)
        kills(folder, 200 if ALL else 6)
        memory(folder)
        downstream(folder)
        crosstalk(range(33601, 33661) if ALL else (1, 2))
        if ALL and shutil.which("cc"):
            clock_set_back(folder)
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
