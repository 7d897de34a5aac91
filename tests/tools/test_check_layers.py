# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
import contextlib
import io
import unittest

from support import Tree, load_tool

layers = load_tool("check_layers")

RIGHT = {
    "src/kinemark/core/result.h": "#include <string>\n",
    "src/kinemark/math/se3.h": '#include <Eigen/Core>\n#include "kinemark/core/result.h"\n',
    "src/kinemark/data/trial.h": '#include "kinemark/math/se3.h"\n',
    "src/kinemark/model/model.h": '#include "kinemark/data/trial.h"\n',
    "src/kinemark/io/file.h": '#include "kinemark/core/result.h"\n',
    "src/kinemark/io/c3d/internal/decode.h": "",
    "src/kinemark/io/c3d/reader.cc": '#include "kinemark/io/c3d/internal/decode.h"\n#include "kinemark/io/file.h"\n',
    "src/kinemark/io/c3d/reader_test.cc": '#include "support/scratch.h"\n#include <gtest/gtest.h>\n',
    "src/kinemark/model/testing/tree.h": '#include "kinemark/model/model.h"\n',
    "src/kinemark/model/model_test.cc": '#include "kinemark/model/testing/tree.h"\n',
    "src/kinemark/stages/motion/ik.h": '#include "kinemark/model/model.h"\n#include "kinemark/io/file.h"\n',
    "src/kinemark/stages/motion/internal/solver.h": '#include "kinemark/stages/motion/ik.h"\n',
    "src/kinemark/stages/report/page.h": '#include "kinemark/data/trial.h"\n',
    "src/kinemark/pipeline/run.h": (
        '#include "kinemark/stages/motion/ik.h"\n#include "kinemark/stages/report/page.h"\n'
    ),
    "cli/main.cc": '#include "cli/args.h"\n#include "kinemark/pipeline/run.h"\n',
    "cli/args.h": "",
}


class CheckLayers(unittest.TestCase):
    def problems(self, **changes):
        """Problems of the right tree with files changed or added."""
        files = dict(RIGHT)
        files.update(changes)
        with Tree(files) as root:
            found, count = layers.check(root)
            self.assertEqual(count, len(files))
            return found

    def only_problem(self, path, text):
        found = self.problems(**{path: text})
        self.assertEqual(len(found), 1, found)
        return found[0]

    def test_passes_a_right_tree(self):
        self.assertEqual(self.problems(), [])

    def test_catches_an_edge_upwards_and_names_its_line(self):
        found = self.only_problem("src/kinemark/core/new.h", '#pragma once\n\n#include "kinemark/data/trial.h"\n')
        self.assertEqual(
            found, "src/kinemark/core/new.h:3: core may not include data (kinemark/data/trial.h)"
        )

    def test_an_edge_upwards_that_closes_a_circle_is_reported_as_both(self):
        found = self.problems(**{"src/kinemark/core/result.h": '#include "kinemark/data/trial.h"\n'})
        self.assertEqual(len(found), 2, found)
        self.assertIn("core may not include data", found[0])
        self.assertIn("circle: ", found[1])

    def test_catches_every_edge_that_design_forbids(self):
        for source, target in [
            ("math", "data"),
            ("data", "model"),
            ("data", "io"),
            ("model", "io"),
            ("io", "model"),
            ("model", "camera"),
            ("stream", "io"),
            ("io", "stages/motion"),
            ("stages/motion", "pipeline"),
            ("stream", "workflow"),
            ("workflow", "io"),
            ("workflow", "pipeline"),
            ("core", "pipeline"),
        ]:
            with self.subTest(source=source, target=target):
                found = self.problems(
                    **{
                        f"src/kinemark/{source}/new.cc": f'#include "kinemark/{target}/other.h"\n',
                        f"src/kinemark/{target}/other.h": "",
                    }
                )
                self.assertEqual(len(found), 1, found)
                self.assertIn(f"{source} may not include {target}", found[0])

    def test_tests_of_layer_3_may_read_files_but_nothing_else_of_their_layer(self):
        io_line, model_line = '#include "kinemark/io/file.h"\n', '#include "kinemark/model/model.h"\n'
        self.assertEqual(self.problems(**{"src/kinemark/model/a_test.cc": io_line}), [])
        self.assertIn("model may not include io", self.only_problem("src/kinemark/model/a.cc", io_line))
        self.assertIn("io may not include model", self.only_problem("src/kinemark/io/a_test.cc", model_line))
        self.assertIn("data may not include io", self.only_problem("src/kinemark/data/a_test.cc", io_line))

    def test_a_verb_takes_frames_as_they_come(self):
        self.assertEqual(self.problems(**{"src/kinemark/workflow/live/a.cc": '#include "kinemark/stream/stream.h"\n', "src/kinemark/stream/stream.h": ""}), [])

    def test_catches_a_stage_that_includes_another(self):
        found = self.only_problem(
            "src/kinemark/stages/report/page.cc", '#include "kinemark/stages/motion/ik.h"\n'
        )
        self.assertIn("stages/report may not include stages/motion", found)

    def test_catches_a_front_end_that_reaches_past_the_pipeline(self):
        found = self.only_problem("cli/ik.cc", '#include "kinemark/stages/motion/ik.h"\n')
        self.assertIn("cli/ik.cc:1: front end may not include stages/motion", found)

    def test_the_server_is_a_front_end_without_the_studies(self):
        study = '#include "studies/common/study_page.h"\n'
        files = {"studies/common/study_page.h": "\n"}
        self.assertEqual(self.problems(**{"cli/a.cc": study}, **files), [])
        found = self.problems(**{"server/a.cc": study}, **files)
        self.assertTrue(any("server may not include studies/common" in problem for problem in found), found)
        self.assertIn("server may not include stages/motion", self.only_problem("server/a.cc", '#include "kinemark/stages/motion/ik.h"\n'))

    def test_catches_a_library_that_includes_a_front_end(self):
        found = self.problems(**{"src/kinemark/pipeline/run.cc": '#include "../../../cli/args.h"\n'})
        self.assertTrue(any("pipeline may not include front end" in problem for problem in found), found)

    def test_catches_an_internal_header_used_from_outside(self):
        found = self.only_problem(
            "src/kinemark/io/text/trc.cc", '#include "kinemark/io/c3d/internal/decode.h"\n'
        )
        self.assertIn("is internal to src/kinemark/io/c3d", found)

    def test_internal_headers_serve_folders_below_their_owner(self):
        self.assertEqual(
            self.problems(
                **{"src/kinemark/io/c3d/internal/decode_test.cc": '#include "kinemark/io/c3d/internal/decode.h"\n'}
            ),
            [],
        )

    def test_steps_include_only_those_before_them(self):
        folder = "src/kinemark/stages/skeleton/articulated"
        header = "kinemark/stages/skeleton/articulated"
        steps = {
            f"{folder}/chain/chain.h": "",
            f"{folder}/geometry/fit.h": f'#include "{header}/chain/chain.h"\n',
            f"{folder}/articulated.cc": f'#include "{header}/geometry/fit.h"\n',
        }
        self.assertEqual(self.problems(**steps), [])
        back = self.problems(**steps, **{f"{folder}/frame/solver.h": f'#include "{header}/geometry/fit.h"\n'})
        self.assertEqual(len(back), 1, back)
        self.assertIn("a later step", back[0])
        outside = self.problems(
            **steps, **{"src/kinemark/stages/skeleton/topology/tree.h": f'#include "{header}/chain/chain.h"\n'}
        )
        self.assertEqual(len(outside), 1, outside)

    def test_catches_a_circle_of_headers(self):
        found = self.problems(
            **{
                "src/kinemark/core/a.h": '#include "kinemark/core/b.h"\n',
                "src/kinemark/core/b.h": '#include "kinemark/core/c.h"\n',
                "src/kinemark/core/c.h": '#include "kinemark/core/a.h"\n',
            }
        )
        self.assertEqual(
            found,
            [
                "circle: src/kinemark/core/a.h -> src/kinemark/core/b.h -> src/kinemark/core/c.h"
                " -> src/kinemark/core/a.h"
            ],
        )

    def test_catches_test_helpers_in_the_library(self):
        self.assertIn(
            "only tests may include",
            self.only_problem("src/kinemark/core/a.cc", '#include "support/scratch.h"\n'),
        )
        for helper in ("testing/tree.h", "testing/body/tree.h"):
            with self.subTest(helper=helper):
                line = f'#include "kinemark/model/{helper}"\n'
                helper = {f"src/kinemark/model/{helper}": '#include "support/scratch.h"\n'}
                self.assertEqual(self.problems(**helper, **{"src/kinemark/model/a_test.cc": line}), [])
                found = self.problems(**helper, **{"src/kinemark/model/a.cc": line})
                self.assertEqual(len(found), 1, found)
                self.assertIn("is for tests only", found[0])

    def test_helpers_of_tests_stand_in_a_folder_of_their_own(self):
        for name in ("test_trees.h", "trees_for_test.h"):
            with self.subTest(name=name):
                problems = self.problems(**{f"src/kinemark/model/{name}": ""})
                self.assertEqual(len(problems), 1, problems)
                self.assertIn(f"model/{name}: a helper of tests belongs into a folder testing/", problems[0])
        self.assertEqual(self.problems(**{"src/kinemark/model/testing/test_trees.h": ""}), [])

    def test_catches_missing_files_and_short_paths(self):
        self.assertIn(
            "does not exist", self.only_problem("src/kinemark/core/a.cc", '#include "kinemark/core/gone.h"\n')
        )
        self.assertIn(
            'write "kinemark/core/result.h"', self.only_problem("src/kinemark/core/a.cc", '#include "result.h"\n')
        )
        self.assertIn("is not found", self.only_problem("src/kinemark/core/a.cc", '#include "nowhere.h"\n'))

        self.assertIn('write "cli/args.h"', self.only_problem("cli/ik.cc", '#include "args.h"\n'))
        self.assertIn("does not exist", self.only_problem("cli/ik.cc", '#include "cli/gone.h"\n'))

    def test_a_header_that_cmake_makes_counts_as_its_template(self):
        template = {"src/kinemark/data/names.h.in": ""}
        with Tree({**RIGHT, **template, "cli/main.cc": '#include "kinemark/data/names.h"\n'}) as root:
            self.assertEqual(layers.check(root)[0], [])
        with Tree({**RIGHT, **template, "src/kinemark/core/a.h": '#include "kinemark/data/names.h"\n'}) as root:
            self.assertIn("core may not include data", layers.check(root)[0][0])

    def test_studies_stand_beside_the_library(self):
        common = {"studies/common/page.h": '#include "kinemark/pipeline/run.h"\n#include "kinemark/stages/motion/ik.h"\n'}
        self.assertEqual(
            self.problems(
                **common,
                **{
                    "studies/wheel/study.h": '#include "studies/common/page.h"\n',
                    "cli/study.cc": '#include "studies/wheel/study.h"\n',
                },
            ),
            [],
        )
        other = {"studies/arm/study.h": "", "studies/wheel/study.h": '#include "studies/arm/study.h"\n'}
        self.assertIn("studies/wheel may not include studies/arm", self.problems(**other)[0])
        up = {**common, "src/kinemark/pipeline/run.cc": '#include "studies/common/page.h"\n'}
        self.assertIn("pipeline may not include studies/common", self.problems(**up)[0])

    def test_catches_a_folder_without_a_layer(self):
        self.assertIn("has no layer", self.only_problem("src/kinemark/misc/a.cc", ""))
        self.assertIn("lies in no layer", self.only_problem("src/kinemark/a.cc", ""))

    def test_the_front_header_stands_before_all_layers_and_in_none(self):
        front = {"src/kinemark/kinemark.h": '#include "kinemark/core/a.h"\n#include "kinemark/pipeline/b.h"\n',
                 "src/kinemark/core/a.h": "", "src/kinemark/pipeline/b.h": ""}
        self.assertEqual(self.problems(**front), [])
        front["src/kinemark/pipeline/c.cc"] = '#include "kinemark/kinemark.h"\n'
        self.assertIn("may not include front header", self.problems(**front)[0])

    def test_reads_include_lines_as_the_compiler_does(self):
        text = '/*\n#include "kinemark/pipeline/run.h"\n*/\n// #include "kinemark/pipeline/run.h"\n'
        self.assertEqual(self.problems(**{"src/kinemark/core/a.cc": text}), [])
        for line in ['  #  include "kinemark/pipeline/run.h"', "#include <kinemark/pipeline/run.h>"]:
            found = self.problems(**{"src/kinemark/core/a.cc": text + line + "\n"})
            self.assertEqual(len(found), 1, found)
            self.assertIn("a.cc:5:", found[0])

    def test_program_says_what_is_wrong_and_exits_with_1(self):
        for files, status in [(RIGHT, 0), ({**RIGHT, "src/kinemark/core/a.h": '#include "kinemark/io/file.h"\n'}, 1)]:
            with Tree(files) as root, contextlib.redirect_stdout(io.StringIO()) as out:
                self.assertEqual(layers.main([str(root)]), status)
            self.assertIn(f"{len(files)} files, {status} wrong edges", out.getvalue())
        with Tree({}) as root, contextlib.redirect_stdout(io.StringIO()):
            self.assertEqual(layers.main([str(root)]), 1)


if __name__ == "__main__":
    unittest.main()
