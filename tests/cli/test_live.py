# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""`kinemark serve` of a live source: frames over a WebSocket, the recording, what is refused. Times are a matter of acceptance."""

import itertools
import json
import math
import signal
import struct
import time

from live_viewer import Ended, Viewer
from serving import Server
from support import PROGRAM, CommandTest, report_data, run

MARKERS, ANGLES, SENTENCE = 1, 2, 3


class LiveTest(CommandTest):
    def serve(self, *arguments):
        server = Server(PROGRAM, *arguments, "--no-open", cwd=self.folder)
        self.addCleanup(server.__exit__)
        return server

    def until_ended(self, server):
        for _ in range(3000):
            state = json.loads(server.request("/api/live")[2])
            if state["ended"]:
                return state
            time.sleep(0.01)
        raise AssertionError(f"still going on: {state}")

    def frames(self, viewer):
        """All messages until the server ends the connection, and why."""
        heard = []
        try:
            while True:
                heard.append(viewer.hear())
                viewer.drawn()
        except Ended as end:
            return heard, end


class Seen(LiveTest):
    def test_a_simulation_with_angles_from_first_to_last(self):
        server = self.serve("sim:reach?rate=100&seconds=3&noise=0")
        with Viewer(server) as viewer:
            self.assertEqual(viewer.status, 101)
            heard, end = self.frames(viewer)
        self.assertEqual((end.code, end.reason), (1000, "the source has ended after 300 frames"))
        markers = [(head, body) for kind, head, body in heard if kind == MARKERS]
        self.assertEqual(markers[-1][0]["frame"], 299, "to the last")
        for (before, _), (head, _) in itertools.pairwise(markers):
            absent = head["frame"] - before["frame"] - 1
            self.assertGreaterEqual(absent, 0, "in order")
            self.assertEqual(absent, head["dropped"] - before["dropped"], "what does not come is counted")
        self.assertEqual({head["count"] for head, _ in markers}, {40})
        self.assertEqual(markers[-1][0]["time_s"], 2.99)
        x = struct.unpack("<120f", markers[-1][1][:480])
        self.assertTrue(all(abs(v) < 3 for v in x))
        self.assertEqual(set(markers[-1][1][480:]), {1}, "measured")
        angles = [(head, body) for kind, head, body in heard if kind == ANGLES]
        self.assertEqual(angles[-1][0]["frame"], 299)
        count = angles[-1][0]["count"]
        values = struct.unpack(f"<{2 * count}f", angles[-1][1][: 8 * count])
        determined = angles[-1][1][8 * count : 9 * count]
        self.assertGreater(sum(determined), count / 2)
        self.assertTrue(all(0 < sd < 30 for sd, known in zip(values[count:], determined) if known))

    def test_the_page_knows_what_comes(self):
        server = self.serve("sim:walk?seconds=0.5", "--record", "live.mcap")
        status, headers, body = server.request("/")
        self.assertEqual(status, 200)
        self.assertIn("connect-src 'self';", headers["Content-Security-Policy"])
        self.assertIn("connect-src 'self';", body, "the page's own policy too")
        summary = json.loads(report_data(body))["summary"]
        self.assertEqual((summary["schema"], summary["rate_hz"], summary["recording"]), ("kinemark.live", 240, "live.mcap"))
        self.assertEqual(len(summary["markers"]), 40)
        self.assertIn("deg", {c["unit"] for c in summary["coordinates"]})


    def test_levels_of_the_goals_are_on_the_page(self):
        server = self.serve("sim:walk?seconds=0.5", "--level", "LASI,RASI", "--level", "*", "--strict", "--omega", "50")
        summary = json.loads(report_data(server.request("/")[2]))["summary"]
        self.assertEqual((summary["levels"], summary["strict"]), (["LASI, RASI", "all others"], True))
        names = {summary["markers"][t["marker"]]: t["level"] for t in summary["targets"]}
        self.assertEqual((len(names), names["LASI"], names["LPSI"]), (40, 0, 1))
        self.assertEqual(len(summary["bodies"]), max(t["body"] for t in summary["targets"]) + 1)
        self.assertEqual(summary["bodies"][0]["parent"], -1)


def push(body, force):
    return struct.pack("<BBH6f", 1, 1, body, 0, 0, 0, *force)


class Pushed(LiveTest):
    def pushed_mm(self, viewer):
        """Of the next frame of angles; NaN: nobody pushes."""
        while True:
            kind, _, body = viewer.hear()
            viewer.drawn()
            if kind == ANGLES:
                return struct.unpack("<f", body[-4:])[0]

    def test_a_body_goes_and_comes_back(self):
        server = self.serve("sim:walk?rate=100&seconds=60")
        with Viewer(server) as viewer:
            for _ in range(20):
                self.assertTrue(math.isnan(self.pushed_mm(viewer)), "nobody pushes")
            farthest = 0
            for _ in range(60):
                viewer.say(2, push(1, (0, 400, 0)))
                now = self.pushed_mm(viewer)
                farthest = max(farthest, 0 if math.isnan(now) else now)
            self.assertGreater(farthest, 0.5)
            viewer.say(2, push(1, (0, 0, 0)))
            self.assertTrue(any(math.isnan(self.pushed_mm(viewer)) for _ in range(400)), "it is back")

    def test_what_is_refused(self):
        server = self.serve("sim:walk?rate=100&seconds=60")
        for wrong in (push(9999, (0, 1, 0)), push(1, (0, math.nan, 0)), push(1, (math.inf, 0, 0)), b"\2" + push(1, (0, 1, 0))[1:], push(1, (0, 1, 0))[:-1]):
            with Viewer(server) as viewer:
                viewer.say(2, wrong)
                self.assertEqual((self.frames(viewer)[1].code), 1008)
        with Viewer(server) as first, Viewer(server) as second:
            first.say(2, push(1, (0, 501, 0)))
            self.assertIn("at most 500 N; 501 N were not applied", self.sentence(first))
            first.say(2, push(1, (0, 100, 0)))
            self.pushed_mm(first)
            second.say(2, push(1, (0, 100, 0)))
            self.assertIn("another page is pushing the body", self.sentence(second))

    def sentence(self, viewer):
        while True:
            kind, _, body = viewer.hear()
            viewer.drawn()
            if kind == SENTENCE:
                return body.decode()


class Recorded(LiveTest):
    def test_every_frame_of_a_replay_is_in_the_recording(self):
        server = self.serve(f"replay:{self.c3d}?rate=1000", "--record", "live.mcap")
        state = self.until_ended(server)
        frames = json.loads(run("info", self.c3d, "--json", cwd=self.folder).out)["frames"]
        self.assertEqual((state["frames"], state["recorded"]), (frames, frames))
        for name in (self.c3d, "live.mcap"):
            done = run("convert", name, self.folder / f"{'a' if name == self.c3d else 'b'}.csv", cwd=self.folder)
            self.assertEqual(done.status, 0, done.err)
        rows = [[line.split(",") for line in (self.folder / name).read_text().splitlines()] for name in ("a.csv", "b.csv")]
        self.assertEqual(len(rows[0]), len(rows[1]))
        self.assertEqual([r[2:] for r in rows[0][-5:]], [r[2:] for r in rows[1][-5:]], "the same positions")
        self.assertIn(f"{frames} recorded in live.mcap", server.end()[2])

    def test_a_kill_loses_nothing_that_was_acknowledged(self):
        server = self.serve("sim:walk?seconds=60", "--record", "live.mcap")
        recorded = 0
        while recorded < 50:
            recorded = json.loads(server.request("/api/live")[2])["recorded"]
        server.end(signal.SIGKILL)
        said = run("info", "live.mcap", "--json", cwd=self.folder)
        self.assertEqual(said.status, 0, said.err)
        facts = json.loads(said.out)
        self.assertGreaterEqual(facts["frames"], recorded)
        self.assertEqual(facts["rate_hz"], 240)
        self.assertTrue(any("not closed" in w for w in facts["warnings"]), facts["warnings"])

    def test_a_recording_that_is_there_stays(self):
        (self.folder / "live.mcap").write_text("mine")
        done = run("serve", "sim:walk?seconds=0.1", "--record", "live.mcap", "--no-open", cwd=self.folder)
        self.assertEqual(done.status, 4)
        self.assertIn("live.mcap", done.err)
        self.assertEqual((self.folder / "live.mcap").read_text(), "mine")

    def test_a_replay_is_not_recorded_over_itself(self):
        recording = self.folder / "walk.c3d"
        recording.write_bytes(self.c3d.read_bytes())
        (self.folder / "link.c3d").symlink_to(recording)
        for name in ("walk.c3d", "./walk.c3d", "link.c3d"):
            done = run("serve", "replay:walk.c3d?rate=1000", "--record", name, "--force", "--no-open", cwd=self.folder)
            self.assertEqual(done.status, 2, done.err)
            self.assertIn(name, done.err)
            self.assertEqual(recording.read_bytes(), self.c3d.read_bytes())


class Refused(LiveTest):
    def test_who_is_no_page_of_this_server(self):
        server = self.serve("sim:walk?seconds=60")
        for status, options in (
            (421, {"Host": "evil.example"}),
            (403, {"Origin": "http://evil.example"}),
            (403, {"Origin": None}),
            (401, {"known": False}),
            (401, {"known": False, "target": "/" + "0" * 32 + "/live/socket"}),
            (404, {"target": "/"}),
            (404, {"target": "/live/socket?x"}),
        ):
            with Viewer(server, **options) as viewer:
                self.assertEqual(viewer.status, status, options)

    def test_messages_that_are_none_end_the_connection_alone(self):
        server = self.serve("sim:walk?seconds=60")
        with Viewer(server) as good:
            for kind, data, code in ((2, b"x", 1008), (1, b"text", 1008), (2, bytes(1000), 1009), (2, struct.pack("<d", 1e9), 1008), (2, struct.pack("<d", float("nan")), 1008)):
                with Viewer(server) as bad:
                    bad.say(kind, data)
                    with self.assertRaises(Ended) as ended:
                        while True:
                            bad.hear()
                    self.assertEqual(ended.exception.code, code, data[:8])
            self.assertEqual(good.hear()[0], MARKERS)

    def test_more_viewers_than_there_is_room_for(self):
        server = self.serve("sim:walk?seconds=60")
        viewers = [Viewer(server) for _ in range(17)]
        self.assertEqual([v.status for v in viewers], [101] * 16 + [503])
        for viewer in viewers:
            viewer.connection.close()

    def test_arguments_that_make_no_sense(self):
        for status, words, arguments in (
            (2, "served alone", ("sim:walk", self.c3d)),
            (2, "for a live source", (self.c3d, "--record", "x.mcap")),
            (2, "walk", ("sim:fly",)),
            (2, "no setting of it", ("sim:walk?speed=3",)),
            (2, "names no file", ("replay:",)),
            (4, "none.c3d", ("replay:none.c3d",)),
            (4, "none.osim", ("sim:walk?seconds=0.1", "--model", "none.osim")),
        ):
            done = run("serve", *arguments, "--no-open", cwd=self.folder)
            self.assertEqual(done.status, status, (arguments, done.err))
            self.assertIn(words, done.err)
            self.assertEqual(done.err.count("\n"), 1, done.err)
