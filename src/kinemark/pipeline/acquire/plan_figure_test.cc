// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/acquire/plan_figure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::HasSubstr;

AcquireJob job_of(const std::string& source) {
  AcquireJob job;
  job.source = source;
  return job;
}

TEST(PlanFigure, DrawsWhatTheDeviceGrants) {
  const testing_support::ScratchFolder scratch;
  auto job = job_of("sim:rig?scene=tree&dark");
  job.rate_hz = 100.0;
  job.intensity = {{"front", 0.5}};
  const auto drawn = run_plan(job, scratch / "plan.svg");
  ASSERT_TRUE(drawn) << drawn.error().message;
  const auto svg = io::read_text(scratch / "plan.svg").value();
  for (const char* part : {"Above one frame, below the slot of LED 1, back left.", "LED 3, front", "dark",
                           "slot 904 µs", "frame 10 ms", "settle 320 µs", "A/D, camera B"})
    EXPECT_THAT(svg, HasSubstr(part));
  const auto json = plan_json(*drawn);
  EXPECT_EQ(json["rate_hz"], 100.0);
  EXPECT_EQ(json["dark_slot"], true);
  EXPECT_EQ(json["intensity"], (std::vector<double>{1.0, 1.0, 0.5}));
  EXPECT_NEAR(json["slot_s"].get<double>(), 904e-6, 1e-12);
  EXPECT_EQ(plan_sentence(drawn->granted),
            "3 LEDs at 2 cameras, 100 frames per second: slots of 904 µs, the LED lit for 704 µs of it");
  EXPECT_THAT(run_plan(job, scratch / "plan.svg").error().message, HasSubstr("--force"));
}

TEST(PlanFigure, IsRefusedWithTheHighestRateOrWhatCanBeWritten) {
  const testing_support::ScratchFolder scratch;
  auto job = job_of("sim:rig");
  job.rate_hz = 5000.0;
  EXPECT_THAT(run_plan(job, scratch / "plan.svg").error().message, HasSubstr("at most"));
  EXPECT_THAT(run_plan(job_of("sim:rig"), scratch / "plan.pdf").error().message, HasSubstr(".svg"));
  EXPECT_EQ(run_plan(job_of("serial:/nowhere"), scratch / "plan.svg").error().code, Code::device);
  EXPECT_EQ(scratch.count_files(), 0);
}

}  // namespace
}  // namespace kinemark::pipeline
