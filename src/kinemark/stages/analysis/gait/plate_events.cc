// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/plate_events.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "kinemark/stages/analysis/gait/plate_contacts.h"

namespace kinemark::analysis {
namespace {

using data::FootEvent;
using data::Side;

constexpr double kLeastSd_s = 0.002, kSdInFrames = 0.2;
constexpr ContactLoads kLoads{};

// Seconds, and their SD, at which the load rises above and falls below what is a contact.
std::array<data::GaitEvent, 2> events_of(const LoadedPlate& plate, const PlateSpan& contact, Side side,
                                         const GaitPaths& paths) {
  const double limit = plate.begins(kLoads);
  std::int64_t last = contact.last;
  while (last > contact.first && plate.load(last) <= limit) --last;
  const auto one = [&](FootEvent what, std::int64_t f) {  // between frames f and f + 1
    const double a = plate.load(f), b = plate.load(f + 1);
    const double slope = std::abs(b - a) * paths.rate_hz;
    return data::GaitEvent{
        .side = side,
        .what = what,
        .time_s = paths.time_s(static_cast<double>(f) + (limit - a) / (b - a)),
        .sd_s = std::hypot(kLeastSd_s, kSdInFrames / paths.rate_hz, plate.noise_n() / slope),
        .source = data::EventSource::plate,
        .method = plate.wrench().name};
  };
  return {one(FootEvent::strike, contact.first - 1), one(FootEvent::off, last)};
}

}  // namespace

PlateEvents find_plate_events(const data::Wrenches& plates, const GaitPaths& paths,
                              const Eigen::Matrix3d& upright) {
  PlateEvents out;
  const auto frames = std::min(plates.frames(), paths.frames());
  for (const auto& wrench : plates.items) {
    const LoadedPlate plate(wrench, frames, upright);
    for (const auto& contact : plate.contacts(paths.rate_hz, kLoads)) {
      const double from = paths.time_s(static_cast<double>(contact.first)),
                   to = paths.time_s(static_cast<double>(contact.last));
      const auto note = [&](std::string_view why) {
        out.notes.push_back(
            fmt::format("{}, {:.2f} to {:.2f} s, tells of no event: {}", wrench.name, from, to, why));
      };
      const auto stands = plate.foot_of(contact, paths, kLoads);
      if (!stands)
        note("the force does not stay under one foot");
      else if (!plate.bears_whole(contact, paths.foot(*stands)))
        note("the foot was not wholly on the plate");
      else
        for (auto& event : events_of(plate, contact, *stands, paths)) out.events.push_back(std::move(event));
    }
  }
  return out;
}

}  // namespace kinemark::analysis
