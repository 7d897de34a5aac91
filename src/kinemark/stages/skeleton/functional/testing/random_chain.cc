// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/testing/random_chain.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <string>

#include "kinemark/core/random.h"

namespace kinemark::skeleton::testing {
namespace {

Eigen::Vector3d direction(Random& random) {
  Eigen::Vector3d v;
  for (double& c : v) c = random.gaussian();
  return v.normalized();
}

Eigen::Matrix3d any_rotation(Random& random) {
  Eigen::Quaterniond q;
  for (double& c : q.coeffs()) c = random.gaussian();
  return q.normalized().toRotationMatrix();
}

Eigen::Matrix3d joint_rotation(Random& random, const ChainSetup& setup) {
  if (setup.rotations == Rotations::anywhere) return any_rotation(random);
  const double angle = random.uniform(-0.5, 0.5) * setup.range_rad;
  const Eigen::Vector3d axis =
      setup.rotations == Rotations::hinge ? Eigen::Vector3d::UnitX() : direction(random);
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

Eigen::Matrix3Xd marker_positions(const ChainSetup& setup, double length_m) {
  Eigen::Matrix3Xd m(3, setup.per_segment);
  for (int k = 0; k < setup.per_segment; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / setup.per_segment;
    m.col(k) << setup.stagger_m * std::cos(angle), setup.stagger_m * std::sin(angle),
        length_m * (k + 1) / (setup.per_segment + 1);
  }
  return m;
}

}  // namespace

TestChain make_chain(const ChainSetup& setup) {
  TestChain chain;
  Random motion(setup.seed, 1), noise(setup.seed, 2), lost(setup.seed, 3);
  const auto segments = setup.lengths_m.size();
  std::vector<std::string> names;
  for (std::size_t s = 0; s < segments; ++s) {
    data::SegmentLayout::Segment segment{"s" + std::to_string(s), {}};
    for (int k = 0; k < setup.per_segment; ++k) {
      segment.markers.push_back(static_cast<int>(names.size()));
      names.push_back(segment.name + "m" + std::to_string(k));
    }
    chain.layout.segments.push_back(segment);
    chain.x_in_segment.push_back(marker_positions(setup, setup.lengths_m[s]));
    if (s > 0)
      chain.layout.joints.push_back(
          {"j" + std::to_string(s - 1), static_cast<int>(s) - 1, static_cast<int>(s)});
  }
  chain.markers =
      data::Trajectories::all_missing(names, {.rate_hz = 60.0, .t0_s = 0.0, .frames = setup.frames});
  chain.centres.assign(segments - 1, Eigen::Matrix3Xd(3, setup.frames));
  chain.world_from_segment.resize(segments);
  for (std::int64_t f = 0; f < setup.frames; ++f) {
    Eigen::Matrix3d rotation = any_rotation(motion);
    Eigen::Vector3d end = 0.2 * direction(motion);
    for (std::size_t s = 0; s < segments; ++s) {
      if (s > 0)
        rotation = setup.rotations == Rotations::anywhere
                       ? any_rotation(motion)
                       : Eigen::Matrix3d(rotation * joint_rotation(motion, setup));
      chain.world_from_segment[s].push_back(rotation);
      for (int k = 0; k < setup.per_segment; ++k) {
        Eigen::Vector3d x = end + rotation * chain.x_in_segment[s].col(k);
        for (double& c : x) c += setup.noise_sd_m * noise.gaussian();
        const auto m =
            static_cast<std::int64_t>(chain.layout.segments[s].markers[static_cast<std::size_t>(k)]);
        if (lost.uniform() < setup.missing) continue;
        chain.markers.x(f, m) = x;
        chain.markers.state[chain.markers.index(f, m)] = data::SampleState::measured;
      }
      end += setup.lengths_m[s] * rotation.col(2);
      if (s + 1 < segments) chain.centres[s].col(f) = end;
    }
  }
  return chain;
}

CentreError centre_error(const data::Skeleton& skeleton, const TestChain& chain, std::int64_t joint) {
  CentreError error;
  double n = 0.0;
  for (std::int64_t f = 0; f < skeleton.frames(); ++f) {
    if (skeleton.state[skeleton.index(f, joint)] == data::CentreState::undetermined) continue;
    error.rms_m +=
        (skeleton.centre(f, joint) - chain.centres[static_cast<std::size_t>(joint)].col(f)).squaredNorm();
    n += 1.0;
  }
  error.rms_m = std::sqrt(error.rms_m / n);
  error.share = n / static_cast<double>(skeleton.frames());
  return error;
}

}  // namespace kinemark::skeleton::testing
