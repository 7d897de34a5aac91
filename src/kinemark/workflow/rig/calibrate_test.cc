// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/rig/calibrate.h"

#include <gmock/gmock.h>

#include "kinemark/stages/simulation/rig_calibration.h"
#include "kinemark/stages/simulation/rig_scene.h"

namespace kinemark::workflow {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A rig, what its operator believes of it, and what was held before it.
struct Laboratory {
  simulation::PhysicalRig drawn = simulation::draw_rig({.seed = 6, .dark_slot = true}).value();
  data::Rig nominal = drawn.nominal;
  ShownCounts tree, scan;
  std::vector<ShownCounts> grids;

  Laboratory() {
    const auto sides = simulation::tree_sides_m();
    auto held = simulation::record_tree_poses(drawn, {.poses = 60}).value();
    tree = {
        .name = "tree",
        .counts = std::move(held.counts),
        .shows = ShownTree{.sides_m = {sides.begin(), sides.end()}, .frames_per_pose = held.frames_per_pose}};
    auto moved = simulation::record_scan(drawn, {.positions = {4, 4, 3}}).value();
    scan = {
        .name = "scan",
        .counts = std::move(moved.counts),
        .shows = ShownScan{.frames_per_place = moved.frames_per_position, .x_in_stage = moved.x_in_stage}};
    auto hung = simulation::record_grid(drawn, {.samples = 5}).value();
    for (auto& counts : hung.counts)
      grids.push_back({.name = "grid",
                       .counts = std::move(counts),
                       .shows = ShownGrid{
                           .nodes = hung.nodes, .spacing_m = hung.spacing_m, .distance_m = hung.distance_m}});
  }
};

const Laboratory& laboratory() {
  static const Laboratory shared;
  return shared;
}

std::vector<ShownCounts> tree_and_grids() {
  auto out = laboratory().grids;
  out.push_back(laboratory().tree);
  return out;
}

/// Quick, and enough for this rig.
CalibrateOptions quick() {
  CalibrateOptions out;
  out.bundle.warp_degree = 6;
  out.bundle.crosstalk = false;
  return out;
}

TEST(Calibrate, TreeAndGridsGiveARigThatTheCountsDoNotContradict) {
  const auto found = calibrate(tree_and_grids(), laboratory().nominal, quick()).value();
  ASSERT_TRUE(found.rig);
  EXPECT_EQ(found.rig->method, "bundle");
  EXPECT_GT(found.rig->covariance.rows(), 100);
  EXPECT_LT(found.bundle->chi2_per_dof, 1.3);
  EXPECT_TRUE(found.remarks.passed());
  EXPECT_THAT(found.remarks.warnings, IsEmpty());
  ASSERT_EQ(found.alignment->cameras.size(), 2U);
}

TEST(Calibrate, DarkSlotsAndLightsOfTheTreeGoToTheRig) {
  const auto found = calibrate(std::vector{laboratory().tree}, laboratory().nominal, quick()).value();
  const auto truth = simulation::rig_in_room(laboratory().drawn);
  for (std::size_t c = 0; c < 2; ++c) {
    const auto &is = found.rig->cameras[c].detector, &should = truth.cameras[c].detector;
    EXPECT_NEAR(is.light_counts, should.light_counts, 0.01 * should.light_counts);
    ASSERT_TRUE(is.knows_dark());
    EXPECT_LT((is.dark_counts - should.dark_counts).cwiseAbs().maxCoeff(), 0.3);
  }
}

TEST(Calibrate, GridsAloneGiveTheTableOf1986AndAScanItsOwnRig) {
  auto options = quick();
  options.method = CalibrateMethod::grid_lut;
  const auto table = calibrate(laboratory().grids, laboratory().nominal, options).value();
  ASSERT_TRUE(table.rig);
  EXPECT_EQ(table.rig->cameras[1].table.nodes, 15);
  EXPECT_FALSE(table.bundle);
  EXPECT_THAT(table.remarks.gates, IsEmpty()) << "no bound is held against a table";
  options.method = CalibrateMethod::scan;
  const auto scanned = calibrate(std::vector{laboratory().scan}, laboratory().nominal, options).value();
  ASSERT_TRUE(scanned.rig);
  EXPECT_EQ(scanned.rig->method, "scan");
}

TEST(Calibrate, AlignmentAloneGivesNoRig) {
  auto options = quick();
  options.align_only = true;
  const auto found = calibrate(std::vector{laboratory().tree}, laboratory().nominal, options).value();
  EXPECT_FALSE(found.rig);
  EXPECT_FALSE(found.bundle);
  EXPECT_FALSE(found.alignment->next.empty());
  EXPECT_TRUE(found.remarks.passed());
}

TEST(Calibrate, AModelThatTheCountsContradictIsAMissedGate) {
  auto options = quick();
  options.bundle.warp_degree = 2;
  options.bundle.escalate = false;
  const auto found = calibrate(tree_and_grids(), laboratory().nominal, options).value();
  EXPECT_FALSE(found.rig);
  EXPECT_FALSE(found.remarks.passed());
  ASSERT_EQ(found.remarks.gates.size(), 1U);
  EXPECT_EQ(found.remarks.gates[0].name, "chi2_per_dof");
}

TEST(Calibrate, ARecordingThatWasCutWithinAPoseSaysHowMuchIsNotUsed) {
  auto cut = laboratory().tree;
  const auto last = static_cast<std::size_t>(--cut.counts.time.frames);
  const auto one_less = [last](auto& values) { values.resize(values.size() / (last + 1) * last); };
  one_less(cut.counts.counts);
  one_less(cut.counts.flags);
  one_less(cut.counts.dark);
  auto options = quick();
  options.align_only = true;
  const auto found = calibrate(std::vector{cut}, laboratory().nominal, options).value();
  EXPECT_THAT(found.remarks.warnings,
              ElementsAre(HasSubstr(
                  "tree: the last 9 of 599 frames are of a pose that was not recorded to its end")));
}

TEST(Calibrate, WhatIsNotShownIsNamed) {
  const auto refused = [](const std::vector<ShownCounts>& shown, CalibrateMethod method, Code code) {
    auto options = quick();
    options.method = method;
    const auto found = calibrate(shown, laboratory().nominal, options);
    if (found) return std::string("found");
    EXPECT_EQ(found.error().code, code);
    return found.error().message;
  };
  EXPECT_THAT(refused(laboratory().grids, CalibrateMethod::bundle, Code::usage),
              HasSubstr("the method bundle needs a recording of the tree"));
  EXPECT_THAT(refused({laboratory().tree}, CalibrateMethod::scan, Code::usage), HasSubstr("of the scan"));
  EXPECT_THAT(refused({laboratory().tree}, CalibrateMethod::grid_lut, Code::usage),
              HasSubstr("needs a recording of the grid"));
  EXPECT_THAT(refused({laboratory().grids[0]}, CalibrateMethod::grid_lut, Code::usage),
              HasSubstr("a grid for 1 of 2 cameras"));
  auto two = laboratory().grids[0];
  two.counts = laboratory().tree.counts;
  EXPECT_THAT(refused({two}, CalibrateMethod::grid_lut, Code::bad_input),
              HasSubstr("grid: a grid is recorded by one camera of the rig; this recording has 2"));
  two = laboratory().grids[0];
  two.counts.cameras[0] = "C";
  EXPECT_THAT(refused({two}, CalibrateMethod::grid_lut, Code::bad_input),
              HasSubstr("grid: its camera 'C' is none of the rig"));
  EXPECT_EQ(to_string(CalibrateMethod::grid_lut), "grid-lut");
}

}  // namespace
}  // namespace kinemark::workflow
