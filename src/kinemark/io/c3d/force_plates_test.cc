// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/c3d/force_plates.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace kinemark::io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// FORCE_PLATFORM of `plates` plates of `type`, `rows` channels each.
C3dParameters plates_of(int plates, int type, int rows) {
  C3dParameters out;
  auto& group = out.group("FORCE_PLATFORM");
  const auto add = [&](const char* name, C3dType stored, std::vector<int> dims, std::vector<double> numbers) {
    group.parameters.push_back(
        {.name = name, .type = stored, .dims = std::move(dims), .numbers = std::move(numbers)});
  };
  std::vector<double> channels, corners;
  for (int i = 0; i < rows * plates; ++i) channels.push_back(i + 1);
  for (int i = 0; i < plates; ++i)
    for (const double v : {400, 600, 0, 0, 600, 0, 0, 0, 0, 400, 0, 0}) corners.push_back(v);
  add("USED", C3dType::int16, {}, {static_cast<double>(plates)});
  add("TYPE", C3dType::int16, {plates}, std::vector<double>(static_cast<std::size_t>(plates), type));
  add("CHANNEL", C3dType::int16, {rows, plates}, channels);
  add("CORNERS", C3dType::float32, {3, 4, plates}, corners);
  add("ORIGIN", C3dType::float32, {3, plates}, std::vector<double>(static_cast<std::size_t>(3 * plates), -1));
  return out;
}

std::vector<data::ForcePlate> found(const C3dParameters& parameters, std::vector<std::string>& warnings) {
  return find_force_plates(parameters, {.analog_channels = 48}, warnings);
}

TEST(C3dForcePlates, PolynomialsBelongToTheirPlates) {
  auto parameters = plates_of(3, 3, 8);
  std::vector<double> numbers(24, 0.0);
  for (std::size_t i = 0; i < 12; ++i) numbers[12 + i] = 0.5 - static_cast<double>(i);
  parameters.group("FORCE_PLATFORM")
      .parameters.push_back(
          {.name = "FPCOPPOLY", .type = C3dType::float32, .dims = {6, 2, 2}, .numbers = numbers});
  std::vector<std::string> warnings;
  const auto plates = found(parameters, warnings);
  ASSERT_EQ(plates.size(), 3U);
  EXPECT_THAT(warnings, IsEmpty());
  EXPECT_THAT(plates[0].pressure_correction, IsEmpty()) << "zeros";
  // The file has x before y, a plate both of each power.
  EXPECT_THAT(plates[1].pressure_correction,
              ElementsAre(0.5, -5.5, -0.5, -6.5, -1.5, -7.5, -2.5, -8.5, -3.5, -9.5, -4.5, -10.5));
  EXPECT_THAT(plates[2].pressure_correction, IsEmpty()) << "absent";
}

TEST(C3dForcePlates, PolynomialsThatAreNoneAreSaidAndNotApplied) {
  const auto said = [](std::vector<int> dims, const std::vector<double>& numbers) {
    auto parameters = plates_of(1, 3, 8);
    parameters.group("FORCE_PLATFORM")
        .parameters.push_back(
            {.name = "FPCOPPOLY", .type = C3dType::float32, .dims = std::move(dims), .numbers = numbers});
    std::vector<std::string> warnings;
    EXPECT_THAT(found(parameters, warnings).at(0).pressure_correction, IsEmpty());
    return warnings;
  };
  std::vector<double> numbers(12, 0.25);
  const auto malformed = ElementsAre(
      HasSubstr("force plate 1: what corrects its centre of pressure (FPCOPPOLY) is not 6 x 2 finite"));
  EXPECT_THAT(said({2, 6}, numbers), malformed);
  EXPECT_THAT(said({12}, numbers), malformed);
  EXPECT_THAT(said({5, 2}, std::vector<double>(10, 0.25)), malformed);
  EXPECT_THAT(said({2, 6}, std::vector<double>(12, 0.0)), IsEmpty()) << "it would correct nothing";
  numbers[5] = std::numeric_limits<double>::infinity();
  EXPECT_THAT(said({6, 2}, numbers), malformed);
}

}  // namespace
}  // namespace kinemark::io
