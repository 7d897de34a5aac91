#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""A recorder killed by kill -9 at 100 random moments loses no acknowledged frame.

    recording_kill.py [FOLDER_OF_PROGRAMS]

recording_acceptance_tool (beside KINEMARK_PROGRAM when no folder is given) records and says which frames were
acknowledged; it is killed after a number of them that a fixed seed gives. What is then in the file is compared frame by
frame, as it is and as `kinemark recover` rewrites it. Prints rows "PASS|FAIL | check | asked | measured".
"""

import os
import random
import subprocess
import sys
import tempfile
from pathlib import Path

from rows import exit_status, row

KILLS = 100
RECOVERED_EVERY = 10
SYNC = ("background", "never", "always")


def record_and_kill(tool, path, sync, lines):
    """Kill the recorder once it has acknowledged `lines` frames or more; how many it had acknowledged by then."""
    with subprocess.Popen([tool, "record", path, sync], stdout=subprocess.PIPE) as recorder:
        said = b""
        while said.count(b"\n") < lines:
            more = os.read(recorder.stdout.fileno(), 256)
            if not more:
                raise RuntimeError(f"the recorder ended by itself, exit status {recorder.wait()}")
            said += more
        recorder.kill()
        said += recorder.stdout.read()
    acknowledged = [int(line) for line in said[: said.rfind(b"\n") + 1].split()]
    if acknowledged != list(range(len(acknowledged))):
        raise RuntimeError("the recorder acknowledged frames out of order")
    return len(acknowledged)


def check(tool, path):
    """(frames in the file, how it ends, the first frame that is wrong or None)."""
    ran = subprocess.run([tool, "check", path], capture_output=True, text=True, check=False)
    if ran.returncode != 0:
        return 0, ran.stderr.strip(), None
    frames, end, wrong = ran.stdout.split()
    return int(frames), end, None if wrong == "none" else int(wrong)


def main():
    program = Path(os.environ.get("KINEMARK_PROGRAM", "build/release/bin/kinemark"))
    tool = (Path(sys.argv[1]) if len(sys.argv) > 1 else program.parent) / "recording_acceptance_tool"
    moments = random.Random(4)
    acknowledged_in_all = lost = wrong = more_than_one = 0
    ends, recovered = {}, []
    with tempfile.TemporaryDirectory(dir=os.environ.get("KINEMARK_SCRATCH")) as scratch:
        for i in range(KILLS):
            sync = SYNC[i % len(SYNC)]
            path = Path(scratch) / f"killed_{i}.mcap"
            acknowledged = record_and_kill(tool, path, sync, moments.randint(1, 60 if sync == "always" else 3000))
            frames, end, first_wrong = check(tool, path)
            acknowledged_in_all += acknowledged
            lost += max(0, acknowledged - frames)
            more_than_one += frames > acknowledged + 1
            wrong += first_wrong is not None
            ends[end] = ends.get(end, 0) + 1
            if i % RECOVERED_EVERY == 0:
                before = path.read_bytes()
                whole = path.with_suffix(".whole.mcap")
                ran = subprocess.run([program, "recover", "--quiet", path, whole], check=False)
                recovered.append(
                    ran.returncode in (0, 1) and check(tool, whole) == (frames, "closed", None) and path.read_bytes() == before
                )
            path.unlink()
    row(lost == 0 and acknowledged_in_all > 100 * KILLS, f"kill -9 at {KILLS} random moments: acknowledged frames lost", "0",
        f"{lost} of {acknowledged_in_all}")
    row(wrong == 0, "files with a frame that is not what was recorded", "0", f"{wrong} of {KILLS}")
    row(more_than_one == 0, "files with more than one frame beyond the acknowledged ones", "0", f"{more_than_one} of {KILLS}")
    row(set(ends) <= {"open", "cut"}, "how the files end", "open or cut", ", ".join(f"{n} {end}" for end, n in sorted(ends.items())))
    row(recovered and all(recovered), "recovered: closed, the same frames, original untouched", f"{len(recovered)}", f"{sum(recovered)}")
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
