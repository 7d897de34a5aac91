// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "kinemark/core/index.h"
#include "kinemark/data/filtering.h"
#include "kinemark/workflow/prepare/marker_screening.h"

namespace kinemark::workflow {
namespace {

using data::Trajectories;

constexpr double kSameInstant_s = 1e-6;  // instants of one frame that differ less are one
constexpr std::int64_t kReach = 3;       // frames to either side in which neighbours are sought
constexpr double kFarthest = 1.0;        // frames from the nearest sample beyond which nothing is made of it

double offset_s(const Trajectories& t, std::int64_t f, std::int64_t m) {
  return t.sample_offset_s.size() == t.names.size() ? t.sample_offset_s[at(m)]
                                                    : t.sample_offset_s[t.index(f, m)];
}

/// The largest difference between instants of one frame, s.
double most_apart_s(const Trajectories& t) {
  double most = 0.0;
  for (std::int64_t f = 0; f < t.frames(); ++f) {
    double first = INFINITY, last = -INFINITY;
    for (std::int64_t m = 0; m < t.markers(); ++m) {
      if (!t.present(f, m)) continue;
      first = std::min(first, offset_s(t, f, m));
      last = std::max(last, offset_s(t, f, m));
    }
    most = std::max(most, last - first);
  }
  return most;
}

/// Samples of one marker that make its position at the frame's time, with their weights.
struct Mixture {
  int count = 0;
  std::array<std::int64_t, 4> frame{};
  std::array<double, 4> weight{};
};

/// The frame whose sample lies about where this frame's time is: its own unless offsets are of a frame or
/// more.
std::int64_t nearest_frame(const Trajectories& t, std::int64_t f, std::int64_t m) {
  const double late = offset_s(t, f, m) * t.time.rate_hz;
  return std::abs(late) < 1.0 ? f : f - std::llround(late);
}

/// Lagrange's polynomial through up to two samples before the frame's time and two behind it; the line
/// through the nearest two where one side has none; the sample itself where it was measured at that time.
Mixture mixture_at(const Trajectories& t, std::int64_t f, std::int64_t m) {
  const auto instant = [&](std::int64_t g) {  // in frames from the frame's time
    return static_cast<double>(g - f) + offset_s(t, g, m) * t.time.rate_hz;
  };
  const double same = kSameInstant_s * t.time.rate_hz;
  const std::int64_t middle = nearest_frame(t, f, m), first = std::max<std::int64_t>(middle - kReach, 0),
                     last = std::min(middle + kReach, t.frames() - 1);
  std::array<std::int64_t, 2> before{}, after{};
  int n_before = 0, n_after = 0;
  const auto add = [&](std::int64_t g, std::array<std::int64_t, 2>& side, int& count) {
    if (count < 2 && (count == 0 || std::abs(instant(g) - instant(side[0])) > same)) side[at(count++)] = g;
  };
  for (std::int64_t g = first; g <= last; ++g)
    if (t.present(g, m) && std::abs(instant(g)) <= same) return {.count = 1, .frame = {g}, .weight = {1.0}};
  for (std::int64_t g = last; g >= first; --g)
    if (t.present(g, m) && instant(g) < 0.0) add(g, before, n_before);
  for (std::int64_t g = first; g <= last; ++g)
    if (t.present(g, m) && instant(g) > 0.0) add(g, after, n_after);
  Mixture out;
  if (n_before == 0 || n_after == 0) {  // a line from one side
    const auto& side = n_before == 0 ? after : before;
    if (std::max(n_before, n_after) < 2 || std::abs(instant(side[0])) > kFarthest) return out;
    out.frame = {side[0], side[1]};
    out.count = 2;
  } else {
    for (int i = 0; i < n_before; ++i) out.frame[at(out.count++)] = before[at(i)];
    for (int i = 0; i < n_after; ++i) out.frame[at(out.count++)] = after[at(i)];
  }
  for (int i = 0; i < out.count; ++i) {
    double weight = 1.0;
    for (int k = 0; k < out.count; ++k)
      if (k != i)
        weight *= instant(out.frame[at(k)]) / (instant(out.frame[at(k)]) - instant(out.frame[at(i)]));
    out.weight[at(i)] = weight;
  }
  return out;
}

/// `values` numbers of a sample, mixed from another array's by weights or their squares.
void mix(const Mixture& mixture, const Trajectories& t, std::int64_t f, std::int64_t m, std::size_t values,
         bool squared, std::span<const double> from, std::span<double> to) {
  double* out = to.data() + values * t.index(f, m);
  std::fill_n(out, values, 0.0);
  for (int i = 0; i < mixture.count; ++i) {
    const double w = squared ? mixture.weight[at(i)] * mixture.weight[at(i)] : mixture.weight[at(i)];
    const double* sample = from.data() + values * t.index(mixture.frame[at(i)], m);
    for (std::size_t k = 0; k < values; ++k) out[k] += w * sample[k];
  }
}

}  // namespace

std::string bring_to_one_time(Trajectories& markers) {
  if (markers.sample_offset_s.empty()) return {};
  const double apart_s = most_apart_s(markers);
  if (apart_s < kSameInstant_s) return {};
  const Trajectories own = markers;
  std::int64_t alone = 0;
  for (std::int64_t m = 0; m < own.markers(); ++m) {
    const bool filtered = data::was_filtered(own, m);
    for (std::int64_t f = 0; f < own.frames(); ++f) {
      const std::int64_t about = nearest_frame(own, f, m);
      if (about < 0 || about >= own.frames() || !own.present(about, m)) {
        if (own.present(f, m)) markers.set_missing(f, m);
        continue;
      }
      const Mixture mixture = mixture_at(own, f, m);
      if (mixture.count == 0) {
        markers.set_missing(f, m);
        ++alone;
        continue;
      }
      const std::size_t to = own.index(f, m), from = own.index(about, m);
      markers.state[to] = own.state[from];
      if (!own.method.empty()) markers.method[to] = own.method[from];
      mix(mixture, own, f, m, 3, false, own.x_in_world, markers.x_in_world);
      if (!own.unfiltered_in_world.empty())
        mix(mixture, own, f, m, 3, false, own.unfiltered_in_world, markers.unfiltered_in_world);
      // Errors of filtered samples hardly differ from one to the next.
      if (!own.covariance.empty() && !filtered)
        mix(mixture, own, f, m, 6, true, own.covariance, markers.covariance);
    }
  }
  markers.sample_offset_s.clear();
  const std::string left_out =
      alone == 0 ? ""
                 : fmt::format(
                       "; samples without another beside them were left out ({}), for their place at "
                       "that time is not known",
                       alone);
  return fmt::format(
      "markers of a frame were measured up to {:.2g} ms apart; they were brought to the frame's time{}",
      1e3 * apart_s, left_out);
}

}  // namespace kinemark::workflow
