#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""The menus of `kinemark acquire`, driven as a person would, through tmux: keys in, what stands on the screen out.

From the list of sources to a trial that is kept, one that is discarded, and a rate that is refused, at 80 x 24 and at 200 x 60; a
terminal that is too small gets plain lines; a hang-up in mid-trial keeps it. Prints rows "PASS|FAIL | check | asked | measured"; exit
status 1 when one fails.
"""

import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from rows import PROGRAM, exit_status, row, run

SOURCE = "sim:rig?leds=3&scene=tree"
PATIENCE_S = 60.0


class Screen:
    """A terminal of tmux with the program in it."""

    def __init__(self, folder, columns, rows, *arguments):
        self.socket = folder / "tmux"
        command = " ".join([f"'{PROGRAM}'", "acquire", *(f"'{a}'" for a in arguments)])
        self.tmux("-f", "/dev/null", "new-session", "-d", "-x", str(columns), "-y", str(rows), "-c", str(folder), f"{command}; echo ended $?; exec cat")

    def tmux(self, *arguments, check=True):
        environment = {**os.environ, "LC_ALL": "C.UTF-8", "TERM": "screen"}
        return subprocess.run(["tmux", "-S", self.socket, *arguments], check=check, capture_output=True, text=True, env=environment).stdout

    def text(self):
        return self.tmux("capture-pane", "-p")

    def press(self, *keys):
        self.tmux("send-keys", *keys)

    def sees(self, words):
        """The screen once it shows the words; nothing when it does not in time."""
        until = time.monotonic() + PATIENCE_S
        while time.monotonic() < until:
            text = self.text()
            if words in text:
                return text
            time.sleep(0.05)
        return None

    def close(self):
        self.tmux("kill-server", check=False)


def steps(screen, *pairs):
    """Presses each key and waits for the words; what was not seen, or nothing."""
    for keys, words in pairs:
        if keys:
            screen.press(*keys)
        if screen.sees(words) is None:
            return f"'{words}' did not come after {keys}"
    return ""


def session(columns, rows):
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        screen = Screen(folder, columns, rows)
        try:
            missing = steps(
                screen,
                ((), "q quit"),
                (("o",), "Enter open"),
                (("-l", SOURCE), SOURCE),
                (("Enter",), "Enter start"),
                (("Down", "9", "9", "9"), "999_"),
                (("Enter",), "frames per second at most"),
                (("BSpace", "BSpace", "BSpace", "Enter"), "r record"),
            )
            refused = "" if missing else screen.text()
            missing = missing or steps(screen, (("r",), "RECORDING 01"), (("s",), "came and are kept"), (("k",), "Kept: 01.mcap"))
            missing = missing or steps(screen, (("r",), "RECORDING 02"), (("s",), "k keep"), (("d",), "Discard 02?"))
            time.sleep(1.0)  # as a person who reads the question
            missing = missing or steps(screen, (("y",), "Discarded: 02"))
            missing = missing or steps(screen, (("q",), "ended 0"))
        finally:
            screen.close()
        files = sorted(p.name for p in folder.glob("*.mcap"))
        size = f"{columns} x {rows}"
        row(not missing and files == ["01.mcap"], f"menus at {size}: a refused rate, a kept and a discarded trial", "all steps; 01.mcap", f"{missing or 'all steps'}; {', '.join(files)}")
        row(refused != "" and "frames per second at most" not in refused, f"menus at {size}: the refusal is gone once the rate is mended", "gone", "there" if "frames per second at most" in refused else "gone")
        if files == ["01.mcap"]:
            status = run("info", folder / "01.mcap").returncode
            row(status == 0, f"menus at {size}: the trial is a whole recording", "exit status 0", str(status))


def small():
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        screen = Screen(folder, 60, 15, SOURCE)
        try:
            missing = steps(
                screen,
                ((), "LEDs"),
                (("2", "Enter"), "Rate"),
                (("Enter",), "Duration"),
                (("0.5", "Enter"), "Subject"),
                (("Enter",), "Name of the next trial"),
                (("Enter",), "k keep"),
                (("Enter",), "Kept: 01.mcap"),
                (("q", "Enter"), "ended 0"),
            )
        finally:
            screen.close()
        files = sorted(p.name for p in folder.glob("*.mcap"))
        row(not missing and files == ["01.mcap"], "a terminal of 60 x 15 is asked in lines", "all steps; 01.mcap", f"{missing or 'all steps'}; {', '.join(files)}")


def hang_up():
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        screen = Screen(folder, 80, 24, SOURCE)
        try:
            missing = steps(screen, ((), "Enter start"), (("Enter",), "r record"), (("r",), "RECORDING 01"))
            screen.press("C-c")
            missing = missing or steps(screen, ((), "ended"))
        finally:
            screen.close()
        files = sorted(p.name for p in folder.glob("*.mcap"))
        row(not missing and files == ["01.mcap"], "Ctrl-C in mid-trial keeps it", "01.mcap", f"{missing} {', '.join(files)}".strip())


def main():
    if shutil.which("tmux") is None:
        sys.exit("tmux is absent; tools/setup installs it")
    session(80, 24)
    session(200, 60)
    small()
    hang_up()
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
