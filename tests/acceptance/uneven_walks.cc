// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "acceptance/uneven_walks.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "kinemark/stages/analysis/gait/testing/known_walk.h"

namespace kinemark::acceptance {
namespace {

using analysis::testing::KnownWalk;
using data::Side;
using Eigen::Vector3d;

constexpr std::int64_t kBefore = 3;    // steps of each foot before the recording
constexpr double kOwnError_s = 0.007;  // of an event: docs/theory/gait.md

/// How somebody differs from step to step, drawn.
struct Spread {
  double step_s, aside_m;
  explicit Spread(Random& random)
      : step_s(std::exp(random.uniform(std::log(0.004), std::log(0.03)))),
        aside_m(std::exp(random.uniform(std::log(0.003), std::log(0.02)))) {}
};

data::Trajectories no_markers(const KnownWalk& walk) {
  return data::Trajectories::all_missing(
      {"LHEE", "LTOE", "RHEE", "RTOE", "SACR"},
      {.rate_hz = walk.rate_hz, .frames = std::llround(walk.duration_s * walk.rate_hz)});
}

void put(data::Trajectories& to, std::int64_t f, std::int64_t m, const Vector3d& x, double noise_m,
         Random& random) {
  for (int axis = 0; axis < 3; ++axis) to.x(f, m)[axis] = x[axis] + noise_m * random.gaussian();
  to.state[to.index(f, m)] = data::SampleState::measured;
}

KnownWalk draw(Random& random, std::uint64_t seed) {
  auto walk = KnownWalk::draw(random);
  constexpr std::array kRates{100.0, 120.0, 200.0};
  walk.rate_hz = kRates[std::min<std::size_t>(2, static_cast<std::size_t>(random.uniform(0.0, 3.0)))];
  walk.treadmill = seed % 2 == 0;
  walk.duration_s = walk.treadmill ? random.uniform(10.0, 30.0) : random.uniform(4.5, 8.0);
  walk.first_strike_s = random.uniform(-1.0, 0.0);
  return walk;
}

double smooth(double u) {
  u = std::clamp(u, 0.0, 1.0);
  return u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
}

/// Real times of the known walker's instants: strikes of both feet in turn, each later than the one before by
/// its own duration; between them a cubic. Feet move as if each strike erred by itself.
class Clock {
 public:
  Clock(const KnownWalk& walk, double step_sd_s, Random& random) {
    const auto steps = static_cast<std::int64_t>(std::ceil(walk.duration_s / walk.stride_s)) + 2 * kBefore;
    for (std::int64_t k = -kBefore; k < steps; ++k)
      for (const Side side : data::kBothSides) known_.push_back(walk.strike_s(side, k));
    true_.push_back(known_.front());
    for (std::size_t i = 1; i < known_.size(); ++i)
      true_.push_back(true_.back() + known_[i] - known_[i - 1] + step_sd_s * random.gaussian());
    for (const double t : true_) real_.push_back(t + kOwnError_s * random.gaussian());
    for (std::size_t i = 0; i < known_.size(); ++i) {
      const auto a = i == 0 ? 0 : i - 1, b = std::min(i + 1, known_.size() - 1);
      slope_.push_back((known_[b] - known_[a]) / (real_[b] - real_[a]));
    }
  }
  [[nodiscard]] double known(double real_s) const {
    const auto i = std::clamp<std::ptrdiff_t>(std::ranges::upper_bound(real_, real_s) - real_.begin() - 1, 0,
                                              std::ssize(real_) - 2);
    const auto k = static_cast<std::size_t>(i);
    const double span = real_[k + 1] - real_[k];
    return analysis::testing::walk_detail::hermite((real_s - real_[k]) / span, span, known_[k], slope_[k],
                                                   known_[k + 1], slope_[k + 1])[0];
  }
  /// True instant of the strike of a foot's step.
  [[nodiscard]] double strike(Side side, std::int64_t step) const {
    return true_[2 * static_cast<std::size_t>(step + kBefore) + data::index_of(side)];
  }

 private:
  std::vector<double> known_, true_, real_, slope_;
};

UnevenWalk shifted(std::uint64_t seed) {
  Random random(seed, 0x73686966);
  auto walk = draw(random, seed);
  const Spread spread(random);
  const Clock clock(walk, spread.step_s, random);
  const double noise_m = 1e-3 * std::exp(random.uniform(std::log(0.1), std::log(1.0)));
  const bool belt = std::exchange(walk.treadmill, false);
  const Vector3d ahead(std::cos(walk.heading_rad), std::sin(walk.heading_rad), 0.0),
      left(-std::sin(walk.heading_rad), std::cos(walk.heading_rad), 0.0);
  UnevenWalk out{.steps = {},
                 .markers = no_markers(walk),
                 .stride_sd_s = std::sqrt(2.0) * spread.step_s,
                 .width_sd_m = std::sqrt(1.5) * spread.aside_m};
  const auto count = static_cast<std::int64_t>(std::ceil(walk.duration_s / walk.stride_s)) + 2 * kBefore;
  for (const Side side : data::kBothSides)
    for (std::int64_t k = -kBefore; k < count; ++k) {
      const double aside =
          (side == Side::left ? 0.5 : -0.5) * walk.width_m + spread.aside_m * random.gaussian();
      out.steps[data::index_of(side)].push_back(
          {.strike_s = clock.strike(side, k),
           .off_s = clock.strike(side, k) + walk.off_s(side, k) - walk.strike_s(side, k),
           .heel = {walk.speed_m_per_s * (walk.strike_s(side, k) - walk.strike_s(Side::left, 0)), aside}});
    }
  for (std::int64_t f = 0; f < out.markers.frames(); ++f) {
    const double t = out.markers.time.time_s(f), known = clock.known(t);
    const Vector3d back = belt ? Vector3d(-walk.speed_m_per_s * t * ahead) : Vector3d(Vector3d::Zero());
    for (const Side side : data::kBothSides) {
      const auto& steps = out.steps[data::index_of(side)];
      const auto k = static_cast<std::size_t>(std::floor((known - walk.strike_s(side, 0)) / walk.stride_s) +
                                              static_cast<double>(kBefore));
      const double usual = (side == Side::left ? 0.5 : -0.5) * walk.width_m,
                   in_swing = (known - walk.off_s(side, static_cast<std::int64_t>(k) - kBefore)) /
                              (walk.stride_s * (1.0 - walk.stance[data::index_of(side)])),
                   share = smooth(in_swing),
                   aside = steps[k].heel.y() + share * (steps[k + 1].heel.y() - steps[k].heel.y()) - usual;
      const auto foot = walk.foot_at(side, known);
      for (std::int64_t m = 0; m < 2; ++m)
        put(out.markers, f, 2 * static_cast<std::int64_t>(data::index_of(side)) + m,
            foot[static_cast<std::size_t>(m)] + aside * left + back, noise_m, random);
    }
    put(out.markers, f, 4, walk.pelvis_at(known) + back, noise_m, random);
  }
  return out;
}

/// Heel and toe of a foot of the plan at a time: flat on its print, rising about the toe, swinging to the
/// next.
std::array<Vector3d, 2> planned_foot(const UnevenStep& now, const UnevenStep& next, double t, double foot_m) {
  constexpr double kLand = 0.3, kLeave = -0.8, kHeel = 0.035, kToe = 0.03;
  const double stance = now.off_s - now.strike_s, u = (t - now.strike_s) / stance;
  double pitch = 0.0, x = now.heel.x(), z = kHeel;
  const auto about_toe = [&](double angle) {
    x = now.heel.x() + foot_m * (1.0 - std::cos(angle)), z = kHeel - foot_m * std::sin(angle);
  };
  const double y = now.heel.y();
  if (u < 0.13) {
    pitch = kLand * (1.0 - smooth(u / 0.13));
  } else if (u < 0.6) {
    pitch = 0.0;
  } else if (u < 1.0) {
    const double v = (u - 0.6) / 0.4;
    pitch = kLeave * v * v;
    about_toe(pitch);
  } else {
    const double v = (t - now.off_s) / (next.strike_s - now.off_s);
    pitch = kLeave + (kLand - kLeave) * smooth(v);
    about_toe(kLeave);
    x += (next.heel.x() - x) * smooth(v);
    z = z + (kHeel - z) * smooth(v) + 0.03 * std::pow(std::sin(std::numbers::pi * v), 2);
    const double aside = y + smooth(v) * (next.heel.y() - y);
    return {Vector3d(x, aside, z),
            Vector3d(x + foot_m * std::cos(pitch), aside, z + foot_m * std::sin(pitch) + kToe - kHeel)};
  }
  return {Vector3d(x, y, z),
          Vector3d(x + foot_m * std::cos(pitch), y, z + foot_m * std::sin(pitch) + kToe - kHeel)};
}

UnevenWalk planned(std::uint64_t seed) {
  Random random(seed, 0x706c616e);
  const auto walk = draw(random, seed);
  const Spread spread(random);
  const double noise_m = 1e-3 * std::exp(random.uniform(std::log(0.1), std::log(1.0)));
  const double kept = random.uniform(0.0, 0.6), fresh = std::sqrt(1.0 - kept * kept);
  UnevenWalk out{.steps = {},
                 .markers = no_markers(walk),
                 .stride_sd_s = std::sqrt(2.0 * (1.0 + kept)) * spread.step_s,
                 .width_sd_m = std::sqrt(1.5 - 2.0 * kept + 0.5 * kept * kept) * spread.aside_m};
  const auto count =
      2 * (static_cast<std::int64_t>(std::ceil(walk.duration_s / walk.stride_s)) + 2 * kBefore);
  std::array<std::vector<UnevenStep>, 2> shown;  // as the feet move
  double duration = random.gaussian(), aside = random.gaussian(),
         t = walk.first_strike_s - kBefore * walk.stride_s, x = 0.0;
  const double step_s = 0.5 * walk.stride_s, stance_s = walk.stance[0] * walk.stride_s;
  for (std::int64_t i = 0; i < count; ++i) {
    duration = kept * duration + fresh * random.gaussian(), aside = kept * aside + fresh * random.gaussian();
    const double to_side = i % 2 == 0 ? 0.5 : -0.5;
    out.steps[static_cast<std::size_t>(i % 2)].push_back(
        {.strike_s = t,
         .off_s = t + stance_s + 0.5 * spread.step_s * random.gaussian(),
         .heel = {x + 0.3 * spread.aside_m * random.gaussian(),
                  to_side * walk.width_m + spread.aside_m * aside}});
    shown[static_cast<std::size_t>(i % 2)].push_back(out.steps[static_cast<std::size_t>(i % 2)].back());
    shown[static_cast<std::size_t>(i % 2)].back().strike_s += kOwnError_s * random.gaussian();
    const double took = step_s + spread.step_s * duration;
    t += took;
    x +=
        walk.treadmill ? walk.speed_m_per_s * took : 0.5 * walk.stride_m() * (1.0 + 0.02 * random.gaussian());
  }
  const double c = std::cos(walk.heading_rad), s = std::sin(walk.heading_rad);
  for (std::int64_t f = 0; f < out.markers.frames(); ++f) {
    const double at = out.markers.time.time_s(f), back = walk.treadmill ? walk.speed_m_per_s * at : 0.0;
    const auto lab = [&](const Vector3d& p) {
      return Vector3d(c * (p.x() - back) - s * p.y(), s * (p.x() - back) + c * p.y(), p.z());
    };
    Vector3d middle = Vector3d::Zero();
    for (std::size_t side = 0; side < 2; ++side) {
      const auto& steps = shown[side];
      std::size_t k = 0;
      while (k + 2 < steps.size() && steps[k + 1].strike_s <= at) ++k;
      const auto foot = planned_foot(steps[k], steps[k + 1], at, walk.foot_m);
      const double through = (at - steps[k].strike_s) / (steps[k + 1].strike_s - steps[k].strike_s);
      middle.x() += 0.5 * (steps[k].heel.x() + (through - 0.3) * (steps[k + 1].heel.x() - steps[k].heel.x()));
      for (std::size_t m = 0; m < 2; ++m)
        put(out.markers, f, static_cast<std::int64_t>(2 * side + m), lab(foot[m]), noise_m, random);
    }
    middle.z() = 0.95;
    put(out.markers, f, 4, lab(middle), noise_m, random);
  }
  return out;
}

}  // namespace

UnevenWalk uneven_walk(const std::string& kind, std::uint64_t seed) {
  return kind == "shifted" ? shifted(seed) : planned(seed);
}

}  // namespace kinemark::acceptance
