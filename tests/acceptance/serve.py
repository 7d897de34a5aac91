#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""`kinemark serve` under attack: what is refused, and how long the rightful page takes meanwhile.

    serve.py            attack a server of its own, on a simulated recording
    serve.py --attack KIND PORT   what the attackers run, in processes of their own, until they are ended

Loopback only. Prints rows "PASS|FAIL | check | asked | measured"; exit status 1 when one fails.
"""

import contextlib
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "cli"))

from serving import Server  # noqa: E402

PROGRAM = os.environ.get("KINEMARK_PROGRAM", "build/release/bin/kinemark")
ASKED_MS = 100
REQUESTS = 100  # of the rightful page, during each attack
MOST_MEMORY_MB = 200
MOST_DESCRIPTORS = 400
failed = False


def row(passed, check, asked, measured):
    global failed
    failed = failed or not passed
    print(f"{'PASS' if passed else 'FAIL'} | {check} | {asked} | {measured}", flush=True)


# What the attackers do, each for ever.


def connect(port):
    connection = socket.create_connection(("127.0.0.1", port), timeout=5)
    connection.setblocking(False)
    return connection


def hold(port, count, drip):
    """`count` connections that send nothing, or a letter of a header now and then; those that are closed are opened again."""
    held = [None] * count
    while True:
        for i, connection in enumerate(held):
            try:
                if connection is None:
                    connection = held[i] = connect(port)
                    connection.send(b"GET / HTTP/1.1\r\nX-" if drip else b"")
                elif drip:
                    connection.send(b"a")
                if connection.recv(1) == b"":
                    raise ConnectionResetError
            except BlockingIOError:
                pass
            except OSError:
                if held[i] is not None:
                    held[i].close()
                held[i] = None
        time.sleep(0.05)


def flood(port, data):
    """One request after the other, as fast as it goes."""
    while True:
        with contextlib.suppress(OSError):
            with socket.create_connection(("127.0.0.1", port), timeout=5) as connection:
                connection.sendall(data)
                while connection.recv(65536):
                    pass


def request(port, first="GET / HTTP/1.1", more="", body=b""):
    return f"{first}\r\nHost: 127.0.0.1:{port}\r\n{more}\r\n".encode() + body


ATTACKS = {
    "1,000 connections that say nothing": lambda port: hold(port, 1000, drip=False),
    "300 connections that send a letter at a time": lambda port: hold(port, 300, drip=True),
    "requests without a token": lambda port: flood(port, request(port)),
    "wrong tokens": lambda port: flood(port, request(port, f"GET /?token={'0' * 32} HTTP/1.1")),
    "foreign hosts": lambda port: flood(port, b"GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n"),
    "headers of 1 MB": lambda port: flood(port, request(port, more="X: " + "a" * 1_000_000 + "\r\n")),
    "bodies of 10 MB": lambda port: flood(port, request(port, "POST / HTTP/1.1", "Content-Length: 10000000\r\n", bytes(10_000_000))),
    "noise": lambda port: flood(port, os.urandom(4096) + b"\r\n\r\n"),
}


@contextlib.contextmanager
def attackers(kind, port, count=2):
    running = [subprocess.Popen([sys.executable, __file__, "--attack", kind, str(port)]) for _ in range(count)]
    time.sleep(1.0)  # they are to be at it
    try:
        yield
    finally:
        for one in running:
            one.kill()
            one.wait()


def timed(server, target):
    """(status, milliseconds) of a request on a new connection."""
    begun = time.perf_counter()
    status, _, _ = server.request(target)
    return status, 1000 * (time.perf_counter() - begun)


def memory_mb(pid):
    lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    return int(next(line for line in lines if line.startswith("VmRSS:")).split()[1]) / 1024


def descriptors_of(server):
    return len(os.listdir(f"/proc/{server.process.pid}/fd"))


def check_refusals(server):
    ours, name = f"http://{server.name}", server.name
    socket_asked = {"Connection": "Upgrade", "Upgrade": "websocket", "Sec_WebSocket_Key": "dGhlIHNhbXBsZSBub25jZQ==", "Sec_WebSocket_Version": "13"}
    for check, asked, measured in (
        ("foreign Host", 421, server.request(Host="evil.example")[0]),
        ("no Host", 421, server.request(Host=None)[0]),
        ("our name as part of a foreign one", 421, server.request(Host=f"{name}.evil.example")[0]),
        ("no token", 401, server.request(known=False)[0]),
        ("wrong token", 401, server.request(f"/?token={'0' * 32}", known=False)[0]),
        ("token with a letter changed", 401, server.request(f"/?token={server.token[:-1]}x", known=False)[0]),
        ("POST from a foreign Origin", 403, server.request(method="POST", Origin="http://evil.example")[0]),
        ("POST without Origin", 403, server.request(method="POST")[0]),
        ("POST from our Origin: nothing to change", 405, server.request(method="POST", Origin=ours)[0]),
        ("WebSocket from a foreign Origin", 403, server.request("/trial/1", Origin="http://evil.example", **socket_asked)[0]),
        ("header of 20 kB", 431, server.request(X="a" * 20_000)[0]),
        ("body of 1 MB", 413, server.request(method="POST", body=bytes(1_000_000), Origin=ours)[0]),
        ("/../../etc/passwd", 404, server.request("/../../etc/passwd")[0]),
        ("/%2e%2e/etc/passwd", 404, server.request("/%2e%2e/etc/passwd")[0]),
        ("a file by its name", 404, server.request("/markers.c3d")[0]),
    ):
        row(asked == measured, check, asked, measured)


def check_attack(server, kind):
    page, most = [], 0
    with attackers(kind, server.port):
        for _ in range(REQUESTS):
            most = max(most, descriptors_of(server))
            page.append(timed(server, "/"))
            page.append(timed(server, "/trial/1"))
            time.sleep(0.005)
    good = sum(status == 200 for status, _ in page)
    times = sorted(ms for _, ms in page)
    late = times[int(0.99 * len(times))]
    row(good == len(page) and late <= ASKED_MS and most <= MOST_DESCRIPTORS, f"{kind}: the rightful page meanwhile",
        f"all answered, 99 % within {ASKED_MS} ms; <= {MOST_DESCRIPTORS} descriptors",
        f"{good} of {len(page)}, {late:.1f} ms (median {times[len(times) // 2]:.1f}, longest {times[-1]:.1f}); {most} descriptors")


def check_long_trial(program, scratch):
    """Others are answered while an hour of 16 markers at 240 Hz is read for the list and for its page."""
    long = scratch / "hour"
    long.mkdir()
    make_hour(long / "hour.trc")
    (long / "short.trc").write_bytes((scratch / "recorded/markers.trc").read_bytes())
    with Server(program, long, "--no-open", cwd=scratch) as server:
        server.request("/")
        with server.connect() as waiting:
            waiting.sendall(request(server.port, "GET /trial/1 HTTP/1.1", f"Cookie: {server.exchanged()}\r\n"))
            times, reading = [], 0
            for _ in range(50):
                status, ms = timed(server, "/")
                times.append(ms if status == 200 else 1e9)
                waiting.setblocking(False)
                with contextlib.suppress(BlockingIOError):
                    reading += waiting.recv(1, socket.MSG_PEEK) == b""
                    break
                reading += 1
                time.sleep(0.005)
        row(reading >= 3 and max(times) <= ASKED_MS, "an hour of 16 markers is being read: the list meanwhile", f"<= {ASKED_MS} ms",
            f"{max(times):.1f} ms at most, asked {reading} times")


def make_hour(path):
    """An hour of 16 markers at 240 Hz as TRC, of ten seconds written again and again."""
    markers, rate, frames = 16, 240, 864_000
    head = (f"PathFileType\t4\t(X/Y/Z)\t{path.name}\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\t"
            f"OrigNumFrames\n{rate}\t{rate}\t{frames}\t{markers}\tmm\t{rate}\t1\t{frames}\nFrame#\tTime\t"
            + "\t\t\t".join(f"M{m}" for m in range(markers)) + "\n\t\t"
            + "\t".join(f"{axis}{m + 1}" for m in range(markers) for axis in "XYZ") + "\n\n")  # fmt: skip
    cells = ["\t".join(f"{100 * m + (7 * f + 3 * axis) % 50}.{f % 10}" for m in range(markers) for axis in range(3)) for f in range(2400)]
    with path.open("w") as file:
        file.write(head)
        for f in range(frames):
            file.write(f"{f + 1}\t{f / rate:.6f}\t{cells[f % 2400]}\n")


def main():
    with tempfile.TemporaryDirectory(dir=os.environ.get("KINEMARK_SCRATCH")) as scratch:
        scratch = Path(scratch)
        subprocess.run([PROGRAM, "simulate", "subject", "-o", scratch / "recorded", "--duration", "10", "--quiet"], check=True)
        with Server(PROGRAM, scratch / "recorded", "--no-open", cwd=scratch) as server:
            check_refusals(server)
            for kind in ATTACKS:
                check_attack(server, kind)
            memory = memory_mb(server.process.pid)
            row(memory <= MOST_MEMORY_MB, "memory after all that", f"<= {MOST_MEMORY_MB} MB", f"{memory:.0f} MB")
            before = sorted(path.name for path in scratch.rglob("*"))
            status = server.end(signal.SIGKILL)[0]
            left = sorted(set(path.name for path in scratch.rglob("*")) - set(before))
            row(status == -signal.SIGKILL and not left, "kill -9: files left", "none", ", ".join(left) or "none")
        check_long_trial(PROGRAM, scratch)
    return 1 if failed else 0


if __name__ == "__main__":
    if sys.argv[1:2] == ["--attack"]:
        ATTACKS[sys.argv[2]](int(sys.argv[3]))
    sys.exit(main())
