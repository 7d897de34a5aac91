// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/clean/internal/clean_output.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/nwb/nwb.h"
#include "kinemark/io/text/table_file.h"
#include "support/scratch.h"

namespace kinemark::pipeline::internal {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// What the account says of an option; "none" where it has no such.
std::string option_of(const CleanJob& job, const std::string& name) {
  const auto run = describe_run(job, {});
  const auto found = std::ranges::find(run.options, name, [](const auto& option) { return option.first; });
  return found == run.options.end() ? "none" : found->second;
}

TEST(CleanAccount, WhatIsFoundFromTheDataSaysSo) {
  CleanJob job;
  job.input = "walk.c3d";
  for (const char* name : {"order", "cut-off", "marker noise"})
    EXPECT_EQ(option_of(job, name), "found from the data") << name;
  job.filter.order = 4;
  job.filter.cutoff_hz = 6.5;
  job.filter.noise_sd_m = 3e-4;
  EXPECT_EQ(option_of(job, "order"), "4");
  EXPECT_EQ(option_of(job, "cut-off"), "6.5 Hz");
  EXPECT_EQ(option_of(job, "marker noise"), "0.3 mm");
  for (const char* name : {"order", "cut-off", "marker noise"})
    EXPECT_THAT(option_of(job, name), Not(HasSubstr("found from the data"))) << name;
}

TEST(CleanAccount, TheRuleOfACutOffIsThatOfButterworthAlone) {
  CleanJob job;
  EXPECT_EQ(option_of(job, "cut-off of both passes together"), "none");
  job.filter.method = trajectory::FilterMethod::butterworth;
  EXPECT_EQ(option_of(job, "cut-off of both passes together"), "yes");
  job.filter.correct_cutoff = false;
  EXPECT_EQ(option_of(job, "cut-off of both passes together"), "no");
}

using data::SampleState;
using ::testing::ElementsAre;
namespace fs = std::filesystem;

constexpr std::int64_t kFrames = 4;

/// Two markers; the second has a gap in frame 1 and a sample that somebody filled in frame 2.
data::Trial recorded() {
  data::Trial trial;
  trial.source = "walk.c3d";
  trial.markers =
      data::Trajectories::all_missing({"A", "B"}, {.rate_hz = 50.0, .t0_s = 0.0, .frames = kFrames});
  for (std::int64_t f = 0; f < kFrames; ++f)
    for (std::int64_t m = 0; m < 2; ++m) {
      if (m == 1 && f == 1) continue;
      trial.markers.x(f, m) = Eigen::Vector3d(static_cast<double>(f), static_cast<double>(m), 0.0);
      trial.markers.state[trial.markers.index(f, m)] = SampleState::measured;
    }
  trial.markers.state[trial.markers.index(2, 1)] = SampleState::interpolated;
  trial.markers.set_method(2, 1, "cubic");
  return trial;
}

/// What a smoother makes of one marker: everything bridged, 1 mm everywhere, velocity 50 m/s in x.
trajectory::MarkerResult smoothed(std::int64_t marker) {
  trajectory::MarkerResult result;
  result.marker = marker;
  result.account.used.method = "kalman";
  for (std::int64_t f = 0; f < kFrames; ++f) {
    for (const double x : {static_cast<double>(f), static_cast<double>(marker), 0.0}) result.x.push_back(x);
    for (const double c : {1e-6, 0.0, 0.0, 1e-6, 0.0, 1e-6}) result.covariance.push_back(c);
    for (const double v : {50.0, 0.0, 0.0}) result.velocity.push_back(v);
    for (int axis = 0; axis < 3; ++axis) result.velocity_sd.push_back(0.5);
    result.state.push_back(marker == 1 && f != 0 && f != 3 ? SampleState::interpolated
                                                           : SampleState::measured);
  }
  return result;
}

TEST(MarkerPiece, KeepsWhoMadeASampleAndNamesTheFilterForItsOwn) {
  const auto trial = recorded();
  const MarkerPiece piece(smoothed(1), trial.markers);
  EXPECT_THAT(piece.markers.names, ElementsAre("B"));
  EXPECT_EQ(piece.markers.time, trial.markers.time);
  EXPECT_EQ(piece.markers.made_by(0, 0), "smoothed by kalman") << "measured";
  EXPECT_EQ(piece.markers.made_by(1, 0), "kalman") << "bridged by the filter";
  EXPECT_EQ(piece.markers.made_by(2, 0), "cubic") << "filled before";
  EXPECT_EQ(piece.derivatives.filters.at(0).method, "kalman");
  EXPECT_EQ(piece.derivatives.velocity.size(), 12U);
}

TEST(MarkerPiece, KeepsMeasuredSamplesFromBeforeTheFilter) {
  auto trial = recorded();
  trial.markers.x(0, 1).x() = 0.25;
  const auto piece = MarkerPiece(smoothed(1), trial.markers).markers;
  ASSERT_EQ(piece.unfiltered_in_world.size(), 12U);
  EXPECT_EQ(piece.unfiltered_in_world[0], 0.25) << "smoothing made it 0";
  EXPECT_TRUE(std::isnan(piece.unfiltered_in_world[3])) << "a gap";
  EXPECT_TRUE(std::isnan(piece.unfiltered_in_world[6])) << "filled";
  EXPECT_EQ(piece.unfiltered_in_world[9], 3.0);
  EXPECT_EQ(piece.filters.at(0).method, "kalman");
}

TEST(MarkerPiece, SampleTimesComeAlong) {
  auto trial = recorded();
  trial.markers.sample_offset_s.assign({0.001, 0.002});
  EXPECT_THAT(MarkerPiece(smoothed(1), trial.markers).markers.sample_offset_s, ElementsAre(0.002));
  trial.markers.sample_offset_s.assign({0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7});
  EXPECT_THAT(MarkerPiece(smoothed(1), trial.markers).markers.sample_offset_s,
              ElementsAre(0.1, 0.3, 0.5, 0.7));
}

TEST(DerivativesTable, HasAColumnAndADeviationForEachAxisAndOrder) {
  const auto trial = recorded();
  DerivativesTable table(trial.markers);
  ASSERT_EQ(table.table().columns.size(), 36U);
  EXPECT_EQ(table.table().columns[0], "A_vx");
  EXPECT_EQ(table.table().columns[1], "A_vx_sd");
  EXPECT_EQ(table.table().columns[35], "B_jz_sd");
  table.add(MarkerPiece(smoothed(1), trial.markers).derivatives, 1);
  const auto& filled = table.table();
  EXPECT_DOUBLE_EQ(filled.time_s[3], 0.06);
  EXPECT_EQ(filled(2, filled.find("B_vx")), 50.0);
  EXPECT_EQ(filled(2, filled.find("B_vz_sd")), 0.5);
  EXPECT_TRUE(std::isnan(filled(2, filled.find("B_ax")))) << "not given";
  EXPECT_TRUE(std::isnan(filled(2, filled.find("A_vx")))) << "not yet added";
}

class CleanOutputTest : public ::testing::Test {
 protected:
  CleanOutput output(const fs::path& file, bool derivatives) {
    job_.derivatives = derivatives;
    auto made = CleanOutput::create(job_, file, trial_, {});
    EXPECT_TRUE(made) << (made ? "" : made.error().message);
    return std::move(made.value());
  }
  void take_both(CleanOutput& output) const {
    for (const std::int64_t m : {1, 0}) EXPECT_TRUE(output.take(MarkerPiece(smoothed(m), trial_.markers), m));
  }
  testing_support::ScratchFolder scratch_;
  data::Trial trial_ = recorded();
  CleanJob job_;
  std::vector<std::string> lost_;
};

TEST_F(CleanOutputTest, MarkersInAnyOrderBecomeOneRecording) {
  auto out = output(scratch_ / "a.csv", true);
  take_both(out);
  data::Trial trial = trial_;
  ASSERT_TRUE(out.finish(trial, scratch_ / "a.sto", "", lost_));
  EXPECT_EQ(trial.markers.count_missing(), 0);
  EXPECT_EQ(trial.markers.made_by(1, 1), "kalman");
  EXPECT_EQ(trial.markers.covariance.at(6 * trial.markers.index(2, 0)), 1e-6);
  const auto back = io::read_markers(scratch_ / "a.csv").value().markers;
  EXPECT_EQ(back.state, trial.markers.state);
  EXPECT_EQ(io::read_table(scratch_ / "a.sto").value().rows(), kFrames);
}

TEST_F(CleanOutputTest, WithoutDerivativesThereIsNoTable) {
  auto out = output(scratch_ / "a.trc", false);
  take_both(out);
  data::Trial trial = trial_;
  ASSERT_TRUE(out.finish(trial, scratch_ / "a.sto", "", lost_));
  EXPECT_TRUE(fs::exists(scratch_ / "a.trc"));
  EXPECT_FALSE(lost_.empty()) << "it cannot tell what was smoothed";
  EXPECT_FALSE(fs::exists(scratch_ / "a.sto"));
}

TEST_F(CleanOutputTest, AnNwbIsWrittenMarkerByMarkerAndSeenAtTheEnd) {
  const fs::path file = scratch_ / "a.NWB";
  auto out = output(file, true);
  EXPECT_TRUE(is_nwb(file)) << "in any case of letters";
  take_both(out);
  EXPECT_FALSE(fs::exists(file));
  data::Trial trial = trial_;
  trial.events = {{.label = "Foot Strike", .context = "Left", .time_s = 0.01}};
  trial.foreign = {{.name = "SUBJECTS"}};
  ASSERT_TRUE(out.finish(trial, {}, "", lost_));
  const auto back = io::read_nwb(file);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->trial.markers.made_by(2, 1), "cubic");
  EXPECT_EQ(back->trial.markers.made_by(0, 0), "smoothed by kalman");
  EXPECT_EQ(back->trial.markers.unfiltered_in_world[3 * back->trial.markers.index(3, 0)], 3.0);
  ASSERT_TRUE(back->derivatives);
  EXPECT_EQ(back->derivatives->velocity.at(0), 50.0);
  EXPECT_TRUE(std::isnan(back->derivatives->jerk.at(0))) << "promised, but not known";
  EXPECT_TRUE(trial.markers.covariance.empty()) << "it is in the file, not kept twice";
  ASSERT_EQ(back->trial.events.size(), 1U);
  EXPECT_EQ(back->trial.events[0].context, "Left");
  EXPECT_THAT(lost_, ::testing::ElementsAre("1 group of parameters cannot be stored in a .nwb file"));
}

TEST_F(CleanOutputTest, AFileThatCannotBeMadeIsSaid) {
  const auto refused = CleanOutput::create(job_, scratch_ / "none/a.nwb", trial_, {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::io);
}

}  // namespace

}  // namespace kinemark::pipeline::internal
