// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/c3d/point_types.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/io/c3d/internal/simulated_trial.h"
#include "kinemark/io/c3d/reader.h"
#include "kinemark/io/c3d/writer.h"
#include "support/scratch.h"
#include "support/test_data.h"

namespace kinemark::io {
namespace {

using data::ChannelKind;
using data::Trial;
using testing::ElementsAre;
using testing::IsEmpty;
using testing_support::ScratchFolder;

C3dParameter texts(std::string name, std::vector<int> dims, std::vector<std::string> values) {
  return {
      .name = std::move(name), .type = C3dType::text, .dims = std::move(dims), .texts = std::move(values)};
}

struct Sorted {
  Trial trial;
  C3dLayout layout;
};

Sorted sort_labels(std::vector<std::string> labels, std::vector<C3dParameter> lists) {
  C3dParameters parameters;
  parameters.group("POINT").parameters = std::move(lists);
  Sorted out;
  out.layout.points = std::ssize(labels);
  out.layout.rate_hz = 100.0;
  out.trial.markers.names = std::move(labels);
  sort_points(parameters, out.layout, out.trial);
  return out;
}

TEST(C3dPointTypes, WithoutListsAllPointsAreMarkersInOneRun) {
  const Sorted s = sort_labels({"LASI", "RASI", "*1"}, {});
  EXPECT_THAT(s.trial.markers.names, ElementsAre("LASI", "RASI", "*1"));
  EXPECT_THAT(s.trial.channels.names, IsEmpty());
  ASSERT_EQ(s.layout.runs.size(), 1U);
  EXPECT_EQ(s.layout.runs[0].count, 3);
  EXPECT_EQ(s.layout.markers, 3);
}

TEST(C3dPointTypes, ListedPointsBecomeChannelsWithTheUnitOfTheirKind) {
  const Sorted s = sort_labels({"Angle", "LASI", "RASI", "Power", "Centre", "LKNE"},
                               {texts("ANGLES", {5, 1}, {"Angle"}), texts("ANGLE_UNITS", {3}, {"deg"}),
                                texts("POWERS", {5, 1}, {"Power"}),
                                texts("MODELED_MARKERS", {6, 1}, {"Centre"}), texts("UNITS", {2}, {"mm"})});
  EXPECT_THAT(s.trial.markers.names, ElementsAre("LASI", "RASI", "LKNE"));
  EXPECT_THAT(s.trial.channels.names, ElementsAre("Angle", "Power", "Centre"));
  EXPECT_THAT(s.trial.channels.kinds,
              ElementsAre(ChannelKind::angle, ChannelKind::power, ChannelKind::modeled_marker));
  EXPECT_THAT(s.trial.channels.units, ElementsAre("deg", "", "mm"));
  EXPECT_THAT(s.layout.channel_points, ElementsAre(0, 3, 4));
  ASSERT_EQ(s.layout.runs.size(), 2U);
  EXPECT_EQ(s.layout.runs[0].first, 1);
  EXPECT_EQ(s.layout.runs[0].count, 2);
  EXPECT_EQ(s.layout.runs[1].first, 5);
}

TEST(C3dPointTypes, ListsGoOnInNumberedParametersAndSubjectsMayBeLeftOut) {
  const Sorted s = sort_labels({"Anna:A1", "A2", "Anna:LASI"},
                               {texts("ANGLES", {2, 1}, {"A1"}), texts("ANGLES2", {2, 1}, {"A2"})});
  EXPECT_THAT(s.trial.channels.names, ElementsAre("Anna:A1", "A2"));
  EXPECT_THAT(s.trial.markers.names, ElementsAre("Anna:LASI"));
}

TEST(C3dPointTypes, TypeGroupsMayNameListsOfTheirOwn) {
  const Sorted s =
      sort_labels({"LASI", "Depth"}, {texts("DEPTHS", {5, 1}, {"Depth"}), texts("DEPTH_UNITS", {2}, {"cm"}),
                                      texts("TYPE_GROUPS", {6, 2, 1}, {"DEPTHS", "DEPTH"})});
  EXPECT_THAT(s.trial.channels.kinds, ElementsAre(ChannelKind::other));
  EXPECT_THAT(s.trial.channels.units, ElementsAre("cm"));
}

TEST(C3dPointTypes, TypeGroupsThatNameTheLabelsThemselvesLeaveMarkersAlone) {
  const Sorted s = sort_labels(
      {"LASI"}, {texts("LABELS", {4, 1}, {"LASI"}), texts("TYPE_GROUPS", {6, 2, 1}, {"LABELS", "LABEL"})});
  EXPECT_THAT(s.trial.markers.names, ElementsAre("LASI"));
}

Trial with_channels() {
  Trial trial = internal::simulate_trial({.markers = 4, .frames = 9, .channels = 2});
  auto& c = trial.channels;
  c.names = {"Knee", "Push", "Centre"};
  c.kinds = {ChannelKind::angle, ChannelKind::force, ChannelKind::modeled_marker};
  c.units = {"deg", "N", "mm"};
  c.rate_hz = trial.markers.time.rate_hz;
  c.frames = 9;
  for (int i = 0; i < 81; ++i) c.values.push_back(static_cast<float>(std::sin(i)) * 37.0F);
  for (int axis = 0; axis < 3; ++axis) {
    c.values[static_cast<std::size_t>(axis)] = 0.0;      // an angle may be 0
    c.values[static_cast<std::size_t>(3 + axis)] = NAN;  // missing
  }
  return trial;
}

Trial copy_through_file(const Trial& trial, const C3dWriteOptions& options) {
  const ScratchFolder scratch;
  const auto written = write_c3d(scratch / "t.c3d", trial, options);
  EXPECT_TRUE(written) << written.error().message;
  return read_c3d(scratch / "t.c3d").value();
}

TEST(C3dPointTypes, WhatIsWrittenIsReadBackToTheBit) {
  const Trial trial = with_channels();
  for (const Processor processor : {Processor::intel, Processor::mips, Processor::dec}) {
    const Trial back = copy_through_file(trial, {.processor = processor});
    EXPECT_TRUE(back.validate());
    EXPECT_EQ(back.markers.names, trial.markers.names);
    EXPECT_EQ(back.markers.state, trial.markers.state);
    EXPECT_EQ(back.channels.names, trial.channels.names);
    EXPECT_EQ(back.channels.kinds, trial.channels.kinds);
    EXPECT_EQ(back.channels.units, trial.channels.units);
    ASSERT_EQ(back.channels.values.size(), trial.channels.values.size());
    for (std::size_t i = 0; i < back.channels.values.size(); ++i) {
      if (std::isnan(trial.channels.values[i])) {
        EXPECT_TRUE(std::isnan(back.channels.values[i])) << i;
      } else {
        EXPECT_EQ(back.channels.values[i], trial.channels.values[i]) << i;
      }
    }
  }
}

TEST(C3dPointTypes, IntegersHoldChannelsToOneStep) {
  const Trial trial = with_channels();
  const Trial back = copy_through_file(trial, {.integers = true});
  ASSERT_EQ(back.channels.values.size(), trial.channels.values.size());
  for (std::size_t i = 6; i < back.channels.values.size(); ++i)
    EXPECT_NEAR(back.channels.values[i], trial.channels.values[i], 0.1) << i;
}

TEST(C3dPointTypes, LengthsFollowTheUnitOfTheFileAnglesDoNot) {
  const Trial trial = with_channels();
  const Trial back = copy_through_file(trial, {.units = "m"});
  EXPECT_THAT(back.channels.units, ElementsAre("deg", "N", "m"));
  EXPECT_EQ(back.channels.values[9], trial.channels.values[9]);
  EXPECT_NEAR(back.channels.values[6], 1e-3 * trial.channels.values[6], 1e-8);
}

TEST(C3dPointTypes, PlugInGaitOutputsAreTypedAsTheirGroupsSay) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  struct Expected {
    const char* file;
    std::int64_t markers, angles, forces, moments, powers;
  };
  for (const Expected& expected : {Expected{"btk-others/PiG_Motion3_FF.c3d", 61, 12, 10, 8, 6},
                                   Expected{"btk-others/PiG_Calibration3_FF.c3d", 54, 12, 0, 0, 0},
                                   Expected{"btk-others/FunctionalWalk.c3d", 110, 12, 10, 8, 6},
                                   Expected{"pycgm-rom/Sample_Static.c3d", 115, 26, 0, 0, 0},
                                   Expected{"c3d-org/sample01/Eb015pr.c3d", 26, 0, 0, 0, 0}}) {
    SCOPED_TRACE(expected.file);
    const Trial trial = read_c3d(data / expected.file).value();
    const auto count = [&](ChannelKind kind) { return std::ranges::count(trial.channels.kinds, kind); };
    EXPECT_TRUE(trial.validate());
    EXPECT_EQ(trial.markers.markers(), expected.markers);
    EXPECT_EQ(count(ChannelKind::angle), expected.angles);
    EXPECT_EQ(count(ChannelKind::force), expected.forces);
    EXPECT_EQ(count(ChannelKind::moment), expected.moments);
    EXPECT_EQ(count(ChannelKind::power), expected.powers);
    for (std::size_t c = 0; c < trial.channels.kinds.size(); ++c)
      if (trial.channels.kinds[c] == ChannelKind::angle) {
        EXPECT_EQ(trial.channels.units[c], "deg");
      }
  }
}

}  // namespace
}  // namespace kinemark::io
