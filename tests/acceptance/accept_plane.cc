// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Circles, ellipses and their arcs of 0.6 to 20 turns: the three ratios of the axes, and whether their
// intervals hold the truth. Arguments: paths of each kind (default 60), first seed (default 1).
#include <fmt/core.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "kinemark/core/index.h"
#include "kinemark/core/parallel.h"
#include "kinemark/core/random.h"
#include "kinemark/stages/analysis/path/definitions.h"
#include "kinemark/stages/analysis/path/path_measures.h"
#include "studies/poizner/wheel_measures.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using testing_support::print_row;

constexpr std::array<std::string_view, 3> kRatios{"plane_axes_ratio", "plane_width_ratio", "ellipse_ratio"};

constexpr int kFewPaths = 20, kManyPaths = 300;  // from which a share says something, and its upper bound
constexpr double kNearlyWhole = 0.95;            // turns, which may be one with what is left at the ends
constexpr double kEnds_s = 0.17;                 // at both ends together, which measures leave out

// A point that goes around, at one pace or at one that comes and goes.
struct Around {
  bool circle = true;
  bool even = true;  // at one pace
  double turns = 1.0, ratio = 1.0, noise_m = 1e-3;
  analysis::PathSamples path;  // without noise
};

Around draw(bool circle, Random& random) {
  Around out{.circle = circle};
  const double rate = random.uniform() < 0.5 ? 100.0 : 200.0;
  const double turns_a_second = std::exp(random.uniform(std::log(0.4), std::log(2.0)));
  out.even = random.uniform() < 0.5;
  const double pace = out.even ? 0.0 : random.uniform(0.05, 0.3), pace_turns = random.uniform(0.3, 1.7),
               from = random.uniform(0.0, 6.3);
  out.turns = std::exp(random.uniform(std::log(0.65), std::log(20.0)));
  out.ratio = circle ? 1.0 : random.uniform(1.1, 3.0);
  out.noise_m = 1e-3 * std::exp(random.uniform(std::log(0.1), std::log(1.5)));
  const double minor = random.uniform(0.08, 0.3);
  const auto n = std::llround((out.turns / turns_a_second + kEnds_s) * rate) + 1;
  const Eigen::Matrix3d rotation =
      Eigen::Quaterniond(random.gaussian(), random.gaussian(), random.gaussian(), random.gaussian())
          .normalized()
          .toRotationMatrix();
  auto& path = out.path;
  path.rate_hz = rate;
  path.x.resize(n, 3), path.v.resize(n, 3);
  path.a = path.j = analysis::SeriesMatrix::Zero(n, 3);
  constexpr double kTurn = 2.0 * std::numbers::pi;
  for (std::int64_t i = 0; i < n; ++i) {
    const double even = kTurn * turns_a_second * static_cast<double>(i) / rate,
                 wave = pace_turns * even + from;
    const double phase = from + even - pace / pace_turns * std::cos(wave);
    const double speed = kTurn * turns_a_second * (1.0 + pace * std::sin(wave));
    const Eigen::Vector3d x(0.5 * out.ratio * minor * std::cos(phase), 0.5 * minor * std::sin(phase), 0.0);
    const Eigen::Vector3d v(-0.5 * out.ratio * minor * std::sin(phase), 0.5 * minor * std::cos(phase), 0.0);
    path.x.row(i) = (rotation * x).transpose();
    path.v.row(i) = speed * (rotation * v).transpose();
  }
  return out;
}

analysis::PathSamples part_of(const analysis::PathSamples& path, double start_s, double end_s) {
  const auto first = std::llround(start_s * path.rate_hz),
             count = std::llround(end_s * path.rate_hz) - first + 1;
  return {.rate_hz = path.rate_hz,
          .x = path.x.middleRows(first, count),
          .v = path.v.middleRows(first, count),
          .a = path.a.middleRows(first, count),
          .j = path.j.middleRows(first, count)};
}

// One ratio of one path.
struct Judged {
  bool circle = true, given = false, held = false;
  double turns = 1.0, error = kNaN, half_width = kNaN, study = kNaN, truth = kNaN;
};

std::array<Judged, 3> judge(bool circle, std::uint64_t seed) {
  Random random(seed, 31);
  const auto around = draw(circle, random);
  const auto n = around.path.count();
  auto markers = data::Trajectories::all_missing({"P"}, {.rate_hz = around.path.rate_hz, .frames = n});
  for (std::int64_t i = 0; i < n; ++i) {
    markers.x(i, 0) =
        around.path.x.row(i).transpose() +
        around.noise_m * Eigen::Vector3d(random.gaussian(), random.gaussian(), random.gaussian());
    markers.state[markers.index(i, 0)] = data::SampleState::measured;
  }
  const auto measured = analysis::measure_paths(markers, {.seed = seed});
  std::array<Judged, 3> out;
  for (auto& one : out) one.circle = circle, one.turns = around.turns;
  if (!measured || measured->measures.empty()) return out;
  const auto& any = measured->measures.front();
  const auto path = part_of(around.path, any.start_s, any.end_s);
  const analysis::PathFrame frame = analysis::recognise(path);
  for (auto& one : out) one.turns = frame.turning.turns;  // as far as it went at an uneven pace
  const analysis::PathFacts truth(path, frame);
  const auto study = studies::measure_wheel(path.x.transpose(), around.ratio);
  const std::array<double, 3> by_study{study.spread_ratio, study.width_ratio, study.ellipse_ratio};
  for (std::size_t k = 0; k < kRatios.size(); ++k) {
    auto& one = out[k];
    one.study = by_study[k];
    for (const auto& definition : analysis::path_definitions())
      if (definition.what.id == kRatios[k]) one.truth = definition.value(truth);
    for (const auto& measure : measured->measures) {
      if (measure.id != kRatios[k] || measure.interval.kind == data::IntervalKind::none) continue;
      one.given = true;
      one.error = measure.value - one.truth;
      one.half_width = measure.interval.high - measure.value;
      // What is spread over time is that of a circle at one pace alone.
      const double held = circle && (around.even || kRatios[k] != "plane_axes_ratio") ? 1.0 : one.truth;
      one.held = !(held > measure.interval.high) && !(held < measure.interval.low);
    }
  }
  return out;
}

struct Counted {
  int paths = 0, given = 0, held = 0;
  double largest = 0.0;
};

int run(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 60;
  const std::uint64_t first = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  std::vector<std::array<Judged, 3>> all(2 * at(count));
  parallel_for(static_cast<std::int64_t>(all.size()), 1, 0, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i)
      all[at(i)] = judge(i < count, first + static_cast<std::uint64_t>(i));
  });
  double apart = 0.0;
  for (std::size_t k = 0; k < kRatios.size(); ++k)
    for (const bool circle : {true, false}) {
      Counted whole, arcs;
      for (const auto& path : all) {
        const auto& one = path[k];
        if (one.circle != circle) continue;
        if (one.turns > kNearlyWhole && one.turns < 1.0) continue;
        auto& into = one.turns >= 1.0 ? whole : arcs;
        ++into.paths, into.given += one.given, into.held += one.held;
        if (one.given) into.largest = std::fmax(into.largest, std::abs(one.error));
        if (one.turns >= 1.0) apart = std::fmax(apart, std::abs(one.study - one.truth));
      }
      const auto row = [&](const char* what, const Counted& c, bool must_be_given) {
        const double share = 100.0 * c.held / std::max(1, c.given);
        const auto name = fmt::format("{}, {} of {}", kRatios[k], what, circle ? "circles" : "ellipses");
        // What cannot be below 1 has one end alone, which holds more than the level.
        const bool many = c.given >= kManyPaths, upper = !circle && many;
        if (c.given >= kFewPaths)
          print_row(share >= 91.0 && (!upper || share <= 98.0), name + ", coverage",
                    circle  ? "at least 91 % hold 1"
                    : upper ? "91 to 98 %"
                            : "at least 91 %, of few",
                    fmt::format("{:.1f} % of {}, largest error {:.2g}", share, c.given, c.largest));
        if (c.paths >= kFewPaths)
          print_row(!must_be_given || c.given >= 0.95 * c.paths, name + ", with an interval", "at least 95 %",
                    fmt::format("{} of {}", c.given, c.paths));
      };
      row("turns", whole, true);
      if (kRatios[k] == "ellipse_ratio")
        row("arcs", arcs, true);
      else
        print_row(arcs.given == 0, fmt::format("{}, arcs of {}", kRatios[k], circle ? "circles" : "ellipses"),
                  "not given below one turn", fmt::format("given {} of {}", arcs.given, arcs.paths));
    }
  print_row(apart < 1e-9, "ratios of the study and of measure, the same path", "the same number",
            fmt::format("{:.1g} apart", apart));
  return testing_support::exit_status();
}

const testing_support::AcceptanceCheck kCheck("plane", run);

}  // namespace
