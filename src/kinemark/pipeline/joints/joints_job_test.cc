// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/joints/joints_job.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "kinemark/core/random.h"
#include "kinemark/io/file.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/pipeline/joints/joints_json.h"
#include "kinemark/pipeline/joints/segments_file.h"
#include "kinemark/stages/simulation/limb.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

/// A chain written to a file, the truth, and a job that reads it.
class JointsJobTest : public ::testing::Test {
 protected:
  void make(const simulation::ChainOptions& options,
            const std::function<void(data::Trajectories&)>& change = {}) {
    use(simulation::simulate_chain(options).value(), change);
  }
  /// Poses that follow one another: an arm that reaches for 5 s, 16 markers.
  void make_reach(const std::function<void(data::Trajectories&)>& change) {
    use(simulation::simulate_sleeve({.duration_s = 5.0, .noise_sd_m = 0.0005, .line_of_sight = false})
            .value(),
        change);
  }
  void use(simulation::LimbRecording made, const std::function<void(data::Trajectories&)>& change) {
    recording = std::move(made);
    if (change) change(recording.markers);
    data::Trial trial;
    trial.markers = recording.markers;
    job.input = scratch / "chain.csv";
    ASSERT_TRUE(io::write_markers(job.input, trial, true));
    job.method = "score";
  }
  void write_segments() {
    job.segments = scratch / "segments.toml";
    ASSERT_TRUE(io::write_text(job.segments, segments_text(recording.layout, recording.markers.names), true));
  }
  [[nodiscard]] double rms_mm(const data::Skeleton& skeleton, std::int64_t joint) const {
    double squares = 0.0, n = 0.0;
    for (std::int64_t f = 0; f < skeleton.frames(); ++f) {
      if (skeleton.state[skeleton.index(f, joint)] == data::CentreState::undetermined) continue;
      // The truth has all joints of the chain, the skeleton those that are known.
      const auto all = static_cast<std::int64_t>(recording.layout.joints.size());
      const Eigen::Map<const Eigen::Vector3d> truth(recording.centre_in_world.data() + 3 * (f * all + joint));
      squares += (skeleton.centre(f, joint) - truth).squaredNorm();
      n += 1.0;
    }
    return 1e3 * std::sqrt(squares / n);
  }
  testing_support::ScratchFolder scratch;
  simulation::LimbRecording recording;
  JointsJob job;
};

const simulation::ChainOptions kSolid{
    .frames = 150, .markers_per_segment = 4, .stagger_m = 0.03, .noise_sd_m = 0.0005};

TEST_F(JointsJobTest, WritesAFolderThatReadsBack) {
  make(kSolid);
  write_segments();
  job.output = scratch / "out";
  const auto outcome = run_joints(job);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->exit_status(), 0);
  for (const char* absent :
       {"samples that the recorder interpolated were left out.", "more defects like these.",
        "break their paths: frames are taken as poses", "' was placed in no frame."})
    EXPECT_THAT(outcome->warnings, Not(Contains(HasSubstr(absent))));
  EXPECT_LT(rms_mm(outcome->skeleton, 0), 1.5);
  EXPECT_EQ(outcome->written.size(), 4U);
  const auto centres = io::read_markers(job.output / "centres.csv");
  ASSERT_TRUE(centres) << centres.error().message;
  EXPECT_EQ(centres->markers.names, (std::vector<std::string>{recording.layout.joints[0].name}));
  EXPECT_EQ(centres->markers.frames(), 150);
  EXPECT_EQ(centres->markers.made_by(0, 0), "SCoRE: determined");
  ASSERT_FALSE(centres->markers.covariance.empty());
  EXPECT_NEAR(centres->markers.covariance[0], outcome->skeleton.covariance[0], 1e-15);
  const auto json = nlohmann::json::parse(io::read_text(job.output / "skeleton.json").value());
  EXPECT_EQ(json["schema"], "kinemark.skeleton");
  EXPECT_EQ(json["joints"][0]["frames"]["determined"], 150);
  EXPECT_EQ(json["segments"].size(), 2U);
  EXPECT_EQ(json["joints"][0]["method"], "SCoRE");
  EXPECT_TRUE(read_segments(job.output / "segments.toml", recording.markers.names));
  EXPECT_EQ(run_joints(job).error().code, Code::io) << "nothing is replaced unasked";
  job.force = true;
  EXPECT_TRUE(run_joints(job));
}

TEST_F(JointsJobTest, WhatTheRecorderMadeAndWhatIsSpoiltAreLeftOutAndSaid) {
  make({.frames = 400, .markers_per_segment = 4, .stagger_m = 0.03, .noise_sd_m = 0.0005},
       [](data::Trajectories& markers) {
         for (std::int64_t f = 1; f + 1 < 400; f += 2)
           for (std::int64_t m = 0; m < markers.markers(); ++m)
             markers.x(f, m) = 0.5 * (markers.x(f - 1, m) + markers.x(f + 1, m));
       });
  write_segments();
  const auto doubled = run_joints(job);
  ASSERT_TRUE(doubled) << doubled.error().message;
  EXPECT_THAT(doubled->warnings,
              Contains(HasSubstr("samples that the recorder interpolated were left out.")));
  make_reach([](data::Trajectories& markers) {
    for (std::int64_t k = 0; k < 8; ++k) markers.x(20 + 30 * k, k)[0] += 0.3;
  });
  write_segments();
  const auto spoilt = run_joints(job);
  ASSERT_TRUE(spoilt) << spoilt.error().message;
  EXPECT_THAT(spoilt->warnings, Contains("Left out: 3 more defects like these."));
}

TEST_F(JointsJobTest, FramesThatFollowNoPathsArePosesOfTheirOwn) {
  make_reach([](data::Trajectories& markers) {
    for (std::int64_t f = 0; f < markers.frames(); ++f)
      for (std::int64_t m = 0; m < markers.markers(); ++m)
        if ((f + 5 * m) % 12 == 6) markers.x(f, m)[0] += 0.04;
  });
  write_segments();
  const auto outcome = run_joints(job);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_THAT(
      outcome->warnings,
      Contains(
          "8 % of the samples break their paths: frames are taken as poses of their own, and nothing was "
          "rejected."));
}

TEST_F(JointsJobTest, SegmentsThatWereHardlySeenTogetherHaveNoJoint) {
  make({.frames = 240, .markers_per_segment = 4, .stagger_m = 0.03, .noise_sd_m = 0.0005},
       [](data::Trajectories& markers) {
         markers.names = {"LASI", "RASI", "LPSI", "RPSI", "LTH1", "LTH2", "LTH3", "LTH4"};
         // Where one segment shows its markers, the other shows one.
         for (std::int64_t f = 0; f < 240; ++f)
           for (std::int64_t m = 0; m < 8; ++m)
             if ((m < 4) == (f % 2 == 0) && m % 4 != f / 2 % 4) markers.set_missing(f, m);
       });
  job.method = "constant-distance";
  const auto outcome = run_joints(job);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_THAT(outcome->warnings, Contains(HasSubstr("the two were hardly seen together")));
  EXPECT_TRUE(outcome->skeleton.joints.empty());
}

TEST_F(JointsJobTest, FindsSegmentsItself) {
  make({.frames = 200,
        .lengths_m = {0.12, 0.15, 0.16},
        .markers_per_segment = 4,
        .stagger_m = 0.02,
        .noise_sd_m = 0.001});
  job.output = scratch / "centres.trc";
  const auto outcome = run_joints(job);
  ASSERT_TRUE(outcome) << outcome.error().message;
  ASSERT_TRUE(outcome->topology);
  ASSERT_EQ(outcome->skeleton.joints.size(), 2U);
  EXPECT_LT(rms_mm(outcome->skeleton, 0), 3.0);
  EXPECT_LT(rms_mm(outcome->skeleton, 1), 3.0);
  EXPECT_EQ(outcome->written.back().filename(), "centres_skeleton.json");
  EXPECT_EQ(joints_json(job, *outcome)["topology"]["markers"].size(), 12U);
}

/// Whether an object of JSON or anything in it has a number.
bool has_number(const nlohmann::json& json) {
  if (json.is_number()) return true;
  if (!json.is_structured()) return false;
  for (const auto& item : json)
    if (has_number(item)) return true;
  return false;
}

TEST_F(JointsJobTest, SegmentsOfTwoMarkersAreNoBodies) {
  make({.frames = 200, .lengths_m = {0.12, 0.15, 0.16}, .markers_per_segment = 2, .stagger_m = 0.02});
  for (const std::string method : {"articulated", "score", "gamage"}) {
    job.method = method;
    job.output = scratch / method;
    job.report = scratch / (method + ".html");
    const auto outcome = run_joints(job);
    ASSERT_TRUE(outcome) << outcome.error().message;
    EXPECT_EQ(outcome->exit_status(), 1);
    EXPECT_TRUE(outcome->skeleton.joints.empty());
    EXPECT_TRUE(std::filesystem::exists(job.output / "skeleton.json"));
    for (const char* name : {"centres.csv", "centres.c3d", "segments.toml"})
      EXPECT_FALSE(std::filesystem::exists(job.output / name)) << name;
    const auto json = nlohmann::json::parse(io::read_text(job.output / "skeleton.json").value());
    for (const char* list : {"joints", "lengths", "segments"}) EXPECT_FALSE(has_number(json[list])) << list;
    EXPECT_TRUE(json["segmentation"]["known"].empty());
    EXPECT_EQ(json["segmentation"]["from"], "data");
    EXPECT_TRUE(std::ranges::any_of(outcome->gates, [](const auto& gate) {
      return gate.name == "any_joint" && gate.sentence.starts_with("No joint is determined");
    }));
    EXPECT_NE(io::read_text(job.report).value().find("No joint is determined"), std::string::npos);
  }
}

TEST_F(JointsJobTest, NamesOfAKnownSetAreTheSegments) {
  make({.frames = 300,
        .lengths_m = {0.12, 0.15, 0.16},
        .markers_per_segment = 4,
        .stagger_m = 0.03,
        .noise_sd_m = 0.0005},
       [](data::Trajectories& markers) {
         const std::vector<std::string> names{"LASI", "RASI", "LPSI", "RPSI", "LTH1", "LTH2",
                                              "LTH3", "LTH4", "LSK1", "LHEE", "LTOE", "M7"};
         markers.names = names;
       });
  job.output = scratch / "out";
  const auto outcome = run_joints(job);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->exit_status(), 1) << "the knee is not determined";
  EXPECT_FALSE(outcome->topology);
  ASSERT_EQ(outcome->skeleton.joints.size(), 1U);
  EXPECT_EQ(outcome->skeleton.joints[0].name, "hip_l");
  EXPECT_LT(rms_mm(outcome->skeleton, 0), 3.0);
  const auto json = nlohmann::json::parse(io::read_text(job.output / "skeleton.json").value());
  EXPECT_EQ(json["segmentation"]["from"], "names");
  EXPECT_EQ(json["segmentation"]["known"][0]["name"], "hip_l");
  const auto& open = json["segmentation"]["not_determined"];
  ASSERT_FALSE(open.empty());
  EXPECT_EQ(open[0]["name"], "knee_l");
  EXPECT_NE(open[0]["words"].get<std::string>().find("shank_l has 1 marker"), std::string::npos);
  EXPECT_EQ(json["segmentation"]["on_no_segment"].get<std::vector<std::string>>(),
            (std::vector<std::string>{"M7"}));
  const auto layout = read_segments(job.output / "segments.toml", outcome->markers);
  ASSERT_TRUE(layout);
  EXPECT_EQ(layout->joints.size(), 1U);
  // What rivals disagree by is in the covariance, and the words say so.
  const double spread = outcome->segmentation->joints[0].spread_m;
  EXPECT_GT(spread, 0.0);
  EXPECT_GE(outcome->skeleton.joints[0].covariance_in_parent(0, 0), spread * spread / 3.0);
  EXPECT_NE(outcome->skeleton.joints[0].description.find("rivals of its segmentation"), std::string::npos);
}

TEST_F(JointsJobTest, EveryMethodRuns) {
  make(kSolid);
  write_segments();
  for (const std::string method :
       {"score", "sara", "gamage", "gamage-plain", "cylinder", "constant-distance", "articulated"}) {
    job.method = method;
    const auto outcome = run_joints(job);
    ASSERT_TRUE(outcome) << method << ": " << outcome.error().message;
    EXPECT_EQ(joints_json(job, *outcome)["method"], method);
    const bool of_skin = !outcome->skeleton.joints[0].skin.description.empty();
    EXPECT_EQ(skeleton_description(outcome->skeleton).size(), of_skin ? 2U : 1U) << method;
    if (method != "sara" && method != "cylinder" && method != "constant-distance") {
      EXPECT_LT(rms_mm(outcome->skeleton, 0), 1.5) << method;
    }
  }
  job.method = "best";
  EXPECT_EQ(run_joints(job).error().code, Code::usage);
}

TEST_F(JointsJobTest, ASlipIsReportedInNotesAndJson) {
  make({.frames = 400, .markers_per_segment = 5, .stagger_m = 0.03, .noise_sd_m = 0.0005},
       [](data::Trajectories& markers) {
         for (std::int64_t f = 200; f < 400; ++f) {
           const Eigen::Vector3d along = (markers.x(f, 2) - markers.x(f, 1)).normalized();
           markers.x(f, 0) += 0.015 * along;
         }
       });
  write_segments();
  const auto outcome = run_joints(job);
  ASSERT_TRUE(outcome);
  ASSERT_FALSE(outcome->slips.empty());
  const auto& slip = outcome->slips[0];
  EXPECT_EQ(slip.subject, recording.markers.names[0]);
  const auto json = joints_json(job, *outcome)["slips"];
  ASSERT_EQ(json.size(), outcome->slips.size());
  EXPECT_EQ(json[0]["words"], sentence_of(slip, recording.markers.time));
  EXPECT_EQ(json[0]["shift_m"], slip.size);
  EXPECT_EQ(json[0]["sd_m"], slip.size_sd);
  EXPECT_EQ(json[0]["frame"], outcome->skeleton.time.number(slip.first_frame));
  EXPECT_TRUE(
      std::ranges::any_of(outcome->warnings, [](const std::string& n) { return n.starts_with("Marker '"); }));
}

TEST_F(JointsJobTest, SoftTissueTellsEveryMarkersNoise) {
  make({.frames = 120, .markers_per_segment = 5, .stagger_m = 0.03, .noise_sd_m = 0.0005},
       [](data::Trajectories& markers) {
         Random skin(5, 1);
         for (std::int64_t f = 0; f < 120; ++f)
           for (double& c : markers.x(f, 2)) c += 0.006 * skin.gaussian();
       });
  write_segments();
  job.doubtful = Doubtful::keep;
  job.soft_tissue = true;
  EXPECT_EQ(run_joints(job).error().code, Code::usage) << "SCoRE has no such term";
  job.method = "articulated";
  const auto outcome = run_joints(job);
  ASSERT_TRUE(outcome) << outcome.error().message;
  ASSERT_EQ(outcome->marker_noise_sd_m.size(), 10U);
  const auto reported = joints_json(job, *outcome)["marker_noise"];
  ASSERT_EQ(reported.size(), 10U);
  EXPECT_EQ(reported[2]["name"], recording.markers.names[2]);
  EXPECT_NEAR(reported[2]["sd_m"].get<double>(), 0.006, 0.002);
  EXPECT_LT(reported[3]["sd_m"].get<double>(), 0.001);
  job.soft_tissue = false;
  EXPECT_FALSE(joints_json(job, run_joints(job).value()).contains("marker_noise"));
}

TEST_F(JointsJobTest, OneSentenceForWhatCannotBe) {
  const auto message = [&] {
    const auto outcome = run_joints(job);
    EXPECT_FALSE(outcome);
    return outcome ? std::string() : outcome.error().message;
  };
  make({.frames = 60, .markers_per_segment = 1});
  EXPECT_NE(message().find("2 markers in all"), std::string::npos);
  make({.frames = 60, .markers_per_segment = 4, .stagger_m = 0.02, .noise_sd_m = 0.0005});
  job.segments = scratch / "one.toml";
  ASSERT_TRUE(io::write_text(
      job.segments, "[[segment]]\nname = \"all\"\nmarkers = [\"s0m0\", \"s0m1\", \"s0m2\"]\n", true));
  EXPECT_NE(message().find("one segment"), std::string::npos);
  write_segments();
  job.method = "constant-distance";
  make({.frames = 60, .markers_per_segment = 4, .stagger_m = 0.02, .missing = 0.9});
  job.method = "constant-distance";
  EXPECT_NE(message().find("no frames show all 8 markers"), std::string::npos);
  job.noise_sd_m = -1.0;
  EXPECT_NE(message().find("-1000 mm"), std::string::npos);
}

}  // namespace
}  // namespace kinemark::pipeline
