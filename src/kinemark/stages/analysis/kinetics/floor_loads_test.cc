// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/kinetics/floor_loads.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"

namespace kinemark::analysis {
namespace {

using Eigen::MatrixX3d;
using Eigen::Vector3d;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::int64_t kStepFrames = 200;
constexpr double kStepRate_hz = 100.0;
using Corners = std::vector<Vector3d>;

Corners square(double x, double y) {
  return {Vector3d(x, y, 0), Vector3d(x + 0.6, y, 0), Vector3d(x + 0.6, y + 0.4, 0), Vector3d(x, y + 0.4, 0)};
}

/// A foot that hurries to x, stands there in frames [first, end) and hurries on.
FootTrack foot_at(const std::string& name, double x, double y, std::int64_t first, std::int64_t end) {
  FootTrack out{.name = name, .points = {MatrixX3d(kStepFrames, 3), MatrixX3d(kStepFrames, 3)}};
  for (std::int64_t f = 0; f < kStepFrames; ++f) {
    const std::int64_t away = f < first ? f - first : f >= end ? f - end + 1 : 0;
    const double forward = x + 0.03 * static_cast<double>(away);
    out.points[0].row(f) = Vector3d(forward, y, 0.03);
    out.points[1].row(f) = Vector3d(forward + 0.2, y, 0.03);
  }
  return out;
}

data::Wrenches plates_of(std::size_t count) {
  data::Wrenches out{.time = {.rate_hz = kStepRate_hz, .frames = kStepFrames}, .items = {}};
  for (std::size_t p = 0; p < count; ++p) {
    data::Wrench plate{
        .name = "plate " + std::to_string(p + 1), .body = {}, .force = {}, .moment = {}, .point = {}};
    for (auto* values : {&plate.force, &plate.moment, &plate.point}) values->assign(at(3 * kStepFrames), 0.0);
    out.items.push_back(std::move(plate));
  }
  return out;
}

void load(data::Wrench& plate, std::int64_t first, std::int64_t end, const Vector3d& point) {
  for (std::int64_t f = first; f < end; ++f) {
    Eigen::Map<Vector3d>(plate.force.data() + 3 * f) = Vector3d(10.0, 0.0, 700.0);
    Eigen::Map<Vector3d>(plate.moment.data() + 3 * f) = Vector3d(0.0, 0.0, 2.0);
    Eigen::Map<Vector3d>(plate.point.data() + 3 * f) = point;
  }
}

std::int64_t known(const FloorLoad& foot) { return std::ranges::count(foot.known, true); }

TEST(FloorLoads, EachFootBearsThePlateUnderIt) {
  auto plates = plates_of(2);
  load(plates.items[0], 50, 110, Vector3d(0.3, 0.1, 0.0));
  load(plates.items[1], 100, 160, Vector3d(1.0, 0.3, 0.0));
  const std::vector<FootTrack> feet{foot_at("left", 0.9, 0.3, 100, 160), foot_at("right", 0.2, 0.1, 50, 110)};
  plates.items[0].corners_in_world = square(0.0, 0.0);
  plates.items[1].corners_in_world = square(0.7, 0.1);
  const auto found = find_floor_loads(plates, feet, Vector3d::UnitZ());
  EXPECT_THAT(found.notes, IsEmpty());
  ASSERT_EQ(found.feet.size(), 2U);
  ASSERT_EQ(found.feet[0].contacts.size(), 1U);
  EXPECT_EQ(found.feet[0].contacts[0].plate, 1U);
  EXPECT_EQ(found.feet[1].contacts[0].plate, 0U);
  EXPECT_EQ(known(found.feet[0]), kStepFrames);
  EXPECT_EQ(known(found.feet[1]), kStepFrames);
  EXPECT_EQ(found.feet[0].wrench.force(120, 2), 700.0);
  EXPECT_EQ(found.feet[0].wrench.force(60, 2), 0.0);
  // About the point of force there is the free moment alone.
  EXPECT_NEAR((found.feet[1].wrench.moment_about(Vector3d(0.3, 0.1, 0.0), 70) - Vector3d(0, 0, 2)).norm(),
              0.0, 1e-12);
}

TEST(FloorLoads, FootOnTheFloorWithoutPlateIsNotKnown) {
  auto plates = plates_of(1);
  load(plates.items[0], 50, 110, Vector3d(0.3, 0.1, 0.0));
  const std::vector<FootTrack> feet{foot_at("left", 0.9, 0.3, 100, 160), foot_at("right", 0.2, 0.1, 50, 110)};
  const auto found = find_floor_loads(plates, feet, Vector3d::UnitZ());
  EXPECT_EQ(known(found.feet[1]), kStepFrames);
  EXPECT_LT(known(found.feet[0]), kStepFrames - 50);
  EXPECT_FALSE(found.feet[0].known[130]);
  EXPECT_TRUE(found.feet[0].known[40]);  // in the air
  ASSERT_EQ(found.notes.size(), 1U);
  EXPECT_THAT(found.notes[0], HasSubstr("left: on the floor without a plate that measures it in "));
}

TEST(FloorLoads, TwoFeetOnOnePlateAreNotKnownWhileBothStand) {
  auto plates = plates_of(1);
  load(plates.items[0], 50, 160, Vector3d(0.3, 0.1, 0.0));
  const std::vector<FootTrack> feet{foot_at("left", 0.1, 0.3, 90, 180), foot_at("right", 0.2, 0.1, 50, 160)};
  plates.items[0].corners_in_world = square(0.0, 0.0);
  const auto found = find_floor_loads(plates, feet, Vector3d::UnitZ());
  EXPECT_TRUE(found.feet[1].known[70]);
  EXPECT_FALSE(found.feet[1].known[120]);
  EXPECT_FALSE(found.feet[0].known[120]);
  EXPECT_THAT(found.notes, testing::Contains(HasSubstr("plate 1: two feet are on it in ")));
}

TEST(FloorLoads, StepPartlyBesideThePlateIsNotKnown) {
  auto plates = plates_of(1);
  load(plates.items[0], 50, 110, Vector3d(0.55, 0.1, 0.0));
  // Its toe is 0.1 m in front of the plate.
  const std::vector<FootTrack> feet{foot_at("right", 0.5, 0.1, 50, 110)};
  plates.items[0].corners_in_world = square(0.0, 0.0);
  const auto found = find_floor_loads(plates, feet, Vector3d::UnitZ());
  EXPECT_FALSE(found.feet[0].known[80]);
  ASSERT_EQ(found.notes.size(), 1U);
  EXPECT_EQ(found.notes[0],
            "right: its step on plate 1 from 0.50 to 1.09 s is partly beside the plate: no moments there.");
  // On a plate of which nobody knows where it ends, nothing is said.
  plates.items[0].corners_in_world.clear();
  EXPECT_THAT(find_floor_loads(plates, feet, Vector3d::UnitZ()).notes, IsEmpty());
}

TEST(FloorLoads, OneFootOnTwoPlatesBearsTheirSum) {
  auto plates = plates_of(2);
  load(plates.items[0], 50, 110, Vector3d(0.55, 0.1, 0.0));
  load(plates.items[1], 50, 110, Vector3d(0.65, 0.1, 0.0));
  const std::vector<FootTrack> feet{foot_at("right", 0.5, 0.1, 50, 110)};
  plates.items[0].corners_in_world = square(0.0, 0.0);
  plates.items[1].corners_in_world = square(0.6, 0.0);
  const auto found = find_floor_loads(plates, feet, Vector3d::UnitZ());
  EXPECT_THAT(found.notes, IsEmpty());
  EXPECT_EQ(found.feet[0].wrench.force(80, 2), 1400.0);
  EXPECT_EQ(known(found.feet[0]), kStepFrames);
}

TEST(FloorLoads, LoadFarFromAllFeetIsNobodys) {
  auto plates = plates_of(1);
  load(plates.items[0], 50, 110, Vector3d(3.0, 0.1, 0.0));
  const std::vector<FootTrack> feet{foot_at("right", 0.5, 0.1, 50, 110)};
  const auto found = find_floor_loads(plates, feet, Vector3d::UnitZ());
  EXPECT_THAT(found.feet[0].contacts, IsEmpty());
  EXPECT_EQ(found.notes[0],
            "plate 1: its load from 0.50 to 1.09 s is no foot's: none is within 150 mm of it.");
}

TEST(FloorLoads, ContactBeginsAndEndsWithItsFirstNewtons) {
  auto plates = plates_of(1);
  load(plates.items[0], 50, 110, Vector3d(0.6, 0.1, 0.0));
  for (const std::int64_t f : {48L, 49L, 110L}) plates.items[0].force[at(3 * f + 2)] = f == 48 ? 2.0 : 15.0;
  const std::vector<FootTrack> feet{foot_at("right", 0.5, 0.1, 50, 110)};
  const auto found = find_floor_loads(plates, feet, Vector3d::UnitZ());
  ASSERT_EQ(found.feet[0].contacts.size(), 1U);
  EXPECT_EQ(found.feet[0].contacts[0].first, 49);
  EXPECT_EQ(found.feet[0].contacts[0].count, 62);
}

TEST(FloorLoads, FrameThatThePlateDidNotMeasureIsNotKnown) {
  auto plates = plates_of(1);
  load(plates.items[0], 50, 110, Vector3d(0.6, 0.1, 0.0));
  Eigen::Map<Vector3d>(plates.items[0].moment.data() + 3L * 80).setConstant(kNaN);
  const std::vector<FootTrack> feet{foot_at("right", 0.5, 0.1, 50, 110)};
  const auto found = find_floor_loads(plates, feet, Vector3d::UnitZ());
  EXPECT_FALSE(found.feet[0].known[80]);
  EXPECT_TRUE(found.feet[0].known[81]);
}

}  // namespace
}  // namespace kinemark::analysis
