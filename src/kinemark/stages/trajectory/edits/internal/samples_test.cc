// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/edits/internal/samples.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/stages/trajectory/edits/testing/edited.h"
#include "kinemark/stages/trajectory/edits/testing/numbered_trial.h"

namespace kinemark::trajectory::internal {
namespace {

using data::SampleState;
using testing::bytes_of;
using ::testing::ElementsAre;
using testing::moving_trial;
using testing::numbered_trial;

/// Everything that is known of one sample.
std::vector<double> known_of(const data::Trial& t, std::int64_t f, std::int64_t m) {
  const auto i = t.markers.index(f, m);
  std::vector<double> out{static_cast<double>(t.markers.state[i]), t.markers.time_s(f, m)};
  if (t.markers.present(f, m)) out.insert(out.end(), {t.markers.x(f, m).x(), t.markers.x(f, m).z()});
  if (!t.markers.method.empty()) out.push_back(t.markers.method[i]);
  if (!t.markers.covariance.empty()) out.push_back(t.markers.covariance[6 * i + 5]);
  out.push_back(std::isnan(t.residual_m[i]) ? -1.0 : static_cast<double>(t.residual_m[i]));
  out.push_back(t.camera_mask[i]);
  return out;
}

TEST(EditSamples, SwapExchangesAllThatIsKnownInTheFramesAlone) {
  const auto before = numbered_trial();
  auto after = before;
  swap_samples(after, 0, 2, {.first = 3, .count = 4});
  ASSERT_TRUE(after.validate());
  for (std::int64_t f = 0; f < 10; ++f)
    for (std::int64_t m = 0; m < 3; ++m) {
      const bool swapped = f >= 3 && f < 7 && m != 1;
      EXPECT_EQ(known_of(after, f, m), known_of(before, f, swapped ? 2 - m : m)) << f << ' ' << m;
    }
}

TEST(EditSamples, TimesOfMarkersGoWithTheirSamplesAndComeBack) {
  auto trial = moving_trial();
  const auto before = trial;
  ASSERT_EQ(trial.markers.sample_offset_s.size(), 6U);
  swap_samples(trial, 1, 4, {.first = 10, .count = 5});
  EXPECT_EQ(trial.markers.sample_offset_s.size(), 1200U);
  EXPECT_EQ(trial.markers.time_s(12, 1), before.markers.time_s(12, 4));
  EXPECT_EQ(trial.markers.time_s(9, 1), before.markers.time_s(9, 1));
  gather_times(trial.markers);
  EXPECT_EQ(trial.markers.sample_offset_s.size(), 1200U) << "they differ";
  swap_samples(trial, 1, 4, {.first = 10, .count = 5});
  gather_times(trial.markers);
  EXPECT_EQ(bytes_of(trial), bytes_of(before));
}

TEST(EditSamples, MoveTakesPresentSamplesAlone) {
  const auto before = numbered_trial();
  auto trial = before;
  for (std::int64_t f = 0; f < 10; ++f) blank_sample(trial, f, 1, SampleState::rejected);
  move_samples(trial, 0, 1, {.first = 0, .count = 10});
  ASSERT_TRUE(trial.validate());
  for (std::int64_t f = 0; f < 10; ++f) {
    const auto i = trial.markers.index(f, 0);
    EXPECT_EQ(trial.markers.state[i], SampleState::missing);
    if (before.markers.present(f, 0)) {
      EXPECT_EQ(known_of(trial, f, 1), known_of(before, f, 0)) << f;
      EXPECT_TRUE(std::isnan(trial.markers.covariance[6 * i]));
      EXPECT_EQ(trial.camera_mask[i], 0);
    } else {
      EXPECT_EQ(trial.markers.state[trial.markers.index(f, 1)], SampleState::rejected);
    }
  }
}

TEST(EditSamples, ABlankSampleIsKnownNothingOf) {
  auto trial = numbered_trial();
  const auto time = trial.markers.time_s(5, 1);
  blank_sample(trial, 5, 0, SampleState::rejected);
  const auto i = trial.markers.index(5, 0);
  EXPECT_EQ(trial.markers.state[i], SampleState::rejected);
  EXPECT_EQ(trial.markers.made_by(5, 0), "");
  EXPECT_TRUE(std::isnan(trial.residual_m[i]));
  EXPECT_TRUE(trial.validate());
  EXPECT_EQ(trial.markers.time_s(5, 1), time);
  forget_cameras(trial, 6, 1);
  EXPECT_EQ(trial.camera_mask[trial.markers.index(6, 1)], 0);
  EXPECT_TRUE(trial.markers.present(6, 1));
}

TEST(EditSamples, AnAddedMarkerChangesNoOther) {
  for (const auto& before : {numbered_trial(), moving_trial()}) {
    auto trial = before;
    add_marker(trial, "new", 1);
    ASSERT_TRUE(trial.validate()) << trial.validate().error().message;
    const auto M = before.markers.markers();
    EXPECT_EQ(trial.markers.names.back(), "new");
    for (std::int64_t f = 0; f < before.markers.frames(); ++f) {
      for (std::int64_t m = 0; m < M; ++m) ASSERT_EQ(known_of(trial, f, m), known_of(before, f, m));
      ASSERT_EQ(trial.markers.state[trial.markers.index(f, M)], SampleState::missing);
      ASSERT_EQ(trial.markers.time_s(f, M), before.markers.time_s(f, 1));
    }
    EXPECT_EQ(trial.markers.sample_offset_s.size() > trial.markers.names.size(),
              before.markers.sample_offset_s.size() > before.markers.names.size());
  }
}

}  // namespace
}  // namespace kinemark::trajectory::internal
