// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Tests of jobs on a simulated recording that lies in a folder of their own, made once for all tests.
#pragma once

#include <string>

#include "kinemark/pipeline/testing/shared_folder.h"
#include "kinemark/pipeline/testing/test_files.h"

namespace kinemark::pipeline::testing {

/// Job is an IkJob or a TrackJob.
template <class Job>
class RecordedTest : public SharedFolder<RecordedTest<Job>> {
 public:
  using SharedFolder<RecordedTest<Job>>::at;
  static void make_files() { simulate_into(at("in")); }

 protected:
  static Job job(const std::string& output, const std::string& markers = "in/markers.c3d") {
    Job j;
    j.model = at("in/model.osim");
    j.markers = at(markers);
    j.output = at(output);
    return j;
  }
};

}  // namespace kinemark::pipeline::testing
