#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""The rig on a microcontroller: its firmware in simavr, its serial line on a pseudo-terminal, its pins driven by the detector model of
`simulate rig --bits 10`.

    serial_rig.py [SECONDS]

SECONDS of the chip's time for each recording (default 2, then calibrations are taken as they were simulated; from 30 on they go through
the chip as well). Prints rows "PASS|FAIL | check | asked | measured"; exit status 1 when one fails.
"""

import contextlib
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from rows import PROGRAM, exit_status, output, row

BIN = Path(PROGRAM).parent
WHEEL_MM = 392.0
TIMES_SD = 1.2
HOLD_S = 8e-6  # from the start of a conversion to its sample
START_S = 6e-6  # what interrupts may move a start by
SEED = 5
CHIP = ("--bits", "10", "--conversion", "64")


class Chip:
    """The firmware, running, with a recording at its pins."""

    def __init__(self, folder, counts, *options):
        self.line = folder / "line"
        self.process = subprocess.Popen([BIN / "rig328p_emulator", BIN / "rig328p.elf", counts, self.line, *options],
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self._wait_for("ready")

    def _wait_for(self, word):
        for line in self.process.stdout:
            if line.strip() == word:
                return
        raise SystemExit("the emulator ended by itself")

    def tell(self, word):
        self.process.stdin.write(word + "\n")
        self.process.stdin.flush()
        self._wait_for("ok")

    def end(self):
        """What its pins did."""
        said, _ = self.process.communicate("end\n", timeout=60)
        return json.loads(said.strip().splitlines()[-1])


@contextlib.contextmanager
def chip(folder, counts, *options):
    one = Chip(folder, counts, *options)
    try:
        yield one
    finally:
        if one.process.poll() is None:
            one.process.kill()
            one.process.wait()


def tool(*words, good=(0,)):
    ran = subprocess.run([BIN / "serial_rig_tool", *map(str, words)], capture_output=True, text=True, timeout=1500, check=False)
    if ran.returncode not in good:
        raise SystemExit(f"serial_rig_tool {' '.join(map(str, words))}: {ran.stdout}{ran.stderr}")
    return ran.stdout.strip()


def record(line, out, leds, frames, rate=0.0, dark=0, trigger=0, level=1.0, stall=0.0):
    return json.loads(tool("record", line, out, leds, frames, rate, dark, trigger, level, stall))


def counts_of(path):
    """Counts of a recording, frame by frame, as text that can be compared."""
    return tool("print", path).splitlines()


def simulate(folder, *words):
    output("simulate", "rig", "wheel", "-o", folder, "--seed", SEED, "--quiet", *CHIP, *words)


def differing(got, numbers, truth):
    return sum(mine != truth[n % len(truth)] for mine, n in zip(got, numbers, strict=True))


def check_counts(folder, seconds):
    """8 LEDs and a dark slot at the highest rate: every count, every conversion's time."""
    simulate(folder / "eight", "--leds", "8", "--dark-slot", "--highest-rate", "--duration", max(seconds, 0.5))
    truth = counts_of(folder / "eight/recording.mcap")
    with chip(folder, folder / "eight/recording.mcap") as one:
        said = record(one.line, folder / "eight.mcap", 8, len(truth), dark=1)
        pins = one.end()
    wrong = differing(counts_of(folder / "eight.mcap"), said["numbers"], truth)
    row(wrong == 0 and said["frames"] == len(truth) and said["lost"] == 0, f"8 LEDs, dark slot, {said['rate_hz']:.1f} Hz, {len(truth) / said['rate_hz']:.0f} s of the chip: every count is the model's",
        f"{len(truth)} frames", f"{said['frames'] - wrong}, {said['lost']} lost")
    times = said["times_s"] + said["dark_s"]
    off = max(abs(t - (times[8 * slot + channel] - HOLD_S)) for slot, channel, *both in pins["conversions"] for t in both)
    row(len(pins["conversions"]) == len(times) == 72 and off <= START_S, "conversions begin when the granted plan says", f"within {1e6 * START_S:.0f} us", f"{1e6 * off:.1f} us at most, of {len(times)}")
    row(pins["two_lit"] == 0, "no two LEDs lit at once", "0", f"{pins['two_lit']}")


def check_wheel(folder, seconds):
    """One LED on the wheel: its diameter by what the chip recorded."""
    simulate(folder / "wheel", "--rate", "100", "--duration", max(seconds, 2.2), "--scan")
    through = seconds >= 30
    scan = folder / "wheel/scan.mcap"
    with chip(folder, folder / "wheel/recording.mcap") as one:
        frames = len(counts_of(folder / "wheel/recording.mcap"))
        said = record(one.line, folder / "wheel.mcap", 1, frames, rate=100.0)
        one.end()
    if through:
        with chip(folder, scan) as one:
            record(one.line, folder / "scan_by_chip.mcap", 1, len(counts_of(scan)), rate=100.0)
            one.end()
        row(counts_of(folder / "scan_by_chip.mcap") == counts_of(scan), "the scan by the motor stage through the chip: every count", "as simulated", f"{len(counts_of(scan))} frames")
    output("calibrate", scan, "--nominal", folder / "wheel/rig_nominal.toml", "--method", "scan", "-o", folder / "rig.toml", "--quiet")
    output("reconstruct", folder / "wheel.mcap", "--rig", folder / "rig.toml", "--method", "frames", "-o", folder / "wheel.csv", "--quiet")
    found = json.loads(output("analyze", folder / "wheel.csv", "--json", "--quiet"))
    diameter = next(m for m in found["measures"] if m["measure"] == "circle_diameter")
    error, sd = abs(diameter["value"] - WHEEL_MM), diameter["sd"]
    row(error <= TIMES_SD * sd and said["lost"] == 0, f"wheel of 1986 by the chip, calibrated by a scan of 10 bits{' through the chip' if through else ''}: diameter", f"{WHEEL_MM:g} mm within {TIMES_SD:g} SD",
        f"{diameter['value']:.3f} mm, SD {sd:.3f}: {error / sd:.2f} SD")


def check_faults(folder, seconds):
    """Bytes lost, doubled and swapped; a host that sleeps; a plug that is pulled."""
    counts = folder / "eight/recording.mcap"
    truth = counts_of(counts)
    frames = max(240, int(60 * seconds))
    with chip(folder, counts, "--spoil", "7") as one:
        said = spoilt_record(one, folder, frames)
        pins = one.end()
    wrong = differing(counts_of(folder / "spoilt.mcap"), said["numbers"], truth)
    row(wrong == 0 and said["frames"] + said["lost"] == said["last"] + 1 and said["last"] < pins["frames"], f"9 of 1,000 bytes lost, doubled or swapped, {said['last'] + 1} frames: whole ones are as sent, the others counted",
        f"{said['last'] + 1} frames", f"{said['frames']} whole, {said['lost']} lost, {wrong} wrong")
    with chip(folder, counts, "--real-time") as one:
        said = record(one.line, folder / "stalled.mcap", 2, 1500, rate=200.0, stall=5.0)
        pins = one.end()
    row(said["lost"] > 0 and said["frames"] + said["lost"] == 1500 and pins["frames"] >= 1500, "a host that stalls for 5 s while the line goes on: losses counted",
        "1500 frames", f"{said['frames']} came, {said['lost']} counted lost in {said['gaps']} gap(s)")


def spoilt_record(one, folder, frames):
    """Commands are spoilt by nobody, answers may be: a host asks again."""
    for _ in range(20):
        ran = subprocess.run([BIN / "serial_rig_tool", "record", one.line, folder / "spoilt.mcap", "8", str(frames), "0", "1", "0", "1"], capture_output=True, text=True, timeout=600, check=False)
        if ran.returncode == 0:
            return json.loads(ran.stdout)
    raise SystemExit(f"spoilt line: {ran.stdout}{ran.stderr}")


def check_plug(folder):
    counts = folder / "eight/recording.mcap"
    truth = counts_of(counts)
    with chip(folder, counts, "--real-time") as one:
        with subprocess.Popen([BIN / "serial_rig_tool", "record", one.line, folder / "pulled.mcap", "4", "800", "200", "0", "0", "1"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as host:
            while "started" not in host.stderr.readline():
                pass
            time.sleep(0.5)
            one.tell("unplug")
            time.sleep(0.5)
            one.tell("plug")
            text, _ = host.communicate(timeout=120)
        said = json.loads(text)
    del truth
    jumps = [b - a for a, b in zip(said["numbers"], said["numbers"][1:], strict=False) if b != a + 1]
    row(said["failures"] == 1 and len(jumps) == 1 and 60 <= said["lost"] <= 400 and said["frames"] + said["lost"] == said["last"] + 1,
        "the plug pulled for half a second and put in again: the same recording goes on", "one gap of 100 frames and the chip's start", f"{len(jumps)} gap of {said['lost']} frames, {said['frames']} recorded")


def check_holders(folder):
    with chip(folder, folder / "eight/recording.mcap") as one:
        left = tool("open", one.line, 1000)
        row(left == "0", "1,000 openings and closings, 100 of them running: handles left", "0", left)
        refused = tool("refuse", one.line, 8, 200, good=(2,))
        row("highest rate is 121.1 Hz" in refused, "8 LEDs at 200 Hz: refused with the highest", "121.1 Hz", refused)
        with subprocess.Popen([BIN / "serial_rig_tool", "hold", one.line], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as first:
            first.stdout.readline()
            told = tool("refuse", one.line, 1, 100, good=(5,))
            first.stdin.close()
        row(f"serial_rig_tool (process {first.pid}) has it" in told, "two programs on one device: the second is told who has it", "name and process", told)


def check_trigger(folder):
    with chip(folder, folder / "eight/recording.mcap") as one:
        with subprocess.Popen([BIN / "serial_rig_tool", "record", one.line, folder / "triggered.mcap", "2", "20", "100", "0", "1", "0.5"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as host:
            while "started" not in host.stderr.readline():
                pass
            one.tell("trigger")
            text, _ = host.communicate(timeout=60)
        said, pins = json.loads(text), one.end()
    row(said["frames"] == 20 and said["lost"] == 0 and [pins["levels"]["0"], pins["levels"]["1"]] == [128, 121], "started by the digital line, LEDs dimmed to 0.5 and 0.475", "levels 128 and 121", f"{pins['levels']}, {said['frames']} frames")


def main():
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 2.0
    if not (BIN / "rig328p_emulator").exists():
        print("SKIP | the firmware in simavr | gcc-avr and libsimavr-dev | absent")
        return 0
    with tempfile.TemporaryDirectory(dir=os.environ.get("KINEMARK_SCRATCH")) as name:
        folder = Path(name)
        check_counts(folder, seconds)
        check_wheel(folder, seconds)
        check_faults(folder, seconds)
        check_plug(folder)
        check_holders(folder)
        check_trigger(folder)
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
