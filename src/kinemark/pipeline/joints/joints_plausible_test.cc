// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What a search for joints says and writes of markers that are no body's.
#include <gtest/gtest.h>

#include <functional>

#include "kinemark/core/random.h"
#include "kinemark/io/file.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/pipeline/joints/joints_job.h"
#include "kinemark/pipeline/joints/joints_json.h"
#include "kinemark/pipeline/joints/segments_file.h"
#include "kinemark/stages/simulation/limb.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

/// Three segments with four markers each, the last of them torn off by up to `torn_m` along every axis in
/// every frame, or each of its markers for itself.
class JointsPlausibleTest : public ::testing::Test {
 protected:
  void make(double torn_m, bool together, std::vector<double> lengths_m = {0.12, 0.15, 0.16}) {
    auto recording = simulation::simulate_chain({.frames = 150,
                                                 .lengths_m = std::move(lengths_m),
                                                 .markers_per_segment = 4,
                                                 .stagger_m = 0.03,
                                                 .noise_sd_m = 0.001})
                         .value();
    Random random(3, 1);
    const auto& last = recording.layout.segments.back();
    for (std::int64_t f = 0; f < recording.markers.frames() && torn_m > 0.0; ++f) {
      Eigen::Vector3d by;
      const auto draw = [&] {
        for (double& c : by) c = random.uniform(-torn_m, torn_m);
      };
      draw();
      for (const int m : last.markers) {
        if (!together) draw();
        recording.markers.x(f, m) += by;
      }
    }
    data::Trial trial;
    trial.markers = recording.markers;
    layout = recording.layout;
    job.input = scratch / "chain.csv";
    ASSERT_TRUE(io::write_markers(job.input, trial, true));
    job.segments = scratch / "segments.toml";
    ASSERT_TRUE(io::write_text(job.segments, segments_text(recording.layout, trial.markers.names), true));
    job.output = scratch / "out";
    job.doubtful = Doubtful::keep;
  }
  testing_support::ScratchFolder scratch;
  data::SegmentLayout layout;
  JointsJob job;
};

TEST_F(JointsPlausibleTest, ABodyIsLeftAlone) {
  make(0.0, true);
  for (const std::string method : {"score", "articulated"}) {
    job.method = method;
    job.force = true;
    const auto outcome = run_joints(job);
    ASSERT_TRUE(outcome) << outcome.error().message;
    EXPECT_EQ(outcome->exit_status(), 0);
    EXPECT_TRUE(outcome->left_out.empty());
    EXPECT_TRUE(outcome->next_step.empty());
    const auto json = joints_json(job, *outcome);
    EXPECT_TRUE(json["left_out"].empty());
    EXPECT_FALSE(json.contains("next_step"));
  }
}

TEST_F(JointsPlausibleTest, AJointWithoutACommonPointIsLeftOutAndReported) {
  make(0.2, true);
  for (const std::string method : {"score", "articulated"}) {
    job.method = method;
    job.force = true;
    const auto outcome = run_joints(job);
    ASSERT_TRUE(outcome) << outcome.error().message;
    EXPECT_EQ(outcome->exit_status(), 1);
    ASSERT_EQ(outcome->left_out.size(), 1U) << method;
    EXPECT_EQ(outcome->left_out[0].name, layout.joints[1].name);
    ASSERT_EQ(outcome->skeleton.joints.size(), 1U);
    EXPECT_EQ(outcome->skeleton.joints[0].name, layout.joints[0].name);
    EXPECT_LT(outcome->skeleton.noise_sd_m, 0.002);
    const auto json = nlohmann::json::parse(io::read_text(job.output / "skeleton.json").value());
    EXPECT_EQ(json["joints"].size(), 1U);
    EXPECT_EQ(json["left_out"][0]["name"], layout.joints[1].name);
    EXPECT_EQ(json["left_out"][0]["figure"], "gap");
    EXPECT_EQ(json["left_out"][0]["most_m"], 0.02);
    EXPECT_NE(json["next_step"].get<std::string>().find(layout.joints[1].name), std::string::npos);
    EXPECT_EQ(io::read_markers(job.output / "centres.csv").value().markers.names.size(), 1U);
  }
}

TEST_F(JointsPlausibleTest, ASegmentWithoutAShapeIsLeftOutAndItsMarkersNamed) {
  make(0.2, false);
  const auto outcome = run_joints(job);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->exit_status(), 1);
  ASSERT_EQ(outcome->left_out.size(), 1U);
  EXPECT_TRUE(outcome->left_out[0].is_segment);
  EXPECT_EQ(outcome->left_out[0].markers.size(), 4U);
  EXPECT_NE(outcome->next_step.find(outcome->left_out[0].markers[0]), std::string::npos)
      << outcome->next_step;
}

TEST_F(JointsPlausibleTest, WhereNothingIsLeftNothingIsWritten) {
  make(0.3, true, {0.12, 0.15});
  for (const std::string method : {"score", "articulated"}) {
    job.method = method;
    const auto outcome = run_joints(job);
    ASSERT_FALSE(outcome) << method;
    EXPECT_EQ(outcome.error().code, Code::bad_input);
    EXPECT_NE(outcome.error().message.find("no joint of a body can be found"), std::string::npos)
        << outcome.error().message;
    EXPECT_NE(outcome.error().message.find("20 mm or less is expected"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(job.output));
  }
}

}  // namespace
}  // namespace kinemark::pipeline
