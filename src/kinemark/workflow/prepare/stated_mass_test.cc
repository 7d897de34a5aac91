// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/prepare/stated_mass.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <string>

namespace kinemark::workflow {
namespace {

data::Trial stating(const std::string& group, const std::string& name, float value) {
  data::ForeignParameter parameter{.name = name, .type = 4, .dims = {}, .values = {}, .description = {}};
  const auto bits = std::bit_cast<std::uint32_t>(value);
  for (int k = 0; k < 4; ++k) parameter.values.push_back(static_cast<std::byte>(bits >> (8 * k)));
  data::Trial out;
  out.foreign.push_back({.name = group, .description = {}, .parameters = {parameter}});
  return out;
}

TEST(StatedMass, IsThatOfTheBody) {
  EXPECT_EQ(stated_mass_kg(stating("PROCESSING", "Bodymass", 81.5F)), 81.5);
  EXPECT_EQ(stated_mass_kg(stating("SUBJECT", "WEIGHT", 60.0F)), 60.0);
  EXPECT_EQ(stated_mass_kg(stating("Subjects", "Mass", 60.0F)), 60.0);
}

TEST(StatedMass, AbsurdOnesAndThoseOfOtherThingsAreNone) {
  EXPECT_TRUE(std::isnan(stated_mass_kg({})));
  EXPECT_TRUE(std::isnan(stated_mass_kg(stating("PROCESSING", "BODYMASS", 0.0F))));
  EXPECT_TRUE(std::isnan(stated_mass_kg(stating("PROCESSING", "BODYMASS", 81500.0F))));
  EXPECT_TRUE(std::isnan(stated_mass_kg(stating("EXPERIMENT", "WEIGHT", 60.0F))));
  EXPECT_TRUE(std::isnan(stated_mass_kg(stating("PROCESSING", "HEIGHT", 60.0F))));
}

}  // namespace
}  // namespace kinemark::workflow
