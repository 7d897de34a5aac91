// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/merge_trials.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/index.h"

namespace kinemark::pipeline {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr double kRate = 100.0;

/// Frames [first, last] of one recording; a marker's place tells its name and frame.
data::Trial part(const std::string& source, std::int64_t first, std::int64_t last,
                 std::vector<std::string> names) {
  data::Trial t{.source = source, .format = "C3D", .first_frame = first};
  t.markers = data::Trajectories::all_missing(
      std::move(names),
      {.rate_hz = kRate, .t0_s = static_cast<double>(first - 1) / kRate, .frames = last - first + 1});
  for (std::int64_t f = 0; f < t.markers.frames(); ++f)
    for (std::int64_t m = 0; m < t.markers.markers(); ++m) {
      t.markers.x(f, m) = Eigen::Vector3d(static_cast<double>(f + first), t.markers.names[at(m)][0], 0.5);
      t.markers.state[t.markers.index(f, m)] = data::SampleState::measured;
    }
  return t;
}

void add_analog(data::Trial& t, std::vector<std::string> names = {"Fz"}) {
  const auto K = std::ssize(names);
  t.analog = {
      .names = std::move(names), .units = {}, .rate_hz = 2 * kRate, .samples = 2 * t.markers.frames()};
  t.analog.units.assign(at(K), "N");
  for (std::int64_t s = 0; s < t.analog.samples; ++s)
    for (std::int64_t k = 0; k < K; ++k)
      t.analog.values.push_back(static_cast<double>(2 * t.first_frame + s));
}

std::string refusal(std::vector<data::Trial> trials) {
  const auto merged = merge_trials(std::move(trials));
  if (merged) return "";
  EXPECT_EQ(merged.error().code, Code::bad_input);
  return merged.error().message;
}

TEST(MergeTrials, OneAloneStaysAsItIs) {
  const auto one = merge_trials({part("a", 5, 9, {"A"})}).value();
  EXPECT_EQ(one.source, "a");
  EXPECT_EQ(one.markers.frames(), 5);
  EXPECT_EQ(merge_trials({}).error().code, Code::usage);
}

TEST(MergeTrials, PartsInTimeFollowEachOtherByTheirNumbers) {
  const auto t = merge_trials({part("b", 8, 10, {"A", "B"}), part("a", 3, 5, {"A"})}).value();
  EXPECT_EQ(t.first_frame, 3);
  EXPECT_EQ(t.last_frame(), 10);
  EXPECT_DOUBLE_EQ(t.markers.time.t0_s, 0.02);
  EXPECT_THAT(t.markers.names, ElementsAre("A", "B"));
  for (std::int64_t f = 0; f < t.markers.frames(); ++f) {
    const std::int64_t number = f + 3;
    EXPECT_EQ(t.markers.present(f, 0), number <= 5 || number >= 8) << number;
    EXPECT_EQ(t.markers.present(f, 1), number >= 8) << number;
    if (t.markers.present(f, 0)) {
      EXPECT_EQ(t.markers.x(f, 0)[0], static_cast<double>(number));
    }
  }
  EXPECT_TRUE(t.validate()) << t.validate().error().message;
}

TEST(MergeTrials, SetsOfMarkersStandSideBySideWithAllThatIsKnownOfThem) {
  auto a = part("a", 1, 4, {"A"}), b = part("b", 1, 4, {"B"});
  b.markers.covariance.assign(24, 1e-6);
  b.markers.state[1] = data::SampleState::interpolated;
  b.markers.set_method(1, 0, "cubic");
  b.residual_m.assign(4, 2e-3F);
  b.camera_mask.assign(4, 5);
  b.markers.sample_offset_s = {1e-3};
  const auto t = merge_trials({a, b}).value();
  EXPECT_THAT(t.markers.names, ElementsAre("A", "B"));
  EXPECT_EQ(t.markers.state[t.markers.index(1, 1)], data::SampleState::interpolated);
  EXPECT_EQ(t.markers.made_by(1, 1), "cubic");
  EXPECT_EQ(t.markers.made_by(1, 0), "");
  EXPECT_EQ(t.markers.covariance[6 * t.markers.index(2, 1)], 1e-6);
  EXPECT_TRUE(std::isnan(t.markers.covariance[6 * t.markers.index(2, 0)]));
  EXPECT_EQ(t.residual_m[t.markers.index(2, 1)], 2e-3F);
  EXPECT_TRUE(std::isnan(t.residual_m[t.markers.index(2, 0)]));
  EXPECT_EQ(t.camera_mask[t.markers.index(2, 1)], 5);
  EXPECT_EQ(t.markers.sample_offset_s[t.markers.index(2, 1)], 1e-3);
  EXPECT_TRUE(t.validate()) << t.validate().error().message;
}

TEST(MergeTrials, ASampleThatBothHoldMustBeTheSame) {
  auto a = part("a.c3d", 1, 4, {"A"}), b = part("b.c3d", 3, 6, {"A"});
  b.markers.x(0, 0)[2] += 5e-5;
  EXPECT_EQ(merge_trials({a, b}).value().markers.x(2, 0)[2], 0.5) << "the first file's";
  b.markers.x(1, 0)[2] += 2e-3;
  EXPECT_EQ(
      refusal({a, b}),
      "a.c3d and b.c3d cannot be merged: 'A' lies 2.0 mm apart in frame 4; leave it out of one of them");
  b.markers.set_missing(1, 0);
  EXPECT_THAT(refusal({a, b}), Not(HasSubstr("; leave it out of one of them")));
  a.markers.set_missing(3, 0, data::SampleState::rejected);
  EXPECT_FALSE(merge_trials({a, b}).value().markers.present(3, 0));
}

TEST(MergeTrials, FilesOfOtherRecordingsAreRefused) {
  auto a = part("a", 1, 4, {"A"}), b = part("b", 5, 6, {"A"});
  b.markers.time.rate_hz = 120.0;
  EXPECT_THAT(refusal({a, b}), HasSubstr("100 and 120 frames per second; need one rate"));
  b = part("b", 5, 6, {"A"});
  b.markers.time.t0_s = 0.0;
  EXPECT_THAT(refusal({a, b}),
              HasSubstr("frame 1 is at 0.0000 and at -0.0400 s; need files of one recording"));
  EXPECT_THAT(refusal({a, part("b", 1000, 1003, {"A"})}),
              HasSubstr("1003 frames from the first to the last, of which 8"));
  // Nothing of that where the files belong together.
  const auto together = refusal({a, part("b", 30, 33, {"A"})});
  EXPECT_EQ(together, "");
  EXPECT_THAT(together, Not(HasSubstr("frames per second; need one rate")));
  EXPECT_THAT(together, Not(HasSubstr("need files of one recording, which count frames and time alike")));
  EXPECT_THAT(together, Not(HasSubstr("frames from the first to the last, of which")));
}

TEST(MergeTrials, AnalogSamplesThatFollowEachOtherAreJoined) {
  auto a = part("a", 1, 3, {"A"}), b = part("b", 3, 6, {"A"});
  add_analog(a);
  add_analog(b);
  a.force_plates = b.force_plates = {{.type = 2, .channel_idx = {0}}};
  a.unloaded_s = {a.markers.time.t0_s, a.markers.time.time_s(1)};
  const auto t = merge_trials({b, a}).value();
  EXPECT_EQ(t.analog.samples, 12);
  for (std::int64_t s = 0; s < 12; ++s) EXPECT_EQ(t.analog.values[at(s)], static_cast<double>(2 + s));
  EXPECT_EQ(t.force_plates.size(), 1U);
  EXPECT_EQ(t.unloaded_s, a.unloaded_s);
  EXPECT_THAT(t.warnings, IsEmpty());
  EXPECT_THAT(t.warnings,
              Not(Contains(HasSubstr("left out: the files do not hold the same ones over all frames"))));
}

TEST(MergeTrials, AnalogSamplesThatDoNotFitAreLeftOutAndSaid) {
  auto a = part("a", 1, 3, {"A"}), b = part("b", 5, 6, {"A"}), c = part("c", 4, 6, {"A"});
  add_analog(a);
  add_analog(b);
  add_analog(c, {"EMG"});
  for (const auto& other : {b, c, part("d", 4, 6, {"A"})}) {
    const auto t = merge_trials({a, other}).value();
    EXPECT_THAT(t.analog.names, IsEmpty());
    EXPECT_THAT(t.warnings,
                Contains(HasSubstr("1 analog channel and 0 force plates left out: the files do not hold "
                                   "the same ones over all frames")));
    EXPECT_TRUE(t.validate());
  }
}

TEST(MergeTrials, ChannelsAndEventsAreThoseOfAll) {
  auto a = part("a", 1, 2, {"A"}), b = part("b", 3, 4, {"A"});
  const data::Channels angle{.names = {"LKnee"},
                             .kinds = {data::ChannelKind::angle},
                             .units = {"deg"},
                             .rate_hz = kRate,
                             .frames = 2,
                             .values = {1, 2, 3, 4, 5, 6}};
  a.channels = b.channels = angle;
  b.channels.names = {"RKnee"};
  a.events = {{.label = "Foot Strike", .context = "Left", .time_s = 0.012}};
  b.events = {{.label = "Foot Off", .context = "Left", .time_s = 0.001},
              {.label = "Foot Strike", .context = "Left", .time_s = 0.0121}};
  a.foreign = b.foreign = {{.name = "SUBJECTS"}};
  a.warnings = {"odd"};
  const auto t = merge_trials({a, b}).value();
  EXPECT_THAT(t.channels.names, ElementsAre("LKnee", "RKnee"));
  EXPECT_EQ(t.channels.values[at(3 * (1 * 2 + 0))], 4.0);
  EXPECT_TRUE(std::isnan(t.channels.values[at(3 * (2 * 2 + 0))]));
  EXPECT_EQ(t.channels.values[at(3 * (3 * 2 + 1) + 2)], 6.0);
  ASSERT_EQ(t.events.size(), 2U);
  EXPECT_EQ(t.events[0].label, "Foot Off");
  EXPECT_THAT(t.warnings, ElementsAre("a: odd", "1 group of parameters of b left out; those of a are kept"));
  EXPECT_TRUE(t.validate());
  b.foreign.clear();
  EXPECT_THAT(merge_trials({a, b})->warnings, Not(Contains(HasSubstr("b left out; those of a are kept"))));
  b.channels = angle;
  EXPECT_THAT(refusal({a, b}), Not(HasSubstr("' is of another kind or unit; leave it out")));
  b.channels.units = {"rad"};
  EXPECT_THAT(refusal({a, b}),
              HasSubstr("channel 'LKnee' is of another kind or unit; leave it out of one of them"));
}

/// The same, smoothed, with the samples from before.
data::Trial smoothed(data::Trial t, double cutoff_hz) {
  for (std::size_t m = 0; m < t.markers.names.size(); ++m)
    t.markers.filters.push_back({.method = "kalman", .order = 4, .cutoff_hz = cutoff_hz});
  t.markers.unfiltered_in_world = t.markers.x_in_world;
  for (double& v : t.markers.unfiltered_in_world) v += 0.001;
  return t;
}

TEST(MergeTrials, FiltersAndSamplesFromBeforeComeAlong) {
  const auto t = merge_trials({smoothed(part("a", 1, 5, {"A"}), 6.0), part("b", 1, 5, {"B"}),
                               smoothed(part("c", 4, 8, {"A"}), 6.0)})
                     .value();
  ASSERT_TRUE(t.validate()) << t.validate().error().message;
  ASSERT_EQ(t.markers.filters.size(), 2U);
  EXPECT_EQ(t.markers.filters[0].cutoff_hz, 6.0);
  EXPECT_EQ(t.markers.filters[1].method, "none");
  for (std::int64_t f = 0; f < 8; ++f) {
    EXPECT_EQ(t.markers.unfiltered_in_world[3 * t.markers.index(f, 0)], t.markers.x(f, 0).x() + 0.001);
    EXPECT_TRUE(std::isnan(t.markers.unfiltered_in_world[3 * t.markers.index(f, 1)]));
  }
}

TEST(MergeTrials, TheErrorOfOneCalibrationComesAlong) {
  auto a = part("a.c3d", 1, 10, {"A"}), b = part("b.c3d", 1, 10, {"B"});
  a.calibration_error.fields = b.calibration_error.fields = {data::CalibrationError::Field::Constant(1e-4)};
  const auto one = merge_trials({a, b}).value();
  EXPECT_EQ(one.calibration_error.fields, a.calibration_error.fields);
  EXPECT_THAT(one.warnings, Not(Contains(HasSubstr("what calibrations leave unknown"))));
  b.calibration_error.fields.clear();
  const auto two = merge_trials({a, b}).value();
  EXPECT_FALSE(two.calibration_error.known());
  EXPECT_THAT(
      two.warnings,
      Contains("what calibrations leave unknown of positions is left out: the files do not hold the same"));
}

TEST(MergeTrials, OfOneFileGoesAlongWhatIsNoMovement) {
  auto a = part("a.c3d", 1, 10, {"A"}), b = part("b.nwb", 1, 10, {"B"}), c = part("c.nwb", 1, 10, {"C"});
  b.beside = {
      .file = "b.nwb", .room = "/processing/behavior", .objects = {{.path = "/units", .type = "Units"}}};
  const auto one = merge_trials({a, b}).value();
  EXPECT_EQ(one.beside.file, "b.nwb");
  EXPECT_THAT(one.unread, Not(Contains(HasSubstr("holds besides movement ("))));
  c.beside = b.beside;
  c.beside.file = "c.nwb";
  const auto two = merge_trials({a, b, c}).value();
  EXPECT_EQ(two.beside.file, "b.nwb");
  EXPECT_THAT(two.unread, ElementsAre("what c.nwb holds besides movement (/units)"));
}

TEST(MergeTrials, OneMarkerThroughTwoFiltersIsRefused) {
  const auto a = smoothed(part("a", 1, 5, {"A"}), 6.0);
  EXPECT_THAT(refusal({a, smoothed(part("b", 6, 9, {"A"}), 7.0)}),
              HasSubstr("'A' went through different filters; leave it out of one of them"));
  EXPECT_THAT(refusal({a, smoothed(part("b", 6, 9, {"A"}), 6.0)}),
              Not(HasSubstr("' went through different filters")));
  EXPECT_THAT(refusal({a, part("b", 6, 9, {"A"})}), HasSubstr("different filters"));
  EXPECT_THAT(refusal({part("b", 6, 9, {"A"}), a}), HasSubstr("different filters"));
}

}  // namespace
}  // namespace kinemark::pipeline
