// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/emg/channel_facts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/missing.h"
#include "kinemark/core/random.h"

namespace kinemark::analysis {
namespace {

using Eigen::VectorXd;
using ::testing::HasSubstr;
using ::testing::Not;

/// Noise of 50 uV with a burst of 500 uV in its middle third.
EmgChannel muscle(std::uint64_t seed) {
  Random random(seed, 0);
  EmgChannel out{.name = "LSOL", .volts = VectorXd(3000)};
  for (Eigen::Index s = 0; s < out.volts.size(); ++s)
    out.volts[s] = (s / 1000 == 1 ? 5e-4 : 5e-5) * random.gaussian();
  return out;
}

TEST(ChannelFacts, WhatWasRectifiedIsSaid) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    auto channel = muscle(seed);
    EXPECT_THAT(why_rectified(channel), Not(HasSubstr("holds no value below zero")));
    channel.volts = channel.volts.cwiseAbs();
    EXPECT_THAT(why_rectified(channel), HasSubstr("LSOL holds no value below zero: it was rectified"));
    channel.volts = -channel.volts;
    EXPECT_THAT(why_rectified(channel), HasSubstr("LSOL holds no value above zero"));
    channel.volts[7] = 1e-6;
    EXPECT_THAT(why_rectified(channel), Not(HasSubstr("holds no value above zero")));
  }
}

TEST(ChannelFacts, AnOffsetIsNoRectifier) {
  for (const double offset : {-2.5, 3e-3, 2.5}) {
    auto channel = muscle(3);
    channel.volts.array() += offset;
    EXPECT_EQ(why_rectified(channel), "") << offset;
  }
}

TEST(ChannelFacts, AnEnvelopeOfOneStrengthIsSmooth) {
  auto channel = muscle(5);
  channel.volts.segment(1000, 1000) *= 0.1;
  double level = 0.0;
  for (auto& v : channel.volts) v = level += 0.02 * (std::abs(v) - level);
  EXPECT_THAT(why_rectified(channel), HasSubstr("LSOL holds no value below zero"));
  channel.volts.array() += 1e-3;
  EXPECT_EQ(why_rectified(channel), "") << "it does not come near zero";
}

TEST(ChannelFacts, OneValueOrFewSamplesTellNothing) {
  EXPECT_EQ(why_rectified({.name = "flat", .volts = VectorXd::Constant(500, 1.0)}), "");
  EXPECT_EQ(why_rectified({.name = "zero", .volts = VectorXd::Zero(500)}), "");
  EXPECT_EQ(why_rectified({.name = "short", .volts = muscle(1).volts.head(99).cwiseAbs()}), "");
  EXPECT_EQ(why_rectified({.name = "missing", .volts = VectorXd::Constant(500, kNaN)}), "");
}

TEST(ChannelFacts, AMeanAboveTheMaximumIsSaid) {
  VectorXd envelope = VectorXd::Constant(100, 0.6);
  envelope.head(20).setConstant(2.0);
  EXPECT_EQ(why_above_maximum("LSOL", envelope), "") << "a peak may be above it";
  EXPECT_THAT(why_above_maximum("LSOL", envelope), Not(HasSubstr("the mean of the whole recording is")));
  envelope *= 2.0;
  EXPECT_THAT(why_above_maximum("LSOL", envelope),
              HasSubstr("LSOL: the mean of the whole recording is 176 % of the maximum"));
  EXPECT_EQ(why_above_maximum("LSOL", VectorXd::Constant(5, kNaN)), "");
}

}  // namespace
}  // namespace kinemark::analysis
