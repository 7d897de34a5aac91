// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/markers/csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

data::Trial small() {
  data::Trial trial;
  trial.first_frame = 7;
  trial.markers = data::Trajectories::all_missing({"A", "B"}, {.rate_hz = 4.0, .t0_s = 1.0, .frames = 2});
  trial.markers.x(0, 0) = Eigen::Vector3d(0.1, -2.0, 1.0 / 3.0);
  trial.markers.state[0] = data::SampleState::measured;
  trial.markers.x(1, 1) = Eigen::Vector3d(1.0, 2.0, 3.0);
  trial.markers.state[3] = data::SampleState::interpolated;
  trial.markers.state[2] = data::SampleState::rejected;
  return trial;
}

TEST(WriteCsv, OneHeaderLineAndOneLinePerFrame) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_csv(scratch / "m.csv", small(), false));
  EXPECT_EQ(read_text(scratch / "m.csv").value(),
            "frame,time_s,A.x,A.y,A.z,A.state,B.x,B.y,B.z,B.state\n"
            "7,1,0.1,-2,0.3333333333333333,measured,,,,missing\n"
            "8,1.25,,,,rejected,1,2,3,interpolated\n");
}

TEST(WriteCsv, QuotesNamesThatNeedIt) {
  const testing_support::ScratchFolder scratch;
  data::Trial trial = small();
  trial.markers.names = {"left, \"upper\"", "B 2"};
  ASSERT_TRUE(write_csv(scratch / "m.csv", trial, false));
  EXPECT_THAT(read_text(scratch / "m.csv").value(),
              testing::StartsWith("frame,time_s,\"left, \"\"upper\"\".x\",\"left, \"\"upper\"\".y\",\"left, "
                                  "\"\"upper\"\".z\",\"left, \"\"upper\"\".state\",B 2.x,"));
}

TEST(WriteCsv, LongTrialsComeOutWhole) {
  const testing_support::ScratchFolder scratch;
  data::Trial trial;
  trial.markers = data::Trajectories::all_missing({"A"}, {.rate_hz = 100.0, .t0_s = 0.0, .frames = 100'000});
  ASSERT_TRUE(write_csv(scratch / "m.csv", trial, false));
  const std::string text = read_text(scratch / "m.csv").value();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 100'001);
  EXPECT_THAT(text, testing::EndsWith("\n100000,999.99,,,,missing\n"));
}

TEST(WriteCsv, RefusesAnInvalidTrialAndAnExistingFile) {
  const testing_support::ScratchFolder scratch;
  data::Trial trial = small();
  trial.markers.names[1] = "A";
  EXPECT_EQ(write_csv(scratch / "m.csv", trial, false).error().code, Code::bad_input);
  EXPECT_EQ(scratch.count_files(), 0);
  ASSERT_TRUE(write_csv(scratch / "m.csv", small(), false));
  EXPECT_EQ(write_csv(scratch / "m.csv", small(), false).error().code, Code::io);
  EXPECT_TRUE(write_csv(scratch / "m.csv", small(), true));
}

}  // namespace
}  // namespace kinemark::io
