# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Marker sets are named, and names that differ are proposed as an option that a shell runs as it stands."""

import json
import re
import shlex
import subprocess

from support import PROGRAM, CommandTest

# Names of the simulated model, and what another laboratory calls the same markers.
OTHERS = {"LHEE": "L.Heel", "RHEE": "R.Heel", "LKNE": "Left Knee", "RKNE": "Right Knee", "LANK": "L_ANK", "RANK": "R_ANK"}


class Names(CommandTest):
    def renamed(self):
        """The recording under the other names."""
        self.good("convert", self.c3d, "theirs.c3d", "--rename", ",".join(f"{own}={other}" for own, other in OTHERS.items()))
        return "theirs.c3d"

    def test_info_names_the_set_and_what_is_missing(self):
        facts = json.loads(self.good("info", self.c3d, "--json").out)["marker_set"]
        self.assertEqual((facts["name"], facts["part"], facts["markers"], facts["missing"]), ("Plug-in Gait", "full body", 39, ["RBAK"]))
        text = self.good("info", self.c3d).out
        self.assertIn("marker_set        Plug-in Gait, full body: 38 of 39 markers, without RBAK\n", text)
        self.good("convert", self.c3d, "few.c3d", "--select", "LKNE,RKNE,C7")
        self.assertNotIn("marker_set", self.good("info", "few.c3d").out)

    def test_what_ik_proposes_runs_as_it_stands(self):
        command = [str(part) for part in self.ik(markers=self.renamed())]
        said = self.good(*command).err
        self.assertIn("6 markers of the model, not in the recording, may be there under other names: --rename ", said)
        proposed = re.search(r"other names: (--rename .*)", said).group(1)
        line = f"{shlex.quote(str(PROGRAM))} {shlex.join(command)} --force {proposed}"
        again = subprocess.run(["sh", "-c", line], cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertNotIn("may be there under", again.stderr)
        pairs = dict(pair.split("=") for pair in shlex.split(proposed)[1].split(","))
        self.assertEqual(pairs, {other: own for own, other in OTHERS.items()})

    def test_nothing_is_proposed_where_names_agree_or_are_of_the_other_side(self):
        self.assertNotIn("--rename", self.good(*self.ik()).err)
        self.good("convert", self.c3d, "left.c3d", "--drop", "RHEE", "--rename", "LHEE=L.Heel")
        said = self.good(*self.ik(markers="left.c3d"), "--force").err
        self.assertIn("--rename L.Heel=LHEE", said)
        self.assertNotIn("RHEE", re.search(r"--rename \S+", said).group(0))

    def test_a_refusal_proposes_too(self):
        self.good("convert", self.c3d, "heels.c3d", "--select", "LHEE,RHEE", "--rename", "LHEE=L.Heel,RHEE=R.Heel")
        said = self.refused(3, "no marker in common", *self.ik(markers="heels.c3d"))
        self.assertTrue(said.endswith("; likely: --rename L.Heel=LHEE,R.Heel=RHEE"), said)
