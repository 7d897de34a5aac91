// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cmath>
#include <string>
#include <vector>

#include "kinemark/workflow/prepare/marker_screening.h"
#include "kinemark/workflow/prepare/prepare.h"

namespace kinemark::workflow {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr double kRate_hz = 100.0;
constexpr std::int64_t kFrames = 60;

Eigen::Vector3d path(double t) { return {0.2 * std::sin(6.0 * t), 0.1 * std::cos(9.0 * t), 0.3 * t * t}; }

/// Markers on one path, each measured a little later than the one before.
data::Trajectories in_turns(const std::vector<double>& offset_s) {
  std::vector<std::string> names;
  for (std::size_t m = 0; m < offset_s.size(); ++m)
    names.push_back(std::string(1, static_cast<char>('a' + m)));
  auto out = data::Trajectories::all_missing(names, {.rate_hz = kRate_hz, .t0_s = 0.5, .frames = kFrames});
  for (std::int64_t f = 0; f < kFrames; ++f)
    for (std::int64_t m = 0; m < out.markers(); ++m) {
      out.x(f, m) = path(out.time.time_s(f) + offset_s[static_cast<std::size_t>(m)]);
      out.state[out.index(f, m)] = data::SampleState::measured;
    }
  out.sample_offset_s.assign(offset_s.begin(), offset_s.end());
  return out;
}

double worst(const data::Trajectories& markers) {
  double most = 0.0;
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    for (std::int64_t m = 0; m < markers.markers(); ++m)
      if (markers.present(f, m))
        most = std::max(most, (markers.x(f, m) - path(markers.time.time_s(f))).norm());
  return most;
}

TEST(OneTime, MarkersThatWereMeasuredInTurnsAreWhereTheyWereAtTheFramesTime) {
  auto markers = in_turns({0.0, 0.002, 0.0068});
  EXPECT_GT(worst(markers), 8e-3);
  EXPECT_EQ(bring_to_one_time(markers),
            "markers of a frame were measured up to 6.8 ms apart; they were brought to the frame's time");
  EXPECT_TRUE(markers.sample_offset_s.empty());
  EXPECT_LT(worst(markers), 1.5e-3) << "the first frame, from a line of the next two";
  markers.set_missing(0, 2);
  EXPECT_LT(worst(markers), 0.1e-3);
}

TEST(OneTime, OffsetsBySampleAndBeforeTheFrameAreHeeded) {
  auto markers = in_turns({0.0, 0.0});
  markers.sample_offset_s.assign(markers.state.size(), 0.0);
  for (std::int64_t f = 0; f < kFrames; ++f) {
    const double late = 0.003 * std::sin(static_cast<double>(f));
    markers.sample_offset_s[markers.index(f, 1)] = late;
    markers.x(f, 1) = path(markers.time.time_s(f) + late);
  }
  EXPECT_THAT(bring_to_one_time(markers), HasSubstr("they were brought to the frame's time"));
  EXPECT_LT(worst(markers), 0.5e-3);
}

TEST(OneTime, OneInstantAFrameIsLeftAsItIs) {
  auto markers = in_turns({0.004, 0.004});
  const auto before = markers.x_in_world;
  EXPECT_THAT(bring_to_one_time(markers), IsEmpty());
  EXPECT_TRUE(std::ranges::equal(markers.x_in_world, before));
  EXPECT_EQ(markers.sample_offset_s.size(), 2U);
  auto plain = in_turns({0.0});
  plain.sample_offset_s.clear();
  EXPECT_THAT(bring_to_one_time(plain), IsEmpty());
}

TEST(OneTime, BesideGapsALineServesAndASampleAloneIsLeftOut) {
  auto markers = in_turns({0.0, 0.005});
  for (std::int64_t f = 10; f < 30; ++f)
    if (f != 20) markers.set_missing(f, 1);
  const auto note = bring_to_one_time(markers);
  EXPECT_THAT(note, HasSubstr("; samples without another beside them were left out (1), for"));
  EXPECT_FALSE(markers.present(20, 1));
  EXPECT_TRUE(markers.present(30, 1)) << "behind the gap";
  EXPECT_TRUE(markers.present(9, 1)) << "before it, between two";
  EXPECT_LT(worst(markers), 2e-3);
  auto whole = in_turns({0.0, 0.005});
  EXPECT_THAT(bring_to_one_time(whole), Not(HasSubstr("samples without another beside them were left out")));
}

TEST(OneTime, ASampleAtTheFramesTimeStaysThoughItIsAlone) {
  auto markers = in_turns({0.0, 0.005});
  for (std::int64_t f = 0; f < kFrames; ++f)
    if (f != 20) markers.set_missing(f, 0);
  const Eigen::Vector3d before = markers.x(20, 0);
  EXPECT_THAT(bring_to_one_time(markers), Not(HasSubstr("were left out")));
  ASSERT_TRUE(markers.present(20, 0));
  EXPECT_EQ(markers.x(20, 0), before);
}

TEST(OneTime, OffsetsOfSeveralFramesFindTheirSamples) {
  auto markers = in_turns({0.0, 0.054, -0.04});
  markers.set_missing(30, 1);
  static_cast<void>(bring_to_one_time(markers));
  EXPECT_LT(worst(markers), 1.5e-3);
  EXPECT_FALSE(markers.present(2, 1)) << "before its first sample";
  EXPECT_FALSE(markers.present(35, 1)) << "what was measured then is missing";
  EXPECT_TRUE(markers.present(30, 1)) << "another sample serves there";
  EXPECT_TRUE(markers.present(20, 2));
}

TEST(OneTime, CovariancesAreThoseOfTheMixtureAndStayThoseOfFilteredSamples) {
  auto markers = in_turns({0.0, 0.005});
  markers.covariance.assign(6 * markers.state.size(), 0.0);
  for (std::size_t i = 0; i < markers.state.size(); ++i) markers.covariance[6 * i] = 1e-6;
  auto filtered = markers;
  filtered.filters.assign(2, {.method = "kalman", .order = 4, .cutoff_hz = 4.0});
  static_cast<void>(bring_to_one_time(markers));
  static_cast<void>(bring_to_one_time(filtered));
  const auto at_half = 6 * markers.index(30, 1), at_own = 6 * markers.index(30, 0);
  EXPECT_NEAR(markers.covariance[at_half], 1e-6 * (2.0 * 81.0 + 2.0) / 256.0, 1e-15);
  EXPECT_DOUBLE_EQ(markers.covariance[at_own], 1e-6);
  EXPECT_EQ(filtered.covariance[at_half], 1e-6);
}

TEST(OneTime, ARecordingIsPreparedSoWhereItIsAskedFor) {
  data::Recording recording;
  recording.trial.markers = in_turns({0.0, 0.005});
  const auto as_it_is = prepare(recording, {.facts = HeldFacts::none()}).value();
  EXPECT_THAT(as_it_is.notes, Not(Contains(HasSubstr("brought to the frame's time"))));
  EXPECT_FALSE(as_it_is.trial.markers.sample_offset_s.empty());
  const auto at_once = prepare(recording, {.one_time = true, .facts = HeldFacts::none()}).value();
  EXPECT_THAT(at_once.notes, Contains(HasSubstr("brought to the frame's time")));
  EXPECT_TRUE(at_once.trial.markers.sample_offset_s.empty());
}

}  // namespace
}  // namespace kinemark::workflow
