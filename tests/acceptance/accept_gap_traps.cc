// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What goes wrong in real marker sets: swapped labels, another subject, noise, few markers. `automatic` must
// be no worse than a prototype with a gate, and report when two markers of a rigid group have exchanged
// labels. Usage: accept_gap_traps GAPS_PER_TRIAL [SEED]
#include <fmt/core.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "acceptance/gap_trials.h"
#include "kinemark/core/parallel.h"
#include "kinemark/core/random.h"
#include "kinemark/math/statistics.h"
#include "kinemark/stages/trajectory/gaps/candidates.h"
#include "kinemark/stages/trajectory/gaps/fill_gaps.h"
#include "support/acceptance.h"
#include "support/test_data.h"

namespace {

using namespace kinemark;
using namespace kinemark::testing_support;
using data::Trajectories;

constexpr std::array kTrials = {"cmu-mocap/cmu_02_05.c3d",
                                "cmu-mocap/85_02.c3d",
                                "biobuddy/right_knee.c3d",
                                "btk-others/FunctionalLHip.c3d",
                                "opensim-hamner-fullbody/subject02_running.trc",
                                "c3d-org/sample13/Dance.c3d"};

struct Trap {
  const char* name;
  double rms_mm, median_mm;  // of the prototype with its gate
};
constexpr std::array<Trap, 7> kTraps = {{{"clean", 3.97, 1.57},
                                         {"target swapped with a neighbour in 10 % of the trial", 6.86, 2.92},
                                         {"two predictors of the segment swapped in the gap", 69.0, 7.3},
                                         {"predictor swapped with a far marker in the gap", 21.0, 2.25},
                                         {"another subject's markers added", 3.97, 1.57},
                                         {"white noise of 1 mm on every marker", 4.39, 2.37},
                                         {"one marker in five left", 30.0, 4.7}}};

struct Case {
  std::size_t trial = 0, trap = 0;
  Trajectories markers;  // with the trap, without the gap
  std::int64_t marker = 0, first = 0, frames = 0;
  Eigen::MatrixXd truth;
  std::pair<std::int64_t, std::int64_t> swapped{-1, -1};
  double rms_m = 0.0, inside_1 = 0.0, inside_2 = 0.0;
  bool flagged = false;
};

void swap(Trajectories& t, std::int64_t a, std::int64_t b, std::int64_t first, std::int64_t end) {
  for (std::int64_t f = first; f < end; ++f) {
    const Eigen::Vector3d x = t.x(f, a);
    t.x(f, a) = t.x(f, b);
    t.x(f, b) = x;
    std::swap(t.state[t.index(f, a)], t.state[t.index(f, b)]);
  }
}

Trajectories select(const Trajectories& t, const std::vector<std::int64_t>& kept) {
  std::vector<std::string> names;
  for (const std::int64_t m : kept) names.push_back(t.names[static_cast<std::size_t>(m)]);
  Trajectories out = Trajectories::all_missing(names, t.time);
  for (std::int64_t f = 0; f < t.frames(); ++f)
    for (std::size_t k = 0; k < kept.size(); ++k) {
      out.x(f, static_cast<std::int64_t>(k)) = t.x(f, kept[k]);
      out.state[out.index(f, static_cast<std::int64_t>(k))] = t.state[t.index(f, kept[k])];
    }
  return out;
}

/// Side by side in one recording, 1.5 m away; the guest holds still when its recording is over.
Trajectories add_subject(const Trajectories& t, const Trajectories& guest) {
  std::vector<std::string> names = t.names;
  for (const std::string& name : guest.names) names.push_back("guest " + name);
  Trajectories out = Trajectories::all_missing(names, t.time);
  for (std::int64_t f = 0; f < t.frames(); ++f)
    for (std::int64_t m = 0; m < out.markers(); ++m) {
      const bool own = m < t.markers();
      const Trajectories& from = own ? t : guest;
      const std::int64_t at = own ? f : std::min(f, guest.frames() - 1);
      const std::int64_t k = own ? m : m - t.markers();
      if (!from.present(at, k)) continue;
      out.x(f, m) = from.x(at, k) + (own ? Eigen::Vector3d::Zero() : Eigen::Vector3d::Constant(1.5)).eval();
      out.state[out.index(f, m)] = data::SampleState::measured;
    }
  return out;
}

/// One gap of 0.5 s with every trap.
void add_cases(const std::vector<GapTrial>& trials, std::size_t index, int gaps, std::uint64_t seed,
               std::vector<Case>& out) {
  const Trajectories& t = trials[index].markers;
  const auto h = static_cast<std::int64_t>(std::clamp(std::round(0.3 * t.time.rate_hz), 6.0, 60.0));
  const std::int64_t frames = std::lround(0.5 * t.time.rate_hz);
  Random random(seed, 200 + index);
  const auto draw = [&](std::int64_t n) {
    return std::min(n - 1, static_cast<std::int64_t>(random.uniform() * static_cast<double>(n)));
  };
  int done = 0;
  for (int tries = 0; tries < 20 * gaps && done < gaps; ++tries) {
    const std::int64_t marker = draw(t.markers());
    const std::int64_t first = h + draw(t.frames() - frames - 2 * h);
    const auto segment = find_segment(t, marker);
    if (!complete(t, marker, first - h, first + frames + h) || segment.size() < 3) continue;
    ++done;
    const std::int64_t end = first + frames;
    Case base{.trial = index,
              .markers = t,
              .marker = marker,
              .first = first,
              .frames = frames,
              .truth = Eigen::MatrixXd(frames, 3)};
    for (std::int64_t i = 0; i < frames; ++i) base.truth.row(i) = t.x(first + i, marker).transpose();
    const std::int64_t from = draw(t.frames() - t.frames() / 10);
    std::int64_t far = draw(t.markers());
    while (std::ranges::find(segment, far) != segment.end()) far = draw(t.markers());
    for (std::size_t trap = 0; trap < kTraps.size(); ++trap) {
      Case c = base;
      c.trap = trap;
      if (trap == 1) {
        for (std::int64_t f = from; f < from + t.frames() / 10; ++f)
          if (f < first - h || f >= end + h) swap(c.markers, marker, segment[1], f, f + 1);
      } else if (trap == 2) {
        swap(c.markers, segment[1], segment[2], first - h, end + h);
        c.swapped = std::minmax(segment[1], segment[2]);
      } else if (trap == 3) {
        swap(c.markers, segment[1], far, first - h, end + h);
      } else if (trap == 4) {
        c.markers = add_subject(t, trials[(index + 1) % trials.size()].markers);
      } else if (trap == 5) {
        for (std::int64_t f = 0; f < t.frames(); ++f)
          for (std::int64_t m = 0; m < t.markers(); ++m)
            for (int axis = 0; axis < 3; ++axis) {
              const double noise = 1e-3 * random.gaussian();
              if (t.present(f, m)) c.markers.x(f, m)(axis) += noise;
            }
      } else if (trap == 6) {
        std::vector<std::int64_t> kept = {marker};
        for (std::int64_t k = 0, m = 0; m < t.markers(); ++m) {
          if (m == marker) continue;
          if (k % 5 == 0) kept.push_back(m);
          ++k;
        }
        c.markers = select(t, kept);
        c.marker = 0;
      }
      out.push_back(std::move(c));
    }
  }
}

void run(Case& c) {
  for (std::int64_t i = 0; i < c.frames; ++i) c.markers.set_missing(c.first + i, c.marker);
  const auto result = trajectory::compare_candidates(c.markers, c.marker, c.first, c.first + c.frames - 1);
  if (!result) throw std::runtime_error(result.error().message);
  c.rms_m = std::sqrt((result->x_in_world - c.truth).squaredNorm() / static_cast<double>(c.frames));
  const Eigen::ArrayXXd z = (result->x_in_world - c.truth).array().abs().colwise() / result->sd_m.array();
  c.inside_1 = (z < 1.0).cast<double>().mean();
  c.inside_2 = (z < 2.0).cast<double>().mean();
  if (c.swapped.first < 0) return;
  const auto check = trajectory::fill_gaps(c.markers, {.method = trajectory::GapMethod::none});
  if (!check) throw std::runtime_error(check.error().message);
  for (const auto& s : check->swaps)
    c.flagged |= s.subject == c.markers.names[static_cast<std::size_t>(c.swapped.first)] &&
                 s.partner == c.markers.names[static_cast<std::size_t>(c.swapped.second)] &&
                 s.first_frame < c.first + c.frames && s.last_frame >= c.first;
}

int run_check(int argc, char** argv) {
  const auto data = test_data_folder();
  if (!data) return skip_all("gap traps");
  const int gaps = argc > 1 ? std::atoi(argv[1]) : 10;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 5;
  std::vector<GapTrial> trials;
  for (const char* file : kTrials) trials.push_back(load_gap_trial(*data, file, 1600, seed, true));
  std::vector<Case> cases;
  std::vector<Case> all;
  for (std::size_t k = 0; k < trials.size(); ++k) {  // one trial at a time: each case holds its own copy
    cases.clear();
    add_cases(trials, k, gaps, seed, cases);
    parallel_for(static_cast<std::int64_t>(cases.size()), 1, 0, [&](std::int64_t a, std::int64_t b) {
      for (std::int64_t i = a; i < b; ++i) run(cases[static_cast<std::size_t>(i)]);
    });
    for (Case& c : cases) {
      c.markers = {};
      all.push_back(std::move(c));
    }
  }
  int flagged = 0;
  int swaps = 0;
  for (std::size_t trap = 0; trap < kTraps.size(); ++trap) {
    std::vector<double> rms;
    double square = 0.0, one = 0.0, two = 0.0;
    for (const Case& c : all) {
      if (c.trap != trap) continue;
      rms.push_back(1e3 * c.rms_m);
      square += 1e6 * c.rms_m * c.rms_m;
      one += c.inside_1;
      two += c.inside_2;
      swaps += c.swapped.first >= 0 ? 1 : 0;
      flagged += c.flagged ? 1 : 0;
    }
    const auto n = static_cast<double>(rms.size());
    const double pooled = std::sqrt(square / n);
    const double median = math::median(rms);
    const Trap& t = kTraps[trap];
    print_row(pooled <= t.rms_mm && median <= t.median_mm, fmt::format("gap trap: {}", t.name),
              fmt::format("RMS <= {:.2f} mm, median <= {:.2f} mm (with gate)", t.rms_mm, t.median_mm),
              fmt::format("{:.2f} mm, {:.2f} mm; inside the bars {:.0f}/{:.0f} %, {} gaps", pooled, median,
                          100 * one / n, 100 * two / n, rms.size()));
  }
  print_row(10 * flagged >= 9 * swaps, "gap trap: swap inside a rigid group is flagged",
            ">= 90 % of the swaps", fmt::format("{} of {}", flagged, swaps));
  return exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("gap_traps", run_check);

}  // namespace
