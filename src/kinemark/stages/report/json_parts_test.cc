// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/internal/json_parts.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "kinemark/core/check.h"

namespace kinemark::report::internal {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Number, IsRoundedAndNeverMinusZero) {
  EXPECT_EQ(number(1.23456, 2), 1.23);
  EXPECT_EQ(number(-1.235, 1), -1.2);
  EXPECT_EQ(number(-0.0001, 2).dump(), "0.0");
  EXPECT_TRUE(number(kNaN, 2).is_null());
  EXPECT_TRUE(number(-kInfinity, 2).is_null());
}

TEST(Number, TooLargeToRoundIsKept) { EXPECT_EQ(number(1e306, 6), 1e306); }

TEST(Significant, KeepsDigitsOverAllDecades) {
  EXPECT_EQ(significant(123456.0, 3), 123000.0);
  EXPECT_EQ(significant(-0.00123456, 3), -0.00123);
  EXPECT_EQ(significant(0.0, 3), 0.0);
  EXPECT_TRUE(significant(kNaN, 3).is_null());
  for (int power = -290; power <= 290; power += 29) {
    const double value = 1.23456789 * std::pow(10.0, power);
    const double kept = significant(value, 5).get<double>();
    EXPECT_NEAR(kept / value, 1.0, 5e-5) << power;
  }
}

TEST(Significant, TheSmallestNumberIsNoTrouble) {
  EXPECT_EQ(significant(std::numeric_limits<double>::denorm_min(), 4),
            std::numeric_limits<double>::denorm_min());
}

TEST(Significant, RefusesNoDigits) { EXPECT_ANY_THROW((void)significant(1.0, 0)); }

TEST(Millimetres, ComeFromMetres) {
  EXPECT_EQ(millimetres(0.0123456789), 12.3457);
  EXPECT_TRUE(millimetres(kNaN).is_null());
}

TEST(FindingsJson, HoldsLevelPlaceAndWords) {
  const std::array<Notice, 2> findings{{{Verdict::attention, "gap", "R.Knee", "A sentence.", 1.5},
                                        {Verdict::good, "warning", "", "Another.", kNaN}}};
  const auto json = findings_json(findings);
  ASSERT_EQ(json.size(), 2U);
  EXPECT_EQ(json[0].dump(),
            R"({"level":"attention","about":"gap","subject":"R.Knee","text":"A sentence.","time_s":1.5})");
  EXPECT_EQ(json[1]["level"], "note");
  EXPECT_TRUE(json[1]["time_s"].is_null());
}

TEST(GatesAndInputsJson, HoldEveryField) {
  const std::array<Gate, 1> gates{{{"left_open", false, 12.5, 10.0, "%", "Too many gaps."}}};
  EXPECT_EQ(
      gates_json(gates)[0].dump(),
      R"({"name":"left_open","passed":false,"value":12.5,"bound":10.0,"unit":"%","sentence":"Too many gaps."})");
  const std::array<InputFile, 1> inputs{{{"markers", "a.c3d", 12, "00ff", "XXH3-64"}}};
  EXPECT_EQ(inputs_json(inputs)[0].dump(),
            R"({"role":"markers","path":"a.c3d","bytes":12,"hash":"00ff","hash_kind":"XXH3-64"})");
}

TEST(OptionsJson, IsAnObjectInTheOrderGiven) {
  const std::array<std::pair<std::string, std::string>, 2> options{{{"gaps", "auto"}, {"filter", "none"}}};
  EXPECT_EQ(options_json(options).dump(), R"({"gaps":"auto","filter":"none"})");
}

}  // namespace
}  // namespace kinemark::report::internal
