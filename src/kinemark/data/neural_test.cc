// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/neural.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace kinemark::data {
namespace {

using ::testing::HasSubstr;

Neural session() {
  Neural out;
  out.units = {{.id = "1", .labels = {{"quality", "good"}}, .times_s = {0.1, 0.1, 0.4}}, {.id = "2"}};
  out.intervals = {{.name = "trials",
                    .rows = {{.start_s = 0.0, .stop_s = 1.0, .labels = {{"target", "left"}}},
                             {.start_s = 1.0, .stop_s = 1.0, .labels = {{"target", "right"}}}}}};
  out.fields = {{.name = "lfp",
                 .unit = "volts",
                 .channels = {"1", "2"},
                 .rate_hz = 1000.0,
                 .start_s = 0.0,
                 .bin_s = 0.5,
                 .bins = 1,
                 .low = {-1.0, kNaN},
                 .high = {1.0, kNaN}}};
  return out;
}

std::string fault_of(const Neural& neural) {
  const auto status = neural.validate();
  return status ? "" : status.error().message;
}

TEST(Neural, IsFoundByName) {
  const auto neural = session();
  EXPECT_EQ(fault_of(neural), "");
  ASSERT_NE(neural.find_unit("1"), nullptr);
  EXPECT_EQ(neural.find_unit("1")->times_s.size(), 3U);
  EXPECT_EQ(neural.find_unit("3"), nullptr);
  ASSERT_NE(neural.find_intervals("trials"), nullptr);
  EXPECT_EQ(neural.find_intervals("epochs"), nullptr);
}

TEST(Neural, SpikesAscend) {
  auto neural = session();
  neural.units[0].times_s = {0.2, 0.1};
  EXPECT_THAT(fault_of(neural), HasSubstr("unit 1: spike times must be numbers that ascend; 0.1 s comes"));
  neural.units[0].times_s = {kNaN};
  EXPECT_THAT(fault_of(neural), HasSubstr("unit 1"));
}

TEST(Neural, NamesAreUnique) {
  auto neural = session();
  neural.units[1].id = "1";
  EXPECT_EQ(fault_of(neural), "two units are called '1'");
  neural = session();
  neural.intervals.push_back({.name = "trials"});
  EXPECT_EQ(fault_of(neural), "two tables of intervals are called 'trials'");
}

TEST(Neural, IntervalsHaveAStopAndTheSameColumns) {
  auto neural = session();
  neural.intervals[0].rows[1].stop_s = 0.5;
  EXPECT_THAT(fault_of(neural), HasSubstr("one goes from 1 to 0.5 s"));
  neural.intervals[0].rows[1].stop_s = std::numeric_limits<double>::infinity();
  EXPECT_THAT(fault_of(neural), HasSubstr("one goes from 1 to inf s"));
  neural.intervals[0].rows[1].stop_s = kNaN;
  EXPECT_TRUE(neural.validate()) << "a trial that was broken off has no end";
  neural = session();
  neural.intervals[0].rows[1].labels[0].column = "side";
  EXPECT_THAT(fault_of(neural), HasSubstr("rows have different columns"));
}

TEST(Neural, EnvelopesHaveTheirShapes) {
  auto neural = session();
  neural.fields[0].bins = 2;
  EXPECT_THAT(fault_of(neural), HasSubstr("not 4 numbers"));
  neural = session();
  neural.fields[0].low[0] = 2.0;
  EXPECT_THAT(fault_of(neural), HasSubstr("above the largest"));
  neural = session();
  neural.fields[0].bin_s = 0.0;
  EXPECT_THAT(fault_of(neural), HasSubstr("has no clock"));
}

}  // namespace
}  // namespace kinemark::data
