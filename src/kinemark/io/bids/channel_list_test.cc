// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/bids/channel_list.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace kinemark::io {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

data::Trial small_trial(double start_s) {
  data::Trial trial;
  trial.markers =
      data::Trajectories::all_missing({"A", "A_x"}, {.rate_hz = 100.0, .t0_s = start_s, .frames = 1});
  trial.channels = {.names = {"Knee", "Work"},
                    .kinds = {data::ChannelKind::angle, data::ChannelKind::power},
                    .units = {"deg", ""},
                    .rate_hz = 100.0,
                    .frames = 1,
                    .values = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0}};
  return trial;
}

TEST(ChannelList, AColumnForEachCoordinateAndOneOfTimeWhereItDoesNotBeginAtZero) {
  const auto columns = columns_of(small_trial(0.0));
  ASSERT_THAT(columns, SizeIs(12));
  EXPECT_EQ(columns[4].name, "A_x_y");
  EXPECT_EQ(columns[4].component, "y");
  EXPECT_EQ(columns[4].point, "A_x");
  EXPECT_EQ(columns[6].type, "JNTANG");
  EXPECT_EQ(columns[9].type, "MISC");
  EXPECT_EQ(columns[9].units, "n/a");
  const auto later = columns_of(small_trial(1.5));
  ASSERT_THAT(later, SizeIs(13));
  EXPECT_EQ(later.back().type, "LATENCY");
  EXPECT_EQ(later.back().units, "s");
}

TEST(ChannelList, NoTwoColumnsShareAName) {
  data::Trial trial = small_trial(0.0);
  trial.channels.names = {"A", "latency"};
  std::set<std::string> names;
  for (const auto& column : columns_of(trial)) EXPECT_TRUE(names.insert(column.name).second) << column.name;
}

TEST(ChannelList, WhatIsWrittenReadsBack) {
  const auto columns = columns_of(small_trial(1.5));
  const auto back = parse_columns(format_columns(columns));
  ASSERT_TRUE(back) << back.error().message;
  ASSERT_EQ(back->size(), columns.size());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    EXPECT_EQ((*back)[i].name, columns[i].name);
    EXPECT_EQ((*back)[i].component, columns[i].component);
    EXPECT_EQ((*back)[i].type, columns[i].type);
    EXPECT_EQ((*back)[i].point, columns[i].point);
    EXPECT_EQ((*back)[i].units, columns[i].units);
    EXPECT_EQ((*back)[i].description, columns[i].description);
  }
}

TEST(ChannelList, BlankLinesAndAByteOrderMarkArePassedOver) {
  const auto columns =
      parse_columns("\xEF\xBB\xBFunits\ttype\ttracked_point\tcomponent\tname\r\n\r\nm\tPOS\tA\tx\tA_x\r\n\n");
  ASSERT_TRUE(columns) << columns.error().message;
  ASSERT_THAT(*columns, SizeIs(1));
  EXPECT_EQ(columns->front().name, "A_x");
  EXPECT_EQ(columns->front().units, "m");
  EXPECT_EQ(columns->front().description, "");
}

TEST(ChannelList, AColumnThatIsMissingIsNamed) {
  for (const char* missing : {"name", "component", "type", "tracked_point", "units"}) {
    std::string head;
    for (const char* name : {"name", "component", "type", "tracked_point", "units"})
      if (std::string(name) != missing) head += (head.empty() ? "" : "\t") + std::string(name);
    const auto refused = parse_columns(head + "\n");
    ASSERT_FALSE(refused) << missing;
    EXPECT_THAT(refused.error().message, HasSubstr("line 1: no column " + std::string(missing)));
  }
  EXPECT_FALSE(parse_columns(""));
}

}  // namespace
}  // namespace kinemark::io
