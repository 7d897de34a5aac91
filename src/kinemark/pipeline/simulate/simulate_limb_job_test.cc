// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/simulate/simulate_limb_job.h"

#include <gmock/gmock.h>

#include "kinemark/io/file.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/pipeline/files/file_set.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;

TEST(SimulateLimb, TheFilesAgreeWithTheStage) {
  const testing_support::ScratchFolder scratch;
  SimulateLimbJob job;
  job.folder = scratch / "arm";
  job.arm.frames = 40;
  job.arm.missing = 0.3;
  job.seed = job.arm.seed = 4;
  const auto outcome = run_simulate_limb(job);
  ASSERT_TRUE(outcome) << outcome.error().message;
  ASSERT_EQ(outcome->written.size(), 4U);
  const std::string set = set_in(scratch / "arm/markers.c3d");
  EXPECT_EQ(set.size(), 16U);
  EXPECT_EQ(set_in(scratch / "arm/markers.trc"), set);
  EXPECT_EQ(set_in(scratch / "arm/segments.toml"), set);
  EXPECT_THAT(outcome->warnings.at(0), HasSubstr("6 markers, 40 frames at 60 Hz"));
  const auto limb = simulation::simulate_chain(job.arm).value();
  for (const char* name : {"arm/markers.c3d", "arm/markers.trc"}) {
    const auto read = io::read_markers(scratch / name).value().markers;
    ASSERT_EQ(read.frames(), 40) << name;
    EXPECT_EQ(read.names, limb.markers.names);
    for (std::int64_t f = 0; f < 40; ++f)
      for (std::int64_t m = 0; m < 6; ++m) {
        ASSERT_EQ(read.present(f, m), limb.markers.present(f, m)) << name;
        if (read.present(f, m)) {
          EXPECT_LT((read.x(f, m) - limb.markers.x(f, m)).norm(), 1e-6);
        }
      }
  }
  const auto truth = io::read_markers(scratch / "arm/truth.csv").value().markers;
  ASSERT_EQ(truth.markers(), 7);
  EXPECT_EQ(truth.names[0], "j0");
  EXPECT_LT((truth.x(17, 0) - Eigen::Map<const Vector3d>(limb.centre_in_world.data() + 51)).norm(), 1e-6);
  EXPECT_LT((truth.x(17, 6) - Eigen::Map<const Vector3d>(limb.x_true.data() + 3 * (17 * 6 + 5))).norm(),
            1e-6);
}

TEST(SimulateLimb, TheRecorderUpsamples) {
  const testing_support::ScratchFolder scratch;
  SimulateLimbJob job;
  job.folder = scratch / "macaque";
  job.scene = LimbScene::macaque;
  job.macaque.duration_s = 1.0;
  job.upsample.factor = 4;
  const auto outcome = run_simulate_limb(job);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_THAT(outcome->warnings.at(1), HasSubstr("237 frames at 240 Hz"));
  EXPECT_EQ(io::read_markers(scratch / "macaque/markers.c3d").value().markers.frames(), 237);
  EXPECT_EQ(io::read_markers(scratch / "macaque/truth.csv").value().markers.frames(), 60);
}

TEST(SimulateLimb, SaysWhichMarkersRideWhere) {
  const testing_support::ScratchFolder scratch;
  SimulateLimbJob job;
  job.folder = scratch.path();
  job.scene = LimbScene::macaque;
  job.macaque.duration_s = 0.1;
  job.macaque.leds_per_segment = 2;
  ASSERT_TRUE(run_simulate_limb(job));
  EXPECT_EQ(io::read_text(scratch / "segments.toml").value(),
            "# kinemark_set=" + set_in(scratch / "segments.toml") +
                "\n[[segment]]\nname = \"upper_arm\"\nmarkers = [\"u0\", \"u1\"]\n\n"
                "[[segment]]\nname = \"forearm\"\nmarkers = [\"f0\", \"f1\"]\n\n"
                "[[joint]]\nname = \"elbow\"\nparent = \"upper_arm\"\nchild = \"forearm\"\n\n"
                "[[joint]]\nname = \"shoulder\"\nparent = \"ground\"\nchild = \"upper_arm\"\n");
  const data::SegmentLayout odd{{{"a\"b", {0}}}, {}};
  EXPECT_THAT(segment_layout_toml(odd, {"c\\d"}), HasSubstr("name = \"a\\\"b\"\nmarkers = [\"c\\\\d\"]"));
}

TEST(SimulateLimb, WritesAllOrNothing) {
  const testing_support::ScratchFolder scratch;
  SimulateLimbJob job;
  job.folder = scratch / "arm";
  job.arm.missing = 2.0;
  EXPECT_EQ(run_simulate_limb(job).error().code, Code::usage);
  job.arm.missing = 0.0;
  job.progress = [](std::int64_t, std::int64_t) { return false; };
  EXPECT_EQ(run_simulate_limb(job).error().code, Code::cancelled);
  job.progress = {};
  EXPECT_EQ(scratch.count_files(), 0);
  job.upsample.factor = 1000;
  EXPECT_EQ(run_simulate_limb(job).error().code, Code::usage);
  job.upsample.factor = 1;
  ASSERT_TRUE(run_simulate_limb(job));
  EXPECT_EQ(run_simulate_limb(job).error().code, Code::io);  // they exist
  job.force = true;
  EXPECT_TRUE(run_simulate_limb(job));
}

}  // namespace
}  // namespace kinemark::pipeline
