// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/upsampling.h"

#include <gtest/gtest.h>

#include <set>

namespace kinemark::data {
namespace {

TEST(Upsampling, EveryKernelAndVerdictHasANameOfItsOwn) {
  std::set<std::string_view> names;
  for (int k = 0; k <= static_cast<int>(InterpolationKernel::akima); ++k)
    names.insert(to_string(static_cast<InterpolationKernel>(k)));
  EXPECT_EQ(names.size(), 8U);
  EXPECT_EQ(to_string(InterpolationKernel::spline), "cubic spline");
  names.clear();
  for (int v = 0; v <= static_cast<int>(BandVerdict::undecided); ++v)
    names.insert(to_string(static_cast<BandVerdict>(v)));
  EXPECT_EQ(names.size(), 4U);
}

TEST(Upsampling, APhaseHoldsFromItsRunToTheNext) {
  Upsampling stream{.factor = 4, .phase = 1};
  stream.runs = {{.first_frame = 0, .phase = 1}, {.first_frame = 100, .phase = 3}};
  EXPECT_EQ(stream.phase_at(99), 1);
  EXPECT_EQ(stream.phase_at(100), 3);
  EXPECT_TRUE(stream.real(97));
  EXPECT_FALSE(stream.real(101));
  EXPECT_TRUE(stream.real(103));
  EXPECT_TRUE(Upsampling{}.real(17)) << "nothing found: all samples are real";
}

TEST(UpsamplingAccount, ItsFactorIsTheLargestOfAll) {
  UpsamplingAccount account;
  EXPECT_EQ(account.factor(), 1);
  account.markers = {{.factor = 2}, {.factor = 6}, {}};
  EXPECT_EQ(account.factor(), 6);
  account.recording.factor = 8;
  EXPECT_EQ(account.factor(), 8);
}

}  // namespace
}  // namespace kinemark::data
