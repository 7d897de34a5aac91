// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The chain from files to files: recordings of known things to a rig, counts and rig to markers.
#include "kinemark/pipeline/rig/calibrate_job.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/recording/counts_recording.h"
#include "kinemark/io/rig/rig_file.h"
#include "kinemark/pipeline/rig/reconstruct_job.h"
#include "kinemark/pipeline/simulate/simulate_rig_job.h"
#include "kinemark/pipeline/testing/shared_folder.h"

namespace kinemark::pipeline {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

/// A simulated laboratory, written once for all tests of this file.
class CalibrateJobTest : public testing::SharedFolder<CalibrateJobTest> {
 public:
  static void make_files() {
    SimulateRigJob job;
    job.folder = at("lab");
    job.scene = RigSceneKind::tree;
    job.duration_s = 0.3;
    job.grid = job.tree_poses = job.scan = true;
    run_simulate_rig(job).value();
  }

 protected:
  static fs::path lab(const std::string& name) { return at("lab/" + name); }
  static fs::path fresh(const std::string& name) { return at(name); }

  static CalibrateJob bundle(const std::string& output) {
    CalibrateJob job;
    job.inputs = {lab("tree_poses.mcap"), lab("grid_A.mcap"), lab("grid_B.mcap")};
    job.nominal = lab("rig_nominal.toml");
    job.output = fresh(output);
    job.options.bundle.warp_degree = 6;  // quick, and enough for this rig
    job.options.bundle.crosstalk = false;
    return job;
  }
};

TEST_F(CalibrateJobTest, FromRecordingsToMarkers) {
  const auto outcome = run_calibrate(bundle("rig.toml"));
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_LT(outcome->bundle->chi2_per_dof, 1.2);
  EXPECT_EQ(outcome->bundle->poses, 300);
  EXPECT_EQ(outcome->alignment->cameras.size(), 2U);
  EXPECT_EQ(outcome->exit_status(), 0);
  ASSERT_EQ(outcome->gates.size(), 1U);
  EXPECT_THAT(outcome->gates[0].sentence, HasSubstr("chi2 per degree of freedom is"));
  const auto json = calibrate_json(*outcome);
  EXPECT_EQ(json["method"], "bundle");
  EXPECT_EQ(json["poses"], 300);
  EXPECT_EQ(json["alignment"]["cameras"][1]["right_down_forward_mm"][2].get<double>(),
            1e3 * outcome->alignment->cameras[1].shift_m.z());
  EXPECT_EQ(json["written"], fresh("rig.toml").string());
  const auto rig = io::read_rig(fresh("rig.toml")).value();
  EXPECT_EQ(rig.method, "bundle");
  EXPECT_GT(rig.covariance.rows(), 100);

  ReconstructJob job;
  job.recording = lab("recording.mcap");
  job.rig = fresh("rig.toml");
  job.output = fresh("points.csv");
  job.options.method = workflow::ReconstructMethod::frames;
  const auto made = run_reconstruct(job);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(made->found.leds.at(0).located, 30);
  const auto markers = io::read_markers(fresh("points.csv")).value().markers;
  const auto truth = io::read_markers(lab("truth.trc")).value().markers;
  double side = 0.0;
  for (std::int64_t f = 0; f < 30; ++f) side += (markers.x(f, 0) - markers.x(f, 1)).norm() / 30.0;
  EXPECT_NEAR(side, (truth.x(0, 0) - truth.x(0, 1)).norm(), 0.6e-3);
  job.output = fresh("points.c3d");
  job.options.method = workflow::ReconstructMethod::smoother;
  ASSERT_TRUE(run_reconstruct(job));
  job.options.method = workflow::ReconstructMethod::classic;
  job.output = fresh("classic.trc");
  EXPECT_TRUE(run_reconstruct(job)) << "the grid left tables in the rig";
}

TEST_F(CalibrateJobTest, GridLutAndScan) {
  auto job = bundle("lut.toml");
  job.options.method = workflow::CalibrateMethod::grid_lut;
  auto recording = io::read_counts(lab("tree_poses.mcap")).value();
  auto& counts = recording.counts;
  const auto last = static_cast<std::size_t>(--counts.time.frames);
  const auto one_less = [last](auto& values) { values.resize(values.size() / (last + 1) * last); };
  one_less(counts.counts);
  one_less(counts.flags);
  one_less(counts.dark);
  ASSERT_TRUE(io::write_counts(fresh("cut.mcap"), counts, recording.metadata, false));
  job.inputs[0] = fresh("cut.mcap");
  const auto tables = run_calibrate(job);
  ASSERT_TRUE(tables) << tables.error().message;
  EXPECT_THAT(tables->warnings,
              Contains(HasSubstr("frames are of a pose that was not recorded to its end; not used")));
  EXPECT_EQ(io::read_rig(job.output)->cameras[1].table.nodes, 15);
  job = bundle("scan.toml");
  job.options.method = workflow::CalibrateMethod::scan;
  job.inputs = {lab("scan.mcap")};
  const auto outcome = run_calibrate(job);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(io::read_rig(job.output)->method, "scan");
}

TEST_F(CalibrateJobTest, AlignmentWritesNothing) {
  auto job = bundle("none.toml");
  job.options.align_only = true;
  job.inputs = {lab("tree_poses.mcap")};
  job.report = fresh("none.html");
  const auto outcome = run_calibrate(job);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_FALSE(outcome->alignment->next.empty());
  EXPECT_FALSE(fs::exists(fresh("none.toml")));
  EXPECT_EQ(outcome->written, std::vector{fresh("none.html")}) << "the page alone";
  const auto json = calibrate_json(*outcome);
  EXPECT_FALSE(json.contains("written"));
  EXPECT_FALSE(json.contains("chi2_per_dof"));
  EXPECT_THAT(outcome->warnings,
              Not(Contains(HasSubstr("frames are of a pose that was not recorded to its end"))));
  std::string judged;
  for (const auto& gate : outcome->gates) judged += gate.sentence;
  EXPECT_THAT(judged, Not(HasSubstr("chi2 per degree of freedom is")));
}

TEST_F(CalibrateJobTest, AModelThatTheCountsContradictIsAMissedGate) {
  auto job = bundle("poor.toml");
  job.options.bundle.warp_degree = 2;
  job.options.bundle.escalate = false;
  const auto refused = run_calibrate(job);
  ASSERT_TRUE(refused) << refused.error().message;
  EXPECT_EQ(refused->exit_status(), 1);
  ASSERT_EQ(refused->gates.size(), 1U);
  EXPECT_EQ(refused->gates[0].name, "chi2_per_dof");
  EXPECT_THAT(refused->gates[0].sentence, HasSubstr("calibration refused"));
  EXPECT_FALSE(refused->bundle);
  EXPECT_TRUE(refused->written.empty());
  EXPECT_FALSE(fs::exists(job.output));
}

TEST_F(CalibrateJobTest, RefusesWhatIsMissingOrWrong) {
  auto job = bundle("wrong.toml");
  job.inputs = {lab("recording.mcap")};
  EXPECT_THAT(run_calibrate(job).error().message, HasSubstr("a tree, a grid or a scan was expected"));
  job.inputs = {lab("grid_A.mcap")};
  EXPECT_THAT(run_calibrate(job).error().message, HasSubstr("a grid for 1 of 2 cameras"));
  job.inputs = {lab("grid_A.mcap"), lab("grid_B.mcap")};
  EXPECT_THAT(run_calibrate(job).error().message, HasSubstr("needs a recording of the tree"));
  job = bundle("wrong.toml");
  job.sides_m = {0.31, 0.533, 0.31};
  EXPECT_THAT(run_calibrate(job).error().message, HasSubstr("sides do not match"));
  EXPECT_FALSE(fs::exists(fresh("wrong.toml")));
  ReconstructJob classic;
  classic.recording = lab("recording.mcap");
  classic.rig = lab("rig_nominal.toml");
  classic.output = fresh("x.trc");
  classic.options.method = workflow::ReconstructMethod::classic;
  EXPECT_THAT(run_reconstruct(classic).error().message, HasSubstr("no look-up table"));
}

}  // namespace
}  // namespace kinemark::pipeline
