// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/testing/swinging_joint.h"

#include <cmath>
#include <numbers>
#include <string>

#include "kinemark/core/random.h"
#include "kinemark/math/euler.h"

namespace kinemark::skeleton::testing {
namespace {

constexpr int kFramesAMovement = 100, kMarkers = 4;

Eigen::Vector3d draw(Random& random) {
  const double x = random.gaussian(), y = random.gaussian(), z = random.gaussian();
  return {x, y, z};
}

Eigen::Vector3d posture_at(const SwingSetup& setup, int frame) {
  const int movement = frame / kFramesAMovement;
  const double phase = static_cast<double>(frame % kFramesAMovement) / kFramesAMovement;
  const double angle = setup.range_rad * (0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * phase));
  const double azimuth = setup.hinge ? 0.0 : std::numbers::pi / 3.5 * movement;
  return {angle * std::cos(azimuth), angle * std::sin(azimuth),
          setup.hinge ? 0.0 : 0.15 * std::sin(0.03 * frame)};
}

}  // namespace

TestChain make_swings(const SwingSetup& setup) {
  const int F = setup.movements * kFramesAMovement;
  TestChain out;
  std::vector<std::string> names;
  for (int s = 0; s < 2; ++s) {
    out.layout.segments.push_back({"s" + std::to_string(s), {}});
    for (int k = 0; k < kMarkers; ++k) {
      out.layout.segments.back().markers.push_back(static_cast<int>(names.size()));
      names.push_back("m" + std::to_string(s) + std::to_string(k));
    }
  }
  out.layout.joints = {{"j0", 0, 1}};
  out.markers = data::Trajectories::all_missing(names, {.rate_hz = 50.0, .t0_s = 0.0, .frames = F});
  out.world_from_segment.resize(2);
  out.centres.emplace_back(3, F);
  Random shape(setup.seed, 1), slide(setup.seed, 2), noise(setup.seed, 3);
  for (int s = 0; s < 2; ++s) {
    Eigen::Matrix3Xd x(3, kMarkers);
    for (int k = 0; k < kMarkers; ++k)
      x.col(k) = Eigen::Vector3d(0.0, 0.0, s == 0 ? 0.18 : -0.2) + 0.06 * draw(shape);
    out.x_in_segment.push_back(x);
  }
  const auto matrix = [&](double size) {
    Eigen::Matrix3d B;
    for (int i = 0; i < 3; ++i) B.col(i) = size * draw(slide);
    return B;
  };
  const Eigen::Matrix3d common = matrix(setup.common_slide_m);
  std::vector<Eigen::Matrix3d> own;
  for (int k = 0; k < kMarkers; ++k) own.push_back(common + matrix(setup.own_slide_m));
  Eigen::Matrix3Xd error = Eigen::Matrix3Xd::Zero(3, 2 * kMarkers);
  const double news = std::sqrt(1.0 - setup.keeps * setup.keeps);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (int f = 0; f < F; ++f) mean += posture_at(setup, f) / F;
  for (int f = 0; f < F; ++f) {
    const Eigen::Vector3d q = posture_at(setup, f),
                          sway(0.1 * std::sin(0.02 * f), 0.1 * std::cos(0.013 * f), 0.0);
    const Eigen::Matrix3d R = math::exp_so3(sway), S = R * math::exp_so3(q);
    out.world_from_segment[0].push_back(R);
    out.world_from_segment[1].push_back(S);
    const Eigen::Vector3d centre(0.05 * std::sin(0.01 * f), 0.0, 0.9);
    out.centres[0].col(f) = centre;
    const Eigen::Vector3d moved =
        centre + R * Eigen::Vector3d(0.0, 0.0, setup.joint_slide_m * (q - mean).x());
    for (int m = 0; m < 2 * kMarkers; ++m) {
      error.col(m) = f == 0 ? draw(noise) : Eigen::Vector3d(setup.keeps * error.col(m) + news * draw(noise));
      const int k = m % kMarkers;
      const Eigen::Vector3d x =
          m < kMarkers ? Eigen::Vector3d(centre + R * out.x_in_segment[0].col(k))
                       : Eigen::Vector3d(moved + S * (out.x_in_segment[1].col(k) +
                                                      own[static_cast<std::size_t>(k)] * (q - mean)));
      out.markers.x(f, m) = x + setup.noise_sd_m * error.col(m);
      out.markers.state[out.markers.index(f, m)] = data::SampleState::measured;
    }
  }
  return out;
}

}  // namespace kinemark::skeleton::testing
