// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/clean/clean_job.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <algorithm>

#include <cmath>

#include "kinemark/core/random.h"
#include "kinemark/io/edits/edit_journal.h"
#include "kinemark/io/file.h"
#include "kinemark/io/input/journal_input.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/nwb/nwb.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/pipeline/testing/test_files.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using data::SampleState;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

class RunClean : public ::testing::Test {
 protected:
  /// Two seconds of three markers on a forearm and one elsewhere, 0.5 mm of noise, a gap of 0.2 s in the
  /// first.
  static data::Trial recording() {
    data::Trial trial;
    trial.markers = data::Trajectories::all_missing({"WRA", "WRB", "FRM", "HEAD"},
                                                    {.rate_hz = 100.0, .t0_s = 0.0, .frames = 200});
    Random noise(11, 0);
    for (std::int64_t f = 0; f < 200; ++f)
      for (std::int64_t m = 0; m < 4; ++m) {
        trial.markers.x(f, m) = truth(f, m);
        for (int axis = 0; axis < 3; ++axis) trial.markers.x(f, m)[axis] += 5e-4 * noise.gaussian();
        trial.markers.state[trial.markers.index(f, m)] = SampleState::measured;
      }
    for (std::int64_t f = 90; f < 110; ++f) trial.markers.set_missing(f, 0);
    return trial;
  }
  static Eigen::Vector3d truth(std::int64_t f, std::int64_t m) {
    const double t = 0.01 * static_cast<double>(f), angle = std::sin(3.0 * t);
    const Eigen::Vector3d arm[] = {{0.25, 0.0, 0.03}, {0.25, 0.0, -0.03}, {0.12, 0.04, 0.0}};
    if (m == 3) return {0.0, 0.5 + 0.01 * std::sin(t), 0.1};
    return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()) * arm[m] + Eigen::Vector3d(0.1 * t, 1.0, 0.0);
  }
  void SetUp() override { ASSERT_TRUE(io::write_markers(at("in.c3d"), recording(), false)); }
  fs::path at(const std::string& name) const { return scratch_ / name; }
  CleanJob job(const std::string& output) const {
    CleanJob j;
    j.input = at("in.c3d");
    j.output = at(output);
    return j;
  }
  static std::int64_t count(const data::Trajectories& t, SampleState state) {
    return std::ranges::count(t.state, state);
  }
  testing_support::ScratchFolder scratch_;
};

TEST_F(RunClean, SmoothsWithoutFillingUnlessAsked) {
  const auto outcome = run_clean(job("out.c3d"));
  ASSERT_TRUE(outcome) << outcome.error().message;
  const auto& cleaned = outcome->trial.markers;
  EXPECT_EQ(count(cleaned, SampleState::missing), 20);
  double raw = 0.0, smooth = 0.0;
  const auto before = recording().markers;
  for (std::int64_t f = 10; f < 190; ++f) {
    raw += (before.x(f, 1) - truth(f, 1)).squaredNorm();
    smooth += (cleaned.x(f, 1) - truth(f, 1)).squaredNorm();
  }
  EXPECT_LT(smooth, 0.25 * raw);
  EXPECT_EQ(io::read_markers(at("out.c3d")).value().markers.count_missing(), 20);
}

TEST_F(RunClean, AFilledGapIsNearTheTruthAndStaysMarkedInTheFile) {
  auto j = job("out.c3d");
  j.gaps.method = trajectory::GapMethod::automatic;
  const auto outcome = run_clean(j);
  ASSERT_TRUE(outcome) << outcome.error().message;
  const auto& cleaned = outcome->trial.markers;
  EXPECT_EQ(count(cleaned, SampleState::missing), 0);
  for (std::int64_t f = 90; f < 110; ++f) {
    EXPECT_NE(cleaned.state[cleaned.index(f, 0)], SampleState::measured);
    EXPECT_NE(cleaned.made_by(f, 0), "");
    EXPECT_LT((cleaned.x(f, 0) - truth(f, 0)).norm(), 0.005) << f;
  }
  ASSERT_EQ(outcome->report.account.gaps.size(), 1U);
  EXPECT_TRUE(outcome->report.account.gaps[0].filled);
  EXPECT_EQ(outcome->report.account.name_of(outcome->report.account.gaps[0].marker), "WRA");
  const auto back = io::read_markers(at("out.c3d")).value().markers;
  for (std::int64_t f = 90; f < 110; ++f)
    EXPECT_EQ(back.state[back.index(f, 0)], cleaned.state[cleaned.index(f, 0)]);
  EXPECT_EQ(back.state[back.index(50, 0)], SampleState::measured);
}

TEST_F(RunClean, NwbHoldsStatesCovariancesAndDerivatives) {
  auto j = job("out.nwb");
  j.gaps.method = trajectory::GapMethod::cubic;
  j.derivatives = true;
  ASSERT_TRUE(run_clean(j));
  const auto file = io::read_nwb(at("out.nwb"));
  ASSERT_TRUE(file) << file.error().message;
  ASSERT_TRUE(file->derivatives);
  EXPECT_EQ(file->trial.markers.made_by(100, 0), "cubic");
  EXPECT_EQ(file->derivatives->filters[1].method, "kalman");
  const double v = file->derivatives->velocity[3 * file->trial.markers.index(60, 1)];
  const double sd = file->derivatives->velocity_sd[3 * file->trial.markers.index(60, 1)];
  const double slope = (truth(61, 1).x() - truth(59, 1).x()) / 0.02;
  EXPECT_GT(sd, 0.0);
  EXPECT_NEAR(v, slope, 5.0 * sd + 1e-3);
  EXPECT_FALSE(fs::exists(at("out_derivatives.sto"))) << "they are in the file";
}

TEST_F(RunClean, OtherFormatsGetATableOfDerivatives) {
  auto j = job("out.trc");
  j.derivatives = true;
  ASSERT_TRUE(run_clean(j));
  const auto table = io::read_table(at("out_derivatives.sto")).value();
  EXPECT_EQ(table.columns.size(), 4U * 18U);
  const double slope = (truth(61, 1).z() - truth(59, 1).z()) / 0.02;
  EXPECT_NEAR(table(60, table.find("WRB_vz")), slope, 0.05);
  EXPECT_GT(table(60, table.find("WRB_vz_sd")), 0.0);
}

TEST_F(RunClean, DefectsAreReportedAndRejectedOnlyWhenAsked) {
  auto trial = recording();
  trial.markers.x(50, 3).x() += 0.2;
  ASSERT_TRUE(io::write_markers(at("in.c3d"), trial, true));
  auto j = job("told.c3d");
  const auto reported = run_clean(j).value();
  ASSERT_EQ(reported.report.account.defects.size(), 1U);
  EXPECT_EQ(reported.report.account.defects[0].finding.kind, data::FindingKind::spike);
  EXPECT_EQ(reported.report.account.defects[0].done, "left as it is");
  j = job("rejected.c3d");
  j.doubtful = Doubtful::drop;
  const auto rejected = run_clean(j).value();
  EXPECT_TRUE(rejected.report.account.defects[0].handled);
  EXPECT_FALSE(rejected.trial.markers.present(50, 3));
}

TEST_F(RunClean, WritesTheAccountAndThePage) {
  auto j = job("out.c3d");
  j.report = at("page.html");
  const auto outcome = run_clean(j).value();
  EXPECT_EQ(outcome.written.size(), 3U);
  const auto json = nlohmann::json::parse(io::read_text(at("out_report.json")).value());
  EXPECT_EQ(json["schema"], "kinemark.clean_report");
  EXPECT_THAT(io::read_text(at("page.html")).value(), HasSubstr("kinemark.clean_report"));
}

TEST_F(RunClean, AnyNumberOfThreadsGivesTheSameFile) {
  auto j = job("one.csv");
  j.gaps.method = trajectory::GapMethod::automatic;
  ASSERT_TRUE(run_clean(j));
  j.output = at("two.csv");
  j.threads = 2;
  ASSERT_TRUE(run_clean(j));
  EXPECT_EQ(io::read_text(at("one.csv")).value(), io::read_text(at("two.csv")).value());
}

TEST_F(RunClean, FailuresLeaveNothingBehind) {
  auto j = job("out.c3d");
  j.input = at("none.c3d");
  EXPECT_EQ(run_clean(j).error().code, Code::io);
  j = job("out.c3d");
  j.filter.cutoff_hz = 60.0;  // above half the rate
  j.filter.method = trajectory::FilterMethod::butterworth;
  EXPECT_THAT(run_clean(j).error().message, HasSubstr("in.c3d"));
  j = job("out.xyz");
  EXPECT_FALSE(run_clean(j));
  j = job("out.c3d");
  j.progress = [](std::int64_t, std::int64_t) { return false; };
  EXPECT_EQ(run_clean(j).error().code, Code::cancelled);
  EXPECT_EQ(scratch_.count_files(), 1) << "only in.c3d";
}

TEST_F(RunClean, EditsComeFirstAndAreInTheRecord) {
  auto journal = io::EditJournal::open(at("in_edits.jsonl"), io::identify_recording(at("in.c3d")).value());
  ASSERT_TRUE(journal) << journal.error().message;
  ASSERT_TRUE(journal->append({.kind = data::EditKind::relabel, .marker = "HEAD", .other = "TOP"}));
  ASSERT_TRUE(
      journal->append({.kind = data::EditKind::cut, .marker = "WRB", .first_frame = 51, .last_frame = 60}));
  auto edited = job("edited.c3d");
  edited.filter.method = trajectory::FilterMethod::none;
  const auto out = run_clean(edited);
  ASSERT_TRUE(out) << out.error().message;
  EXPECT_EQ(out->trial.markers.names[3], "TOP");
  EXPECT_EQ(count(out->trial.markers, SampleState::rejected), 10);
  ASSERT_EQ(out->report.run.inputs.size(), 2U);
  EXPECT_EQ(out->report.run.inputs[1].role, "edits");
  EXPECT_THAT(io::read_text(at("edited_report.json")).value(), HasSubstr("edits in force"));
  edited.gaps.method = trajectory::GapMethod::cubic;
  edited.output = at("filled.c3d");
  EXPECT_EQ(run_clean(edited)->trial.markers.count_missing(), 0) << "what was cut is a gap";
  edited.edits = at("no_edits.jsonl");
  edited.output = at("no.c3d");
  EXPECT_EQ(run_clean(edited).error().code, Code::io);
  EXPECT_FALSE(fs::exists(at("no.c3d")));
}

TEST_F(RunClean, HandsOnFilterNoiseAndTheSamplesFromBefore) {
  const auto raw = io::read_markers(at("in.c3d")).value().markers;
  for (const char* name : {"one.c3d", "two.csv", "three.nwb", "four.mat"}) {
    auto j = job(name);
    j.gaps.method = trajectory::GapMethod::cubic;
    ASSERT_TRUE(run_clean(j)) << name;
    const auto t = io::read_markers(at(name)).value().markers;
    ASSERT_EQ(t.filters.size(), 4U) << name;
    ASSERT_EQ(t.unfiltered_in_world.size(), raw.x_in_world.size()) << name;
    for (std::int64_t m = 0; m < 4; ++m) {
      EXPECT_EQ(t.filters[static_cast<std::size_t>(m)].method, "kalman");
      EXPECT_NEAR(t.filters[static_cast<std::size_t>(m)].noise_sd_m, 5e-4, 1.5e-4) << name;
      for (std::int64_t f = 0; f < 200; ++f) {
        const double before = t.unfiltered_in_world[3 * t.index(f, m) + 1];
        if (raw.present(f, m)) {
          EXPECT_EQ(before, raw.x(f, m).y()) << name << " " << f;
          EXPECT_EQ(t.made_by(f, m), "smoothed by kalman") << name;
        } else {
          EXPECT_TRUE(std::isnan(before)) << name << " " << f;
          EXPECT_EQ(t.made_by(f, m), "cubic") << name;
        }
      }
    }
  }
}

TEST_F(RunClean, ACleanedRecordingIsCleanedFromTheSamplesFromBefore) {
  ASSERT_TRUE(run_clean(job("once.nwb")));
  auto j = job("twice.nwb");
  j.input = at("once.nwb");
  const auto outcome = run_clean(j);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_THAT(outcome->report.run.warnings,
              ::testing::Contains(HasSubstr("kept beside them: smoothed anew from those")));
  const auto once = io::read_markers(at("once.nwb")).value().markers,
             twice = io::read_markers(at("twice.nwb")).value().markers;
  for (std::size_t i = 0; i < once.x_in_world.size(); ++i)
    EXPECT_THAT(twice.x_in_world[i], ::testing::NanSensitiveDoubleEq(once.x_in_world[i]));
  EXPECT_EQ(twice.filters[3].cutoff_hz, once.filters[3].cutoff_hz);
}

TEST_F(RunClean, OneWithoutThemIsSmoothedTwiceAndThatIsSaid) {
  auto without = job("once.csv");
  without.keep_unfiltered = false;
  const auto first = run_clean(without);
  ASSERT_TRUE(first);
  EXPECT_TRUE(first->report.run.warnings.empty());
  EXPECT_TRUE(io::read_markers(at("once.csv")).value().markers.unfiltered_in_world.empty());
  auto j = job("twice.csv");
  j.input = at("once.csv");
  const auto outcome = run_clean(j);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_THAT(outcome->report.run.warnings,
              Contains(HasSubstr(
                  ", so that it is smoothed twice: noise found here is what the first filter left, and "
                  "less than that of the measurement")));
  const auto t = io::read_markers(at("twice.csv")).value().markers;
  EXPECT_EQ(t.filters[0].method, "kalman, kalman");
  EXPECT_TRUE(t.unfiltered_in_world.empty()) << "its samples were smoothed";
}

TEST_F(RunClean, SaysOfEarlierFiltersOnlyWhatIsSo) {
  const auto raw = run_clean(job("once.nwb"));
  ASSERT_TRUE(raw);
  const auto& of_raw = raw->report.run.warnings;
  EXPECT_THAT(of_raw, Not(Contains(HasSubstr(": smoothed anew from those"))));
  EXPECT_THAT(of_raw, Not(Contains(HasSubstr("so that it is smoothed twice: noise found here is what"))));
  auto again = job("twice.nwb");
  again.input = at("once.nwb");
  // The smoother left covariances, which are those of smoothed samples.
  EXPECT_THAT(run_clean(again)->report.run.warnings,
              Contains(HasSubstr(": smoothed anew from those, whose own covariances are not known")));
  auto bare = io::read_markers(at("once.nwb")).value();
  bare.markers.covariance.clear();
  ASSERT_TRUE(io::write_markers(at("bare.csv"), bare, false));
  auto from_bare = job("from_bare.csv");
  from_bare.input = at("bare.csv");
  const auto without = run_clean(from_bare)->report.run.warnings;
  EXPECT_THAT(without, Contains(HasSubstr("smoothed anew from those")));
  EXPECT_THAT(without, Not(Contains(HasSubstr(", whose own covariances are not known"))));
  auto left = job("left.nwb");
  left.input = at("once.nwb");
  left.filter.method = trajectory::FilterMethod::none;
  const auto as_it_is = run_clean(left);
  ASSERT_TRUE(as_it_is);
  EXPECT_THAT(as_it_is->report.run.warnings,
              Contains(::testing::EndsWith("the samples from before are kept beside them")));
}

TEST_F(RunClean, ASwapThatIsNotReliedOnIsSaidWhereThereIsOne) {
  // Six markers on one body that turns; the first is hidden, while two others have each other's label or not.
  const auto done_of = [this](const std::string& name, bool exchanged) {
    data::Trial trial;
    trial.markers =
        data::Trajectories::all_missing({"A", "B", "C", "D", "E", "F"}, {.rate_hz = 100.0, .frames = 500});
    auto& t = trial.markers;
    Random noise(5, 0);
    const Eigen::Vector3d body[] = {{0.1, 0.0, 0.0},   {0.0, 0.12, 0.0},  {0.0, 0.0, 0.09},
                                    {-0.08, 0.0, 0.0}, {0.0, -0.1, 0.03}, {0.05, 0.05, -0.1}};
    for (std::int64_t f = 0; f < 500; ++f) {
      const double s = 0.01 * static_cast<double>(f);
      const Eigen::Matrix3d turned = (Eigen::AngleAxisd(0.6 * std::sin(2.0 * s), Eigen::Vector3d::UnitY()) *
                                      Eigen::AngleAxisd(0.4 * std::cos(3.0 * s), Eigen::Vector3d::UnitX()))
                                         .toRotationMatrix();
      for (std::int64_t m = 0; m < 6; ++m) {
        t.x(f, m) = turned * body[m] + Eigen::Vector3d(0.2 * s, 1.0, 0.1 * std::sin(s)) +
                    3e-4 * Eigen::Vector3d(noise.gaussian(), noise.gaussian(), noise.gaussian());
        t.state[t.index(f, m)] = SampleState::measured;
      }
      if (exchanged && f >= 210 && f < 290) {
        const Eigen::Vector3d other = t.x(f, 1);
        t.x(f, 1) = t.x(f, 2);
        t.x(f, 2) = other;
      }
    }
    for (std::int64_t f = 230; f < 270; ++f) t.set_missing(f, 0);
    EXPECT_TRUE(io::write_markers(at(name + ".c3d"), trial, false));
    auto j = job(name + "_clean.csv");
    j.input = at(name + ".c3d");
    j.exchange_back = false;
    j.gaps.method = trajectory::GapMethod::automatic;
    const auto outcome = run_clean(j);
    std::string out;
    if (!outcome) return outcome.error().message;
    for (const auto& defect : outcome->report.account.defects) out += defect.done + "\n";
    return out;
  };
  EXPECT_THAT(done_of("exchanged", true), HasSubstr("not relied on when filling; left as it is"));
  EXPECT_THAT(done_of("right", false), Not(HasSubstr("not relied on when filling; left as it is")));
}

TEST_F(RunClean, ATrcNotesTheirAbsence) {
  const auto outcome = run_clean(job("out.trc"));
  ASSERT_TRUE(outcome);
  EXPECT_THAT(outcome->warnings,
              ::testing::Contains(HasSubstr("the filters of markers and their samples from "
                                            "before cannot be stored in a .trc file")));
}

}  // namespace
}  // namespace kinemark::pipeline
