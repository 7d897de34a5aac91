// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/core/length_unit.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace kinemark {
namespace {

TEST(LengthUnit, WordsOfFilesAreKnownInAnyCase) {
  EXPECT_EQ(metres_per_unit("MM"), 1e-3);
  EXPECT_EQ(metres_per_unit("inches"), 0.0254);
  EXPECT_EQ(metres_per_unit("Millimetres"), 1e-3);
  EXPECT_EQ(metres_per_unit("meters"), 1.0);
  EXPECT_FALSE(metres_per_unit("deg"));
  EXPECT_FALSE(metres_per_unit("ms"));
}

std::vector<std::string> names_like(std::string_view word) {
  std::vector<std::string> names;
  for (const auto& unit : units_like(word)) names.push_back(unit.name);
  return names;
}

TEST(LengthUnit, AMisspeltWordIsLikeTheUnitThatItWasMeantToBe) {
  EXPECT_EQ(names_like("mete"), std::vector<std::string>{"meter"});
  EXPECT_EQ(names_like("milimeters"), std::vector<std::string>{"millimeter"});
  EXPECT_EQ(names_like("centi"), std::vector<std::string>{"centimeter"});
  EXPECT_EQ(names_like("inhces"), std::vector<std::string>{"inches"});
  EXPECT_EQ(names_like("furlong"), std::vector<std::string>{});
  EXPECT_EQ(names_like(""), std::vector<std::string>{});
  EXPECT_EQ(names_like("mn"), std::vector<std::string>{}) << "two letters are like anything";
}

TEST(LengthUnit, OfSeveralUnitsTheSizeOfABodyTells) {
  const std::vector<LengthUnitName> units{{"mm", 1e-3}, {"cm", 1e-2}, {"m", 1.0}};
  EXPECT_EQ(unit_of_body_size(units, 1.8).value().name, "m");
  EXPECT_EQ(unit_of_body_size(units, 15'000.0).value().name, "mm");
  EXPECT_FALSE(unit_of_body_size(units, 1'700.0)) << "1.7 m in mm, 17 m in cm";
  EXPECT_FALSE(unit_of_body_size(units, 1e-3)) << "nothing so small is a body";
  EXPECT_FALSE(unit_of_body_size(units_like("mete"), 1'700.0)) << "nor so large";
  EXPECT_FALSE(unit_of_body_size(units, std::numeric_limits<double>::quiet_NaN()));
}

}  // namespace
}  // namespace kinemark
