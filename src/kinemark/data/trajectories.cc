// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/trajectories.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <span>

#include "kinemark/core/check.h"
#include "kinemark/core/enum_names.h"

namespace kinemark::data {

std::string_view to_string(SampleState state) {
  static constexpr EnumNames<SampleState::rejected> kNames{"missing",      "measured",  "interpolated",
                                                           "model_filled", "upsampled", "rejected"};
  return kNames[state];
}

void Trajectories::set_missing(std::int64_t frame, std::int64_t marker, SampleState why) {
  x(frame, marker).setConstant(std::numeric_limits<double>::quiet_NaN());
  state[index(frame, marker)] = why;
  // What is taken away was not measured, before its filter neither.
  if (!unfiltered_in_world.empty())
    std::fill_n(unfiltered_in_world.begin() + static_cast<std::ptrdiff_t>(3 * index(frame, marker)), 3,
                std::numeric_limits<double>::quiet_NaN());
}

std::string_view Trajectories::made_by(std::int64_t frame, std::int64_t marker) const {
  const std::uint8_t k = method.empty() ? 0 : method[index(frame, marker)];
  return k == 0 ? std::string_view() : methods[static_cast<std::size_t>(k - 1)];
}

void Trajectories::set_method(std::int64_t frame, std::int64_t marker, std::string_view name) {
  if (method.empty()) method.assign(static_cast<std::size_t>(frames() * markers()), 0);
  auto at = std::ranges::find(methods, name);
  if (at == methods.end()) {
    check(methods.size() < 255, "trajectories hold 255 methods at most");
    at = methods.emplace(methods.end(), name);
  }
  method[index(frame, marker)] = static_cast<std::uint8_t>(at - methods.begin() + 1);
}

double Trajectories::time_s(std::int64_t frame, std::int64_t marker) const {
  const double t = time.time_s(frame);
  if (sample_offset_s.empty()) return t;
  const bool per_marker = sample_offset_s.size() == names.size();
  return t + sample_offset_s[per_marker ? static_cast<std::size_t>(marker) : index(frame, marker)];
}

std::int64_t Trajectories::find(std::string_view name) const {
  const auto it = std::ranges::find(names, name);
  return it == names.end() ? -1 : it - names.begin();
}

std::int64_t Trajectories::count_missing() const {
  // In pieces, whose narrow sums let the compiler count many at once.
  constexpr std::size_t kPiece = 1 << 16;
  std::int64_t out = 0;
  for (std::size_t begin = 0; begin < state.size(); begin += kPiece) {
    const auto piece = std::span(state).subspan(begin, std::min(kPiece, state.size() - begin));
    std::int32_t count = 0;
    for (const SampleState s : piece)
      count += static_cast<std::int32_t>(s == SampleState::missing) |
               static_cast<std::int32_t>(s == SampleState::rejected);
    out += count;
  }
  return out;
}

Trajectories Trajectories::all_missing(std::vector<std::string> names, const TimeBase& time) {
  Trajectories t;
  t.names = std::move(names);
  t.time = time;
  const auto samples = static_cast<std::size_t>(t.frames() * t.markers());
  t.x_in_world.assign(3 * samples, std::numeric_limits<double>::quiet_NaN());
  t.state.assign(samples, SampleState::missing);
  return t;
}

Status Trajectories::validate() const {
  const auto samples = static_cast<std::size_t>(std::max<std::int64_t>(0, frames()) * markers());
  if (frames() < 0)
    return fail(Code::bad_input, fmt::format("trajectories have {} frames; need 0 or more", frames()));
  if (!(time.rate_hz > 0.0) || !std::isfinite(time.rate_hz))
    return fail(Code::bad_input,
                fmt::format("trajectories have a rate of {} Hz; need a positive number", time.rate_hz));
  if (!std::isfinite(time.t0_s))
    return fail(Code::bad_input, "trajectories start at a time that is not a number");
  if (x_in_world.size() != 3 * samples || state.size() != samples)
    return fail(
        Code::bad_input,
        fmt::format(
            "trajectories of {} frames and {} markers hold {} coordinates and {} states; need {} and {}",
            frames(), markers(), x_in_world.size(), state.size(), 3 * samples, samples));
  if (!covariance.empty() && covariance.size() != 6 * samples)
    return fail(Code::bad_input, fmt::format("trajectories hold {} covariance numbers; need {} or none",
                                             covariance.size(), 6 * samples));
  if (!method.empty() && method.size() != samples)
    return fail(Code::bad_input,
                fmt::format("trajectories hold {} method numbers; need {} or none", method.size(), samples));
  if (!method.empty() && *std::ranges::max_element(method) > methods.size())
    return fail(Code::bad_input, fmt::format("a sample was made by method {}; there are {}",
                                             *std::ranges::max_element(method), methods.size()));
  if (!sample_offset_s.empty() && sample_offset_s.size() != names.size() && sample_offset_s.size() != samples)
    return fail(Code::bad_input, fmt::format("trajectories hold {} sample times; need {}, {} or none",
                                             sample_offset_s.size(), names.size(), samples));
  if (!filters.empty() && filters.size() != names.size())
    return fail(Code::bad_input, fmt::format("trajectories name the filters of {} markers; need {} or none",
                                             filters.size(), names.size()));
  if (!unfiltered_in_world.empty() && unfiltered_in_world.size() != 3 * samples)
    return fail(Code::bad_input, fmt::format("trajectories hold {} unfiltered coordinates; need {} or none",
                                             unfiltered_in_world.size(), 3 * samples));
  std::set<std::string_view> seen;
  for (const std::string& name : names) {
    if (name.empty()) return fail(Code::bad_input, "a marker has no name");
    if (!seen.insert(name).second)
      return fail(Code::bad_input, fmt::format("marker name '{}' occurs twice", name));
  }
  for (std::int64_t f = 0; f < frames(); ++f) {
    for (std::int64_t m = 0; m < markers(); ++m) {
      const auto p = x(f, m);
      if (present(f, m) ? !p.allFinite() : !p.array().isNaN().all())
        return fail(Code::bad_input,
                    fmt::format("marker '{}' frame {} is marked {} but its coordinates are {} {} {}",
                                names[static_cast<std::size_t>(m)], f, to_string(state[index(f, m)]), p.x(),
                                p.y(), p.z()));
    }
  }
  return {};
}

}  // namespace kinemark::data
