#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""An A/D board in a machine of its own: Debian's kernel with its driver comedi_test under QEMU, in which comedi_tool acquires 8 inputs at
1 kHz and reads its analog outputs back.

    comedi_qemu.py [SECONDS [TIMES]]

SECONDS of each of TIMES recordings (default 6 and 3). Downloads the kernel's package by apt-get once, into the build folder. Prints rows
"PASS|FAIL | check | asked | measured"; exit status 1 when one fails.
"""

import gzip
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from rows import PROGRAM, exit_status, row

BIN = Path(PROGRAM).parent
KEPT = BIN.parent / "comedi_kernel"  # the kernel's package, unpacked
RATE_HZ = 1000
PROGRAM_FRAMES = 3000  # that kinemark acquire records
OVERRUN_HZ = 40_000  # 640 kB/s: the kernel's 2 MB run over within 5 s
INIT = """#!/bin/sh
B=/bin/busybox
$B mount -t proc proc /proc; $B mount -t sysfs sys /sys; $B mount -t devtmpfs dev /dev
$B insmod /m/comedi.ko comedi_default_buf_maxsize_kb=2048 && $B insmod /m/comedi_test.ko
/kinemark acquire comedi:/dev/comedi0 -o /tmp/trial.mcap --rate RATE --frames FRAMES --json --quiet
/comedi_tool ARGUMENTS
echo DONE
$B poweroff -f
"""


def kernel():
    """Kernel image and folder of comedi's modules; the package is fetched where it is not kept."""
    if not (KEPT / "boot").exists():
        about = subprocess.run(["apt-cache", "show", "linux-image-amd64"], capture_output=True, text=True, check=True).stdout
        name = re.search(r"^Depends: (\S+)", about, re.MULTILINE)[1]
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run(["apt-get", "-q", "download", name], cwd=folder, check=True, capture_output=True)
            package = next(Path(folder).glob("*.deb"))
            subprocess.run(["dpkg-deb", "-x", package, f"{KEPT}.part"], check=True)
        os.rename(f"{KEPT}.part", KEPT)
    image = next((KEPT / "boot").glob("vmlinuz-*"))
    modules = next((KEPT / "lib/modules").iterdir()) / "kernel/drivers/comedi"
    return image, (modules / "comedi.ko", modules / "drivers/comedi_test.ko")


def make_root(folder, modules, arguments):
    """The machine's files, as an archive for its memory."""
    root = folder / "root"
    for name in ("bin", "dev", "proc", "sys", "m", "tmp"):
        (root / name).mkdir(parents=True)
    shutil.copy("/bin/busybox", root / "bin/busybox")
    (root / "bin/sh").symlink_to("busybox")
    for program in (BIN / "comedi_tool", Path(PROGRAM)):
        shutil.copy(program, root / program.name)
        for library in re.findall(r"(/\S+) \(0x", subprocess.run(["ldd", program], capture_output=True, text=True, check=True).stdout):
            target = root / library[1:]
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(library, target)
    for module in modules:
        shutil.copy(module, root / "m")
    init = root / "init"
    init.write_text(INIT.replace("ARGUMENTS", arguments).replace("RATE", str(RATE_HZ)).replace("FRAMES", str(PROGRAM_FRAMES)))
    init.chmod(0o755)
    names = "\n".join(str(p.relative_to(root)) for p in sorted(root.rglob("*"))) + "\n"
    archive = subprocess.run(["cpio", "-o", "-H", "newc", "--quiet"], cwd=root, input=names.encode(), capture_output=True, check=True).stdout
    out = folder / "root.gz"
    out.write_bytes(gzip.compress(archive, 1))
    return out


def run_machine(folder, seconds, times):
    """What the tool printed, by kind, and how long it all took, s."""
    image, modules = kernel()
    root = make_root(folder, modules, f"{seconds} {times} {OVERRUN_HZ}")
    began = time.monotonic()
    ran = subprocess.run(
        ["qemu-system-x86_64", "-M", "q35", "-accel", "tcg", "-cpu", "max", "-m", "512", "-nographic", "-no-reboot", "-net", "none",
         "-kernel", image, "-initrd", root, "-append", "console=ttyS0 quiet panic=-1"],
        stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace", timeout=300 + 4 * seconds * times, check=False)
    wall_s = time.monotonic() - began
    said = {}
    for line in ran.stdout.splitlines():
        at = line.find('{"')
        if at >= 0:
            one = json.loads(line[at:])
            what = "acquired" if "acknowledged" in one else one.get("what", "error")
            said.setdefault(what, []).append(one)
    if "DONE" not in ran.stdout or "error" in said:
        raise SystemExit(f"the machine did not end as it should: {ran.stdout[-2000:]}{ran.stderr[-500:]}")
    return said, wall_s


def main():
    seconds, times = (int(a) for a in (sys.argv[1:] + ["6", "3"][len(sys.argv) - 1 :])[:2])
    missing = [name for name in ("qemu-system-x86_64", "cpio", "busybox") if shutil.which(name) is None]
    if missing or not (BIN / "comedi_tool").exists():
        print(f"SKIP | comedi under QEMU | qemu-system-x86, busybox-static, cpio, libcomedi-dev | {' '.join(missing) or 'comedi_tool'} absent")
        return 0
    with tempfile.TemporaryDirectory(dir=os.environ.get("KINEMARK_SCRATCH")) as name:
        said, wall_s = run_machine(Path(name), seconds, times)
    board = said["board"][0]
    row(board["cameras"] == 2 and board["listed"] == 1 and "has it; end that first" in board["second"], "comedi_test: a board of two cameras; a second opening is told who has it", "2", f"{board['name']}: {board['second']}")
    acquired = said["acquired"][-1]
    row(acquired.get("ended") == "complete" and acquired["acknowledged"] == PROGRAM_FRAMES and acquired["dropped_by_device"] == acquired["dropped_here"] == 0,
        "kinemark acquire comedi: in the machine", f"{PROGRAM_FRAMES} frames, 0 lost", f"{acquired['acknowledged']} frames, {acquired['dropped_by_device'] + acquired['dropped_here']} lost")
    steady = said["steady"]
    good = [s for s in steady if s["frames"] == s["last"] + 1 >= seconds * RATE_HZ and s["lost"] == s["uneven"] == 0]
    row(len(good) == times, f"8 inputs at 1 kHz, {times} starts and stops of {seconds} s: every sample, in order", f"{times} x {seconds * RATE_HZ} frames",
        ", ".join(f"{s['frames']} frames, {s['lost']} lost, {s['uneven']} out of step" for s in steady))
    misplaced = sum(s["misplaced"] for s in steady)
    row(misplaced == 0, "each input in its place: saw tooth, square wave, six that stand still", "all samples", f"{misplaced} others of {sum(7 * s['frames'] for s in steady)}")
    outputs = said["outputs"][0]
    row(outputs["worst_v"] <= 2e-4 and "11 V on analog output 2; it has -10 to 10 V" in outputs["beyond"], "analog outputs 2 to 7 read back on their inputs; one beyond its range is refused", "within 0.2 mV (16 bits)", f"{1e3 * outputs['worst_v']:.3f} mV")
    stalled = said["stalled"][0]
    row(stalled["lost"] == stalled["uneven"] == stalled["misplaced"] == 0, "a reader stalled for 5 s at 1 kHz: the kernel holds it all", "0 lost", f"{stalled['lost']} lost of {stalled['last'] + 1}")
    over = said["overrun"][0]
    row(over["lost"] > 0 and over["overflow"] and over["gaps"] >= 1 and over["frames"] + over["lost"] == over["last"] + 1 and over["uneven"] <= 1 and over["misplaced"] == 0,
        f"a reader stalled for 5 s at {OVERRUN_HZ / 1000:.0f} kHz: what ran over is counted", "by the wave's phase, within 6 frames", f"{over['lost']} lost in {over['gaps']} gap(s), {over['uneven']} out of step")
    if seconds * times <= 20:
        row(wall_s <= 90, "wall time", "<= 90 s", f"{wall_s:.0f} s")
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
