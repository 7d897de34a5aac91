// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/geometry.h"

#include <gtest/gtest.h>

namespace kinemark::motion {
namespace {

TEST(Geometry, empty) { EXPECT_TRUE(default_scale_groups({}).empty()); }

}  // namespace
}  // namespace kinemark::motion
