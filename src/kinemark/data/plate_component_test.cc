// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/plate_component.h"

#include <gtest/gtest.h>

namespace kinemark::data {
namespace {

TEST(PlateComponent, IsFoundInLabelsOfEveryProgram) {
  for (const char* label : {"Fx", "FX1", "F1X", "Force.Fx2", "Electric Potential.Fx", "fx12", "AMTI Fx 3"})
    EXPECT_EQ(plate_component(label), "fx") << label;
  EXPECT_EQ(plate_component("Moment.Mz1"), "mz");
  EXPECT_EQ(plate_component("MY"), "my");
}

TEST(PlateComponent, IsNothingWhereTheLabelNamesNone) {
  for (const char* label : {"", "12", "EMG1", "Px1", "Force", "Fz left foot", "max", "channel 3"})
    EXPECT_EQ(plate_component(label), "") << label;
}

}  // namespace
}  // namespace kinemark::data
