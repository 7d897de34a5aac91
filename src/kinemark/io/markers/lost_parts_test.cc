// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/markers/lost_parts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "support/scratch.h"

namespace kinemark::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::array kAllParts = {Part::provenance, Part::covariance, Part::sample_times, Part::residuals,
                                  Part::channels,   Part::analog,     Part::events,       Part::force_plates,
                                  Part::groups,     Part::filters,    Part::calibration};

/// Two markers, four frames, nothing but positions.
data::Trial bare() {
  data::Trial trial;
  trial.markers = data::Trajectories::all_missing({"A", "B"}, {.rate_hz = 100.0, .t0_s = 0.0, .frames = 4});
  for (std::int64_t f = 0; f < 3; ++f)
    for (std::int64_t m = 0; m < 2; ++m) {
      trial.markers.x(f, m) = Eigen::Vector3d(0.5, 0.25, 1.0);
      trial.markers.state[trial.markers.index(f, m)] = data::SampleState::measured;
    }
  return trial;
}

/// The same with something of one part.
data::Trial with(Part part) {
  data::Trial t = bare();
  const std::size_t samples = t.markers.state.size();
  switch (part) {
    case Part::provenance:
      t.markers.state[0] = data::SampleState::interpolated;
      t.markers.set_missing(1, 0, data::SampleState::rejected);
      break;
    case Part::covariance:
      t.markers.covariance.assign(6 * samples, 1e-6);
      break;
    case Part::sample_times:
      t.markers.sample_offset_s.assign(2, 1e-3);
      break;
    case Part::residuals:
      t.residual_m.assign(samples, 1e-3F);
      break;
    case Part::channels:
      t.channels = {.names = {"LKneeAngles"},
                    .kinds = {data::ChannelKind::angle},
                    .units = {"deg"},
                    .rate_hz = 100.0,
                    .frames = 4};
      t.channels.values.assign(12, 1.0);
      break;
    case Part::analog:
      t.analog = {.names = {"EMG"}, .units = {"V"}, .rate_hz = 100.0, .samples = 4};
      t.analog.values.assign(4, 0.5);
      break;
    case Part::events:
      t.events = {{.label = "Foot Strike", .time_s = 0.01}, {.label = "Foot Off", .time_s = 0.02}};
      break;
    case Part::force_plates:
      t.analog = {.names = {"F1", "F2", "F3", "F4", "F5", "F6"},
                  .units = {"N", "N", "N", "Nm", "Nm", "Nm"},
                  .rate_hz = 100.0,
                  .samples = 4};
      t.analog.values.assign(24, 0.5);
      t.force_plates = {{.type = 2, .channel_idx = {0, 1, 2, 3, 4, 5}}};
      break;
    case Part::groups:
      t.foreign = {{.name = "SUBJECTS"}};
      break;
    case Part::filters:
      t.markers.filters = {{.method = "kalman", .order = 4, .cutoff_hz = 6.5, .noise_sd_m = 2e-4},
                           {.method = "gcv", .order = 3, .cutoff_hz = 9.0, .noise_sd_m = 1e-4}};
      t.markers.unfiltered_in_world = t.markers.x_in_world;
      break;
    case Part::calibration:
      t.calibration_error.fields = {data::CalibrationError::Field::Constant(1e-4)};
      break;
  }
  return t;
}

TEST(LostParts, APlainRecordingLosesNothingAnywhere) {
  for (const Part part : kAllParts) EXPECT_EQ(held(bare(), part), "");
  for (const MarkerFormat& f : marker_formats()) {
    if (f.write == nullptr) continue;
    EXPECT_THAT(lost_in(f, bare()), IsEmpty()) << f.name;
  }
}

TEST(LostParts, EachPartIsSeenAndNoneBesides) {
  for (const Part part : kAllParts)
    for (const Part other : kAllParts) {
      const bool comes_with = part == Part::force_plates && other == Part::analog;
      EXPECT_EQ(held(with(part), other).empty(), part != other && !comes_with)
          << static_cast<int>(part) << ' ' << static_cast<int>(other);
    }
}

TEST(LostParts, TheSentencesCountAndName) {
  const MarkerFormat& trc = *written_format(".trc");
  EXPECT_THAT(lost_in(trc, with(Part::events)), ElementsAre("2 events cannot be stored in a .trc file"));
  EXPECT_THAT(lost_in(trc, with(Part::provenance)),
              ElementsAre("the provenance of 2 samples cannot be stored in a .trc file"));
  EXPECT_THAT(lost_in(trc, with(Part::channels)),
              ElementsAre("1 channel that is no marker (LKneeAngles) cannot be stored in a .trc file"));
  EXPECT_THAT(lost_in(trc, with(Part::groups)),
              ElementsAre("1 group of parameters cannot be stored in a .trc file"));
  EXPECT_THAT(
      lost_in(trc, with(Part::filters)),
      ElementsAre("the filters of markers and their samples from before cannot be stored in a .trc file"));
  EXPECT_THAT(
      lost_in(trc, with(Part::calibration)),
      ElementsAre("what the calibration leaves unknown of all positions cannot be stored in a .trc file"));
  data::Trial stated = with(Part::filters);
  stated.markers.unfiltered_in_world.clear();
  EXPECT_THAT(lost_in(trc, stated), ElementsAre("the filters of markers cannot be stored in a .trc file"));
  EXPECT_THAT(lost_in(*written_format(".c3d"), with(Part::covariance)),
              ElementsAre(HasSubstr("covariances of samples are kept as one standard deviation")));
}

TEST(LostParts, WhatAFormatKeepsInPartMayBeAllThereIs) {
  data::Trial trial = with(Part::covariance);
  for (std::size_t i = 0; i < trial.markers.covariance.size(); ++i)
    trial.markers.covariance[i] = i % 6 == 0 || i % 6 == 3 || i % 6 == 5 ? 4e-6 : 0.0;
  EXPECT_THAT(lost_in(*written_format(".c3d"), trial), IsEmpty());
  EXPECT_THAT(lost_in(*written_format(".trc"), trial), ElementsAre(HasSubstr("covariances of samples")));
  trial.markers.covariance[1] = 1e-9;
  EXPECT_THAT(lost_in(*written_format(".c3d"), trial), ElementsAre(HasSubstr("one standard deviation")));
}

TEST(LostParts, WhatTheReaderCouldNotCarryIsSaidOfEveryFormat) {
  data::Trial trial = bare();
  trial.unread = {"derivatives of markers"};
  for (const char* ending : {".c3d", ".nwb", ".csv"})
    EXPECT_THAT(lost_in(*written_format(ending), trial),
                ElementsAre("not carried on: derivatives of markers"));
}

TEST(LostParts, WhatLiesBesideMovementIsNamedOnce) {
  data::Trial trial = bare();
  EXPECT_EQ(lost_beside(".csv", trial.beside), "");
  trial.beside = {.file = "a.nwb",
                  .room = "/processing/behavior",
                  .objects = {{.path = "/units", .type = "Units"},
                              {.path = "/intervals/trials", .type = "TimeIntervals"}}};
  EXPECT_THAT(
      lost_in(*written_format(".c3d"), trial),
      ElementsAre("not carried on: what its file holds besides movement (/units, /intervals/trials); only "
                  "an .nwb file keeps it, and info lists it"));
  EXPECT_THAT(lost_in(*written_format(".nwb"), trial), IsEmpty());
  trial.beside.objects[1].lost = "why";
  EXPECT_EQ(lost_beside(".nwb", trial.beside), "not carried on: /intervals/trials (TimeIntervals: why)");
  for (int i = 0; i < 48; ++i) trial.beside.objects.push_back({.path = "/more", .type = "dataset"});
  EXPECT_THAT(lost_beside(".mot", trial.beside), HasSubstr("/more and 10 more); only"));
}

/// What the table promises is what the writers do: written, read, and looked for.
TEST(LostParts, AFormatKeepsWhatTheTableSays) {
  const testing_support::ScratchFolder scratch;
  for (const MarkerFormat& f : marker_formats()) {
    if (f.write == nullptr || f.read == nullptr || !f.one_file) continue;
    for (const Part part : kAllParts) {
      SCOPED_TRACE(std::string(f.name) + " part " + std::to_string(static_cast<int>(part)));
      const data::Trial before = with(part);
      const auto file = scratch / ("a" + std::string(f.extension));
      std::vector<std::string> lost;
      const auto written = f.write(file, before, {.force = true, .lost = &lost});
      ASSERT_TRUE(written) << written.error().message;
      EXPECT_THAT(lost, IsEmpty());
      Eigen::AlignedBox3d box_m;
      const auto after = f.read(file, {}, box_m);
      ASSERT_TRUE(after) << after.error().message;
      const bool kept = held(*after, part) == held(before, part);
      EXPECT_EQ(kept, f.keeps(part) != Kept::none) << held(*after, part);
    }
  }
}

TEST(LostParts, TheTableHasALineForEachFormat) {
  const std::string table = marker_format_table();
  EXPECT_EQ(std::ranges::count(table, '\n'), std::ssize(marker_formats()) + 2);
  EXPECT_THAT(table, HasSubstr("| C3D | `.c3d` | yes | float, mm | yes | in part |  | yes |"));
  EXPECT_THAT(table, HasSubstr("| Visual3D text | `.v3d` | yes |  |"));
  const auto width =
      std::count(table.begin(), table.begin() + static_cast<std::ptrdiff_t>(table.find('\n')), '|');
  EXPECT_EQ(std::ranges::count(table, '|'), width * (std::ssize(marker_formats()) + 2));
}

}  // namespace
}  // namespace kinemark::io
