// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/dynamics/internal/unmeasured_load.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "kinemark/core/index.h"
#include "kinemark/math/statistics.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Vector3d;

// Shares of the body weight.
constexpr double kBegin = 0.1, kBeginOnPlate = 0.25, kEnd = 0.03, kQuiet = 0.25, kMostScatter = 0.05;
constexpr double kShortest = 0.03;        // s
constexpr double kStanding = 0.8;         // m/s, mass centre of a foot on the floor
constexpr double kFarFromFoot = 0.35;     // m, centre of pressure to the mass centre of a foot that bears it
constexpr double kToMedianToSd = 1.4826;  // of a normal distribution

/// The residual of one root as the search needs it.
class Search {
 public:
  Search(const std::vector<RootFrame>& frames, const Vector3d& gravity, double mass_kg, double contact_n,
         double rate_hz)
      : frames_(frames), up_(-gravity.normalized()), weight_n_(mass_kg * gravity.norm()), rate_hz_(rate_hz) {
    double lowest = std::numeric_limits<double>::infinity();
    std::vector<double> quiet;
    for (const auto& frame : frames) {
      vertical_.push_back(frame.force.dot(up_));
      if (std::abs(vertical_.back()) < kQuiet * weight_n_) quiet.push_back(std::abs(vertical_.back()));
      for (const auto& foot : frame.feet) lowest = std::min(lowest, foot.dot(up_));
    }
    floor_ = lowest;
    floor_velocity_ = velocity_on_plates();
    const double scatter =
        quiet.empty() ? 0.0 : std::min(kToMedianToSd * math::median(quiet), kMostScatter * weight_n_);
    begin_n_ = std::max({contact_n, kBegin * weight_n_, 5.0 * scatter});
    end_n_ = std::max({0.5 * contact_n, kEnd * weight_n_, 2.0 * scatter});
  }

  [[nodiscard]] std::vector<UnmeasuredLoad> run(int foot) const {
    std::vector<UnmeasuredLoad> out;
    const auto F = static_cast<std::int64_t>(frames_.size());
    for (std::int64_t f = 0; f < F; ++f) {
      if (!begins(f, foot)) continue;
      UnmeasuredLoad load{.foot = foot, .first_frame = f, .last_frame = f};
      const std::int64_t before = out.empty() ? -1 : out.back().last_frame;
      while (load.first_frame - 1 > before && goes_on(load.first_frame - 1, foot)) --load.first_frame;
      while (load.last_frame + 1 < F && goes_on(load.last_frame + 1, foot)) ++load.last_frame;
      for (std::int64_t k = load.first_frame; k <= load.last_frame; ++k)
        load.force_max_n = std::max(load.force_max_n, vertical_[at(k)]);
      f = load.last_frame;
      if (static_cast<double>(load.last_frame - load.first_frame + 1) >= kShortest * rate_hz_)
        out.push_back(load);
    }
    return out;
  }

 private:
  /// Index of the foot nearest to the centre of pressure, -1 when none is near.
  [[nodiscard]] int bearer(std::int64_t f, bool free_only) const {
    const auto& frame = frames_[at(f)];
    const Vector3d axis = frame.origin + frame.force.cross(frame.moment) / frame.force.squaredNorm();
    const Vector3d centre = axis + (floor_ - axis.dot(up_)) / vertical_[at(f)] * frame.force;
    int best = -1;
    double nearest = kFarFromFoot;
    for (std::size_t i = 0; i < frame.feet.size(); ++i) {
      if (free_only && frame.on_plate[i]) continue;
      const Vector3d from = frame.feet[i] - centre;
      const double distance = (from - from.dot(up_) * up_).norm();
      if (distance >= nearest) continue;
      nearest = distance;
      best = static_cast<int>(i);
    }
    return best;
  }

  [[nodiscard]] bool begins(std::int64_t f, int foot) const {
    if (!(vertical_[at(f)] > begin_n_)) return false;
    if (!frames_[at(f)].on_plate[at(foot)]) return stands(f, foot) && bearer(f, true) == foot;
    return vertical_[at(f)] > kBeginOnPlate * weight_n_ && bearer(f, false) == foot;
  }

  [[nodiscard]] bool goes_on(std::int64_t f, int foot) const {
    if (!(vertical_[at(f)] > end_n_) || frames_[at(f)].on_plate[at(foot)]) return begins(f, foot);
    return stands(f, foot) || bearer(f, true) == foot;
  }

  /// Moves with the floor, or with the belt of a treadmill.
  [[nodiscard]] bool stands(std::int64_t f, int foot) const {
    return (velocity(f, at(foot)) - floor_velocity_).norm() < kStanding;
  }

  /// Median velocity of the feet on plates; zero where there are none.
  [[nodiscard]] Vector3d velocity_on_plates() const {
    std::array<std::vector<double>, 3> axes;
    for (std::size_t f = 0; f < frames_.size(); ++f)
      for (std::size_t i = 0; i < frames_[f].feet.size(); ++i) {
        const Vector3d v = velocity(static_cast<std::int64_t>(f), i);
        if (!frames_[f].on_plate[i] || !v.allFinite()) continue;
        for (int axis = 0; axis < 3; ++axis) axes[at(axis)].push_back(v[axis]);
      }
    if (axes[0].empty()) return Vector3d::Zero();
    return {math::median(axes[0]), math::median(axes[1]), math::median(axes[2])};
  }

  [[nodiscard]] Vector3d velocity(std::int64_t f, std::size_t foot) const {
    const std::int64_t last = static_cast<std::int64_t>(frames_.size()) - 1;
    const std::int64_t a = std::max<std::int64_t>(0, f - 1), b = std::min(last, f + 1);
    if (a == b) return Vector3d::Zero();
    return (frames_[at(b)].feet[foot] - frames_[at(a)].feet[foot]) * rate_hz_ / static_cast<double>(b - a);
  }

  const std::vector<RootFrame>& frames_;
  Vector3d up_;
  double weight_n_, rate_hz_;
  double floor_ = 0.0, begin_n_ = 0.0, end_n_ = 0.0;
  Vector3d floor_velocity_ = Vector3d::Zero();
  std::vector<double> vertical_;  // N
};

}  // namespace

std::vector<UnmeasuredLoad> find_unmeasured_load(const std::vector<RootFrame>& frames,
                                                 const Vector3d& gravity, double body_mass_kg,
                                                 double contact_force_n, double rate_hz) {
  std::vector<UnmeasuredLoad> out;
  if (frames.empty() || !(gravity.norm() > 0.0)) return out;
  const Search search(frames, gravity, body_mass_kg, contact_force_n, rate_hz);
  for (std::size_t i = 0; i < frames[0].feet.size(); ++i) {
    const auto of_foot = search.run(static_cast<int>(i));
    out.insert(out.end(), of_foot.begin(), of_foot.end());
  }
  return out;
}

std::vector<int> limb_coordinates(const model::Model& model, int body) {
  std::vector<std::uint8_t> in_limb(model.bodies().size(), 0);
  for (int b = body; b >= 0; b = model.bodies()[at(b)].parent) in_limb[at(b)] = 1;
  std::vector<std::uint8_t> carried(model.bodies().size(), 0);
  carried[at(body)] = 1;
  for (std::size_t b = at(body) + 1; b < model.bodies().size(); ++b)
    if (model.bodies()[b].parent >= 0 && carried[at(model.bodies()[b].parent)]) carried[b] = in_limb[b] = 1;
  std::vector<int> out;
  for (int c = 0; c < model.coordinate_count(); ++c) {
    const int speed = model.coordinates()[at(c)].speed_idx;
    if (speed >= 0 && std::ranges::any_of(model.columns(), [&](const auto& column) {
          return column.speed == speed && in_limb[at(column.body)];
        }))
      out.push_back(c);
  }
  return out;
}

}  // namespace kinemark::motion::internal
