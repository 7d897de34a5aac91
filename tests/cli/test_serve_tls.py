# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""`kinemark serve` with a certificate: TLS for pages and WebSockets, addresses that other machines reach, and what is refused."""

import contextlib
import json
import os
import shutil
import socket
import ssl
import subprocess
import unittest
import warnings

from live_viewer import Viewer
from serving import Server
from support import PROGRAM, CommandTest, run

HAS_TLS = "without TLS" not in run("serve", ".", "--certificate", os.devnull, "--key", os.devnull, cwd="/").err


def make_certificate(folder, name, names="DNS:localhost,IP:127.0.0.1"):
    """NAME.pem and NAME.key there."""
    subprocess.run(
        ["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-days", "2", "-subj", "/CN=test",
         "-addext", f"subjectAltName={names}", "-keyout", folder / f"{name}.key", "-out", folder / f"{name}.pem"],
        check=True, capture_output=True,
    )  # fmt: skip
    return "--certificate", folder / f"{name}.pem", "--key", folder / f"{name}.key"


@unittest.skipUnless(HAS_TLS, "NO TLS in this program")
@unittest.skipUnless(shutil.which("openssl"), "NO OPENSSL: the command makes the certificates")
class ServeTls(CommandTest):
    @classmethod
    def setUpClass(cls):
        """Nothing has to be simulated."""

    def setUp(self):
        super().setUp()
        (self.folder / "day").mkdir()
        (self.folder / "day" / "q.sto").write_text("q\nversion=1\nnRows=1\nnColumns=2\ninDegrees=no\nendheader\ntime\ta\n0\t1\n")
        self.given = make_certificate(self.folder, "own")

    def serve(self, *more, source="day", given=None):
        server = Server(PROGRAM, source, "--no-open", *(given or self.given), *more, cwd=self.folder, trusted=self.folder / "own.pem")
        self.addCleanup(server.__exit__)
        return server

    def test_pages_come_over_tls_alone_and_the_secrets_are_asked_for_as_ever(self):
        server = self.serve()
        self.assertTrue(server.line.startswith("https://localhost:"))
        status, headers, _ = server.request(f"/?token={server.token}", known=False)
        self.assertEqual(status, 303)
        self.assertNotIn("Set-Cookie", headers)
        self.assertEqual(server.request("/")[0], 200)
        self.assertEqual(server.request("/", known=False)[0], 401)
        self.assertEqual(server.request("/", Host="evil.example")[0], 421)
        self.assertEqual(server.request("/", Host=f"127.0.0.1:{server.port}")[0], 200)
        post = {"method": "POST", "body": b"{}", "Content_Type": "application/json"}
        self.assertEqual(server.request("/api/trial/1/angles", Origin=f"http://{server.name}", **post)[0], 403)
        self.assertEqual(server.request("/api/trial/1/angles", Origin=server.origin, **post)[0], 400)
        server.tls = None
        with contextlib.suppress(OSError):
            self.assertEqual(server.request("/")[0], 0, "plain HTTP gets no answer")

    def test_versions_before_1_2_are_refused(self):
        server = self.serve()
        warnings.simplefilter("ignore", DeprecationWarning)  # of the name of what must be refused
        for version, good in ((ssl.TLSVersion.TLSv1_1, False), (ssl.TLSVersion.TLSv1_2, True), (ssl.TLSVersion.TLSv1_3, True)):
            server.tls = ssl.create_default_context(cafile=self.folder / "own.pem")
            server.tls.set_ciphers("DEFAULT:@SECLEVEL=0")
            server.tls.minimum_version = server.tls.maximum_version = version
            try:
                self.assertEqual(server.request("/")[0] == 200, good, version)
            except (ssl.SSLError, ConnectionError):
                self.assertFalse(good, version)

    def test_a_live_source_is_watched_over_wss(self):
        server = self.serve(source="sim:walk?seconds=20&rate=100")
        with Viewer(server) as viewer:
            self.assertEqual(viewer.status, 101)
            kinds = set()
            for _ in range(20):
                kinds.add(viewer.hear()[0])
                viewer.drawn()
        self.assertIn(1, kinds)
        with Viewer(server, Origin=f"http://{server.name}") as viewer:
            self.assertEqual(viewer.status, 403)
        self.assertGreater(json.loads(server.request("/api/live")[2])["frames"], 0)

    def test_all_addresses_take_the_names_of_the_certificate(self):
        server = self.serve("--bind", "0.0.0.0")
        self.assertEqual(server.host, "localhost")
        self.assertEqual(server.request("/")[0], 200)
        self.assertEqual(server.request("/", Host=f"0.0.0.0:{server.port}")[0], 421)
        nameless = make_certificate(self.folder, "nameless", "email:a@b.example")
        self.refused(2, "subjectAltName", "serve", "day", "--bind", "0.0.0.0", *nameless)

    def test_who_begins_a_handshake_and_stays_is_sent_away(self):
        server = self.serve()
        with socket.create_connection(("127.0.0.1", server.port), timeout=30) as slow:
            slow.sendall(b"\x16\x03\x01\x02\x00\x01")
            self.assertEqual(server.request("/")[0], 200)
            self.assertEqual(slow.recv(1), b"")

    def test_what_cannot_be_used_is_one_sentence(self):
        other = make_certificate(self.folder, "other")
        own = self.folder / "own.pem", self.folder / "own.key"
        (self.folder / "bad.pem").write_text("nonsense")
        encrypted = self.folder / "locked.key"
        subprocess.run(["openssl", "pkcs8", "-topk8", "-in", own[1], "-out", encrypted, "-passout", "pass:secret"], check=True, capture_output=True)
        for certificate, key, status, words in (
            (own[0], None, 2, "belong together"),
            (None, own[1], 2, "belong together"),
            ("absent.pem", own[1], 4, "absent.pem"),
            (own[0], "absent.key", 4, "absent.key"),
            ("bad.pem", own[1], 3, "bad.pem: is no certificate"),
            (own[0], "bad.pem", 3, "bad.pem: is no key"),
            (own[0], other[3], 3, "other.key: is not the key of the certificate"),
            (own[0], encrypted, 3, "locked.key: is encrypted"),
        ):
            given = [*(("--certificate", certificate) if certificate else ()), *(("--key", key) if key else ())]
            self.refused(status, words, "serve", "day", *given)


if __name__ == "__main__":
    unittest.main()
