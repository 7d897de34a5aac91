#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""`kinemark serve` under attack: what is refused, and how long the rightful page takes meanwhile.

    serve.py            attack a server of its own, on a simulated recording
    serve.py sockets    attack the WebSocket of a live source
    serve.py tls        attack a server with a certificate, which openssl makes
    serve.py --attack TABLE KIND PORT SESSION   what the attackers run, in processes of their own, until they are ended

Loopback only. Prints rows "PASS|FAIL | check | asked | measured"; exit status 1 when one fails.
"""

import contextlib
import os
import signal
import socket
import ssl
import struct
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

ASKED_MS = 100
REQUESTS = 100  # of the rightful page, during each attack
MOST_MEMORY_MB = 200
MOST_DESCRIPTORS = 400


# What the attackers do, each for ever.


def connect(port):
    connection = socket.create_connection(("127.0.0.1", port), timeout=5)
    connection.setblocking(False)
    return connection


def hold(port, count, drip, begin=b"GET / HTTP/1.1\r\nX-"):
    """`count` connections that send nothing, or begin and send a letter now and then; those that are closed are opened again."""
    held = [None] * count
    while True:
        for i, connection in enumerate(held):
            try:
                if connection is None:
                    connection = held[i] = connect(port)
                    connection.send(begin if drip else b"")
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


UPGRADE = "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"


def upgrade(port, more="", session=""):
    return request(port, f"GET {session}/live/socket HTTP/1.1", UPGRADE + more)


def known(port, session):
    return upgrade(port, f"Origin: http://127.0.0.1:{port}\r\n", session)


def hold_asked(port, count, asked):
    """`count` connections that ask at once and read nothing; those that are closed are opened again."""
    held = [None] * count
    while True:
        for i, connection in enumerate(held):
            try:
                if connection is None:
                    held[i] = connect(port)
                    held[i].send(asked)
                elif connection.recv(1, socket.MSG_PEEK) == b"":
                    raise ConnectionResetError
            except BlockingIOError:
                pass
            except OSError:
                if held[i] is not None:
                    held[i].close()
                held[i] = None
        time.sleep(0.05)


def flood_socket(port, session, message):
    """A WebSocket that is let in and then sends this, over and over."""
    while True:
        with contextlib.suppress(OSError):
            with socket.create_connection(("127.0.0.1", port), timeout=5) as connection:
                connection.sendall(known(port, session))
                connection.recv(1024)
                while True:
                    connection.sendall(message)


def frame(kind, size):
    """A masked frame of so many zeros."""
    return bytes([0x80 | kind, 0xFF]) + struct.pack(">Q", size) + b"mask" + bytes(size)


# On the WebSocket of a live source, by two attackers each; the last of them know the secret.
SOCKET_ATTACKS = {
    "1,000 WebSockets without a token": lambda port, _: hold_asked(port, 500, upgrade(port, f"Origin: http://127.0.0.1:{port}\r\n")),
    "WebSockets without a token, one after the other": lambda port, _: flood(port, upgrade(port, f"Origin: http://127.0.0.1:{port}\r\n")),
    "WebSockets from a foreign Origin": lambda port, session: flood(port, upgrade(port, "Origin: http://evil.example\r\n", session)),
    "300 upgrades that send a letter at a time": lambda port, _: hold(port, 300, True, upgrade(port)[:-2] + b"X-"),
    "1,000 connections that say nothing": lambda port, _: hold(port, 1000, drip=False),
    "messages of 10 MB over WebSockets": lambda port, session: flood_socket(port, session, frame(2, 10_000_000)),
    "pings without end": lambda port, session: flood_socket(port, session, frame(9, 100) * 1000),
    "4 viewers that never read": lambda port, session: hold_asked(port, 4, known(port, session)),
}


def flood_handshakes(port):
    """One whole handshake after the other, and nothing asked."""
    context = ssl.create_default_context()
    context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
    while True:
        with contextlib.suppress(OSError):
            with socket.create_connection(("127.0.0.1", port), timeout=5) as connection, context.wrap_socket(connection):
                pass


# On a server with a certificate.
TLS_ATTACKS = {
    "300 handshakes that send a letter at a time": lambda port: hold(port, 300, True, b"\x16\x03\x01\x02\x00\x01"),
    "1,000 connections that say nothing": lambda port: hold(port, 1000, drip=False),
    "handshakes one after the other": flood_handshakes,
    "plain HTTP": lambda port: flood(port, request(port)),
    "noise": lambda port: flood(port, os.urandom(4096)),
}
TABLES = {"pages": ATTACKS, "sockets": SOCKET_ATTACKS, "tls": TLS_ATTACKS}


@contextlib.contextmanager
def attackers(table, kind, port, count=2, session=""):
    running = [subprocess.Popen([sys.executable, __file__, "--attack", table, kind, str(port), session]) for _ in range(count)]
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


def check_attack(server, kind, table="pages"):
    page, most = [], 0
    with attackers(table, kind, server.port):
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
            waiting.sendall(request(server.port, f"GET {server.exchanged()}/trial/1 HTTP/1.1"))
            times, reading = [], 0
            for _ in range(REQUESTS):
                status, ms = timed(server, "/")
                times.append(ms if status == 200 else 1e9)
                waiting.setblocking(False)
                with contextlib.suppress(BlockingIOError):
                    reading += waiting.recv(1, socket.MSG_PEEK) == b""
                    break
                reading += 1
                time.sleep(0.005)
        late = sorted(times)[int(0.98 * len(times))]
        row(reading >= 3 and late <= ASKED_MS, "an hour of 16 markers is being read: the list meanwhile", f"98 % within {ASKED_MS} ms",
            f"{late:.1f} ms, asked {reading} times (longest {max(times):.1f})")


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


class Rightful(threading.Thread):
    """A viewer that takes every message of a live source."""

    def __init__(self, server):
        super().__init__(daemon=True)
        self.viewer, self.frames, self.ages, self.dropped, self.going = Viewer(server), 0, [], 0, True

    def run(self):
        with contextlib.suppress(Ended, OSError):
            while self.going:
                kind, head, _ = self.viewer.hear()
                if kind == 1:
                    self.frames += 1
                    self.dropped = head["dropped"]
                    self.ages.append(1000 * (time.monotonic() - head["due_s"]))
                self.viewer.drawn()


def check_socket_refusals(server):
    name = server.name
    for check, asked, changes in (
        ("no token", 401, {"known": False}),
        ("wrong token", 401, {"known": False, "Authorization": f"Bearer {'0' * 32}"}),
        ("foreign Origin", 403, {"Origin": "http://evil.example"}),
        ("no Origin", 403, {"Origin": None}),
        ("Origin null", 403, {"Origin": "null"}),
        ("foreign Host", 421, {"Host": "evil.example"}),
        ("another target", 404, {"target": "/live/sockets"}),
        ("ours", 101, {"Origin": f"http://{name}"}),
    ):
        with Viewer(server, **changes) as viewer:
            row(viewer.status == asked, f"WebSocket: {check}", asked, viewer.status)
    for check, code, kind, data in (
        ("a message of 10 MB", 1009, 2, bytes(10_000_000)),
        ("text", 1008, 1, b"drawn"),
        ("a number that cannot be", 1008, 2, struct.pack("<d", 1e9)),
    ):
        with Viewer(server) as viewer:
            with contextlib.suppress(OSError):
                viewer.connection.sendall(frame(kind, len(data)) if kind == 2 and len(data) > 100 else b"")
                if len(data) <= 100:
                    viewer.say(kind, data)
            try:
                while True:
                    viewer.hear()
            except (Ended, OSError) as end:
                row(getattr(end, "code", 0) in (code, 0), f"WebSocket: {check}", f"ended, {code}", f"ended, {getattr(end, 'code', 'reset')}")


def check_socket_attack(server, kind, count=2):
    rightful = Rightful(server)
    rightful.start()
    page, most = [], 0
    with attackers("sockets", kind, server.port, count, server.exchanged()):
        begun = len(rightful.ages)
        for _ in range(REQUESTS):
            most = max(most, descriptors_of(server))
            page.append(timed(server, "/api/live"))
            page.append(timed(server, "/"))
            time.sleep(0.005)
        seen = sorted(rightful.ages[begun:]) or [1e9]
    rightful.going = False
    rightful.join(10)
    good = sum(status == 200 for status, _ in page)
    times = sorted(ms for _, ms in page)
    late, old = times[int(0.99 * len(times))], seen[int(0.99 * len(seen))]
    row(good == len(page) and late <= ASKED_MS and old <= ASKED_MS and most <= MOST_DESCRIPTORS and rightful.is_alive() is False,
        f"{kind}: the rightful page meanwhile", f"all answered, 99 % within {ASKED_MS} ms, its frames too; <= {MOST_DESCRIPTORS} descriptors",
        f"{good} of {len(page)}, {late:.1f} ms (longest {times[-1]:.1f}); {len(seen)} frames, {old:.1f} ms old; {most} descriptors")


def sockets(scratch):
    with Server(PROGRAM, "sim:walk?rate=240&seconds=600", "--no-open", cwd=scratch) as server:
        check_socket_refusals(server)
        most = 0.0
        check_socket_attack(server, "nobody attacks", count=0)
        for kind in SOCKET_ATTACKS:
            check_socket_attack(server, kind)
            most = max(most, memory_mb(server.process.pid))
        row(most <= MOST_MEMORY_MB, "memory during all that", f"<= {MOST_MEMORY_MB} MB", f"{most:.0f} MB")


def tls(scratch):
    subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-days", "2", "-subj", "/CN=test", "-addext",
                    "subjectAltName=IP:127.0.0.1", "-keyout", scratch / "key.pem", "-out", scratch / "cert.pem"], check=True, capture_output=True)  # fmt: skip
    subprocess.run([PROGRAM, "simulate", "subject", "-o", scratch / "recorded", "--duration", "10", "--quiet"], check=True)
    with Server(PROGRAM, scratch / "recorded", "--no-open", "--certificate", "cert.pem", "--key", "key.pem", cwd=scratch, trusted=scratch / "cert.pem") as server:
        for check, asked, measured in (
            ("no token", 401, server.request(known=False)[0]),
            ("foreign Host", 421, server.request(Host="evil.example")[0]),
            ("POST from our name by http", 403, server.request(method="POST", Origin=f"http://{server.name}")[0]),
            ("ours", 200, server.request()[0]),
        ):
            row(asked == measured, f"over TLS: {check}", asked, measured)
        for kind in TLS_ATTACKS:
            check_attack(server, kind, "tls")
        memory = memory_mb(server.process.pid)
        row(memory <= MOST_MEMORY_MB, "memory after all that", f"<= {MOST_MEMORY_MB} MB", f"{memory:.0f} MB")


def main():
    if sys.argv[1:] in (["sockets"], ["tls"]):
        with tempfile.TemporaryDirectory(dir=os.environ.get("KINEMARK_SCRATCH")) as scratch:
            (sockets if sys.argv[1] == "sockets" else tls)(Path(scratch))
        return exit_status()
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
    return exit_status()


if __name__ == "__main__":
    if sys.argv[1:2] == ["--attack"]:
        table, kind, port, session = *sys.argv[2:4], int(sys.argv[4]), sys.argv[5]
        TABLES[table][kind](port, *([session] if table == "sockets" else []))
    sys.exit(main())
