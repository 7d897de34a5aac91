// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/core/result.h"

#include <gtest/gtest.h>

#include "kinemark/core/check.h"

namespace kinemark {
namespace {

Result<int> half(int x) {
  if (x % 2 != 0) return fail(Code::bad_input, "value is odd");
  return x / 2;
}

TEST(Result, CarriesTheValueOrTheSentence) {
  EXPECT_EQ(half(8).value(), 4);
  EXPECT_EQ(half(3).error().message, "value is odd");
}

TEST(Result, FailAtPutsThePlaceInFrontAndKeepsTheCode) {
  const auto failed = half(3);
  const Result<int> higher = fail_at("trial.c3d", failed.error());
  EXPECT_EQ(higher.error().message, "trial.c3d: value is odd");
  EXPECT_EQ(higher.error().code, Code::bad_input);
}

TEST(Result, EveryCodeHasItsDocumentedExitStatus) {
  EXPECT_EQ(exit_status(Code::usage), 2);
  EXPECT_EQ(exit_status(Code::bad_input), 3);
  EXPECT_EQ(exit_status(Code::not_supported), 3);
  EXPECT_EQ(exit_status(Code::io), 4);
  EXPECT_EQ(exit_status(Code::device), 5);
  EXPECT_EQ(exit_status(Code::cancelled), 130);
}

TEST(Check, ThrowsInEveryBuildAndSaysWhere) {
  EXPECT_NO_THROW(check(true, "fine"));
  try {
    check(false, "frames must match");
    FAIL() << "check(false) returned";
  } catch (const ContractError& error) {
    EXPECT_NE(std::string(error.what()).find("frames must match"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("result_test.cc"), std::string::npos);
  }
}

}  // namespace
}  // namespace kinemark
