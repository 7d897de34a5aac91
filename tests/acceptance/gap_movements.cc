// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "acceptance/gap_movements.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "kinemark/core/random.h"

namespace kinemark::testing_support {
namespace {

constexpr double kRateHz = 100.0;
constexpr std::int64_t kFrames = 800;
constexpr int kBodies = 3;
constexpr int kMarkers = 4;

/// One coordinate through time, of size about 1.
std::vector<double> course(LimbMovement movement, double period_s, Random& random) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  std::vector<double> x(kFrames, 0.0);
  const auto add_sine = [&](double size, double hz) {
    const double phase = random.uniform(0.0, kTurn);
    for (std::size_t f = 0; f < x.size(); ++f)
      x[f] += size * std::sin(kTurn * hz * static_cast<double>(f) / kRateHz + phase);
  };
  if (movement == LimbMovement::rhythm) {
    for (int h = 1; h <= 3; ++h) add_sine(random.uniform(0.3, 1.0) / h, h / period_s);
  } else if (movement == LimbMovement::sines) {
    for (int h = 1; h <= 3; ++h) add_sine(random.uniform(0.3, 0.8), random.uniform(0.2, 1.3));
  } else if (movement == LimbMovement::random) {
    for (int h = 1; h <= 12; ++h) add_sine(0.4 * random.gaussian(), 0.125 * h);
  }
  return x;
}

/// Shared beginnings and ends of the movements from rest, s.
std::vector<std::pair<double, double>> draw_reaches(LimbMovement movement, Random& random) {
  std::vector<std::pair<double, double>> out;
  double at = movement == LimbMovement::start ? random.uniform(3.0, 5.0) : random.uniform(0.2, 1.0);
  while (at < static_cast<double>(kFrames) / kRateHz) {
    const double seconds = random.uniform(0.4, 1.2);
    out.emplace_back(at, at + seconds);
    at += seconds + random.uniform(0.3, 2.0);
  }
  return out;
}

Eigen::Matrix3d rotation(const Eigen::Vector3d& v) {
  return Eigen::AngleAxisd(v.norm(), v.norm() > 0.0 ? v.normalized().eval() : Eigen::Vector3d::UnitX().eval())
      .toRotationMatrix();
}

Eigen::Vector3d draw(Random& random, double size) {
  const double x = random.uniform(-size, size);
  const double y = random.uniform(-size, size);
  const double z = random.uniform(-size, size);
  return {x, y, z};
}

}  // namespace

data::Trajectories moving_limb(LimbMovement movement, std::uint64_t seed) {
  Random random(seed, 10 + static_cast<std::uint64_t>(movement));
  const double period_s = random.uniform(0.9, 1.4);
  const double noise_m = random.uniform(0.0002, 0.0008);
  const auto reaches = draw_reaches(movement, random);
  // Three angles of each joint, then the place of the first segment.
  std::vector<std::vector<double>> courses;
  for (int k = 0; k < 3 * kBodies + 3; ++k) {
    std::vector<double> x = course(movement, period_s, random);
    if (movement == LimbMovement::reaches || movement == LimbMovement::start) {
      double target = 0.0;
      for (const auto& [begin, end] : reaches) {
        const double next = random.uniform(-1.0, 1.0);
        for (std::size_t f = 0; f < x.size(); ++f) {
          const double u = std::clamp((static_cast<double>(f) / kRateHz - begin) / (end - begin), 0.0, 1.0);
          x[f] += (next - target) * u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
        }
        target = next;
      }
    }
    courses.push_back(std::move(x));
  }
  std::vector<std::string> names;
  std::vector<Eigen::Vector3d> place;
  std::vector<Eigen::Matrix3d> slide;  // m per radian of the joint above
  for (int b = 0; b < kBodies; ++b)
    for (int k = 0; k < kMarkers; ++k) {
      names.push_back(fmt::format("b{}m{}", b, k));
      place.push_back(draw(random, 0.1));
      Eigen::Matrix3d s;
      for (int c = 0; c < 3; ++c) s.col(c) = draw(random, 0.008);
      slide.push_back(s);
    }
  auto t = data::Trajectories::all_missing(names, {.rate_hz = kRateHz, .frames = kFrames});
  for (std::int64_t f = 0; f < kFrames; ++f) {
    const auto at = [&](int k) { return courses[static_cast<std::size_t>(k)][static_cast<std::size_t>(f)]; };
    Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
    Eigen::Vector3d c = 0.2 * Eigen::Vector3d(at(3 * kBodies), at(3 * kBodies + 1), at(3 * kBodies + 2));
    for (int b = 0; b < kBodies; ++b) {
      const Eigen::Vector3d angle = 0.5 * Eigen::Vector3d(at(3 * b), at(3 * b + 1), at(3 * b + 2));
      R = R * rotation(angle);
      for (int k = 0; k < kMarkers; ++k) {
        const int m = b * kMarkers + k;
        const auto i = static_cast<std::size_t>(m);
        const double x = random.gaussian();
        const double y = random.gaussian();
        const double z = random.gaussian();
        t.x(f, m) = c + R * (place[i] + slide[i] * angle) + noise_m * Eigen::Vector3d(x, y, z);
        t.state[t.index(f, m)] = data::SampleState::measured;
      }
      c += R * Eigen::Vector3d(0.35, 0.0, 0.0);
    }
  }
  return t;
}

}  // namespace kinemark::testing_support
