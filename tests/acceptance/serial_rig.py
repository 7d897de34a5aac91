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
import signal
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
RIGS = range(101, 113)
LONG_S = 30
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


def record(line, out, leds, frames, rate=0.0, dark=0, trigger=0, level=1.0):
    return json.loads(tool("record", line, out, leds, frames, rate, dark, trigger, level))


@contextlib.contextmanager
def host_of(one, out, *plan):
    """A recording that runs: LEDs, frames, rate and, where they are said, dark, trigger, level."""
    words = [*plan, 0, 0, 1] if len(plan) == 3 else plan
    with subprocess.Popen([BIN / "serial_rig_tool", "record", one.line, out, *map(str, words)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as host:
        while "started" not in (line := host.stderr.readline()):
            if not line:
                raise SystemExit(f"the recording ended by itself: {host.stdout.read()}")
        yield host


def counts_of(path):
    """Counts of a recording, frame by frame, as text that can be compared."""
    return tool("print", path).splitlines()


def simulate(folder, seed, *words):
    output("simulate", "rig", "wheel", "-o", folder, "--seed", seed, "--quiet", *CHIP, *words)


def differing(got, numbers, truth):
    return sum(mine != truth[n % len(truth)] for mine, n in zip(got, numbers, strict=True))


def check_counts(folder, seconds):
    """8 LEDs and a dark slot at the highest rate: every count, every conversion's time."""
    simulate(folder / "eight", SEED, "--leds", "8", "--dark-slot", "--highest-rate", "--duration", max(seconds, 0.5))
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


def check_program(folder):
    """The program itself, by the address that its list shows."""
    simulate(folder / "two", SEED, "--leds", "2", "--rate", 100, "--duration", 1)
    truth = counts_of(folder / "two/recording.mcap")
    with chip(folder, folder / "two/recording.mcap") as one:
        said = json.loads(output("acquire", f"serial:{one.line}", "-o", folder / "two.mcap", "--leds", "2", "--rate", 100, "--frames", len(truth), "--json", "--quiet").splitlines()[-1])
    got = counts_of(folder / "two.mcap")
    wrong = differing(got, range(len(got)), truth)
    row(wrong == 0 and len(got) == said["acknowledged"] == len(truth) and said["dropped_by_device"] == said["dropped_here"] == 0,
        "kinemark acquire serial: every count is the model's", f"{len(truth)} frames, 0 lost", f"{len(got) - wrong}, {said['dropped_by_device'] + said['dropped_here']} lost")


def diameter_of(counts, scan, folder):
    """Error of the wheel's diameter and its SD, mm, by a rig that is calibrated from a scan."""
    output("calibrate", scan, "--nominal", folder / "rig_nominal.toml", "--method", "scan", "-o", folder / "rig.toml", "--quiet")
    output("reconstruct", counts, "--rig", folder / "rig.toml", "--method", "frames", "-o", folder / "wheel.csv", "--quiet")
    found = json.loads(output("analyze", folder / "wheel.csv", "--json", "--quiet"))
    diameter = next(m for m in found["measures"] if m["measure"] == "circle_diameter")
    return diameter["value"] - WHEEL_MM, diameter["sd"]


def check_wheel(folder, seconds):
    """One LED on the wheel: its diameter by what the chip recorded."""
    lab = folder / "wheel"
    simulate(lab, SEED, "--rate", "100", "--duration", max(seconds, 2.2), "--scan")
    frames = len(counts_of(lab / "recording.mcap"))
    with chip(folder, lab / "recording.mcap") as one:
        said = record(one.line, folder / "wheel.mcap", 1, frames, rate=100.0)
    # The recording of the chip does not say where the stage stood; its counts are those of the one that does.
    through, scan = seconds >= LONG_S, lab / "scan.mcap"
    if through:
        simulated, by_chip = counts_of(scan), folder / "scan.mcap"
        with chip(folder, scan) as one:
            record(one.line, by_chip, 1, len(simulated), rate=100.0)
        row(counts_of(by_chip) == simulated, "the scan by the motor stage, through the chip: every count", f"{len(simulated)} frames", "the same")
    error, sd = diameter_of(folder / "wheel.mcap", scan, lab)
    row(abs(error) <= TIMES_SD * sd and said["lost"] == 0, "wheel of 1986 by the chip, calibrated by a scan of 10 bits: diameter", f"{WHEEL_MM:g} mm within {TIMES_SD:g} SD",
        f"{WHEEL_MM + error:.3f} mm, SD {sd:.3f}: {abs(error) / sd:.2f} SD")
    if through:
        found = []
        for seed in RIGS:
            lab = folder / f"wheel{seed}"
            simulate(lab, seed, "--rate", "100", "--scan")
            found.append(diameter_of(lab / "recording.mcap", lab / "scan.mcap", lab))
        times = (sum((error / sd) ** 2 for error, sd in found) / len(found)) ** 0.5
        row(times <= TIMES_SD, f"the same of {len(found)} other rigs, whose counts are the chip's: RMS error", f"<= {TIMES_SD:g} SD", f"{times:.2f} SD, largest {max(abs(e / s) for e, s in found):.2f}")


def check_faults(folder, seconds):
    """Bytes lost, doubled and swapped."""
    counts = folder / "eight/recording.mcap"
    truth = counts_of(counts)
    frames = max(240, int(60 * seconds))
    with chip(folder, counts, "--spoil", "7") as one:
        said = spoilt_record(one, folder, frames)
        pins = one.end()
    wrong = differing(counts_of(folder / "spoilt.mcap"), said["numbers"], truth)
    row(wrong == 0 and said["frames"] + said["lost"] == said["last"] + 1 and said["last"] < pins["frames"], f"9 of 1,000 bytes lost, doubled or swapped, {said['last'] + 1} frames: whole ones are as sent, the others counted",
        f"{said['last'] + 1} frames", f"{said['frames']} whole, {said['lost']} lost, {wrong} wrong")


def check_stall(folder):
    """The host is stopped (SIGSTOP) while the chip goes on for 5 s: 108 kB, of which a USB bridge keeps 4."""
    with chip(folder, folder / "eight/recording.mcap") as one:
        with host_of(one, folder / "stalled.mcap", 1, 6000, 900) as host:
            host.send_signal(signal.SIGSTOP)
            one.tell("ahead 5")
            host.send_signal(signal.SIGCONT)
            said = json.loads(host.communicate(timeout=120)[0])
        pins = one.end()
    row(4000 <= said["lost"] <= 4500 and said["frames"] + said["lost"] == said["last"] + 1 <= pins["frames"], "a host that stands still for 5 s while the chip goes on: losses counted",
        "all of 6,000 frames", f"{said['frames']} came, {said['lost']} counted lost in {said['gaps']} gap(s)")


def spoilt_record(one, folder, frames):
    """Commands are spoilt by nobody, answers may be: a host asks again."""
    for _ in range(20):
        ran = subprocess.run([BIN / "serial_rig_tool", "record", one.line, folder / "spoilt.mcap", "8", str(frames), "0", "1", "0", "1"], capture_output=True, text=True, timeout=600, check=False)
        if ran.returncode == 0:
            return json.loads(ran.stdout)
    raise SystemExit(f"spoilt line: {ran.stdout}{ran.stderr}")


def check_plug(folder):
    with chip(folder, folder / "eight/recording.mcap", "--real-time") as one:
        with host_of(one, folder / "pulled.mcap", 4, 800, 200) as host:
            time.sleep(0.5)
            one.tell("unplug")
            time.sleep(0.5)
            one.tell("plug")
            text, _ = host.communicate(timeout=120)
        said = json.loads(text)
    jumps = [b - a for a, b in zip(said["numbers"], said["numbers"][1:], strict=False) if b != a + 1]
    row(said["failures"] == 1 and len(jumps) == 1 and 60 <= said["lost"] <= 400 and said["frames"] + said["lost"] == said["last"] + 1,
        "the plug pulled for half a second and put in again: the same recording goes on", "one gap of 100 frames and the chip's start", f"{len(jumps)} gap of {said['lost']} frames, {said['frames']} recorded")


def check_holders(folder, times):
    with chip(folder, folder / "eight/recording.mcap") as one:
        left = tool("open", one.line, times)
        row(left == "0", f"{times} openings and closings, a tenth of them running: handles left", "0", left)
        refused = tool("refuse", one.line, 8, 200, good=(2,))
        row("highest rate is 121.1 Hz" in refused, "8 LEDs at 200 Hz: refused with the highest", "121.1 Hz", refused)
        with subprocess.Popen([BIN / "serial_rig_tool", "hold", one.line], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as first:
            first.stdout.readline()
            said = tool("refuse", one.line, 1, 100, good=(5,))
            first.stdin.close()
        row(f"serial_rig_tool (process {first.pid}) has it" in said, "two programs on one device: the second hears who has it", "name and process", said)


def check_trigger(folder):
    with chip(folder, folder / "eight/recording.mcap") as one:
        with host_of(one, folder / "triggered.mcap", 2, 20, 100, 0, 1, 0.5) as host:
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
        check_program(folder)
        check_wheel(folder, seconds)
        check_faults(folder, seconds)
        check_stall(folder)
        check_plug(folder)
        check_holders(folder, 1000 if seconds >= LONG_S else 200)
        check_trigger(folder)
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
