// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/event_labels.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace kinemark::analysis {
namespace {

using data::FootEvent;
using data::GaitEvent;
using data::Side;

constexpr double kApart_s = 0.15;    // beyond which two events are not the same instant
constexpr double kSds = 4.0;         // likewise
constexpr double kExplained = 0.75;  // of the events, by one cause
constexpr double kFits = 0.5;        // of the events as they are, at most, where one cause is named
constexpr double kSameInstant_s = 0.08;
constexpr std::ptrdiff_t kLeast = 3;  // events that one cause must explain
constexpr double kOwnStride = 0.4;    // of a stride: farther events are of another one
constexpr double kLongestShift_s = 10.0, kShiftStep_s = 0.01;
// Of a stride: what no stance and no swing lasts less than. A walk has both feet on the ground twice (its
// shortest swing here, at 0.3 m/s: 0.18), a sprint stands for 0.2.
constexpr double kWalkStance = 0.4, kWalkSwing = 0.1, kRunStance = 0.1, kRunSwing = 0.4;

GaitEvent changed(GaitEvent event, bool side, bool what, double earlier_s) {
  if (side) event.side = event.side == Side::left ? Side::right : Side::left;
  if (what) event.what = event.what == FootEvent::strike ? FootEvent::off : FootEvent::strike;
  event.time_s -= earlier_s;
  return event;
}

// From the nearest of the markers of its kind and side to the event; infinite where there is none.
struct Nearest {
  double later_s = std::numeric_limits<double>::infinity();
  double sd_s = 0.0;
};

Nearest nearest_of(const MarkerEvents& of_markers, const GaitEvent& event) {
  Nearest out;
  for (const auto& own : of_markers.events) {
    if (own.side != event.side || own.what != event.what) continue;
    const double later = event.time_s - own.time_s;
    if (std::abs(later) < std::abs(out.later_s))
      out = {later, std::hypot(std::isfinite(own.sd_s) ? own.sd_s : 0.0,
                               std::isfinite(event.sd_s) ? event.sd_s : 0.0)};
  }
  return out;
}

// What is said of an event that is too near before the one of the markers that ends what it would begin; or
// nothing.
std::string too_short(const MarkerEvents& of_markers, const GaitEvent& event) {
  const bool stands = event.what == FootEvent::strike, walks = of_markers.kind.manner == GaitManner::walk;
  const double least = of_markers.kind.stride_s *
                       (stands ? (walks ? kWalkStance : kRunStance) : (walks ? kWalkSwing : kRunSwing));
  const auto ends = changed(event, false, true, 0.0);
  for (const auto& own : of_markers.events) {
    if (own.side != ends.side || own.what != ends.what || own.time_s < event.time_s) continue;
    const double lasts = own.time_s - event.time_s;
    if (lasts + kSds * (std::isfinite(own.sd_s) ? own.sd_s : 0.0) >= least) return {};
    return fmt::format(
        "the file's {} {} at {:.3f} s lies {:.0f} ms before the {} that the markers show of that foot: "
        "no {} is so short",
        to_string(event.side), to_string(event.what), event.time_s, 1e3 * lasts, to_string(own.what),
        stands ? "stance" : "swing");
  }
  return {};
}

struct Fit {
  std::ptrdiff_t fitting = 0, judged = 0;
  [[nodiscard]] bool explains() const {
    return fitting >= kLeast && static_cast<double>(fitting) >= kExplained * static_cast<double>(judged);
  }
};

// Events that lie at one of the markers, of those within the time that markers tell of.
Fit fit_of(const MarkerEvents& of_markers, std::span<const GaitEvent> of_file, bool side, bool what,
           double earlier_s) {
  const auto [first, last] = std::ranges::minmax(of_markers.events, {}, &GaitEvent::time_s);
  Fit out;
  for (const auto& stored : of_file) {
    const auto event = changed(stored, side, what, earlier_s);
    if (event.time_s < first.time_s - kSameInstant_s || event.time_s > last.time_s + kSameInstant_s) continue;
    ++out.judged;
    const auto near = nearest_of(of_markers, event);
    if (std::abs(near.later_s) <= std::max(kSameInstant_s, 2.0 * near.sd_s)) ++out.fitting;
  }
  return out;
}

// The smallest shift that explains most of the events, or 0.
double shift_of(const MarkerEvents& of_markers, std::span<const GaitEvent> of_file) {
  const auto enough = std::max<std::ptrdiff_t>(kLeast, std::ssize(of_file) / 2);
  for (double size = kApart_s; size <= kLongestShift_s; size += kShiftStep_s)
    for (const double shift : {size, -size}) {
      const auto fit = fit_of(of_markers, of_file, false, false, shift);
      if (!fit.explains() || fit.judged < enough) continue;
      double sum = 0.0, count = 0.0;  // what is left goes to the shift
      for (const auto& event : of_file)
        if (const auto near = nearest_of(of_markers, changed(event, false, false, shift));
            std::abs(near.later_s) <= kApart_s)
          sum += near.later_s, count += 1.0;
      const double found = shift + sum / count;
      return std::abs(found) > kApart_s ? found : 0.0;
    }
  return 0.0;
}

}  // namespace

std::vector<std::string> contradicted_labels(const MarkerEvents& of_markers,
                                             std::span<const GaitEvent> of_file) {
  if (of_file.empty() || of_markers.events.empty() || !of_markers.kind.not_gait.empty()) return {};
  const auto as_they_are = fit_of(of_markers, of_file, false, false, 0.0);
  if (static_cast<double>(as_they_are.fitting) <=
      kFits * static_cast<double>(std::max<std::ptrdiff_t>(as_they_are.judged, kLeast))) {
    const auto all = [&](const Fit& fit) { return fmt::format("{} of {}", fit.fitting, fit.judged); };
    if (const auto fit = fit_of(of_markers, of_file, true, false, 0.0); fit.explains())
      return {
          fmt::format("left and right of the file's events are exchanged: {} lie at events of the markers "
                      "of the other foot",
                      all(fit))};
    if (const auto fit = fit_of(of_markers, of_file, false, true, 0.0); fit.explains())
      return {
          fmt::format("strikes and offs of the file's events are exchanged: {} lie at events of the "
                      "markers of the other kind",
                      all(fit))};
    if (const double shift = shift_of(of_markers, of_file); shift != 0.0)
      return {fmt::format(
          "the file's events run on another clock: {} lie at events of the markers when {:.0f} ms "
          "are {}",
          all(fit_of(of_markers, of_file, false, false, shift)), 1e3 * std::abs(shift),
          shift > 0.0 ? "taken off" : "added")};
  }
  std::vector<std::string> out;
  for (const auto& event : of_file) {
    const auto near = nearest_of(of_markers, event);
    const double apart = std::abs(near.later_s);
    if (!(apart > std::max(kApart_s, kSds * near.sd_s))) continue;
    const auto of_other = nearest_of(of_markers, changed(event, true, false, 0.0));
    if (std::abs(of_other.later_s) <= std::max(kSameInstant_s, 2.0 * of_other.sd_s))
      out.push_back(
          fmt::format("the file's {} {} at {:.3f} s lies at one that the markers show of the other foot",
                      to_string(event.side), to_string(event.what), event.time_s));
    else if (apart < kOwnStride * of_markers.kind.stride_s)
      out.push_back(fmt::format("{} foot: the file's {} at {:.3f} s lies {:.0f} ms {} that of the markers",
                                to_string(event.side), to_string(event.what), event.time_s, 1e3 * apart,
                                near.later_s > 0.0 ? "after" : "before"));
    else if (auto said = too_short(of_markers, event); !said.empty())
      out.push_back(std::move(said));
  }
  return out;
}

}  // namespace kinemark::analysis
