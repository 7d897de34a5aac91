# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
import json
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

from support import PROJECT, load_script

maker = load_script(PROJECT / "tools" / "make_sbom")


class Bill(unittest.TestCase):
    def test_of_a_program_of_this_system(self):
        with tempfile.TemporaryDirectory() as folder:
            output = Path(folder) / "bill.json"
            subprocess.run([PROJECT / "tools" / "make_sbom", "/bin/ls", output, "--version", "1.2"], check=True)
            first = output.read_bytes()
            subprocess.run([PROJECT / "tools" / "make_sbom", "/bin/ls", output, "--version", "1.2"], check=True)
            self.assertEqual(output.read_bytes(), first, "the same program gives the same bytes")
        document = json.loads(first)
        packages = {package["name"]: package for package in document["packages"]}
        self.assertEqual(document["spdxVersion"], "SPDX-2.3")
        self.assertIn("libc6", packages)
        self.assertTrue(packages["libc6"]["versionInfo"])
        self.assertEqual(packages["uplot"]["licenseDeclared"], "MIT")
        self.assertEqual(packages["three"]["licenseDeclared"], "MIT")
        known = {"SPDXRef-DOCUMENT", *(package["SPDXID"] for package in document["packages"])}
        for relation in document["relationships"]:
            self.assertLessEqual({relation["spdxElementId"], relation["relatedSpdxElement"]}, known)
        self.assertTrue(all(re.fullmatch(r"SPDXRef-[A-Za-z0-9.-]+", name) for name in known))

    def test_a_library_of_no_package_stands_there_without_version(self):
        self.assertNotIn("versionInfo", maker.debian("libown.so.1", None))
        self.assertEqual(maker.debian("libown++.so", None)["SPDXID"], "SPDXRef-debian-libown--.so")

    def test_what_the_page_embeds_must_be_in_the_lock_file(self):
        with self.assertRaisesRegex(ValueError, "no package 'uplot'"):
            maker.embedded("uplot", {"packages": {}})

    def test_a_program_that_is_not_there(self):
        ran = subprocess.run([PROJECT / "tools" / "make_sbom", "/no/program", "/dev/null", "--version", "1"], capture_output=True, text=True, check=False)
        self.assertEqual(ran.returncode, 1)
        self.assertIn("/no/program", ran.stderr)


if __name__ == "__main__":
    unittest.main()
