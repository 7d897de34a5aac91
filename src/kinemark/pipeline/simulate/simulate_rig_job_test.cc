// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/simulate/simulate_rig_job.h"

#include <gmock/gmock.h>

#include <cmath>

#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/recording/counts_recording.h"
#include "kinemark/io/rig/rig_file.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/pipeline/files/file_set.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

SimulateRigJob job(const fs::path& folder, RigSceneKind scene = RigSceneKind::sign) {
  SimulateRigJob out;
  out.folder = folder;
  out.scene = scene;
  out.duration_s = 0.3;
  return out;
}

std::string refusal(const SimulateRigJob& job) {
  const auto outcome = run_simulate_rig(job);
  return outcome ? "written" : outcome.error().message;
}

TEST(SimulateRig, TheFilesAgreeWithTheStage) {
  const testing_support::ScratchFolder scratch;
  auto asked = job(scratch / "sign");
  asked.seed = 3;
  const auto outcome = run_simulate_rig(asked);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->written.size(), 5U);
  const auto rig = simulation::draw_rig({.seed = 3}).value();
  const auto expected =
      simulation::record(rig, simulation::signing_arm(), {.frames = 30, .seed = 3, .stream = 420}).value();
  const auto recording = io::read_counts(scratch / "sign/recording.mcap").value();
  EXPECT_EQ(recording.counts.counts, expected.counts.counts);
  EXPECT_EQ(recording.counts.leds, expected.counts.leds);
  EXPECT_EQ(recording.counts.rig_id, rig.rig.id);
  const auto truth = io::read_markers(scratch / "sign/truth.trc").value().markers;
  EXPECT_LT((truth.x(17, 3) - expected.truth.x(17, 3)).norm(), 1e-7);
  const auto rates = io::read_table(scratch / "sign/truth_derivatives.sto").value();
  EXPECT_NEAR(rates(17, rates.find("hand_vy")),
              expected.derivatives.velocity[3 * expected.truth.index(17, 3) + 1], 1e-9);
  const auto read = io::read_rig(scratch / "sign/rig_true.toml").value();
  EXPECT_EQ(io::format_rig(read), io::format_rig(simulation::rig_in_room(rig)));
  EXPECT_EQ(io::read_rig(scratch / "sign/rig_nominal.toml").value().method, "nominal");
}

TEST(SimulateRig, FilesNameTheirSet) {
  const testing_support::ScratchFolder scratch;
  auto asked = job(scratch / "tree", RigSceneKind::tree);
  asked.grid = asked.scan = true;
  const auto outcome = run_simulate_rig(asked);
  ASSERT_TRUE(outcome) << outcome.error().message;
  const std::string set = set_in(outcome->written.front());
  EXPECT_EQ(set.size(), 16U);
  for (const auto& file : outcome->written) EXPECT_EQ(set_in(file), set) << file;
  asked.folder = scratch / "other";
  asked.seed = 8;
  ASSERT_TRUE(run_simulate_rig(asked));
  EXPECT_NE(set_in(scratch / "other/recording.mcap"), set);
}

TEST(SimulateRig, CalibrationRecordingsTellWhatIsKnown) {
  const testing_support::ScratchFolder scratch;
  auto asked = job(scratch / "tree", RigSceneKind::tree);
  asked.grid = asked.tree_poses = asked.scan = true;
  const auto outcome = run_simulate_rig(asked);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->written.size(), 9U);
  const auto values = [&scratch](const char* file) {
    const auto recording = io::read_counts(scratch / file).value();
    for (const auto& metadata : recording.metadata)
      if (metadata.name == "calibration") return metadata.values;
    return std::map<std::string, std::string>();
  };
  EXPECT_EQ(values("tree/grid_B.mcap")["nodes"], "15");
  EXPECT_EQ(values("tree/tree_poses.mcap")["frames_per_pose"], "10");
  EXPECT_EQ(values("tree/tree_poses.mcap")["sides_m"], "0.533 0.31 0.31");
  EXPECT_EQ(std::ranges::count(values("tree/scan.mcap")["places_m"], '\n'), 8 * 9 * 6);
}

TEST(SimulateRig, MarkersOfAFileBecomeLeds) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(run_simulate_rig(job(scratch / "wheel", RigSceneKind::wheel)));
  auto again = job(scratch / "again", RigSceneKind::markers);
  again.markers = scratch / "wheel/truth.trc";
  again.duration_s = 0.0;
  const auto outcome = run_simulate_rig(again);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_THAT(outcome->warnings[0], HasSubstr("1 LED, 100 frames per second, 29 frames"));
  again.marker_options.markers = {"hub"};
  again.folder = scratch / "none";
  EXPECT_THAT(refusal(again), HasSubstr("truth.trc: there is no marker 'hub'"));
}

TEST(SimulateRig, OcclusionsAndIntensitiesGoByName) {
  const testing_support::ScratchFolder scratch;
  auto asked = job(scratch / "sign");
  asked.occlusions = {"hand:B:3-5", "all:A:9-9"};
  asked.intensity = {{"", 0.5}, {"elbow", 20.0}};
  const auto outcome = run_simulate_rig(asked);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_THAT(outcome->warnings,
              ::testing::Contains(HasSubstr("LED 'elbow' saturates camera A in 29 of 30 frames")));
  const auto counts = io::read_counts(scratch / "sign/recording.mcap").value().counts;
  EXPECT_LT(counts.at(3, 3, 1).sum(), 60.0);
  EXPECT_GT(counts.at(3, 3, 0).sum(), 500.0);
  for (int l = 0; l < 4; ++l) EXPECT_LT(counts.at(9, l, 0).sum(), l == 1 ? 600.0 : 60.0);
}

TEST(SimulateRig, WhatIsWrongIsOneSentenceAndLeavesNothing) {
  const testing_support::ScratchFolder scratch;
  const auto with = [&](auto&& spoil, RigSceneKind scene = RigSceneKind::sign) {
    auto asked = job(scratch / "deep/new", scene);
    spoil(asked);
    return refusal(asked);
  };
  EXPECT_THAT(with([](SimulateRigJob& j) { j.recording.rate_hz = 300.0; }),
              HasSubstr("276.5 frames per second at most"));
  EXPECT_THAT(with([](SimulateRigJob& j) { j.tree_pose = 10; }, RigSceneKind::tree),
              HasSubstr("tree pose 10"));
  EXPECT_THAT(with([](SimulateRigJob& j) { j.wheel.rotation_deg = NAN; }, RigSceneKind::wheel),
              HasSubstr("turned by nan"));
  EXPECT_THAT(with([](SimulateRigJob&) {}, RigSceneKind::markers), HasSubstr("needs a marker file"));
  EXPECT_THAT(with([](SimulateRigJob& j) { j.occlusions = {"thumb:A:1-2"}; }),
              HasSubstr("there are shoulder, elbow"));
  EXPECT_THAT(with([](SimulateRigJob& j) { j.occlusions = {"hand:C:1-2"}; }),
              HasSubstr("no camera 'C'; there are A, B"));
  for (const char* text :
       {"hand", "hand:A", "hand:A:5", "hand:A:5-4", "hand:A:x-9", ":", "::", "hand:A:-1-4"})
    EXPECT_THAT(with([&](SimulateRigJob& j) { j.occlusions = {text}; }),
                HasSubstr("is not LED:CAMERA:FIRST-LAST"))
        << text;
  EXPECT_THAT(with([](SimulateRigJob& j) { j.intensity = {{"thumb", 1.0}}; }), HasSubstr("no LED 'thumb'"));
  EXPECT_THAT(with([](SimulateRigJob& j) { j.intensity = {{"", -1.0}}; }), HasSubstr("intensity -1"));
  EXPECT_THAT(with([](SimulateRigJob& j) { j.duration_s = -1.0; }), HasSubstr("need positive numbers"));
  EXPECT_THAT(with([](SimulateRigJob& j) { j.duration_s = 1e300; }), HasSubstr("10 million"));
  EXPECT_THAT(with([](SimulateRigJob& j) { j.rig.crosstalk = 2.0; }), HasSubstr("crosstalk"));
  EXPECT_EQ(scratch.count_files(), 0);
  EXPECT_FALSE(fs::exists(scratch / "deep"));
  EXPECT_THAT(parse_rig_scene("dance").error().message, HasSubstr("there are tree, wheel, sign and markers"));
}

TEST(SimulateRig, TheHighestRateIsUsedWhenAskedFor) {
  const testing_support::ScratchFolder scratch;
  auto asked = job(scratch / "wheel", RigSceneKind::wheel);
  asked.wheel.leds = 8;
  asked.highest_rate = true;
  asked.rig.dark_slot = true;
  const auto outcome = run_simulate_rig(asked);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_THAT(outcome->warnings[0], HasSubstr("8 LEDs, 122.911 frames per second"));
  EXPECT_TRUE(io::read_counts(scratch / "wheel/recording.mcap").value().counts.has_dark_slot());
}

}  // namespace
}  // namespace kinemark::pipeline
