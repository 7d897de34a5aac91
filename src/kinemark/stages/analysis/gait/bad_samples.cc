// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/bad_samples.h"

#include <algorithm>
#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/math/statistics.h"

namespace kinemark::analysis {
namespace {

constexpr double kLeap_m = 0.06, kLeap_m_per_s2 = 60.0, kLeapInMedians = 6.0;
constexpr std::int64_t kLeastHeld = 3;
constexpr double kHeldEnds_m = 0.03, kHeldEndsInSteps = 3.0;
constexpr double kLongHeld_s = 0.6, kFine_m = 2e-5;

class Judge {
 public:
  Judge(const data::Trajectories& markers, std::int64_t marker) : markers_(markers), marker_(marker) {
    for (std::int64_t f = 0; f < markers.frames(); ++f)
      out_.seen.push_back(markers.state[markers.index(f, marker)] == data::SampleState::measured);
  }

  SamplesBelieved judge() {
    find_held();
    find_leaps();
    return std::move(out_);
  }

 private:
  [[nodiscard]] auto x(std::int64_t f) const { return markers_.x(f, marker_); }

  // Step from a frame to the next, m; infinite where one of them is not seen.
  [[nodiscard]] double step(std::int64_t f) const {
    if (f + 1 >= markers_.frames() || !out_.seen[at(f)] || !out_.seen[at(f + 1)]) return INFINITY;
    return (x(f + 1) - x(f)).norm();
  }

  // The smallest change of a coordinate that there is, m: what the file resolves.
  [[nodiscard]] double resolution() const {
    double least = INFINITY;
    for (std::int64_t f = 0; f + 1 < markers_.frames(); ++f)
      if (out_.seen[at(f)] && out_.seen[at(f + 1)])
        for (int axis = 0; axis < 3; ++axis)
          if (const double d = std::abs(x(f + 1)[axis] - x(f)[axis]); d > 0.0) least = std::min(least, d);
    return least;
  }

  void find_held() {
    const std::int64_t n = markers_.frames();
    const auto lasts = static_cast<std::int64_t>(std::ceil(kLongHeld_s * markers_.time.rate_hz));
    std::vector<FrameSpan> held;
    for (std::int64_t f = 0; f < n; ++f) {
      if (step(f) != 0.0) continue;
      std::int64_t last = f;
      while (step(last) == 0.0) ++last;
      const double leap = step(last), next = last + 1 < n ? step(last + 1) : INFINITY;
      const bool ends_in_leap =
          std::isfinite(leap) && std::isfinite(next) && leap > kHeldEnds_m && leap > kHeldEndsInSteps * next;
      const std::int64_t count = last - f + 1;
      if ((count > kLeastHeld && ends_in_leap) || (count >= lasts && resolution() < kFine_m))
        held.push_back({.first = f + 1, .last = last});
      f = last;
    }
    for (const auto& span : held)
      std::fill(out_.seen.begin() + span.first, out_.seen.begin() + span.last + 1, false);
    out_.held = std::move(held);
  }

  void find_leaps() {
    std::vector<std::int64_t> frames;
    std::vector<double> aside;
    std::int64_t before = -1, two_before = -1;
    for (std::int64_t f = 0; f < markers_.frames(); ++f) {
      if (!out_.seen[at(f)]) continue;
      if (two_before >= 0) {
        aside.push_back((x(before) - 0.5 * (x(two_before) + x(f))).norm());
        frames.push_back(f - two_before == 2 ? before : -1);
      }
      two_before = before, before = f;
    }
    if (aside.size() < 3) return;
    const double rate = markers_.time.rate_hz;
    const double most =
        std::max(kLeap_m, kLeap_m_per_s2 / (rate * rate)) + kLeapInMedians * math::median(aside);
    for (std::size_t i = 0; i < aside.size(); ++i)
      if (frames[i] >= 0 && aside[i] > most) {
        out_.seen[at(frames[i])] = false;
        ++out_.leaps;
      }
  }

  const data::Trajectories& markers_;
  std::int64_t marker_;
  SamplesBelieved out_;
};

}  // namespace

SamplesBelieved believe_samples(const data::Trajectories& markers, std::int64_t marker) {
  return Judge(markers, marker).judge();
}

}  // namespace kinemark::analysis
