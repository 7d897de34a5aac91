// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/filtering.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace kinemark::data {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Four frames of two markers; the first was smoothed, the second was not. Frame 1 was filled, frame 2
/// rejected.
Trajectories half_smoothed() {
  auto t = Trajectories::all_missing({"A", "B"}, {.rate_hz = 100.0, .frames = 4});
  t.unfiltered_in_world.assign(t.x_in_world.size(), kNone);
  t.covariance.assign(2 * t.x_in_world.size(), 1e-8);
  for (std::int64_t f = 0; f < 4; ++f)
    for (std::int64_t m = 0; m < 2; ++m) {
      t.x(f, m).setConstant(static_cast<double>(f));
      t.state[t.index(f, m)] = SampleState::measured;
    }
  for (const std::size_t f : {0U, 3U})
    for (std::size_t k = 0; k < 3; ++k) t.unfiltered_in_world[3 * 2 * f + k] = 0.5 + static_cast<double>(f);
  t.state[t.index(1, 0)] = SampleState::interpolated;
  t.set_method(1, 0, "cubic");
  t.set_missing(2, 0, SampleState::rejected);
  t.filters = {{.method = "kalman", .order = 5, .cutoff_hz = 6.4, .noise_sd_m = 2e-4},
               {.method = "none", .cutoff_hz = kNone, .noise_sd_m = kNone}};
  mark_smoothed(t, 0, "kalman");
  return t;
}

TEST(Filtering, MarksMeasuredSamplesAndNoOthers) {
  const auto t = half_smoothed();
  EXPECT_EQ(t.made_by(0, 0), "smoothed by kalman");
  EXPECT_EQ(t.made_by(1, 0), "cubic");
  EXPECT_EQ(t.made_by(2, 0), "");
  EXPECT_EQ(t.made_by(0, 1), "");
  EXPECT_TRUE(was_filtered(t, 0));
  EXPECT_FALSE(was_filtered(t, 1)) << "none is no filter";
  EXPECT_TRUE(keeps_unfiltered(t, 0));
  EXPECT_FALSE(keeps_unfiltered(t, 1));
}

TEST(Filtering, AMethodThatWasThereStaysAndASecondFilterTakesThePlaceOfTheFirst) {
  auto t = half_smoothed();
  t.set_method(3, 1, "edited");
  mark_smoothed(t, 1, "gcv");
  mark_smoothed(t, 0, "gcv");
  EXPECT_EQ(t.made_by(3, 1), "edited, smoothed by gcv");
  EXPECT_EQ(t.made_by(0, 0), "smoothed by gcv");
  mark_smoothed(t, 1, "savgol");
  EXPECT_EQ(t.made_by(3, 1), "edited, smoothed by savgol");
}

TEST(Filtering, RestoresWhatWasMeasuredAndNothingElse) {
  auto t = half_smoothed();
  ASSERT_TRUE(restore_unfiltered(t));
  EXPECT_EQ(t.x(0, 0).x(), 0.5);
  EXPECT_EQ(t.x(3, 0).z(), 3.5);
  EXPECT_EQ(t.state[t.index(1, 0)], SampleState::missing) << "it was filled";
  EXPECT_EQ(t.state[t.index(2, 0)], SampleState::rejected);
  EXPECT_EQ(t.x(1, 1).x(), 1.0) << "it was not filtered";
  EXPECT_EQ(t.made_by(0, 0), "");
  EXPECT_TRUE(t.filters.empty() && t.unfiltered_in_world.empty() && t.covariance.empty());
  EXPECT_TRUE(t.validate());
  EXPECT_FALSE(restore_unfiltered(t)) << "once is enough";
}

TEST(Filtering, LeavesAllAsItIsWhereAMarkerHasNoSamplesFromBefore) {
  auto t = half_smoothed();
  t.filters[1] = t.filters[0];
  const auto before = t;
  EXPECT_FALSE(restore_unfiltered(t));
  EXPECT_EQ(t.state, before.state);
  EXPECT_EQ(t.filters.size(), 2U);
}

TEST(Filtering, ForgetsSmoothingButNotWhatWasThereBeforeIt) {
  auto t = half_smoothed();
  t.method.clear();
  t.methods.clear();
  t.set_method(0, 0, "edited");
  mark_smoothed(t, 0, "kalman");
  ASSERT_TRUE(restore_unfiltered(t));
  EXPECT_EQ(t.made_by(0, 0), "edited");
  EXPECT_EQ(t.made_by(3, 0), "");
}

TEST(Filtering, TwoFiltersAreTheLowerOneOfUnknownNoise) {
  const FilterUsed wide{.method = "butterworth", .order = 2, .cutoff_hz = 12.0, .noise_sd_m = 1e-3},
      narrow{.method = "kalman", .order = 5, .cutoff_hz = 6.0, .noise_sd_m = 1e-4};
  const auto both = one_after_other(wide, narrow);
  EXPECT_EQ(both.method, "butterworth, kalman");
  EXPECT_EQ(both.cutoff_hz, 6.0);
  EXPECT_TRUE(std::isnan(both.noise_sd_m));
  EXPECT_EQ(one_after_other({.method = "none"}, narrow).noise_sd_m, 1e-4);
  EXPECT_EQ(one_after_other(wide, {.method = "none"}).method, "butterworth");
  EXPECT_EQ(one_after_other({.method = "savgol", .cutoff_hz = kNone}, narrow).cutoff_hz, 6.0);
}

TEST(Filtering, TellsWhatIsKnown) {
  auto t = half_smoothed();
  EXPECT_EQ(describe_filters(t),
            "1 of 2 markers was smoothed by kalman (order 5; -3 dB at 6.4 Hz; noise before it 0.2 mm); the "
            "samples from before are kept beside them");
  t.filters[1] = {.method = "gcv", .order = 3, .cutoff_hz = 9.0, .noise_sd_m = kNone};
  EXPECT_THAT(describe_filters(t), ::testing::StartsWith("2 markers were smoothed by gcv or kalman (order 3 "
                                                         "to 5; -3 dB at 6.4 to 9 Hz;"));
  EXPECT_THAT(describe_filters(t), HasSubstr("the samples from before are kept of 1 of them"));
  EXPECT_THAT(describe_filters(t), Not(HasSubstr("the samples from before are kept beside them")));
  t.unfiltered_in_world.clear();
  EXPECT_THAT(describe_filters(t), HasSubstr("the samples from before are not there"));
  EXPECT_THAT(describe_filters(t), Not(HasSubstr("the samples from before are kept of")));
  EXPECT_THAT(note_on_noise(t), ::testing::EndsWith("deviations that rest on it, are too small"));
  t.filters.clear();
  EXPECT_EQ(describe_filters(t), "");
  EXPECT_EQ(note_on_noise(t), "");
}

TEST(Filtering, SaysOnlyWhatIsThere) {
  auto t = half_smoothed();
  EXPECT_THAT(describe_filters(t), Not(HasSubstr("the samples from before are not there")));
  EXPECT_THAT(describe_filters(t), Not(HasSubstr("the samples from before are kept of")));
  t.filters[0].method = "none";
  EXPECT_THAT(note_on_noise(t),
              Not(HasSubstr("noise that is found in the smoothed samples, and deviations that rest")));
  EXPECT_EQ(note_on_noise(t), "") << "none is no filter";
  t.filters[0] = {.method = "butterworth", .order = 0, .cutoff_hz = kNone, .noise_sd_m = kNone};
  t.unfiltered_in_world.clear();
  EXPECT_EQ(describe_filters(t),
            "1 of 2 markers was smoothed by butterworth; the samples from before are not there")
      << "no number that is not known";
}

TEST(Filtering, AMarkerThatWasNeverSeenKeepsNothingBack) {
  auto t = half_smoothed();
  t.filters[1] = t.filters[0];
  for (std::int64_t f = 0; f < t.frames(); ++f) t.set_missing(f, 1);
  EXPECT_FALSE(keeps_unfiltered(t, 1));
  EXPECT_TRUE(restore_unfiltered(t));
  EXPECT_EQ(t.x(0, 0).x(), 0.5);
  EXPECT_FALSE(t.present(0, 1));
}

}  // namespace
}  // namespace kinemark::data
