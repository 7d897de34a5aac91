# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""MCAP files of other programs go wherever other marker files go; our own recordings stay what they are."""

import json
import struct
import unittest

from support import CommandTest, read_csv


def record(op, content):
    return bytes([op]) + struct.pack("<Q", len(content)) + content


def text(value):
    return struct.pack("<I", len(value)) + value.encode()


def scene(encoding="json", frames=5):
    """An MCAP file with the transforms of two points at 50 Hz."""
    out = b"\x89MCAP0\r\n" + record(1, text("") + text("judge"))
    out += record(3, struct.pack("<H", 1) + text("foxglove.FrameTransform") + text("jsonschema") + text("{}"))
    out += record(4, struct.pack("<HH", 1, 1) + text("/tf") + text(encoding) + struct.pack("<I", 0))
    for frame in range(frames):
        for point, x in (("LASI", 0.1), ("RASI", -0.1)):
            message = {"timestamp": {"sec": 3, "nsec": frame * 20_000_000}, "parent_frame_id": "lab", "child_frame_id": point,
                       "translation": {"x": x + 0.01 * frame, "y": 0.5, "z": 1.0}}
            out += record(5, struct.pack("<HIQQ", 1, frame, 0, 0) + json.dumps(message).encode())
    return out + record(0x0F, bytes(4))


class Mcap(CommandTest):
    def test_positions_are_converted(self):
        self.write("scene.mcap", scene())
        self.good("convert", "scene.mcap", "scene.csv")
        rows = read_csv(self.folder / "scene.csv")
        self.assertEqual([r["marker"] for r in rows[:2]], ["LASI", "RASI"])
        self.assertEqual(float(rows[-1]["x_m"]), -0.1 + 0.01 * 4)
        found = json.loads(self.good("info", "--json", "scene.mcap").out)
        self.assertEqual((found["kind"], found["format"], found["frames"]), ("markers", "MCAP", 5))
        self.assertAlmostEqual(found["rate_hz"], 50.0)

    def test_what_is_no_position_is_refused(self):
        self.write("proto.mcap", scene("protobuf"))
        for command in (["info", "proto.mcap"], ["convert", "proto.mcap", "out.csv"]):
            self.refused(3, ["proto.mcap", "/tf (protobuf, foxglove.FrameTransform)"], *command)
        self.write("cut.mcap", scene()[:60])
        self.refused(3, ["cut.mcap", "none with messages"], "info", "cut.mcap")
        self.write("bad.mcap", scene().replace(b'{"timestamp"', b'!"timestamp"', 1))
        self.refused(3, ["bad.mcap", "no object of JSON"], "convert", "bad.mcap", "out.csv")

    def test_a_recording_of_ours_is_no_marker_file(self):
        self.good("simulate", "rig", "-o", "rig", "--duration", 0.1)
        self.assertEqual(json.loads(self.good("info", "--json", "rig/recording.mcap").out)["kind"], "recording")
        self.refused(3, ["recording.mcap", "kinemark reconstruct"], "convert", "rig/recording.mcap", "out.csv")

    def test_a_pose_is_for_nwb_alone(self):
        self.write("scene.mcap", scene())
        self.refused(2, ["--ndx-pose", "out.csv is no .nwb file"], "convert", "scene.mcap", "out.csv", "--ndx-pose")
        self.good("convert", "scene.mcap", "plain.nwb")
        self.good("convert", "scene.mcap", "pose.nwb", "--ndx-pose")
        self.assertGreater((self.folder / "pose.nwb").stat().st_size, (self.folder / "plain.nwb").stat().st_size)
        self.good("convert", "pose.nwb", "pose.csv")
        self.good("convert", "plain.nwb", "plain.csv")
        self.assertEqual((self.folder / "pose.csv").read_bytes(), (self.folder / "plain.csv").read_bytes())


if __name__ == "__main__":
    unittest.main()
