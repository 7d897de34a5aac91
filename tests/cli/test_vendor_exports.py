# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Text exports of Qualisys, OptiTrack and Vicon go wherever other marker files go."""

import csv
import io
import json
import struct
import zipfile

from support import CommandTest, real_file


def rows_of(path):
    """{marker: [(x, y, z) or None, ...]} of a CSV that `convert` wrote, in metres."""
    rows = {}
    with path.open(newline="") as file:
        for row in csv.DictReader(file):
            seen = row["state"] != "missing"
            rows.setdefault(row["marker"], []).append(tuple(float(row[a]) for a in ("x_m", "y_m", "z_m")) if seen else None)
    return rows


class VendorExports(CommandTest):
    def setUp(self):
        super().setUp()
        self.good("convert", self.c3d, "known.csv", "--force")
        self.known = rows_of(self.folder / "known.csv")
        self.names = list(self.known)
        self.frames = len(self.known[self.names[0]])

    def cells(self, frame, unit, blank):
        """The coordinates of all markers in a frame, as cells."""
        samples = (self.known[name][frame] for name in self.names)
        return [cell for x in samples for cell in ([repr(unit * v) for v in x] if x else [blank] * 3)]

    def qtm(self):
        head = [
            f"NO_OF_FRAMES\t{self.frames}",
            f"NO_OF_MARKERS\t{len(self.names)}",
            "FREQUENCY\t100",
            "DATA_INCLUDED\t3D",
            "\t".join(["MARKER_NAMES", *self.names]),
        ]
        rows = ["\t".join([str(f + 1), f"{f / 100:.5f}", *self.cells(f, 1000.0, "0.000")]) for f in range(self.frames)]
        return "\n".join([*head, *rows]) + "\n"

    def motive(self):
        def triple(words):
            return ",".join(word for word in words for _ in range(3))

        count = len(self.names)
        head = [
            "Format Version,1.23,Take Name,walk,Export Frame Rate,100.0,Length Units,Meters",
            "",
            ",Type," + triple(["Marker"] * count),
            ",Name," + triple(self.names),
            ",ID," + triple(map(str, range(count))),
            ",," + triple(["Position"] * count),
            "Frame,Time (Seconds)," + ",".join(["X,Y,Z"] * count),
        ]
        rows = [",".join([str(f), f"{f / 100:.6f}", *self.cells(f, 1.0, "")]) for f in range(self.frames)]
        return "\n".join([*head, *rows]) + "\n"

    def vicon(self):
        head = [
            "Trajectories",
            "100",
            ",," + ",".join(f"{name},," for name in self.names),
            "Frame,Sub Frame," + ",".join(["X,Y,Z"] * len(self.names)),
            ",," + ",".join(["mm,mm,mm"] * len(self.names)),
        ]
        rows = [",".join([str(f + 1), "0", *self.cells(f, 1000.0, "")]) for f in range(self.frames)]
        return "\n".join([*head, *rows]) + "\n"

    def d_flow(self):
        head = "\t".join(["TimeStamp", "FrameNumber", *(f"{name}.Pos{axis}" for name in self.names for axis in "XYZ"), "FP1.ForX"])
        rows = ["\t".join([f"{f / 100:.6f}", str(f + 1), *self.cells(f, 1.0, "0.0"), "3"]) for f in range(self.frames)]
        return "\n".join([head, *rows]) + "\n"

    def npz(self, packing):
        """An archive as numpy.savez or savez_compressed writes it, by Python's own zipfile."""
        def npy(kind, shape, data):
            header = repr({"descr": kind, "fortran_order": False, "shape": shape}).encode()
            header += b" " * (-(len(header) + 11) % 64) + b"\n"
            return b"\x93NUMPY\1\0" + struct.pack("<H", len(header)) + header + data

        longest = max(map(len, self.names))
        names = b"".join(name.ljust(longest, "\0").encode("utf-32-le") for name in self.names)
        x = [float(cell) for f in range(self.frames) for cell in self.cells(f, 1000.0, "nan")]
        buffer = io.BytesIO()
        with zipfile.ZipFile(buffer, "w", packing) as archive:
            archive.writestr("markers.npy", npy("<f8", (self.frames, len(self.names), 3), struct.pack(f"<{len(x)}d", *x)))
            archive.writestr("names.npy", npy(f"<U{longest}", (len(self.names),), names))
            archive.writestr("fs.npy", npy("<i8", (), struct.pack("<q", 100)))
            archive.writestr("unit.npy", npy("<U2", (), "mm".encode("utf-32-le")))
        return buffer.getvalue()

    def frames_alone(self, label):
        head = ",".join([label, *(f"{name}_{axis}" for name in self.names for axis in "xyz")])
        rows = [",".join([str(f), *self.cells(f, 1000.0, "")]) for f in range(self.frames)]
        return "\n".join([head, *rows]) + "\n"

    def test_a_table_of_frames_without_times_needs_a_rate(self):
        for label in ("frame", "Frame #", ""):
            with self.subTest(label=label):
                self.write("t.csv", self.frames_alone(label))
                self.refused(3, ["t.csv", "line 1", "without a column of times; give its frame rate with --rate HZ"],
                             "convert", "t.csv", "t.c3d", "--unit", "mm")
                self.good("info", "t.csv", "--unit", "mm")
                self.good("convert", "t.csv", "from_t.csv", "--rate", "100", "--unit", "mm", "--force")
                facts = json.loads(self.good("info", "from_t.csv", "--json").out)
                self.assertEqual((facts["points"], facts["frames"], facts["rate_hz"]), (len(self.names), self.frames, 100.0))
                found = rows_of(self.folder / "from_t.csv")
                for marker in self.names:
                    for a, b in zip(self.known[marker], found[marker], strict=True):
                        self.assertEqual(a is None, b is None)
                        if a is not None:
                            self.assertLess(max(abs(p - q) for p, q in zip(a, b, strict=True)), 1e-9)
        self.write("timed.csv", self.frames_alone("time_s"))
        self.refused(2, "the file stores its own rate", "info", "timed.csv", "--rate", "100", "--unit", "mm")

    def test_each_holds_what_the_c3d_holds(self):
        for name, text in (
            ("q.tsv", self.qtm()),
            ("m.csv", self.motive()),
            ("v.csv", self.vicon()),
            ("d.txt", self.d_flow()),
            ("n.npz", self.npz(zipfile.ZIP_STORED)),
            ("c.npz", self.npz(zipfile.ZIP_DEFLATED)),
        ):
            with self.subTest(name=name):
                self.write(name, text)
                facts = json.loads(self.good("info", name, "--json").out)
                self.assertEqual((facts["points"], facts["frames"], facts["rate_hz"]), (len(self.names), self.frames, 100.0))
                self.good("convert", name, f"from_{name[0]}.csv", "--force")
                found = rows_of(self.folder / f"from_{name[0]}.csv")
                self.assertEqual(list(found), self.names)
                for marker in self.names:
                    for a, b in zip(self.known[marker], found[marker], strict=True):
                        self.assertEqual(a is None, b is None)
                        if a is not None:
                            self.assertLess(max(abs(p - q) for p, q in zip(a, b, strict=True)), 1e-9)

    def test_angles_come_from_them_as_from_any_other(self):
        self.write("q.tsv", self.qtm())
        self.good("ik", "-m", self.model, "-t", "q.tsv", "-o", "q.mot", "--force")
        self.assertTrue((self.folder / "q_sd.sto").is_file())

    def test_bad_ones_are_refused_with_file_and_line(self):
        self.write("bad.tsv", self.qtm().replace("FREQUENCY\t100", "FREQUENCY\tEXT"))
        self.refused(3, ["bad.tsv", "line 3", "FREQUENCY is 'EXT'"], "info", "bad.tsv")
        self.write("six.tsv", self.qtm().replace("DATA_INCLUDED\t3D", "DATA_INCLUDED\t6D"))
        self.refused(3, ["six.tsv", "6D data, and no line BODY_NAMES"], "convert", "six.tsv", "six.c3d")
        self.write("bad.csv", self.vicon().replace("100\n", "fast\n", 1))
        self.refused(3, ["bad.csv", "line 2", "the frame rate is 'fast'"], "info", "bad.csv")
        self.write("bare.csv", self.motive().replace("Position", "Rotation"))
        self.refused(3, ["bare.csv", "no column is the position of a marker"], "info", "bare.csv")

    def test_a_real_recording_of_qualisys_goes_to_c3d(self):
        self.good("convert", real_file("dfki-hand/recording.tsv"), "hand.c3d", "--force")
        facts = json.loads(self.good("info", "hand.c3d", "--json").out)
        self.assertEqual((facts["points"], facts["frames"], facts["rate_hz"]), (21, 6000, 100.0))
