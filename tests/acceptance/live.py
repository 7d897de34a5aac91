#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""A live source at 240 Hz with 40 markers and two viewers, one of them slow: what is recorded, dropped, and how late frames are.

    live.py [SECONDS [SEED]]

Loopback only. Prints rows "PASS|FAIL | check | asked | measured"; exit status 1 when one fails.
"""

import json
import os
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "cli"))

from live_viewer import Ended, Viewer  # noqa: E402
from serving import Server  # noqa: E402
from rows import PROGRAM, exit_status, row

RATE = 240
ASKED_MS = 5.0
SLOW_PER_SECOND = 30  # messages that the slow viewer takes


class Watching(threading.Thread):
    """Takes messages until the server ends the connection; keeps (frame, dropped, age in ms) of each frame of markers."""

    def __init__(self, server, pause_s=0.0):
        super().__init__(daemon=True)
        self.viewer, self.pause_s, self.frames, self.end = Viewer(server), pause_s, [], None

    def run(self):
        try:
            while True:
                kind, head, _ = self.viewer.hear()
                if kind == 1:
                    # due_s is by the clock that time.monotonic() is too, as both run on this machine.
                    self.frames.append((head["frame"], head["dropped"], 1e3 * (time.monotonic() - head["due_s"])))
                time.sleep(self.pause_s)
                self.viewer.drawn()
        except Ended as end:
            self.end = end


def at_share(values, share):
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))]


def memory_kb(process):
    """The most that a process has held so far."""
    status = Path(f"/proc/{process.pid}/status").read_text()
    return int(next(line for line in status.splitlines() if line.startswith("VmHWM")).split()[1])


def most_held(scratch, seconds):
    """kB that a server of a simulation of so many seconds has held when 200 frames have come."""
    with Server(PROGRAM, f"sim:walk?rate={RATE}&seconds={seconds}", "--no-open", cwd=scratch) as server:
        while json.loads(server.request("/api/live")[2])["frames"] < 200:
            time.sleep(0.05)
        return memory_kb(server.process)


def main(seconds, seed):
    with tempfile.TemporaryDirectory(dir=os.environ.get("KINEMARK_SCRATCH")) as scratch:
        source = f"sim:walk?rate={RATE}&seconds={seconds}&missing=0.02"
        frames = round(RATE * seconds)
        with Server(PROGRAM, source, "--record", "live.mcap", "--seed", str(seed), "--no-open", cwd=scratch) as server:
            fast, slow = Watching(server), Watching(server, 1 / SLOW_PER_SECOND)
            fast.start()
            slow.start()
            state = viewers = None
            while state is None or not state["ended"]:
                time.sleep(0.25)
                state = json.loads(server.request("/api/live")[2])
                viewers = state["viewers"] if len(state["viewers"]) == 2 else viewers
            fast.join(60)
            slow.join(60)
        said = subprocess.run([PROGRAM, "info", "live.mcap", "--json"], cwd=scratch, capture_output=True, text=True, check=True)
        facts = json.loads(said.stdout)
        row(facts["frames"] == frames and state["recorded"] == frames and not facts["warnings"], f"{seconds:g} s at {RATE} Hz: frames in the recording",
            f"{frames}, no remark", f"{facts['frames']}, {len(facts['warnings'])} remarks")
        first, last = fast.frames[0][0], fast.frames[-1][0]
        numbers = [f for f, _, _ in fast.frames]
        row(last == frames - 1 and numbers == list(range(first, frames)) and fast.frames[-1][1] == 0, "the fast viewer: frames received",
            "all since it came, none dropped", f"{len(numbers)} of {frames - first}, {fast.frames[-1][1]} dropped")
        numbers = [f for f, _, _ in slow.frames]
        gaps = numbers[-1] - numbers[0] + 1 - len(numbers)
        dropped = slow.frames[-1][1] - slow.frames[0][1]
        ages = [age for _, _, age in slow.frames]
        row(numbers == sorted(set(numbers)) and numbers[-1] == frames - 1 and dropped == gaps > 0, "the slow viewer: what it did not get is counted",
            "as many as are missing between its first and last frame, which is the newest", f"{dropped} counted, {gaps} missing, last {numbers[-1]} of {frames - 1}")
        # What waits at the pace of this viewer, and the time by which messages are ahead of what is drawn.
        most_s = 32 / SLOW_PER_SECOND + 1.0
        row(at_share(ages, 0.99) < 1e3 * most_s, "the slow viewer: how old its frames are, 99 %", f"< {most_s:.1f} s, however long it goes on",
            f"{at_share(ages, 0.99) / 1e3:.2f} s (half {at_share(ages, 0.5) / 1e3:.2f})")
        ages = [age for _, _, age in fast.frames]
        # Of two viewers the fast one is who dropped nothing.
        socket_ms = min(viewers, key=lambda v: v["dropped"])["to_socket_ms"]
        row(socket_ms["p99"] < ASKED_MS, "from due to the socket, 99 %", f"< {ASKED_MS:g} ms",
            f"{socket_ms['p99']:.2f} ms (half {socket_ms['p50']:.2f}, longest {socket_ms['longest']:.1f}); at the viewer {at_share(ages, 0.99):.2f} ms")
        minute, hours = most_held(scratch, 60), most_held(scratch, 36_000)
        row(hours < 1.1 * minute, "memory for a simulation of 10 hours beside one of a minute", "< 1.1 times", f"{hours / minute:.2f} times ({hours / 1024:.0f} MB)")
    return exit_status()


if __name__ == "__main__":
    sys.exit(main(float(sys.argv[1]) if len(sys.argv) > 1 else 30.0, int(sys.argv[2]) if len(sys.argv) > 2 else 1))
