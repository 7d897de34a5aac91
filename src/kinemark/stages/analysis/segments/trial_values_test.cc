// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/segments/internal/trial_values.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/stages/analysis/segments/testing/formulas.h"

namespace kinemark::analysis::internal {
namespace {

using Eigen::Vector3d;

// Two markers, the second 0.3 to 0.5 m above the first; it is missing in the last frame.
class TrialValues : public ::testing::Test {
 protected:
  TrialValues() {
    for (std::int64_t f = 0; f < 4; ++f) {
      markers_.x(f, 0) = Vector3d(1.0, 2.0, 0.0);
      markers_.x(f, 1) = Vector3d(1.0, 2.0, 0.3 + 0.1 * static_cast<double>(f));
      for (std::int64_t m = 0; m < 2; ++m) markers_.state[markers_.index(f, m)] = data::SampleState::measured;
    }
    markers_.set_missing(3, 1);
  }
  Result<std::vector<Vector3d>> of(const std::string& text, StepType type) {
    const auto formula = testing::of(text);
    const TrialMarkers trial(markers_, aliases_);
    Subject subject;
    return values_over({}, {.formula = &formula, .type = type, .what = "it"}, subject.names(trial, false),
                       subject, trial);
  }

  data::Trajectories markers_ = data::Trajectories::all_missing({"A", "B"}, {.rate_hz = 100.0, .frames = 4});
  std::map<std::string, std::string> aliases_;
};

TEST_F(TrialValues, AreThoseOfFramesThatGiveOne) {
  const auto lengths = of("distance(A, B)", StepType::number);
  ASSERT_TRUE(lengths);
  ASSERT_EQ(lengths->size(), 3U);
  EXPECT_NEAR((*lengths)[1].x(), 0.4, 1e-12);
  const auto mean = trial_mean(*lengths);
  EXPECT_EQ(mean.frames, 3);
  EXPECT_NEAR(mean.mean.x(), 0.4, 1e-12);
  EXPECT_NEAR(mean.sd.x(), 0.1 / std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(mean.first.x(), 0.3, 1e-12);
  EXPECT_NEAR(mean.last.x(), 0.5, 1e-12);
}

TEST_F(TrialValues, AreNoneWhereAMarkerIsLacking) {
  const auto none = of("distance(A, C)", StepType::number);
  ASSERT_TRUE(none);
  EXPECT_TRUE(none->empty());
  EXPECT_EQ(trial_mean(*none).frames, 0);
  EXPECT_TRUE(std::isnan(trial_mean(*none).mean.x()));
}

TEST_F(TrialValues, AMarkerGoesByItsAliasToo) {
  aliases_["Top"] = "B";
  const auto points = of("Top", StepType::vector);
  ASSERT_TRUE(points);
  ASSERT_EQ(points->size(), 3U);
  EXPECT_NEAR((*points)[2].z(), 0.5, 1e-12);
}

}  // namespace
}  // namespace kinemark::analysis::internal
