// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/ik_setup_options.h"

#include <gmock/gmock.h>

#include <map>

#include "kinemark/core/units.h"
#include "kinemark/io/file.h"
#include "kinemark/pipeline/simulate/human_model.h"
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
  ASSERT_TRUE(io::write_text(scratch_ / "between.xml",
                             "<OpenSimDocument Version=\"40000\"><InverseKinematicsTool name=\"t\">"
                             "<time_range>0.37 0.63</time_range></InverseKinematicsTool></OpenSimDocument>",
                             false));
  IkJob job;
  job.setup = scratch_ / "between.xml";
  ASSERT_TRUE(apply_setup(job));
  ASSERT_TRUE(apply_tasks(job, *model_, markers_));
  EXPECT_EQ(job.options.first_time_s, 0.25);
  EXPECT_EQ(job.options.last_time_s, 0.75);
  job.options.first_time_s = 0.38;  // as an option would
  job.options.last_time_s = 0.6;
  ASSERT_TRUE(apply_tasks(job, *model_, markers_));
  EXPECT_EQ(job.options.first_time_s, 0.38);
  EXPECT_EQ(job.options.last_time_s, 0.6);
}

TEST_F(IkSetupOptions, ARangeBeyondTheRecordingTakesNoFrameOfIt) {
  ASSERT_TRUE(io::write_text(scratch_ / "late.xml",
                             "<OpenSimDocument Version=\"40000\"><InverseKinematicsTool name=\"t\">"
                             "<time_range>7 9</time_range></InverseKinematicsTool></OpenSimDocument>",
                             false));
  IkJob job;
  job.setup = scratch_ / "late.xml";
  ASSERT_TRUE(apply_setup(job));
  ASSERT_TRUE(apply_tasks(job, *model_, markers_));
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

}  // namespace
}  // namespace kinemark::pipeline
