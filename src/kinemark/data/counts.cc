// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/counts.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>

#include "kinemark/data/rig.h"

namespace kinemark::data {
namespace {

Status check_names(const std::vector<std::string>& names, std::string_view what) {
  std::set<std::string_view> seen;
  for (const std::string& name : names) {
    if (name.empty()) return fail(Code::bad_input, fmt::format("counts: a {} has no name", what));
    if (!seen.insert(name).second)
      return fail(Code::bad_input, fmt::format("counts: {} name '{}' occurs twice", what, name));
  }
  return {};
}

Status check_size(std::size_t have, std::int64_t need, std::string_view what) {
  if (have == static_cast<std::size_t>(need)) return {};
  return fail(Code::bad_input, fmt::format("counts: {} numbers of {}; need {}", have, what, need));
}

Status check_codes(const Array<std::int16_t>& codes, std::int16_t highest, std::string_view what) {
  const auto wrong =
      std::ranges::find_if(codes, [highest](std::int16_t code) { return code < 0 || code > highest; });
  if (wrong == codes.end()) return {};
  return fail(Code::bad_input, fmt::format("counts: {} number {} is {}; the converter goes from 0 to {}",
                                           what, wrong - codes.begin(), *wrong, highest));
}

}  // namespace

Counts Counts::zeros(std::vector<std::string> leds, std::vector<std::string> cameras, const TimeBase& time,
                     bool dark_slot) {
  Counts out;
  out.leds = std::move(leds);
  out.cameras = std::move(cameras);
  out.time = time;
  const auto frames = static_cast<std::size_t>(time.frames);
  out.counts.assign(4 * frames * out.leds.size() * out.cameras.size(), 0);
  out.conversion_time_s.assign(4 * out.leds.size() * out.cameras.size(), 0.0);
  out.flags.assign(frames * out.leds.size() * out.cameras.size(), 0);
  if (dark_slot) {
    out.dark.assign(4 * frames * out.cameras.size(), 0);
    out.dark_time_s.assign(4 * out.cameras.size(), 0.0);
  }
  return out;
}

Status Counts::validate() const {
  if (frames() < 0) return fail(Code::bad_input, fmt::format("counts: {} frames; need 0 or more", frames()));
  if (!(time.rate_hz > 0.0) || !std::isfinite(time.rate_hz) || !std::isfinite(time.t0_s))
    return fail(Code::bad_input, fmt::format("counts: {} frames per second from {} s; need a positive number "
                                             "and a time",
                                             time.rate_hz, time.t0_s));
  if (auto s = check_names(leds, "LED"); !s) return s;
  if (auto s = check_names(cameras, "camera"); !s) return s;
  const std::int64_t observations = led_count() * camera_count();
  if (auto s = check_size(counts.size(), 4 * frames() * observations, "counts"); !s) return s;
  if (auto s = check_size(flags.size(), frames() * observations, "flags"); !s) return s;
  if (auto s = check_size(conversion_time_s.size(), 4 * observations, "conversion times"); !s) return s;
  if (!dark_time_s.empty())
    if (auto s = check_size(dark_time_s.size(), 4 * camera_count(), "dark conversion times"); !s) return s;
  if (auto s =
          check_size(dark.size(), dark_time_s.empty() ? 0 : 4 * frames() * camera_count(), "dark counts");
      !s)
    return s;
  if (auto s = check_codes(counts, highest_code, "count"); !s) return s;
  if (auto s = check_codes(dark, highest_code, "dark count"); !s) return s;
  for (const auto* times : {&conversion_time_s, &dark_time_s})
    for (const double t : *times)
      if (!(std::abs(t) * time.rate_hz <= 2.0))
        return fail(Code::bad_input,
                    fmt::format("counts: a conversion {} s after its frame; frames are {} s apart", t,
                                1.0 / time.rate_hz));
  return {};
}

Status check_same_rig(const Counts& counts, const Rig& rig) {
  if (!counts.rig_id.empty() && !rig.id.empty() && counts.rig_id != rig.id)
    return fail(Code::bad_input,
                fmt::format("the recording was made with rig '{}', this rig is '{}'", counts.rig_id, rig.id));
  if (counts.camera_count() != rig.camera_count())
    return fail(Code::bad_input,
                fmt::format("the recording has {} cameras and the rig {}; they must be the same",
                            counts.camera_count(), rig.camera_count()));
  return {};
}

}  // namespace kinemark::data
