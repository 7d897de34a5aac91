// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/filtering.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>
#include <vector>

namespace kinemark::data {
namespace {

constexpr std::string_view kSmoothedBy = "smoothed by ";

/// "0.21 to 0.4", or one number where both ends read alike; empty without a finite number.
std::string range_of(const std::vector<double>& values) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double v : values)
    if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
  if (low > high) return "";
  const std::string a = fmt::format("{:.3g}", low), b = fmt::format("{:.3g}", high);
  return a == b ? a : a + " to " + b;
}

/// What stood before "smoothed by", without the comma between them.
std::string before_smoothing(std::string_view method) {
  const auto at = method.find(kSmoothedBy);
  if (at == std::string_view::npos) return std::string(method);
  method = method.substr(0, at);
  if (method.ends_with(", ")) method.remove_suffix(2);
  return std::string(method);
}

void forget_smoothing(Trajectories& t) {
  std::vector<std::string> methods = std::exchange(t.methods, {});
  Array<std::uint8_t> numbers = std::exchange(t.method, {});
  if (numbers.empty()) return;
  for (std::string& name : methods) name = before_smoothing(name);
  for (std::int64_t f = 0; f < t.frames(); ++f)
    for (std::int64_t m = 0; m < t.markers(); ++m) {
      const auto k = numbers[t.index(f, m)];
      if (k == 0 || !t.present(f, m)) continue;
      if (const auto& name = methods[static_cast<std::size_t>(k - 1)]; !name.empty())
        t.set_method(f, m, name);
    }
}

}  // namespace

bool is_filter(const FilterUsed& used) { return !used.method.empty() && used.method != "none"; }

bool was_filtered(const Trajectories& t, std::int64_t marker) {
  return !t.filters.empty() && is_filter(t.filters[static_cast<std::size_t>(marker)]);
}

bool keeps_unfiltered(const Trajectories& t, std::int64_t marker) {
  if (t.unfiltered_in_world.empty()) return false;
  for (std::int64_t f = 0; f < t.frames(); ++f)
    if (std::isfinite(t.unfiltered_in_world[3 * t.index(f, marker)])) return true;
  return false;
}

std::string smoothed_by(std::string_view filter) { return std::string(kSmoothedBy) + std::string(filter); }

void mark_smoothed(Trajectories& t, std::int64_t marker, std::string_view filter) {
  const std::string name = smoothed_by(filter);
  for (std::int64_t f = 0; f < t.frames(); ++f) {
    if (t.state[t.index(f, marker)] != SampleState::measured) continue;
    const std::string earlier = before_smoothing(t.made_by(f, marker));
    t.set_method(f, marker, earlier.empty() ? name : earlier + ", " + name);
  }
}

FilterUsed one_after_other(const FilterUsed& first, const FilterUsed& then) {
  if (!is_filter(first)) return then;
  if (!is_filter(then)) return first;
  const bool known = std::isfinite(first.cutoff_hz) && std::isfinite(then.cutoff_hz);
  return {.method = first.method + ", " + then.method,
          .order = then.order,
          .cutoff_hz = known                            ? std::min(first.cutoff_hz, then.cutoff_hz)
                       : std::isfinite(first.cutoff_hz) ? first.cutoff_hz
                                                        : then.cutoff_hz,
          .noise_sd_m = std::numeric_limits<double>::quiet_NaN()};
}

bool restore_unfiltered(Trajectories& t) {
  bool any = false;
  for (std::int64_t m = 0; m < t.markers(); ++m) {
    if (!was_filtered(t, m)) continue;
    // A marker that was never seen has nothing that could be restored.
    bool seen = false;
    for (std::int64_t f = 0; f < t.frames() && !seen; ++f) seen = t.present(f, m);
    if (!seen) continue;
    if (!keeps_unfiltered(t, m)) return false;
    any = true;
  }
  if (!any) return false;
  for (std::int64_t m = 0; m < t.markers(); ++m) {
    if (!was_filtered(t, m)) continue;
    for (std::int64_t f = 0; f < t.frames(); ++f) {
      const std::size_t i = t.index(f, m);
      const Eigen::Map<const Eigen::Vector3d> raw(t.unfiltered_in_world.data() + 3 * i);
      if (raw.allFinite()) {
        t.x(f, m) = raw;
        t.state[i] = SampleState::measured;
      } else if (t.state[i] != SampleState::rejected) {
        t.set_missing(f, m);
      }
    }
  }
  forget_smoothing(t);
  t.filters.clear();
  t.unfiltered_in_world.clear();
  t.covariance.clear();
  return true;
}

std::string describe_filters(const Trajectories& t) {
  std::set<std::string> names;
  std::vector<double> order, cutoff_hz, noise_mm;
  std::int64_t filtered = 0, kept = 0;
  for (std::int64_t m = 0; m < t.markers(); ++m) {
    if (!was_filtered(t, m)) continue;
    const FilterUsed& used = t.filters[static_cast<std::size_t>(m)];
    ++filtered;
    kept += keeps_unfiltered(t, m);
    names.insert(used.method);
    if (used.order > 0) order.push_back(used.order);
    cutoff_hz.push_back(used.cutoff_hz);
    noise_mm.push_back(1e3 * used.noise_sd_m);
  }
  if (filtered == 0) return "";
  std::string by, facts;
  for (const std::string& name : names) by += (by.empty() ? "" : " or ") + name;
  const auto add = [&](std::string_view before, const std::vector<double>& values, std::string_view after) {
    if (const std::string range = range_of(values); !range.empty())
      facts += fmt::format("{}{}{}{}", facts.empty() ? " (" : "; ", before, range, after);
  };
  add("order ", order, "");
  add("-3 dB at ", cutoff_hz, " Hz");
  add("noise before it ", noise_mm, " mm");
  if (!facts.empty()) facts += ")";
  const std::string whose =
      filtered == t.markers() ? fmt::format("{}", filtered) : fmt::format("{} of {}", filtered, t.markers());
  return fmt::format("{} {} smoothed by {}{}; {}", whose,
                     t.markers() == 1 ? "marker was"
                     : filtered == 1  ? "markers was"
                                      : "markers were",
                     by, facts,
                     kept == filtered ? "the samples from before are kept beside them"
                     : kept == 0      ? "the samples from before are not there"
                                      : fmt::format("the samples from before are kept of {} of them", kept));
}

std::string note_on_noise(const Trajectories& t) {
  const std::string filters = describe_filters(t);
  if (filters.empty()) return "";
  return filters +
         "; noise that is found in the smoothed samples, and deviations that rest on it, are too small";
}

}  // namespace kinemark::data
