// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Tests of jobs whose files are made once for all tests of a suite.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "support/scratch.h"

namespace kinemark::pipeline::testing {

/// `Suite` is the class that derives from this one; its static make_files() fills the folder, by at().
template <class Suite>
class SharedFolder : public ::testing::Test {
 public:
  static void SetUpTestSuite() {
    scratch_ = new testing_support::ScratchFolder;
    Suite::make_files();
  }
  static void TearDownTestSuite() {
    delete scratch_;
    scratch_ = nullptr;
  }
  static std::filesystem::path at(const std::string& name) { return *scratch_ / name; }

 private:
  SharedFolder() = default;
  friend Suite;
  static inline testing_support::ScratchFolder* scratch_ = nullptr;
};

}  // namespace kinemark::pipeline::testing
