# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""The same bits for any number of threads, and signals during long work."""

import signal
import subprocess
import time
import unittest

from support import PROGRAM, SECONDS, CommandTest, listing


class SameBits(CommandTest):
    def test_one_and_two_threads(self):
        for threads in (1, 2):
            folder = self.folder / str(threads)
            options = ["--duration", 2, "--soft-tissue", 1, "--dropout-random", 0.1, "--threads", threads]
            self.good("simulate", "subject", "-o", folder, *options)
            self.good(*self.ik(output=folder / "q.mot", threads=threads))
        one, two = (listing(self.folder / name) for name in "12")
        self.assertEqual(one.keys(), two.keys())
        for name in one:
            if not name.endswith("_report.json"):  # tells the time that it took
                self.assertEqual(one[name], two[name], name)


class Signals(CommandTest):
    def interrupt(self, number, folder, *arguments):
        """Sends a signal as soon as the work shows its hidden folder; (exit status, words)."""
        program = subprocess.Popen(
            [PROGRAM, *map(str, arguments)], cwd=self.folder, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL
        )
        try:
            end = time.monotonic() + SECONDS
            while not list(folder.glob(".kinemark-*")):
                self.assertIsNone(program.poll(), "the program ended before it could be stopped")
                self.assertLess(time.monotonic(), end)
                time.sleep(0.002)
            program.send_signal(number)
            _, said = program.communicate(timeout=SECONDS)
        finally:
            program.kill()
            program.wait()
        return program.returncode, said.decode()

    def test_long_work_stops_and_leaves_nothing(self):
        # Long enough that the signal comes seconds before the end, on any machine.
        self.good("simulate", "subject", "-o", "long", "--duration", 100, "--quiet")
        before = listing(self.folder)
        job = self.ik(markers="long/markers.c3d", model="long/model.osim", threads=1)
        for number, status in ((signal.SIGINT, 130), (signal.SIGTERM, 143)):
            returned, said = self.interrupt(number, self.folder, *job, "--quiet")
            self.assertEqual(returned, status, said)
            self.assertRegex(said, r"^kinemark: the command was stopped \(SIG(INT|TERM)\)\n$")
            self.assertEqual(listing(self.folder), before)

    def test_a_simulation_stops_and_leaves_no_folder(self):
        (self.folder / "new").mkdir()
        returned, said = self.interrupt(
            signal.SIGINT, self.folder / "new", "simulate", "subject", "-o", "new", "--duration", 100
        )
        self.assertEqual(returned, 130, said)
        self.assertIn("the command was stopped (SIGINT)", said)
        self.assertEqual(list(listing(self.folder)), ["new"])


if __name__ == "__main__":
    unittest.main()
