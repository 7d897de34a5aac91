// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/belt.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/math/statistics.h"

namespace kinemark::analysis {
namespace {

using Eigen::RowVector2d;

constexpr double kFlatFrom = 0.3, kFlatTo = 0.55;  // of a stance: the foot lies flat
constexpr std::size_t kLeastStances = 6;
constexpr double kLeastRange = 0.03, kSlow = 0.5;

// Velocities of heel and toe of a foot that lies flat.
struct FlatFoot {
  double frame = 0.0;
  RowVector2d heel, toe;
};

std::vector<FlatFoot> flat_feet(const GaitPaths& paths, const Steps& steps) {
  std::vector<FlatFoot> out;
  for (const auto side : data::kBothSides) {
    const auto& foot = paths.foot(side);
    const auto& swings = steps.foot(side).swings;
    for (std::size_t i = 0; i + 1 < swings.size(); ++i) {
      if (!swings[i].lands || !swings[i + 1].leaves) continue;
      const auto lands = static_cast<double>(*swings[i].lands),
                 stance = static_cast<double>(*swings[i + 1].leaves) - lands;
      const auto first = std::llround(lands + kFlatFrom * stance),
                 last = std::llround(lands + kFlatTo * stance);
      if (last <= first || !foot.known[at(first)] || !foot.known[at(last)]) continue;
      const double per_s = paths.rate_hz / static_cast<double>(last - first);
      out.push_back({.frame = 0.5 * static_cast<double>(first + last),
                     .heel = per_s * (foot.heel.row(last) - foot.heel.row(first)).leftCols<2>(),
                     .toe = per_s * (foot.toe.row(last) - foot.toe.row(first)).leftCols<2>()});
    }
  }
  return out;
}

}  // namespace

Ground belt_velocity(const GaitPaths& paths, const Steps& steps, const Ground& ground) {
  std::array<std::vector<double>, 2> mean, apart;  // of heel and toe, by axis
  for (const auto& foot : flat_feet(paths, steps))
    for (const Eigen::Index axis : {0, 1}) {
      mean[at(axis)].push_back(0.5 * (foot.heel[axis] + foot.toe[axis]));
      apart[at(axis)].push_back(foot.heel[axis] - foot.toe[axis]);
    }
  if (mean[0].empty()) return ground;
  return {.velocity = {math::median(mean[0]), math::median(mean[1])},
          .sd = 0.5 * std::hypot(math::median(apart[0]), math::median(apart[1]))};
}

BeltPace belt_pace(const GaitPaths& paths, const Steps& steps, const RowVector2d& belt) {
  auto feet = flat_feet(paths, steps);
  std::ranges::stable_sort(feet, {}, &FlatFoot::frame);
  BeltPace out{.frame = {}, .m_per_s = {}, .along = belt.normalized()};
  for (const auto& foot : feet) {
    if (!out.frame.empty() && foot.frame <= out.frame.back()) continue;
    out.frame.push_back(foot.frame);
    out.m_per_s.push_back(0.5 * (foot.heel + foot.toe).dot(out.along));
  }
  return out;
}

bool BeltPace::changes() const {
  if (m_per_s.size() < kLeastStances) return false;
  double mean = 0.0, squares = 0.0, steps = 0.0;
  for (const double x : m_per_s) mean += x / static_cast<double>(m_per_s.size());
  for (const double x : m_per_s) squares += (x - mean) * (x - mean);
  for (std::size_t i = 0; i + 1 < m_per_s.size(); ++i)
    steps += (m_per_s[i + 1] - m_per_s[i]) * (m_per_s[i + 1] - m_per_s[i]);
  return std::ranges::max(m_per_s) - std::ranges::min(m_per_s) > kLeastRange * std::abs(mean) &&
         steps < kSlow * squares;
}

double BeltPace::scatter() const {
  double squares = 0.0, count = 0.0;
  for (std::size_t i = 1; i + 1 < m_per_s.size(); ++i) {
    const double u = (frame[i] - frame[i - 1]) / (frame[i + 1] - frame[i - 1]);
    const double off = m_per_s[i] - (1.0 - u) * m_per_s[i - 1] - u * m_per_s[i + 1];
    squares += off * off / (1.0 + u * u + (1.0 - u) * (1.0 - u)), count += 1.0;
  }
  return std::sqrt(squares / std::max(1.0, count));
}

math::SeriesMatrix BeltPace::ahead_of(double even_m_per_s, std::int64_t frames, double rate_hz) const {
  math::SeriesMatrix out = math::SeriesMatrix::Zero(frames, 2);
  std::size_t next = 0;
  double way = 0.0, before = 0.0;
  for (std::int64_t f = 0; f < frames; ++f) {
    const auto now = static_cast<double>(f);
    while (next < frame.size() && frame[next] < now) ++next;
    double speed = next == 0 ? m_per_s.front() : m_per_s[next - 1];
    if (next > 0 && next < frame.size())
      speed += (now - frame[next - 1]) / (frame[next] - frame[next - 1]) * (m_per_s[next] - speed);
    const double ahead = speed - even_m_per_s;
    if (f > 0) way += 0.5 * (before + ahead) / rate_hz;
    before = ahead;
    out.row(f) = way * along;
  }
  return out;
}

}  // namespace kinemark::analysis
