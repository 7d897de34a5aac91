// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/ik_job.h"

#include <gmock/gmock.h>

#include <cmath>
#include <map>

#include "kinemark/core/units.h"
#include "kinemark/io/file.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/osim/osim_writer.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/io/text/trc.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/workspace.h"
#include "kinemark/pipeline/simulate/human_model.h"
#include "kinemark/pipeline/testing/recorded_test.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

const char* const kTasks = R"(<?xml version="1.0"?>
<OpenSimDocument Version="40000"><IKTaskSet name="tasks"><objects>
<IKMarkerTask name="LASI"><apply>true</apply><weight>5</weight></IKMarkerTask>
<IKMarkerTask name="RASI"><apply>false</apply><weight>5</weight></IKMarkerTask>
<IKMarkerTask name="nobody"><apply>true</apply><weight>5</weight></IKMarkerTask>
<IKCoordinateTask name="knee_angle_r"><apply>true</apply><weight>2</weight><value_type>manual_value</value_type><value>0.5</value></IKCoordinateTask>
<IKCoordinateTask name="knee_angle_l"><apply>true</apply><weight>3</weight><value_type>from_file</value_type></IKCoordinateTask>
</objects></IKTaskSet></OpenSimDocument>
)";

class IkSetupOptions : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(io::write_text(scratch_ / "tasks.xml", kTasks, false));
    ASSERT_TRUE(io::write_text(scratch_ / "q.sto",
                               "q\nversion=1\nnRows=2\nnColumns=2\ninDegrees=yes\nendheader\n"
                               "time\tknee_angle_l\n0\t10\n1\t20\n",
                               false));
    ASSERT_TRUE(io::write_text(scratch_ / "setup.xml",
                               R"(<OpenSimDocument Version="40000"><InverseKinematicsTool name="t">
<model_file>body.osim</model_file><marker_file>walk.trc</marker_file><coordinate_file>q.sto</coordinate_file>
<output_motion_file>out.mot</output_motion_file><time_range>0.25 0.75</time_range>
<IKTaskSet file="tasks.xml"/></InverseKinematicsTool></OpenSimDocument>)",
                               false));
    model_ = std::make_unique<model::Model>(model::Model::compile(human_model().value()).value());
    std::vector<std::string> names;
    for (const auto& marker : model_->description().markers) names.push_back(marker.name);
    markers_ = data::Trajectories::all_missing(names, {.rate_hz = 4.0, .t0_s = 0.0, .frames = 5});
  }
  /// A job whose setup names a range of time and nothing else, its tasks applied.
  IkJob job_of_range(const std::string& range) const {
    IkJob job;
    job.setup = scratch_ / "range.xml";
    EXPECT_TRUE(io::write_text(job.setup,
                               "<OpenSimDocument Version=\"40000\"><InverseKinematicsTool name=\"t\">"
                               "<time_range>" +
                                   range + "</time_range></InverseKinematicsTool></OpenSimDocument>",
                               false));
    EXPECT_TRUE(apply_setup(job));
    EXPECT_TRUE(apply_tasks(job, *model_, markers_));
    return job;
  }
  std::map<std::string, double> weights(const IkJob& job) const {
    std::map<std::string, double> all;
    for (const auto& w : job.options.marker_weights) all[w.marker] = w.weight;
    return all;
  }
  testing_support::ScratchFolder scratch_;
  std::unique_ptr<model::Model> model_;
  data::Trajectories markers_;
};

TEST_F(IkSetupOptions, FillWhatTheJobLeavesOpen) {
  IkJob job;
  job.setup = scratch_ / "setup.xml";
  job.output = "mine.mot";
  ASSERT_TRUE(apply_setup(job));
  EXPECT_EQ(job.model, scratch_ / "body.osim");
  EXPECT_EQ(job.markers, scratch_ / "walk.trc");
  EXPECT_EQ(job.output, "mine.mot") << "what the user names wins";
  EXPECT_EQ(job.options.first_time_s, 0.25);
  EXPECT_EQ(job.options.last_time_s, 0.75);
}

TEST_F(IkSetupOptions, TasksBecomeWeightsAndTargets) {
  IkJob job;
  job.setup = scratch_ / "setup.xml";
  job.options.first_time_s = 0.25;
  job.options.last_time_s = 0.75;
  ASSERT_TRUE(apply_tasks(job, *model_, markers_));
  EXPECT_EQ(job.options.default_marker_weight, 0.0) << "only listed markers take part, as in OpenSim";
  const auto w = weights(job);
  EXPECT_EQ(w.at("LASI"), 5.0);
  EXPECT_EQ(w.at("RASI"), 0.0) << "apply is false";
  EXPECT_FALSE(w.contains("nobody"));
  ASSERT_EQ(job.options.coordinate_tasks.size(), 2U);
  EXPECT_EQ(job.options.coordinate_tasks[0].value, 0.5) << "radians";
  const auto& values = job.options.coordinate_tasks[1].values;  // at 0.25, 0.5 and 0.75 s
  ASSERT_EQ(values.size(), 3U);
  EXPECT_NEAR(values[0], 12.5 * kRadPerDeg, 1e-12);
  EXPECT_NEAR(values[2], 17.5 * kRadPerDeg, 1e-12);
}

TEST_F(IkSetupOptions, TheRangeOfASetupTakesTheNearestFramesAndThatOfTheUserIsTaken) {
  auto job = job_of_range("0.37 0.63");
  EXPECT_EQ(job.options.first_time_s, 0.25);
  EXPECT_EQ(job.options.last_time_s, 0.75);
  job.options.first_time_s = 0.38;  // as an option would
  job.options.last_time_s = 0.6;
  ASSERT_TRUE(apply_tasks(job, *model_, markers_));
  EXPECT_EQ(job.options.first_time_s, 0.38);
  EXPECT_EQ(job.options.last_time_s, 0.6);
}

TEST_F(IkSetupOptions, ARangeBeyondTheRecordingTakesNoFrameOfIt) {
  const auto job = job_of_range("7 9");
  EXPECT_EQ(job.options.first_time_s, 7.0);
  EXPECT_EQ(job.options.last_time_s, 9.0);
}

TEST_F(IkSetupOptions, WeightsOfTheUserWinOverThoseOfTheFile) {
  IkJob job;
  job.tasks = scratch_ / "tasks.xml";
  job.options.marker_weights = {{"LASI", 0.5}};
  job.options.coordinate_tasks = {{.coordinate = "knee_angle_r", .weight = 9.0},
                                  {.coordinate = "knee_angle_l", .weight = 9.0}};
  ASSERT_TRUE(apply_tasks(job, *model_, markers_));
  EXPECT_EQ(weights(job).at("LASI"), 0.5);
  EXPECT_EQ(job.options.coordinate_tasks.size(), 2U);
  EXPECT_EQ(job.options.coordinate_tasks[0].weight, 9.0);
}

TEST_F(IkSetupOptions, FailuresNameTheFile) {
  IkJob job;
  job.setup = scratch_ / "absent.xml";
  EXPECT_THAT(apply_setup(job).error().message, HasSubstr("absent.xml"));
  job.setup = scratch_ / "setup.xml";
  fs::remove(scratch_ / "q.sto");
  EXPECT_THAT(apply_tasks(job, *model_, markers_).error().message, HasSubstr("q.sto"));
  std::string strange = kTasks;
  strange.replace(strange.find("knee_angle_r"), 12, "no_such_knee");
  ASSERT_TRUE(io::write_text(scratch_ / "tasks.xml", strange, true));
  EXPECT_THAT(apply_tasks(job, *model_, markers_).error().message,
              HasSubstr("a task names coordinate 'no_such_knee'"));
}

using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

using RunIk = testing::RecordedTest<IkJob>;

std::string sentence_of_gate(const IkOutcome& outcome, std::string_view name) {
  for (const auto& gate : outcome.gates)
    if (gate.name == name) return gate.sentence;
  return {};
}

TEST_F(RunIk, WritesAnglesDeviationsErrorsAndSummaryThatCoverTheTruth) {
  const auto outcome = run_ik(job("Q.mot"));
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->exit_status(), 0);
  EXPECT_EQ(outcome->written.size(), 4U);
  const auto q = io::read_table(at("Q.mot")).value();
  const auto sd = io::read_table(at("Q_sd.sto")).value();
  const auto truth = io::read_table(at("in/truth.mot")).value();
  ASSERT_EQ(q.columns, sd.columns);
  std::int64_t inside = 0, all = 0;
  for (std::int64_t r = 0; r < q.rows(); ++r)
    for (std::size_t k = 0; k < q.columns.size(); ++k) {
      const auto column = static_cast<std::int64_t>(k);
      if (std::isnan(sd(r, column))) continue;
      const double error = q(r, column) - truth(r, truth.find(q.columns[k]));
      inside += std::abs(error) < 3.0 * sd(r, column);
      ++all;
    }
  ASSERT_GT(all, 1000);
  EXPECT_GT(static_cast<double>(inside) / static_cast<double>(all), 0.97);
}

TEST_F(RunIk, AClosedLoopTellsItsWidestGapAndAModelWithoutOneTellsNone) {
  auto looped = io::read_osim(at("in/model.osim")).value();
  // The right hand is tied to the chest where it is in the default posture.
  const auto tree = model::Model::compile(looped).value();
  model::Workspace w(tree);
  model::kinematics(tree, w, tree.default_state());
  data::PointConstraintDescription loop{
      .name = "loop", .body_a_idx = looped.find_body("thorax"), .body_b_idx = looped.find_body("hand_r")};
  const auto chest = static_cast<std::size_t>(tree.body_of(loop.body_a_idx)),
             hand = static_cast<std::size_t>(tree.body_of(loop.body_b_idx));
  loop.point_in_a = w.rotation[chest].transpose() * (w.position[hand] - w.position[chest]);
  looped.point_constraints.push_back(loop);
  ASSERT_TRUE(io::write_osim(at("looped.osim"), looped));
  auto closed = job("closed.mot");
  closed.model = at("looped.osim");
  closed.options.last_time_s = 0.05;
  const auto with = run_ik(closed);
  ASSERT_TRUE(with) << with.error().message;
  EXPECT_THAT(sentence_of_gate(*with, "loop_gap"), HasSubstr("The widest gap of a closed loop is"));
  auto open = job("open.mot");
  open.options.last_time_s = 0.05;
  const auto without = run_ik(open).value();
  EXPECT_THAT(sentence_of_gate(without, "loop_gap"), Not(HasSubstr("The widest gap of a closed loop is")));
  EXPECT_THAT(sentence_of_gate(without, "mean_marker_offset"),
              Not(HasSubstr("No marker is seen in the time range.")));
  EXPECT_THAT(sentence_of_gate(without, "marker_rms"),
              Not(HasSubstr("How far measured and model markers are apart")));
}

TEST_F(RunIk, WhereNoMarkerIsSeenThatIsSaid) {
  auto trial = io::read_markers(at("in/markers.c3d")).value();
  for (std::int64_t f = 10; f < 20; ++f)
    for (std::int64_t m = 0; m < trial.markers.markers(); ++m) trial.markers.set_missing(f, m);
  trial.residual_m.clear();
  trial.camera_mask.clear();
  ASSERT_TRUE(io::write_trc(at("dark.trc"), trial, {}));
  auto dark = job("dark.mot");
  dark.markers = at("dark.trc");
  dark.options.first_time_s = trial.markers.time.time_s(12);
  dark.options.last_time_s = trial.markers.time.time_s(17);
  const auto outcome = run_ik(dark);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->exit_status(), 1);
  EXPECT_EQ(sentence_of_gate(*outcome, "mean_marker_offset"), "No marker is seen in the time range.");
  EXPECT_EQ(sentence_of_gate(*outcome, "marker_rms"),
            "How far measured and model markers are apart is not known: none is seen in the time range.");
}

TEST_F(RunIk, ForcesOfAFileAreInTheTorquesAndInTheAccount) {
  // 100 N up and 7 N m about the vertical on the pelvis, for most of the recording.
  data::Table table;
  table.columns = {"fx", "fy", "fz", "px", "py", "pz", "mx", "my", "mz"};
  for (const double time : {-1.0, 0.4}) {
    table.time_s.push_back(time);
    table.values.insert(table.values.end(), {0.0, 100.0, 0.0, 0.2, 0.3, 0.4, 0.0, 7.0, 0.0});
  }
  ASSERT_TRUE(io::write_table(at("push.sto"), table));
  ASSERT_TRUE(io::write_text(
      at("push.xml"),
      "<OpenSimDocument><ExternalLoads><objects><ExternalForce name=\"push\"><applied_to_body>pelvis"
      "</applied_to_body><force_identifier>f</force_identifier><point_identifier>p</point_identifier>"
      "<torque_identifier>m</torque_identifier></ExternalForce></objects><datafile>push.sto</datafile>"
      "</ExternalLoads></OpenSimDocument>",
      false));
  auto without = job("free.mot");
  without.torques = true;
  ASSERT_TRUE(run_ik(without));
  auto with = job("pushed.mot");
  with.forces = at("push.xml");
  const auto outcome = run_ik(with);
  ASSERT_TRUE(outcome) << outcome.error().message;
  const auto free = io::read_table(at("free_tau.sto")).value(),
             pushed = io::read_table(at("pushed_tau.sto")).value();
  EXPECT_TRUE(fs::exists(at("pushed_tau_sd.sto")));
  const auto up = free.find("pelvis_ty_force"), knee = free.find("knee_angle_r_moment");
  ASSERT_GE(up, 0);
  ASSERT_GE(knee, 0);
  for (std::int64_t r = 0; r < free.rows(); ++r) {
    if (free.time_s[static_cast<std::size_t>(r)] > 0.41) {
      EXPECT_TRUE(std::isnan(pushed(r, up))) << r;
      continue;
    }
    EXPECT_NEAR(pushed(r, up), free(r, up) - 100.0, 1e-6);
    EXPECT_NEAR(pushed(r, knee), free(r, knee), 1e-6);  // a push on the root is no torque of the knee
  }
  const auto report = nlohmann::json::parse(io::read_text(at("pushed_report.json")).value()).dump();
  EXPECT_THAT(report, HasSubstr("force of push"));
  EXPECT_THAT(report, HasSubstr("on pelvis 0.000 to 0.400 s"));
  EXPECT_THAT(report, HasSubstr("push.sto"));
  EXPECT_THAT(report, HasSubstr("forces not known for"));
  with.output = at("none.mot");
  with.forces = at("gone.c3d");
  const auto gone = run_ik(with);
  EXPECT_EQ(gone.error().code, Code::io);
  EXPECT_THAT(gone.error().message, HasSubstr("gone.c3d"));
  EXPECT_FALSE(fs::exists(at("none.mot")));
}

TEST_F(RunIk, AMissedGateStillWritesAndEndsWithOne) {
  auto strict = job("strict.mot");
  strict.max_rms_m = 1e-5;
  const auto outcome = run_ik(strict).value();
  EXPECT_EQ(outcome.exit_status(), 1);
  EXPECT_TRUE(fs::exists(at("strict.mot")));
  std::string reported;
  for (const auto& notice : outcome.summary.notices) reported += notice.text;
  EXPECT_THAT(reported, HasSubstr("at most 0.0 mm is accepted"));
  const auto frames = sentence_of_gate(outcome, "frames_off"),
             mean = sentence_of_gate(outcome, "mean_marker_offset");
  EXPECT_THAT(frames,
              HasSubstr(" frames the RMS distance between measured and model markers is above 0.0 mm"));
  EXPECT_THAT(frames, Not(HasSubstr("The mean of all marker errors is")));
  EXPECT_THAT(mean, HasSubstr("The mean of all marker errors is"));
  EXPECT_THAT(mean,
              Not(AnyOf(HasSubstr(" frames the RMS distance between measured and model markers is above"),
                        HasSubstr("mm. Check that recording and model share origin, axes and unit."))));
}

TEST_F(RunIk, ARecordingElsewhereIsSaidToBeSoWithTheShiftThatMendsIt) {
  auto trial = io::read_markers(at("in/markers.c3d")).value();
  for (std::size_t i = 0; i < trial.markers.x_in_world.size(); i += 3) trial.markers.x_in_world[i] += 0.8;
  ASSERT_TRUE(io::write_trc(at("away.trc"), trial, {}));
  auto away = job("away.mot");
  away.markers = at("away.trc");
  auto bound = io::read_osim(at("in/model.osim")).value();
  for (auto& coordinate : bound.coordinates)
    if (!coordinate.is_rotation) coordinate.locked = true;
  ASSERT_TRUE(io::write_osim(at("bound.osim"), bound));
  away.model = at("bound.osim");
  away.options.last_time_s = 0.15;  // ten frames are as far away as all
  const auto outcome = run_ik(away).value();
  EXPECT_EQ(outcome.exit_status(), 1);
  const auto mean = sentence_of_gate(outcome, "mean_marker_offset");
  EXPECT_THAT(mean, HasSubstr("mm. Check that recording and model share origin, axes and unit."));
  EXPECT_THAT(mean, Not(HasSubstr("The mean of all marker errors is")));
}

TEST_F(RunIk, WhereTheNoiseIsFromIsInTheOptions) {
  const auto noise_of = [](const IkOutcome& outcome) {
    for (const auto& [name, value] : outcome.summary.run.options)
      if (name == "marker noise") return value;
    return std::string();
  };
  const auto estimated = noise_of(run_ik(job("estimated.mot")).value());
  auto with_noise = job("given.mot");
  with_noise.options.marker_noise_sd_m = 0.002;
  const auto given = noise_of(run_ik(with_noise).value());
  EXPECT_EQ(estimated, "estimated from the residuals, per marker and segment");
  EXPECT_EQ(given, "0.002 m per axis, given");
  EXPECT_THAT(given, Not(HasSubstr("estimated from the residuals, per marker and segment")));
}

TEST_F(RunIk, ExclusionsCarryTheirReason) {
  auto trial = io::read_markers(at("in/markers.c3d")).value();
  for (std::int64_t f = 0; f < trial.markers.frames(); ++f) trial.markers.set_missing(f, 0);
  trial.markers.names[1] = "stranger";
  if (!trial.residual_m.empty()) trial.residual_m.clear();
  if (!trial.camera_mask.empty()) trial.camera_mask.clear();
  const std::string unseen = trial.markers.names[0], weightless = trial.markers.names[2];
  ASSERT_TRUE(io::write_markers(at("odd.trc"), trial, false));
  auto odd = job("odd.mot");
  odd.markers = at("odd.trc");
  odd.options.marker_weights = {{weightless, 0.0}};
  const auto outcome = run_ik(odd).value();
  std::map<std::string, std::string> why;
  for (const auto& marker : outcome.summary.markers) why[marker.name] = marker.why_excluded;
  EXPECT_EQ(why[unseen], "never seen");
  EXPECT_EQ(why[weightless], "given the weight 0");
  EXPECT_EQ(why["stranger"], "in the recording, not in the model");
}

TEST_F(RunIk, NothingIsWrittenWhenItFailsOrIsStopped) {
  auto gone = job("gone.mot");
  gone.markers = at("in/none.c3d");
  EXPECT_EQ(run_ik(gone).error().code, Code::io);
  auto early = job("gone.mot");
  early.options.first_time_s = 100.0;
  EXPECT_THAT(run_ik(early).error().message, HasSubstr("markers.c3d"));
  auto stop = job("gone.mot");
  stop.progress = [](std::int64_t, std::int64_t) { return false; };
  const auto stopped = run_ik(stop);
  EXPECT_EQ(stopped.error().code, Code::cancelled);
  for (const char* file : {"gone.mot", "gone_sd.sto", "gone_report.json"}) EXPECT_FALSE(fs::exists(at(file)));
}

TEST_F(RunIk, AsksForWhatIsNotGiven) {
  IkJob empty;
  EXPECT_EQ(run_ik(empty).error().code, Code::usage);
  empty = job("Q2.mot");
  empty.output.clear();
  EXPECT_THAT(run_ik(empty).error().message, HasSubstr("no output"));
}

}  // namespace

}  // namespace kinemark::pipeline
