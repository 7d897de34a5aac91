// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/desk/desk_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/core/version.h"

namespace kinemark::pipeline {
namespace {

using testing::HasSubstr;

TEST(DeskPage, HoldsWhatWasGiven) {
  const auto page = desk_page("serial:/dev/ttyACM0", "day/one");
  EXPECT_THAT(page, HasSubstr(R"("kinemark.desk")"));
  EXPECT_THAT(page, HasSubstr(R"("serial:/dev/ttyACM0")"));
  EXPECT_THAT(page, HasSubstr(R"("day/one")"));
  EXPECT_THAT(page, HasSubstr(std::string(kVersion)));
}

}  // namespace
}  // namespace kinemark::pipeline
