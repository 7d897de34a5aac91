// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/consistency/motion_facts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace kinemark::analysis {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr std::int64_t kFrames = 100;

/// A pelvis free in space, knees with ranges of -120 to 10 deg, a slide of 0 to 100 mm.
data::ModelDescription legs(int knees = 1) {
  data::ModelDescription out;
  const auto add = [&out](const std::string& name, bool rotates, double low, double high) {
    out.coordinates.push_back({.name = name, .is_rotation = rotates, .range_min = low, .range_max = high});
    data::AxisDescription axis;
    axis.is_rotation = rotates;
    axis.coordinate_idx = static_cast<int>(out.coordinates.size()) - 1;
    return axis;
  };
  data::JointDescription pelvis{.name = "ground_pelvis"};
  pelvis.axes = {add("pelvis_rotation", true, -90.0 * kDegree, 90.0 * kDegree),
                 add("pelvis_tx", false, -5.0, 5.0)};
  out.joints = {pelvis};
  for (int k = 0; k < knees; ++k) {
    data::JointDescription joint{.name = "knee" + std::to_string(k), .parent_body_idx = 0};
    joint.axes = {add("knee_" + std::to_string(k), true, -120.0 * kDegree, 10.0 * kDegree)};
    out.joints.push_back(joint);
  }
  data::JointDescription slide{.name = "slide", .parent_body_idx = 0};
  slide.axes = {add("slide_x", false, 0.0, 0.1)};
  out.joints.push_back(slide);
  return out;
}

/// Every coordinate at 0 throughout.
data::JointMotion still(const data::ModelDescription& model) {
  data::JointMotion out;
  for (const auto& coordinate : model.coordinates) {
    out.coordinates.push_back(coordinate.name);
    out.is_rotation.push_back(coordinate.is_rotation);
  }
  out.time = {.rate_hz = 100.0, .t0_s = 0.0, .frames = kFrames};
  out.q.assign(static_cast<std::size_t>(kFrames * out.size()), 0.0);
  return out;
}

void set(data::JointMotion& motion, const char* name, std::int64_t first, std::int64_t count, double value) {
  for (std::int64_t f = first; f < first + count; ++f) motion.q[motion.index(f, motion.find(name))] = value;
}

TEST(MotionFacts, AKneeThatGoesTheOtherWayIsNamed) {
  const auto model = legs();
  auto motion = still(model);
  EXPECT_THAT(coordinates_out_of_range(model, motion), IsEmpty());
  set(motion, "knee_0", 20, 30, 44.0 * kDegree);
  set(motion, "knee_0", 40, 1, 45.0 * kDegree);
  EXPECT_THAT(coordinates_out_of_range(model, motion),
              ElementsAre("'knee_0' lies up to 35 deg above its range in the model, -120 to 10 deg, in 30 of "
                          "100 frames, farthest at 0.400 s"));
  set(motion, "knee_0", 20, 30, -150.0 * kDegree);
  EXPECT_THAT(coordinates_out_of_range(model, motion),
              ElementsAre(HasSubstr("'knee_0' lies up to 30 deg below its range in the model")));
}

TEST(MotionFacts, ClampedIsSaidTooAndSo) {
  auto model = legs();
  model.coordinates[2].clamped = true;
  auto motion = still(model);
  set(motion, "knee_0", 0, 50, 60.0 * kDegree);
  EXPECT_THAT(coordinates_out_of_range(model, motion),
              ElementsAre(HasSubstr("-120 to 10 deg (clamped), in 50")));
}

TEST(MotionFacts, LittleOrForAMomentIsNothing) {
  const auto model = legs();
  auto motion = still(model);
  set(motion, "knee_0", 0, 100, 19.0 * kDegree);
  EXPECT_THAT(coordinates_out_of_range(model, motion), Not(Contains(HasSubstr("its range in the model"))))
      << "9 deg";
  motion = still(model);
  set(motion, "knee_0", 50, 4, 60.0 * kDegree);
  EXPECT_THAT(coordinates_out_of_range(model, motion), IsEmpty()) << "4 of 100 frames";
  set(motion, "knee_0", 50, 5, 60.0 * kDegree);
  EXPECT_THAT(coordinates_out_of_range(model, motion), SizeIs(1));
}

TEST(MotionFacts, TranslationsAreInMillimetres) {
  const auto model = legs();
  auto motion = still(model);
  set(motion, "slide_x", 0, 100, 0.129);
  EXPECT_THAT(coordinates_out_of_range(model, motion), IsEmpty());
  set(motion, "slide_x", 0, 100, 0.14);
  EXPECT_THAT(coordinates_out_of_range(model, motion),
              ElementsAre(HasSubstr("'slide_x' lies up to 40 mm above its range in the model, 0 to 100 mm")));
}

TEST(MotionFacts, ABodyInSpaceWhatIsHeldAndWhatHasNoRangeAreNotAsked) {
  auto model = legs();
  auto motion = still(model);
  set(motion, "pelvis_rotation", 0, 100, 175.0 * kDegree);
  EXPECT_THAT(coordinates_out_of_range(model, motion), IsEmpty()) << "who walks the other way";
  set(motion, "knee_0", 0, 100, 60.0 * kDegree);
  EXPECT_THAT(coordinates_out_of_range(model, motion), SizeIs(1));
  model.coordinates[2].locked = true;
  EXPECT_THAT(coordinates_out_of_range(model, motion), IsEmpty());
  model.coordinates[2].locked = false;
  model.coordinates[2].range_min = -1e30, model.coordinates[2].range_max = 1e30;
  EXPECT_THAT(coordinates_out_of_range(model, motion), IsEmpty());
}

TEST(MotionFacts, FiveAreNamedAndTheOthersCounted) {
  const auto model = legs(8);
  auto motion = still(model);
  for (int k = 0; k < 8; ++k) set(motion, ("knee_" + std::to_string(k)).c_str(), 0, 100, 60.0 * kDegree);
  const auto said = coordinates_out_of_range(model, motion);
  ASSERT_THAT(said, SizeIs(6));
  EXPECT_EQ(said.back(), "3 more coordinates leave their range in the model as far");
  motion = still(model);
  for (int k = 0; k < 5; ++k) set(motion, ("knee_" + std::to_string(k)).c_str(), 0, 100, 60.0 * kDegree);
  EXPECT_THAT(coordinates_out_of_range(model, motion),
              Not(Contains(HasSubstr("more coordinates leave their range in the model as far"))));
}

}  // namespace
}  // namespace kinemark::analysis
