// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Points in images as pandas with PyTables (DeepLabCut) and sleap-io wrote them: testdata/make_files.py.
#include "kinemark/io/nwb/pose_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "kinemark/io/file.h"
#include "kinemark/io/nwb/internal/pose_reader.h"
#include "kinemark/io/nwb/nwb.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using internal::arrange_columns;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::filesystem::path file(const char* name) { return std::filesystem::path(KINEMARK_TESTDATA) / name; }

/// The formula of make_files.py.
void expect_values(const PoseTable& table, std::size_t people, bool score_of_missing) {
  ASSERT_EQ(table.frames, 4);
  ASSERT_EQ(table.people.size(), people);
  EXPECT_THAT(table.points, ElementsAre("wrist", "ellbogen_\u00fc"));
  const double* value = table.values.data();
  for (int f = 0; f < 4; ++f)
    for (std::size_t p = 0; p < people; ++p)
      for (int m = 0; m < 2; ++m, value += 3) {
        const bool missing = f == 2 && m == 0;
        const double x = 100.0 * static_cast<double>(p) + 10.0 * m + f;
        EXPECT_EQ(std::isnan(value[0]), missing);
        EXPECT_EQ(std::isnan(value[1]), missing);
        if (missing && !score_of_missing) {
          EXPECT_TRUE(std::isnan(value[2]));
        }
        if (missing) continue;
        EXPECT_EQ(value[0], x);
        EXPECT_EQ(value[1], x + 0.5);
        EXPECT_NEAR(value[2], m == 1 && f == 1 ? 0.3 : 0.9, 1e-7);
      }
}

TEST(PoseTable, TablesOfDeepLabCutInBothFormatsOfPandas) {
  for (const char* name : {"dlc_table.h5", "dlc_fixed.h5"}) {
    const auto table = read_pose_table(file(name));
    ASSERT_TRUE(table) << table.error().message;
    expect_values(*table, 1, false);
  }
  const auto many = read_pose_table(file("dlc_individuals.h5"));
  ASSERT_TRUE(many) << many.error().message;
  EXPECT_THAT(many->people, ElementsAre("m1", "m2"));
  expect_values(*many, 2, false);
}

TEST(PoseTable, AnalysisFilesOfSleapInEitherOrderOfAxes) {
  const auto one = read_pose_table(file("sleap_one.h5"));
  ASSERT_TRUE(one) << one.error().message;
  expect_values(*one, 1, true);
  const auto two = read_pose_table(file("sleap_frames_first.h5"));
  ASSERT_TRUE(two) << two.error().message;
  EXPECT_THAT(two->people, ElementsAre("track_0", "track_1"));
  expect_values(*two, 2, true);
}

TEST(PoseTable, WhatIsNoVideoIsOneSentence) {
  const auto images = read_pose_table(file("dlc_images.h5"));
  EXPECT_EQ(images.error().code, Code::bad_input);
  EXPECT_THAT(images.error().message, HasSubstr("dlc_images.h5: its rows are numbered by 'string'"));
  const auto project = read_pose_table(file("sleap_project.slp"));
  EXPECT_EQ(project.error().code, Code::not_supported);
  EXPECT_THAT(project.error().message, HasSubstr("Export Analysis HDF5"));
  EXPECT_EQ(read_pose_table(file("absent.h5")).error().code, Code::io);
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "text.h5", "\x89HDF\r\n\x1a\nand no more", false));
  EXPECT_EQ(read_pose_table(scratch / "text.h5").error().code, Code::bad_input);
}

TEST(PoseTable, AReaderOfPositionsSaysWhereTheyGo) {
  for (const char* name : {"dlc_table.h5", "sleap_one.h5", "sleap_project.slp"}) {
    const auto nwb = read_nwb(file(name));
    EXPECT_EQ(nwb.error().code, Code::not_supported);
    EXPECT_THAT(nwb.error().message, HasSubstr("--images CAMERA=FILE"));
  }
}

using Columns = std::vector<std::vector<std::string>>;
const Columns kColumns = {{"n", "a", "x"}, {"n", "a", "y"}, {"n", "b", "y"}, {"n", "b", "x"}};

TEST(PoseTable, ColumnsMayStandInAnyOrder) {
  const auto table = arrange_columns(kColumns, {0.0}, {1.0, 2.0, 3.0, 4.0});
  ASSERT_TRUE(table) << table.error().message;
  EXPECT_THAT(table->values, ElementsAre(1.0, 2.0, 1.0, 4.0, 3.0, 1.0)) << "without a likelihood: sure";
}

TEST(PoseTable, ColumnsThatMakeNoSenseAreOneSentence) {
  const auto said = [](Columns columns, Array<double> frames = {0.0}) {
    const auto table = arrange_columns(columns, frames, Array<double>(columns.size() * frames.size(), 1.0));
    return table ? "read without complaint" : table.error().message;
  };
  EXPECT_EQ(said(kColumns), "read without complaint");
  EXPECT_THAT(said(kColumns, {0.0, 2.0}), HasSubstr("row 2 is frame 2; need 0, 1, 2"));
  EXPECT_THAT(said(kColumns, {1.0}), HasSubstr("row 1 is frame 1"));
  EXPECT_THAT(said({{"n", "a", "x"}}), HasSubstr("point 'a' has x or y alone"));
  EXPECT_THAT(said({{"n", "a", "z"}}), HasSubstr("column 1 is 'z' with 3 labels"));
  EXPECT_THAT(said({{"a", "x"}}), HasSubstr("column 1 is 'x' with 2 labels"));
  EXPECT_THAT(said({{}}), HasSubstr("with 0 labels"));
  EXPECT_THAT(said({{"n", "a", "x"}, {"n", "a", "y"}, {"m", "a", "x"}}),
              HasSubstr("point 'a' has a coordinate twice"));
  EXPECT_THAT(said({}), HasSubstr("do not fit"));
  EXPECT_FALSE(arrange_columns(kColumns, {0.0}, {1.0, 2.0, 3.0})) << "a row that is short";
  Columns sparse;
  for (int n = 0; n < 200; ++n)
    for (const char* coordinate : {"x", "y"})
      sparse.push_back({"n", "person" + std::to_string(n), "point" + std::to_string(n), coordinate});
  EXPECT_THAT(said(sparse), HasSubstr("200 individuals of 200 points, but only 400 columns"));
}

}  // namespace
}  // namespace kinemark::io
