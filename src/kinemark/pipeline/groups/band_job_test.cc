// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/groups/band_job.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "kinemark/io/file.h"
#include "kinemark/pipeline/groups/norm_job.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class BandJobTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(io::write_text(curves_, "1,2,3,4\n2,2,5,4\n3,5,4,4\n2,3,4,5\n", false));
  }

  testing_support::ScratchFolder scratch_;
  std::filesystem::path curves_ = scratch_ / "walk.csv";
};

TEST_F(BandJobTest, BandsAreWrittenAndReadBackAsANorm) {
  const auto outcome = run_band({.inputs = {curves_}, .output = scratch_ / "band.csv"});
  ASSERT_TRUE(outcome) << outcome.error().message;
  ASSERT_EQ(outcome->bands.size(), 1u);
  EXPECT_EQ(outcome->bands[0].mean[0], 2.0);
  EXPECT_THAT(band_text(*outcome),
              HasSubstr("walk: 4 curves, 4 points; at all points at once with 95 %: the mean curve within"));
  EXPECT_THAT(band_text(*outcome), Not(HasSubstr("points have no band: a curve is missing")));
  EXPECT_THAT(band_text(*outcome), Not(HasSubstr("at each of the 4 points a curve is missing")));
  const auto norm = read_norm(scratch_ / "band.csv", "point", {});
  ASSERT_TRUE(norm) << norm.error().message;
  EXPECT_NEAR(norm->high[0] - norm->low[0], 2.0 * outcome->bands[0].of_one(0), 1e-7);
  EXPECT_EQ(norm->meaning, "simultaneous band of one further curve");
}

TEST_F(BandJobTest, WhereACurveIsMissingThereIsNoBand) {
  ASSERT_TRUE(io::write_text(scratch_ / "hole.csv", "1,2,3\n2,nan,5\n3,5,4\n2,3,4\n", false));
  EXPECT_THAT(band_text(*run_band({.inputs = {scratch_ / "hole.csv"}})),
              HasSubstr("  1 points have no band: a curve is missing there\n"));
  ASSERT_TRUE(io::write_text(scratch_ / "none.csv", "2,3,4\nnan,2,3\n2,nan,5\n3,5,nan\n", false));
  const auto none = band_text(*run_band({.inputs = {scratch_ / "none.csv"}}));
  EXPECT_EQ(none, "none: 4 curves have no band: at each of the 3 points a curve is missing\n");
  EXPECT_THAT(none, Not(HasSubstr("points; at all points at once with")));
}

TEST_F(BandJobTest, JsonHoldsBothBands) {
  ASSERT_TRUE(run_band({.inputs = {curves_}, .output = scratch_ / "band.json"}));
  const auto json = nlohmann::json::parse(io::read_text(scratch_ / "band.json").value());
  const auto& group = json["groups"][0];
  EXPECT_EQ(group["mean"].size(), 4u);
  EXPECT_GT(group["half_width_of_one"][0], group["half_width_of_mean"][0]);
}

TEST_F(BandJobTest, AGroupThatIsTooSmallIsNamed) {
  ASSERT_TRUE(io::write_text(scratch_ / "few.csv", "1,2\n3,4\n", false));
  const auto outcome = run_band({.inputs = {scratch_ / "few.csv"}});
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.error().code, Code::bad_input);
  EXPECT_THAT(outcome.error().message, HasSubstr("group 'few': "));
  EXPECT_EQ(run_band({.inputs = {curves_}, .level = 1.0}).error().code, Code::usage);
}

}  // namespace
}  // namespace kinemark::pipeline
