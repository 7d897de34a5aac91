// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/length_unit.h"

#include <gtest/gtest.h>

namespace kinemark::io {
namespace {

TEST(LengthUnit, WordsOfFilesAreKnownInAnyCase) {
  EXPECT_EQ(metres_per_unit("MM"), 1e-3);
  EXPECT_EQ(metres_per_unit("inches"), 0.0254);
  EXPECT_EQ(metres_per_unit("Millimetres"), 1e-3);
  EXPECT_EQ(metres_per_unit("meters"), 1.0);
  EXPECT_FALSE(metres_per_unit("deg"));
  EXPECT_FALSE(metres_per_unit("ms"));
}

}  // namespace
}  // namespace kinemark::io
