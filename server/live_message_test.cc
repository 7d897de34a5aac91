// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/live_message.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "kinemark/core/check.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/units.h"
#include "kinemark/pipeline/simulate/human_model.h"

namespace kinemark::server {
namespace {

/// A value of a message, on a machine with the little end first.
template <class T>
T at(const std::string& message, std::size_t offset) {
  T value{};
  std::memcpy(&value, message.data() + offset, sizeof(T));
  return value;
}

TEST(LiveMessage, AFrameOfMarkersByteByByte) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> x{1.5, -2.0, 0.25, nan, nan, nan};
  const std::vector<data::SampleState> state{data::SampleState::measured, data::SampleState::rejected};
  const auto message = markers_message(7, 0.5, 12.25, x, state);
  ASSERT_EQ(message.size(), kLiveHeadBytes + 6 * 4 + 2);
  EXPECT_EQ(message[0], 1);
  EXPECT_EQ(message[1], 1);
  EXPECT_EQ(at<std::uint16_t>(message, 2), 2);
  EXPECT_EQ(at<std::uint32_t>(message, 4), 0U);
  EXPECT_EQ(at<double>(message, 8), 7.0);
  EXPECT_EQ(at<double>(message, 16), 0.5);
  EXPECT_EQ(at<double>(message, 24), 12.25);
  EXPECT_TRUE(std::isnan(at<float>(message, 32)));
  EXPECT_EQ(at<float>(message, 40), 1.5F);
  EXPECT_EQ(at<float>(message, 44), -2.0F);
  EXPECT_TRUE(std::isnan(at<float>(message, 52)));
  EXPECT_EQ(message[64], 1);
  EXPECT_EQ(message[65], 5);
}

motion::LivePose two_coordinates() {
  motion::LivePose pose{.frame = 3, .time_s = 0.1, .determined = {1, 0}};
  pose.q = Eigen::Vector2d(0.25, 0.02);
  pose.q_sd = Eigen::Vector2d(0.5, kNaN);
  return pose;
}

TEST(LiveMessage, AFrameOfAnglesByteByByte) {
  const auto message = angles_message(two_coordinates(), std::vector{8.0, 1000.0}, 4.0);
  ASSERT_EQ(message.size(), kLiveHeadBytes + 2 * 9);
  EXPECT_EQ(message[0], 2);
  EXPECT_EQ(at<double>(message, 8), 3.0);
  EXPECT_EQ(at<double>(message, 16), 0.1);
  EXPECT_EQ(at<double>(message, 24), 4.0);
  EXPECT_EQ(at<float>(message, 40), 2.0F);
  EXPECT_EQ(at<float>(message, 44), 20.0F);
  EXPECT_EQ(at<float>(message, 48), 4.0F);
  EXPECT_TRUE(std::isnan(at<float>(message, 52)));
  EXPECT_EQ(message[56], 1);
  EXPECT_EQ(message[57], 0);
  EXPECT_THROW((void)angles_message(two_coordinates(), std::vector{8.0}, 4.0), ContractError);
}

TEST(LiveMessage, AnglesAreInDegreesAndTranslationsInMillimetres) {
  const auto model = model::Model::compile(pipeline::human_model().value()).value();
  const auto units = message_units(model);
  const auto& coordinates = model.description().coordinates;
  ASSERT_EQ(units.size(), coordinates.size());
  std::size_t rotations = 0;
  for (std::size_t c = 0; c < units.size(); ++c) {
    EXPECT_EQ(units[c], coordinates[c].is_rotation ? kDegPerRad : 1000.0) << coordinates[c].name;
    rotations += coordinates[c].is_rotation;
  }
  EXPECT_EQ(rotations, units.size() - 3) << "the root moves in three directions";
}

TEST(LiveMessage, ASentenceIsCutWhereItsCountEnds) {
  const auto message = sentence_message("the disk is full", 1.0);
  EXPECT_EQ(message[0], 3);
  EXPECT_EQ(message.substr(kLiveHeadBytes), "the disk is full");
  EXPECT_EQ(sentence_message(std::string(70'000, 'x'), 1.0).size(), kLiveHeadBytes + 65'535);
}

TEST(LiveMessage, WhatDiffersBetweenViewersIsSetAlone) {
  auto message = sentence_message("x", 1.0);
  const auto before = message;
  set_viewer_fields(message, 0x01020304, 0.25F);
  EXPECT_EQ(at<std::uint32_t>(message, 4), 0x01020304U);
  EXPECT_EQ(at<float>(message, 32), 0.25F);
  message.replace(4, 4, before, 4, 4);
  message.replace(32, 4, before, 32, 4);
  EXPECT_EQ(message, before);
}

TEST(LiveMessage, ACountIsAWholeNumberOfEightBytes) {
  const auto bytes = [](double value) {
    std::string text(8, '\0');
    std::memcpy(text.data(), &value, 8);
    return text;
  };
  EXPECT_EQ(drawn_count(bytes(0.0)), 0U);
  EXPECT_EQ(drawn_count(bytes(12'345.0)), 12'345U);
  for (const double wrong : {-1.0, 0.5, 1e300, HUGE_VAL, std::nan("")})
    EXPECT_FALSE(drawn_count(bytes(wrong))) << wrong;
  EXPECT_FALSE(drawn_count(""));
  EXPECT_FALSE(drawn_count(bytes(1.0) + "x"));
}

}  // namespace
}  // namespace kinemark::server
