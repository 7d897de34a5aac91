// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/skin_slide.h"

#include <gtest/gtest.h>

namespace kinemark::skeleton {
namespace {

TEST(SkinSlide, IsNotToldOfFewFrames) {
  SegmentPoses none;
  RelativeMotion motion;
  EXPECT_FALSE(measure_skin_slide(none, none, motion, Matrix6::Identity(), Vector6::Zero()).known);
}

}  // namespace
}  // namespace kinemark::skeleton
