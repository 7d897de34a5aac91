// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/gaps/testing/moving_bodies.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "kinemark/core/random.h"

namespace kinemark::trajectory::testing {
namespace {

constexpr int kMarkersPerBody = 5;

/// Sum of three sines per axis.
struct Wave {
  Eigen::Matrix3d amplitude, frequency_hz, phase;
  Wave(Random& random, double size) {
    for (Eigen::Index i = 0; i < 9; ++i) {
      amplitude(i) = size * random.uniform(0.3, 1.0);
      frequency_hz(i) = random.uniform(0.2, 1.3);
      phase(i) = random.uniform(0.0, 2.0 * std::numbers::pi);
    }
  }
  [[nodiscard]] Eigen::Vector3d at(double t) const {
    return (amplitude.array() * (2.0 * std::numbers::pi * t * frequency_hz.array() + phase.array()).sin())
        .rowwise()
        .sum();
  }
};

Eigen::Matrix3d rotation(const Eigen::Vector3d& v) {
  return Eigen::AngleAxisd(v.norm(), v.norm() > 0.0 ? v.normalized().eval() : Eigen::Vector3d::UnitX().eval())
      .toRotationMatrix();
}

}  // namespace

data::Trajectories moving_bodies(const BodiesOptions& o) {
  Random random(o.seed, 1);
  std::vector<std::string> names;
  std::vector<Wave> rotations;
  std::vector<Eigen::Vector3d> positions;
  const Wave way(random, 0.25);
  for (int b = 0; b < o.bodies; ++b) {
    rotations.emplace_back(random, 0.35);
    for (int k = 0; k < kMarkersPerBody; ++k) {
      names.push_back(fmt::format("b{}m{}", b, k));
      const double x = random.uniform(-0.1, 0.1);
      const double y = random.uniform(-0.1, 0.1);
      const double z = random.uniform(-0.1, 0.1);
      positions.emplace_back(x, y, z);
    }
  }
  auto t = data::Trajectories::all_missing(names, {.rate_hz = o.rate_hz, .frames = o.frames});
  Random noise(o.seed, 2);
  for (std::int64_t f = 0; f < o.frames; ++f) {
    const double s = t.time.time_s(f);
    Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
    Eigen::Vector3d c = way.at(s);
    for (int b = 0; b < o.bodies; ++b) {
      R = R * rotation(rotations[static_cast<std::size_t>(b)].at(s));
      for (int k = 0; k < kMarkersPerBody; ++k) {
        const int m = b * kMarkersPerBody + k;
        const double x = noise.gaussian();
        const double y = noise.gaussian();
        const double z = noise.gaussian();
        t.x(f, m) = c + R * positions[static_cast<std::size_t>(m)] + o.noise_m * Eigen::Vector3d(x, y, z);
        t.state[t.index(f, m)] = data::SampleState::measured;
      }
      c += R * Eigen::Vector3d(0.35, 0.0, 0.0);
    }
  }
  return t;
}

void hide(data::Trajectories& t, std::int64_t marker, std::int64_t first, std::int64_t last) {
  for (std::int64_t f = first; f <= last; ++f) t.set_missing(f, marker);
}

double rms_between(const data::Trajectories& a, const data::Trajectories& b, std::int64_t marker,
                   std::int64_t first, std::int64_t last) {
  double sum = 0.0;
  for (std::int64_t f = first; f <= last; ++f) sum += (a.x(f, marker) - b.x(f, marker)).squaredNorm();
  return std::sqrt(sum / static_cast<double>(3 * (last - first + 1)));
}

}  // namespace kinemark::trajectory::testing
