// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "acceptance/gait_recordings.h"
#include "kinemark/core/random.h"
#include "kinemark/stages/analysis/gait/gait_paths.h"
#include "support/acceptance.h"

namespace kinemark::acceptance {
namespace {

using analysis::Gait;
using data::GaitEvent;
using data::Side;
using testing_support::print_row;

constexpr double kNear_s = 0.15;

using Spoil = std::function<data::Trajectories(data::Trajectories, const analysis::GaitMarkers&, Random&)>;

data::Trajectories every(const data::Trajectories& in, double rate_hz) {
  const auto step = std::max<std::int64_t>(1, static_cast<std::int64_t>(in.time.rate_hz / rate_hz));
  auto out =
      data::Trajectories::all_missing(in.names, {.rate_hz = in.time.rate_hz / static_cast<double>(step),
                                                 .t0_s = in.time.t0_s,
                                                 .frames = in.frames() / step});
  for (std::int64_t f = 0; f < out.frames(); ++f)
    for (std::int64_t m = 0; m < out.markers(); ++m)
      if (in.present(f * step, m)) {
        out.x(f, m) = in.x(f * step, m);
        out.state[out.index(f, m)] = in.state[in.index(f * step, m)];
      }
  return out;
}

void each(data::Trajectories& markers, const std::function<void(std::int64_t, std::int64_t)>& change) {
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    for (std::int64_t m = 0; m < markers.markers(); ++m)
      if (markers.present(f, m)) change(f, m);
}

Spoil noise(double sd_m) {
  return [sd_m](data::Trajectories x, const analysis::GaitMarkers&, Random& random) {
    each(x, [&](auto f, auto m) {
      for (int axis = 0; axis < 3; ++axis) x.x(f, m)[axis] += sd_m * random.gaussian();
    });
    return x;
  };
}

data::Trajectories gaps(data::Trajectories x, const analysis::GaitMarkers& which, Random& random) {
  const double rate = x.time.rate_hz;
  for (const auto& foot : which.feet)
    for (const auto m : {foot.heel, foot.toe})
      for (double t = random.uniform(0.2, 1.0); m >= 0 && t * rate < static_cast<double>(x.frames());
           t += 1.0)
        for (double s = 0.0; s < 0.15 && (t + s) * rate < static_cast<double>(x.frames()) - 1.0;
             s += 1.0 / rate)
          x.set_missing(static_cast<std::int64_t>((t + s) * rate), m);
  return x;
}

data::Trajectories spikes(data::Trajectories x, const analysis::GaitMarkers& which, Random& random) {
  for (const auto& foot : which.feet)
    for (const auto m : {foot.heel, foot.toe})
      for (std::int64_t f = 0; m >= 0 && f < x.frames(); ++f)
        if (random.uniform() < 1.0 / 150.0 && x.present(f, m))
          x.x(f, m)[static_cast<int>(random.uniform(0.0, 3.0))] += 0.3;
  return x;
}

// Turned about the vertical, which then points along -x.
data::Trajectories turned(data::Trajectories x, const analysis::GaitMarkers& which, Random& random) {
  const auto upright = analysis::GaitSmoother::create(x, which, 0.0).value().upright();
  const double a = random.uniform(-3.0, 3.0);
  Eigen::Matrix3d turn, down;
  turn << std::cos(a), -std::sin(a), 0, std::sin(a), std::cos(a), 0, 0, 0, 1;
  down << 0, 0, -1, 0, 1, 0, 1, 0, 0;
  const Eigen::Matrix3d all = down * turn * upright;
  each(x, [&](auto f, auto m) { x.x(f, m) = (all * x.x(f, m)).eval(); });
  return x;
}

struct Scores {
  int found = 0, all = 0, extra = 0, ours = 0, same_kind = 0, runs = 0;
  std::string changed;
};

// Events of the spoiled recording beside those of the whole one, away from the ends.
void compare(const GaitFound& whole, const data::Trajectories& spoiled, Scores& out) {
  ++out.runs;
  const auto gait = by_markers(spoiled);
  const double from = spoiled.time.time_s(0) + kEnd_s,
               to = spoiled.time.time_s(spoiled.frames() - 1) - kEnd_s;
  const std::vector<GaitEvent> none;
  const auto& events = gait ? gait->events : none;
  for (const auto& event : whole.gait.events)
    if (event.time_s > from && event.time_s < to) {
      ++out.all;
      out.found += nearest(events, event) != nullptr;
    }
  for (const auto& event : events)
    if (event.time_s > from && event.time_s < to) {
      ++out.ours;
      out.extra += nearest(whole.gait.events, event) == nullptr;
    }
  const bool same =
      gait && gait->kind.manner == whole.gait.kind.manner && gait->kind.belt == whole.gait.kind.belt;
  out.same_kind += same;
  if (!same)
    out.changed +=
        fmt::format("; {}: {}", whole.recording.file, gait ? kind_of(*gait) : gait.error().message);
}

}  // namespace

Result<Gait> by_markers(const data::Trajectories& markers, std::int64_t refits) {
  return analysis::analyze_gait(
      markers, {}, {.choice = analysis::EventChoice::kinematics, .refits = refits, .threads = 0});
}

const GaitEvent* nearest(const std::vector<GaitEvent>& events, const GaitEvent& to) {
  const GaitEvent* best = nullptr;
  for (const auto& event : events)
    if (event.side == to.side && event.what == to.what && std::abs(event.time_s - to.time_s) < kNear_s &&
        (best == nullptr || std::abs(event.time_s - to.time_s) < std::abs(best->time_s - to.time_s)))
      best = &event;
  return best;
}

std::string kind_of(const Gait& gait) {
  return fmt::format(
      "{} {} {}", to_string(gait.kind.manner), gait.kind.belt ? "treadmill" : "ground",
      gait.kind.direction == analysis::GaitDirection::unknown ? "?" : to_string(gait.kind.direction));
}

double share(double of, double all) { return 100.0 * of / std::max(1.0, all); }

void judge_spoils(const std::vector<GaitFound>& recordings, std::uint64_t seed) {
  const std::vector<std::pair<std::string, Spoil>> spoils{
      {"33 Hz", [](const auto& x, const auto&, auto&) { return every(x, 33.0); }},
      {"25 Hz", [](const auto& x, const auto&, auto&) { return every(x, 25.0); }},
      {"noise 5 mm", noise(0.005)},
      {"noise 10 mm", noise(0.01)},
      {"gaps of 0.15 s each second", gaps},
      {"leaps of 300 mm", spikes},
      {"axes exchanged and turned", turned}};
  for (const auto& [name, spoil] : spoils) {
    Scores scores;
    Random random(seed, 100 + name.size());
    for (const auto& one : recordings) {
      const auto which = analysis::find_gait_markers(one.trial.markers).value();
      compare(one, spoil(one.trial.markers, which, random), scores);
    }
    print_row(share(scores.found, scores.all) >= 98.0 && share(scores.extra, scores.ours) <= 2.0,
              "gait_events, " + name, ">= 98 % found, <= 2 % more",
              fmt::format("{} of {}, {} more; walk or run and surface kept in {} of {}{}", scores.found,
                          scores.all, scores.extra, scores.same_kind, scores.runs, scores.changed));
  }
}

void judge_hidden(const std::vector<GaitFound>& recordings, std::uint64_t seed) {
  for (const bool held : {false, true}) {
    Random random(seed, held ? 71 : 72);
    int said = 0, all = 0, kept = 0, others = 0;
    for (const auto& one : recordings)
      for (const Side side : data::kBothSides) {
        auto markers = one.trial.markers;
        const auto which = analysis::find_gait_markers(markers).value();
        const auto n = markers.frames();
        const auto from = static_cast<std::int64_t>(random.uniform(0.05, 0.55) * static_cast<double>(n)),
                   to = from + static_cast<std::int64_t>(0.4 * static_cast<double>(n));
        for (const auto m : {which.foot(side).heel, which.foot(side).toe})
          for (auto f = from + 1; f < to; ++f)
            if (!held)
              markers.set_missing(f, m);
            else if (markers.present(from, m) && markers.present(f, m))
              markers.x(f, m) = Eigen::Vector3d(markers.x(from, m));
        const auto gait = by_markers(markers);
        ++all;
        const std::string foot = side == Side::left ? "left" : "right";
        said += !gait || std::ranges::any_of(gait->notes, [&](const auto& note) {
          return (note.find(foot + " foot") != note.npos && note.find("hidden") != note.npos) ||
                 note.find("no marker of the " + foot + " foot that is seen") != note.npos;
        });
        for (const auto& event : one.gait.events)
          if (event.side != side) {
            ++others;
            kept += gait && nearest(gait->events, event) != nullptr;
          }
      }
    const std::string name = held ? "gait_events, a foot held still" : "gait_events, a foot hidden";
    print_row(said == all, name + ", said", "always", fmt::format("{} of {}", said, all));
    print_row(share(kept, others) >= 95.0, name + ", the other foot's events", ">= 95 %",
              fmt::format("{} of {}", kept, others));
  }
}

}  // namespace kinemark::acceptance
