// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Tests of jobs on a simulated recording that lies in a folder of their own, made once for all tests.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "kinemark/pipeline/testing/test_files.h"
#include "support/scratch.h"

namespace kinemark::pipeline::testing {

/// Job is an IkJob or a TrackJob.
template <class Job>
class RecordedTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new testing_support::ScratchFolder;
    simulate_into(*scratch_ / "in");
  }
  static void TearDownTestSuite() {
    delete scratch_;
    scratch_ = nullptr;
  }
  static std::filesystem::path at(const std::string& name) { return *scratch_ / name; }
  static Job job(const std::string& output, const std::string& markers = "in/markers.c3d") {
    Job j;
    j.model = at("in/model.osim");
    j.markers = at(markers);
    j.output = at(output);
    return j;
  }

 private:
  static inline testing_support::ScratchFolder* scratch_ = nullptr;
};

}  // namespace kinemark::pipeline::testing
