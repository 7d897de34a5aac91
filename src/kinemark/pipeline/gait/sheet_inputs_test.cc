// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/gait/sheet_inputs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/pipeline/gait/testing/known_curves.h"

namespace kinemark::pipeline {
namespace {

using data::Side;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

std::vector<std::string> names(const std::vector<SheetInput>& inputs) {
  std::vector<std::string> out;
  for (const auto& one : inputs) out.push_back(one.curves.id + " " + one.curves.context);
  return out;
}

// Rises by 1 a second from 0 to 4 s.
analysis::CycleSeries ramp(const std::string& id) {
  analysis::CycleSeries out{.id = id};
  for (int i = 0; i <= 400; ++i) out.time_s.push_back(0.01 * i), out.values.push_back(0.01 * i);
  return out;
}

TEST(SheetInputs, SeriesAreCutByTheSideOfTheirName) {
  const auto gait = testing::known_gait();
  std::vector<SheetInput> out;
  add_series(ramp("knee_angle_r"), gait.cycles, "", out);
  add_series(ramp("pelvis_tilt"), gait.cycles, "", out);
  EXPECT_THAT(names(out), ElementsAre("knee_angle_r Right", "pelvis_tilt Left", "pelvis_tilt Right"));
  EXPECT_NEAR(out[0].curves(1, 50), 2.0, 1e-9);  // the second right cycle is from 1.5 to 2.5 s
  out.clear();
  add_series(ramp("knee_angle_r"), testing::known_gait(2, 0).cycles, "", out);
  EXPECT_TRUE(out.empty());
}

TEST(SheetInputs, CurvesOfNoCycleAreLeftOut) {
  std::vector<SheetInput> out;
  add_curves({testing::known_curve("a", Side::left).curves, testing::known_curve("b", Side::left, 0).curves},
             out);
  EXPECT_THAT(names(out), ElementsAre("a Left"));
}

data::Trial with_channels() {
  data::Trial trial;
  trial.markers.time = {.rate_hz = 100.0, .frames = 401};
  auto& channels = trial.channels;
  channels.rate_hz = 100.0;
  channels.frames = 401;
  channels.names = {"LKneeMoment", "LKneePower", "LElbowMoment", "LKneeAngles", "LKneeForce"};
  channels.kinds = {data::ChannelKind::moment, data::ChannelKind::power, data::ChannelKind::moment,
                    data::ChannelKind::angle, data::ChannelKind::force};
  channels.units = {"Nmm", "", "Nmm", "deg", "N"};
  for (int f = 0; f < 401; ++f)
    for (int c = 0; c < 5; ++c)
      for (int axis = 0; axis < 3; ++axis)
        channels.values.push_back(c == 1 && axis < 2 ? 0.0 : f + 1000 * axis);
  return trial;
}

TEST(SheetInputs, KineticsOfTheRecordingInItsUnits) {
  std::vector<SheetInput> out;
  add_kinetic_channels(with_channels(), testing::known_gait().cycles, out);
  EXPECT_THAT(names(out), ElementsAre("LKneeMoment x Left", "LKneeMoment y Left", "LKneeMoment z Left",
                                      "LKneePower z Left"));
  EXPECT_EQ(out[0].unit, "Nmm");
  EXPECT_EQ(out[3].unit, "unit of the file");
  EXPECT_THAT(out[0].unit, Not(HasSubstr("unit of the file")));
  EXPECT_NEAR(out[1].curves(1, 0), 1100.0, 1e-9);  // at 1 s
}

// One plate that bears 700 N all the time, about z; it saw the strike of the left at 1 s.
struct OnPlate {
  data::Wrenches plates;
  analysis::Gait gait = testing::known_gait();
  OnPlate() {
    plates.time = {.rate_hz = 100.0, .frames = 401};
    data::Wrench plate{.name = "plate 2"};
    for (int f = 0; f < 401; ++f) plate.force.insert(plate.force.end(), {10.0, 20.0, 700.0});
    plates.items = {plate};
    for (auto& event : gait.events)
      if (event.side == Side::left && std::abs(event.time_s - 1.0) < 1e-9)
        event.source = data::EventSource::plate, event.method = "plate 2";
  }
};

TEST(SheetInputs, TheGroundBearsAFootUntilItLeaves) {
  const OnPlate on;
  std::vector<SheetInput> out;
  add_ground_reaction(on.plates, Eigen::Vector3d::UnitZ(), on.gait, out);
  ASSERT_THAT(names(out), ElementsAre("vertical_ground_reaction Left"));
  const auto& curves = out[0].curves;
  EXPECT_EQ(curves.count(), 3);
  EXPECT_TRUE(std::isnan(curves(0, 30)));  // no plate saw the first
  EXPECT_NEAR(curves(1, 0), 700.0, 1e-9);
  EXPECT_NEAR(curves(1, 59), 700.0, 1e-9);
  EXPECT_EQ(curves(1, 61), 0.0);  // it left at 60 %
  EXPECT_TRUE(std::isnan(curves(2, 30)));
}

TEST(SheetInputs, UpIsWhatIsSaid) {
  const OnPlate on;
  std::vector<SheetInput> out;
  add_ground_reaction(on.plates, -Eigen::Vector3d::UnitY(), on.gait, out);
  EXPECT_NEAR(out[0].curves(1, 10), -20.0, 1e-9);
}

TEST(SheetInputs, WithoutAStrikeOnAPlateThereIsNoForce) {
  OnPlate on;
  for (auto& event : on.gait.events) event.source = data::EventSource::kinematics;
  std::vector<SheetInput> out;
  add_ground_reaction(on.plates, Eigen::Vector3d::UnitZ(), on.gait, out);
  EXPECT_TRUE(out.empty());
}

}  // namespace
}  // namespace kinemark::pipeline
