// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/rig/reconstruct.h"

#include <gmock/gmock.h>

#include <cmath>

#include "kinemark/stages/simulation/rig_recording.h"
#include "kinemark/stages/simulation/rig_scene.h"

namespace kinemark::workflow {
namespace {

/// A wheel before two cameras, and the rig as it is.
struct Wheel {
  simulation::PhysicalRig drawn = simulation::draw_rig({.seed = 7}).value();
  data::Rig rig = simulation::rig_in_room(drawn);
  simulation::RigRecording recording =
      simulation::record(drawn, simulation::rotating_wheel(), {.frames = 120}).value();
};

const Wheel& wheel() {
  static const Wheel shared;
  return shared;
}

double rms_error_m(const data::Trajectories& found, const data::Trajectories& truth) {
  double squares = 0.0, points = 0.0;
  for (std::int64_t f = 0; f < found.frames(); ++f)
    for (std::int64_t m = 0; m < found.markers(); ++m) {
      if (!found.present(f, m)) continue;
      squares += (found.x(f, m) - truth.x(f, m)).squaredNorm();
      points += 1.0;
    }
  return std::sqrt(squares / points);
}

TEST(Reconstruct, EachMethodFindsTheWheel) {
  for (const auto method : {ReconstructMethod::smoother, ReconstructMethod::frames}) {
    const auto found = reconstruct(wheel().recording.counts, wheel().rig, {.method = method});
    ASSERT_TRUE(found) << to_string(method) << ": " << found.error().message;
    EXPECT_EQ(found->markers.frames(), 120);
    EXPECT_EQ(found->leds.size(), found->markers.names.size());
    EXPECT_EQ(found->fits.empty(), method != ReconstructMethod::smoother);
    EXPECT_LT(rms_error_m(found->markers, method == ReconstructMethod::smoother ? wheel().recording.truth
                                                                                : wheel().recording.when_lit),
              0.005)
        << to_string(method);
  }
}

TEST(Reconstruct, ThreadsChangeNoBit) {
  const auto one = reconstruct(wheel().recording.counts, wheel().rig, {.threads = 1}).value();
  const auto two = reconstruct(wheel().recording.counts, wheel().rig, {.threads = 2}).value();
  EXPECT_EQ(one.markers.state, two.markers.state);
  for (std::size_t i = 0; i < one.markers.x_in_world.size(); ++i)
    if (!std::isnan(one.markers.x_in_world[i]))
      EXPECT_EQ(one.markers.x_in_world[i], two.markers.x_in_world[i]);
}

TEST(Reconstruct, OptionsOutOfRangeAreRefused) {
  EXPECT_FALSE(reconstruct(wheel().recording.counts, wheel().rig, {.frames = {.dim_share = -1.0}}));
  const auto classic =
      reconstruct(wheel().recording.counts, wheel().rig, {.method = ReconstructMethod::classic});
  ASSERT_FALSE(classic);
  EXPECT_THAT(classic.error().message, ::testing::HasSubstr("no look-up table"));
  EXPECT_EQ(to_string(ReconstructMethod::classic), "classic");
}

}  // namespace
}  // namespace kinemark::workflow
