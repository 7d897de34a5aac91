// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/segments/segment_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace kinemark::pipeline {
namespace {

using analysis::SegmentSeries;
using analysis::SubjectQuantity;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using State = data::SampleState;

constexpr double kDegree = std::numbers::pi / 180.0;

analysis::SegmentMotion two_frames() {
  analysis::SegmentMotion out{.time = {.rate_hz = 100.0, .frames = 2}};
  out.angles.push_back({.name = "Knee",
                        .labels = {"flexion", "varus", "rotation"},
                        .value = {10 * kDegree, 0.0, 1 * kDegree, kNaN, kNaN, kNaN},
                        .sd = {1 * kDegree, 2 * kDegree, 3 * kDegree, kNaN, kNaN, kNaN},
                        .state = {State::measured, State::missing}});
  out.values.push_back({.name = "length",
                        .labels = {},
                        .quantity = SubjectQuantity::length,
                        .value = {0.4, 0.41},
                        .sd = {0.001, 0.002},
                        .state = {State::measured, State::interpolated}});
  out.points = data::Trajectories::all_missing({"KJC"}, out.time);
  out.points.x(0, 0) = Eigen::Vector3d(1.0, 2.0, 3.0);
  out.points.state[0] = State::model_filled;
  return out;
}

analysis::JointLoads knee_loads() {
  analysis::JointLoads out;
  const auto add = [&](const std::string& name, std::vector<std::string> labels, const std::string& unit) {
    SegmentSeries one{
        .name = name, .labels = std::move(labels), .quantity = SubjectQuantity::number, .unit = unit};
    for (std::size_t i = 0; i < 2 * one.size(); ++i) one.value.push_back(0.5 + static_cast<double>(i));
    one.sd.assign(2 * one.size(), 0.25);
    one.state.assign(2, State::measured);
    out.series.push_back(std::move(one));
  };
  add("KneeForce", {"anterior", "left", "tension"}, "N/kg");
  add("KneeMoment", {"extension", "valgus", "external_rotation"}, "N m/kg");
  add("KneePower", {}, "W/kg");
  return out;
}

TEST(SegmentTables, ColumnsAreInDegreesMetresAndTheSeriesUnit) {
  const auto motion = two_frames();
  const auto table = series_table(series_of(motion), motion.time, "angles");
  EXPECT_THAT(table.columns, ElementsAre("Knee_flexion", "Knee_varus", "Knee_rotation", "length"));
  EXPECT_NEAR(table.values[0], 10.0, 1e-12);
  EXPECT_EQ(table.values[3], 0.4);
  EXPECT_TRUE(std::isnan(table.values[4]));
  const auto sd = deviations_table(series_of(motion), motion.time, "angles_sd");
  EXPECT_NEAR(sd.values[1], 2.0, 1e-12);
  EXPECT_EQ(sd.columns, table.columns);
  const auto loads = knee_loads();
  const auto moments = series_table(series_of(loads), motion.time, "loads");
  EXPECT_EQ(moments.columns.back(), "KneePower");
  EXPECT_EQ(moments.values[3], 0.5);
}

TEST(SegmentTables, LongFormSaysUnitAndState) {
  const auto motion = two_frames();
  const auto text = series_csv(series_of(motion), motion.time);
  EXPECT_THAT(text,
              HasSubstr("time_s,name,component,value,sd,unit,state\n0,Knee,flexion,10,1,deg,measured\n"));
  EXPECT_THAT(text, HasSubstr("0.01,Knee,flexion,,,deg,missing\n"));
  EXPECT_THAT(text, HasSubstr("0.01,length,,0.41,0.002,m,interpolated\n"));
  const auto loads = knee_loads();
  const auto moments = series_csv(series_of(loads), motion.time);
  EXPECT_THAT(moments, HasSubstr("0,KneeMoment,extension,0.5,0.25,N m/kg,measured\n"));
  EXPECT_THAT(moments, HasSubstr("0.01,KneePower,,1.5,0.25,W/kg,measured\n"));
}

TEST(SegmentTables, RecordingGetsAnglesLoadsAndPoints) {
  const auto motion = two_frames();
  data::Trial recording;
  recording.markers = data::Trajectories::all_missing({"LKNE", "KJC"}, motion.time);
  recording.channels = {.names = {"old", "KneePower"},
                        .kinds = {data::ChannelKind::scalar, data::ChannelKind::power},
                        .units = {"V", "W"},
                        .rate_hz = 100.0,
                        .frames = 2,
                        .values = {}};
  recording.channels.values.assign(12, 7.0);
  const auto whole = trial_with(motion, knee_loads(), recording);
  EXPECT_THAT(whole.channels.names,
              ElementsAre("old", "Knee", "length", "KneeForce", "KneeMoment", "KneePower"));
  using Kind = data::ChannelKind;
  EXPECT_THAT(whole.channels.kinds,
              ElementsAre(Kind::scalar, Kind::angle, Kind::scalar, Kind::force, Kind::moment, Kind::power));
  EXPECT_THAT(whole.channels.units, ElementsAre("V", "deg", "m", "N/kg", "N m/kg", "W/kg"));
  EXPECT_TRUE(whole.channels.validate());
  EXPECT_THAT(whole.markers.names, ElementsAre("LKNE", "KJC"));
  EXPECT_EQ(whole.markers.x(0, 1).y(), 2.0);
  EXPECT_TRUE(std::isnan(whole.channels.values[3 * 6 + 3]));  // an angle of frame 1
}

TEST(SegmentTables, SeriesAreCountedByState) {
  const auto motion = two_frames();
  const auto list = series_json(series_of(motion));
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[0]["measured"].get<int>(), 1);
  EXPECT_EQ(list[0]["missing"].get<int>(), 1);
  EXPECT_NEAR(list[0]["sd"][2].get<double>(), 3.0, 1e-12);
  EXPECT_EQ(list[1]["unit"].get<std::string>(), "m");
  EXPECT_EQ(list[1]["interpolated"].get<int>(), 1);
  const auto loads = knee_loads();
  EXPECT_EQ(series_json(series_of(loads))[1]["unit"].get<std::string>(), "N m/kg");
  EXPECT_THAT(series_json({}), IsEmpty());
}

}  // namespace
}  // namespace kinemark::pipeline
