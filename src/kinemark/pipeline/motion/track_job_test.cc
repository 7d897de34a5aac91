// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/track_job.h"

#include <gmock/gmock.h>

#include <cmath>

#include "kinemark/io/file.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/pipeline/testing/recorded_test.h"
#include "kinemark/stages/motion/scaling/geometry.h"

namespace kinemark::pipeline {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::Pair;
namespace fs = std::filesystem;

class RunTrack : public testing::RecordedTest<TrackJob> {
 protected:
  /// No gaps, no noise: half a second is short.
  static TrackJob job(const std::string& output) { return RecordedTest::job(output, "in/truth.trc"); }
};

TEST_F(RunTrack, WritesAnglesTorquesBoundsAndTheAccount) {
  const auto outcome = run_track(job("Q.mot"));
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->exit_status(), 0);
  EXPECT_EQ(outcome->written.size(), 8U);
  for (const auto& path : outcome->written) EXPECT_TRUE(fs::exists(path)) << path;
  const auto q = io::read_table(at("Q.mot")).value();
  const auto bound = io::read_table(at("Q_bound.sto")).value();
  const auto tau = io::read_table(at("Q_tau.sto")).value();
  const auto truth = io::read_table(at("in/truth.mot")).value();
  ASSERT_EQ(q.columns, bound.columns);
  EXPECT_EQ(tau.columns.size(), q.columns.size());
  for (std::int64_t r = 0; r < q.rows(); ++r)
    for (std::size_t k = 6; k < q.columns.size(); ++k) {
      const auto column = static_cast<std::int64_t>(k);
      EXPECT_NEAR(q(r, column), truth(r, truth.find(q.columns[k])), 2.0) << q.columns[k] << ' ' << r;
      EXPECT_TRUE(std::isfinite(tau(r, column)));
    }
  const auto report = nlohmann::json::parse(io::read_text(at("Q_report.json")).value());
  EXPECT_THAT(report.dump(), HasSubstr("direct marker control"));
}

TEST_F(RunTrack, TorquesHaveDeviationsThatGrowWithTheNoise) {
  const auto deviations = [&](const std::string& output, double noise_m) {
    auto j = job(output + ".mot");
    j.options.marker_noise_sd_m = noise_m;
    EXPECT_TRUE(run_track(j));
    return io::read_table(at(output + "_tau_sd.sto")).value();
  };
  const auto quiet = deviations("quiet", 1e-3), loud = deviations("loud", 4e-3);
  EXPECT_EQ(quiet.columns, io::read_table(at("quiet_tau.sto")).value().columns);
  double sum_quiet = 0.0, sum_loud = 0.0;
  for (std::size_t i = 0; i < quiet.values.size(); ++i) {
    EXPECT_GT(quiet.values[i], 0.0) << i;
    sum_quiet += quiet.values[i];
    sum_loud += loud.values[i];
  }
  EXPECT_GT(sum_loud, sum_quiet);
}

TEST_F(RunTrack, AnAdaptedBodyIsWrittenWithItsLengths) {
  auto plain = job("given.mot"), adapted = job("adapted.mot");
  adapted.adapt = true;
  const auto without = run_track(plain).value(), with = run_track(adapted).value();
  EXPECT_FALSE(without.adapted);
  EXPECT_FALSE(fs::exists(at("given_model.osim")));
  ASSERT_TRUE(with.adapted);
  const auto report = nlohmann::json::parse(io::read_text(at("adapted_report.json")).value());
  const auto lengths = report.at("adapted").at("lengths");
  ASSERT_EQ(lengths.size(), with.adapted->lengths.size());
  const auto given = motion::segment_lengths(io::read_osim(at("in/model.osim")).value());
  const auto written = motion::segment_lengths(io::read_osim(at("adapted_model.osim")).value());
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const auto& length = with.adapted->lengths[i];
    EXPECT_NEAR(lengths[i].at("length_m").get<double>(), length.length_m, 1e-9);
    EXPECT_NEAR(length.initial_m, given[i].length_m, 1e-9) << "that of the model that was given";
    EXPECT_NEAR(length.length_m, written[i].length_m, 1e-6) << length.name;
    if (length.determined)
      EXPECT_NEAR(length.length_m, length.initial_m, 0.01) << length.name << ": it had its size";
  }
  for (const auto& size : with.adapted->parameters)
    if (size.kind == motion::ParameterKind::body_scale && size.determined)
      EXPECT_NEAR(size.value, 1.0, 0.03) << size.name << ": of the model that was given";
  // What is not known of the sizes is part of the angles' deviations.
  const auto &a = without.result.motion, &b = with.result.motion;
  const auto i = a.index(20, a.find("knee_angle_r"));
  EXPECT_GT(b.q_sd[i], a.q_sd[i]);
  EXPECT_GT(b.q_bound[i], a.q_bound[i]);
}

TEST_F(RunTrack, TheRankOfEveryFrameIsWritten) {
  const auto whole = run_track(job("whole.mot")).value();
  const auto table = io::read_table(at("whole_rank.sto")).value();
  ASSERT_EQ(table.columns, (std::vector<std::string>{"rank", "smallest_singular_value"}));
  ASSERT_EQ(table.rows(), whole.result.motion.frames());
  EXPECT_DOUBLE_EQ(table.time_s[7], whole.result.motion.time.time_s(7));
  for (std::int64_t f = 0; f < table.rows(); ++f) {
    EXPECT_EQ(table(f, 0), whole.result.free_speeds);
    EXPECT_GT(table(f, 1), 0.0);
  }
  EXPECT_THAT(whole.summary.run.options,
              Not(Contains(Pair("determined in fewer than 95 % of the frames", HasSubstr("knee_angle_r")))));
  EXPECT_THAT(whole.summary.run.options, Not(Contains(Pair(::testing::_, "not known without error bars"))));
  auto few = job("few.mot");
  few.options.levels = {{.markers = {"LASI", "RASI"}}};
  few.options.lock = motion::LockMode::off;
  const auto tracked = run_track(few);
  ASSERT_TRUE(tracked) << tracked.error().message;
  EXPECT_THAT(tracked->summary.run.options,
              Contains(Pair("determined in fewer than 95 % of the frames", HasSubstr("knee_angle_r"))));
  const auto rank = io::read_table(at("few_rank.sto")).value();
  for (std::int64_t f = 0; f < rank.rows(); ++f) EXPECT_LE(rank(f, 0), 6.0) << "two points";
}

TEST_F(RunTrack, ForcesOfAFileAreInTheTorquesNotInTheAngles) {
  const auto pushed_by = [&](const std::string& name, double newtons) {
    data::Table table;
    table.columns = {"fx", "fy", "fz", "px", "py", "pz"};
    for (const double time : {-1.0, 1.0}) {
      table.time_s.push_back(time);
      table.values.insert(table.values.end(), {0.0, newtons, 0.0, 0.2, 0.3, 0.4});
    }
    EXPECT_TRUE(io::write_table(at(name + ".sto"), table));
    EXPECT_TRUE(io::write_text(
        at(name + ".xml"),
        "<OpenSimDocument><ExternalLoads><objects><ExternalForce name=\"push\"><applied_to_body>pelvis"
        "</applied_to_body><force_identifier>f</force_identifier><point_identifier>p</point_identifier>"
        "</ExternalForce></objects><datafile>" +
            name + ".sto</datafile></ExternalLoads></OpenSimDocument>",
        false));
    auto j = job(name + ".mot");
    j.forces = at(name + ".xml");
    const auto outcome = run_track(j);
    EXPECT_TRUE(outcome) << outcome.error().message;
    EXPECT_TRUE(fs::exists(at(name + "_tau_sd.sto")));
    return io::read_table(at(name + "_tau.sto")).value();
  };
  const auto none = pushed_by("none_pushes", 0.0), push = pushed_by("push", 100.0);
  EXPECT_EQ(io::read_table(at("none_pushes.mot")).value().values,
            io::read_table(at("push.mot")).value().values);
  const auto up = none.find("pelvis_ty_force"), knee = none.find("knee_angle_r_moment");
  ASSERT_GE(up, 0);
  ASSERT_GE(knee, 0);
  for (std::int64_t r = 0; r < none.rows(); ++r) {
    EXPECT_NEAR(push(r, up), none(r, up) - 100.0, 1e-6);
    EXPECT_NEAR(push(r, knee), none(r, knee), 1e-6);
  }
  const auto report = io::read_text(at("push_report.json")).value();
  EXPECT_THAT(report, HasSubstr("force of push"));
  EXPECT_THAT(report, HasSubstr("push.sto"));
}

TEST_F(RunTrack, SaysWhatIsMissingAndWritesNothing) {
  auto j = job("none.mot");
  j.model.clear();
  EXPECT_THAT(run_track(j).error().message, HasSubstr("no model"));
  j = job("none.mot");
  j.markers.clear();
  EXPECT_THAT(run_track(j).error().message, HasSubstr("no marker file"));
  j = job("");
  j.output.clear();
  EXPECT_THAT(run_track(j).error().message, HasSubstr("no output"));
  j = job("none.mot");
  j.options.levels = {{.markers = {"NOSE"}}};
  const auto unknown = run_track(j);
  EXPECT_THAT(unknown.error().message, HasSubstr("level 1 names marker 'NOSE'"));
  EXPECT_EQ(unknown.error().code, Code::bad_input);
  j = job("none.mot");
  j.options.step_s = 1.0 / 60.0;
  EXPECT_EQ(run_track(j).error().code, Code::usage);
  EXPECT_FALSE(fs::exists(at("none.mot")));
}

TEST_F(RunTrack, AMissedGateIsAnExitStatusAndTheFilesAreThere) {
  auto j = job("gate.mot");
  j.max_rms_m = 1e-9;
  j.options.error_bars = false;
  const auto outcome = run_track(j);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->exit_status(), 1);
  EXPECT_EQ(outcome->written.size(), 5U);
  EXPECT_TRUE(fs::exists(at("gate.mot")));
  EXPECT_FALSE(fs::exists(at("gate_bound.sto")));
}

TEST_F(RunTrack, GoalsOutOfReachAreCountedAndThoseWithinAreNot) {
  const auto flagged = [](const TrackOutcome& outcome) {
    for (const auto& gate : outcome.gates)
      if (gate.name == "flagged") return gate.sentence;
    return std::string();
  };
  const auto begin_of = [](const std::string& name) {
    auto j = job(name + ".mot");
    j.options.last_time_s = 0.1;
    j.options.error_bars = j.options.judge_samples = false;
    return j;
  };
  const auto short_run = run_track(begin_of("within")).value();
  EXPECT_THAT(short_run.summary.run.options,
              Contains(Pair("determined in fewer than 95 % of the frames", "not known without error bars")));
  const auto within = flagged(short_run);
  EXPECT_FALSE(
      ::testing::Value(within, ::testing::MatchesRegex("[1-9].* frames are flagged: goals out of reach.*")))
      << within;
  EXPECT_THAT(within, ::testing::StartsWith("0 of "));
  auto trial = io::read_markers(at("in/truth.trc")).value();
  for (std::int64_t f = 0; f < trial.markers.frames(); ++f)
    for (std::int64_t m = 0; m < trial.markers.markers(); ++m) trial.markers.x(f, m) *= 4.0;
  ASSERT_TRUE(io::write_markers(at("giant.trc"), trial, false));
  auto giant = begin_of("giant");
  giant.markers = at("giant.trc");
  const auto outcome = run_track(giant);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->exit_status(), 1);
  EXPECT_THAT(
      flagged(*outcome),
      ::testing::MatchesRegex("[1-9].* frames are flagged: goals out of reach, or a body that ran away .*"));
}

TEST(TrackJob, ATaskIsDescribedInItsUnit) {
  const auto turn =
      describe_task({.text = "orientation:torso", .is_angle = true, .rms_error = 0.01, .max_error = 0.02});
  EXPECT_EQ(turn, "0.573 deg RMS from its goal, 1.15 deg at most");
  EXPECT_EQ(describe_task({.text = "com:x=0", .rms_error = 0.0012, .max_error = 0.003}),
            "1.2 mm RMS from its goal, 3 mm at most");
  EXPECT_THAT(turn, Not(HasSubstr("no goal in any frame")));
  EXPECT_EQ(describe_task({.text = "distance:A-B"}), "no goal in any frame");
  EXPECT_THAT(describe_task({.text = "distance:A-B"}), Not(HasSubstr(" RMS from its goal, ")));
}

TEST(TrackJob, AProposalIsTheOptionsThatGiveIt) {
  EXPECT_EQ(describe_proposal(
                {.levels = {{.markers = {"A", "s:B-1"}}, {.markers = {"it's C"}}, {.markers = {"*"}}}}),
            "--level A,s:B-1 --level 'it'\\''s C' --level '*'");
}

TEST_F(RunTrack, StopsWhenAsked) {
  auto stop = job("stopped.mot");
  stop.progress = [](std::int64_t, std::int64_t) { return false; };
  const auto outcome = run_track(stop);
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.error().code, Code::cancelled);
  EXPECT_FALSE(fs::exists(at("stopped.mot")));
}

}  // namespace
}  // namespace kinemark::pipeline
