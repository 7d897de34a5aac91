// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/rig/rig_page.h"

#include <gmock/gmock.h>

#include "kinemark/core/missing.h"

namespace kinemark::pipeline {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

data::Rig one_camera(const Eigen::Vector3d& at) {
  data::Rig rig;
  rig.cameras.resize(1);
  rig.cameras[0].name = "left";
  rig.cameras[0].cam_from_world.translation = -at;
  return rig;
}

TEST(RigPage, ACalibrationShowsBothPositionsOfACameraAndWhatToTurn) {
  CalibrateJob job;
  job.inputs = {"lab/tree.mcap"};
  CalibrateOutcome outcome;
  outcome.alignment = calibration::Alignment{};
  outcome.alignment->next = "Turn camera left by 2 degrees.";
  const auto nominal = one_camera({0.0, 0.0, 0.0}), found = one_camera({0.0, 0.0, 0.25});
  const auto page = calibrate_page(job, outcome, nominal, found);
  EXPECT_THAT(page, HasSubstr("Turn camera left by 2 degrees."));
  EXPECT_THAT(page, HasSubstr(R"("centre_m":[0.0,0.0,0.25])"));
  EXPECT_THAT(page, HasSubstr(R"("nominal":true)"));
  EXPECT_THAT(page, HasSubstr(R"("centre_sd_mm":null)"));
  outcome.alignment->aligned = true;
  EXPECT_THAT(calibrate_page(job, outcome, nominal, found), Not(HasSubstr("camera is to be turned")));
}

TEST(RigPage, AReconstructionJudgesEachLed) {
  ReconstructOutcome outcome;
  outcome.frames = 100;
  outcome.written = {"points.c3d"};
  outcome.found.leds = {{.name = "hand", .frames = 100, .located = 100},
                        {.name = "wrist", .frames = 100, .located = 70, .occluded = 25, .inconsistent = 5},
                        {.name = "lost", .frames = 100, .occluded = 100}};
  const auto points = data::Trajectories::all_missing({"hand", "wrist", "lost"},
                                                      {.rate_hz = 100.0, .t0_s = 0.0, .frames = 100});
  const auto page = reconstruct_page({}, outcome, one_camera({0.0, 0.0, 0.0}), points);
  EXPECT_THAT(page, HasSubstr(R"("verdict":"attention")"));
  EXPECT_THAT(page, HasSubstr("1 LED located in no frame"));
  EXPECT_THAT(page, HasSubstr("1 LED located in less than 80 % of the frames"));
  EXPECT_THAT(page,
              HasSubstr("wrist: the cameras contradict each other in 5 of 100 frames; no point there."));
  EXPECT_THAT(page, HasSubstr(R"("precision":[null,null])"));
  EXPECT_THAT(page, Not(HasSubstr("light_curves")));
  outcome.found.lights.resize(3);
  for (auto& light : outcome.found.lights) light.seen.assign(100, kNaN);
  outcome.found.lights[0].source = reconstruction::LightSource::direction;
  outcome.found.lights[0].seen[50] = 0.5;
  EXPECT_THAT(
      reconstruct_page({}, outcome, one_camera({0.0, 0.0, 0.0}), points),
      HasSubstr(R"("light_curves":[{"led":"hand","cameras":["left"],"time_s":[0.5],"seen":[[0.5]]}])"));
  outcome.found.leds.resize(1);
  EXPECT_THAT(reconstruct_page({}, outcome, one_camera({0.0, 0.0, 0.0}), points),
              HasSubstr(R"("verdict":"good")"));
}

}  // namespace
}  // namespace kinemark::pipeline
