// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/event_times.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/math/statistics.h"

namespace kinemark::analysis {
namespace {

using data::FootEvent;

// Milliseconds. Bias of each detector by set of markers: the median of its time less the plate's, over the
// events learnt from; `weights`: a constant and what each detector's deviation from the median of all adds,
// by ridge regression; `sd`: of the fused time with the laboratory left out, each laboratory counted once, at
// least 14.
struct Row {
  std::array<double, kDetectors> bias;
  double sd;
};
struct Table {
  std::array<Row, 4> rows;  // heel and toe; ankle and toe; toe alone; rear alone
  std::array<double, 1 + kDetectors> weights;
};

constexpr Table kWalkStrike{{{{{5.88, -34.32, -10.51, -25.56}, 18.0},
                              {{2.13, -29.73, 1.09, -18.19}, 17.3},
                              {{14.17, -32.33, 7.27, -21.33}, 18.4},
                              {{-26.76, -34.42, -13.30, -26.79}, 18.4}}},
                            {2.987, 0.4272, -0.0807, -0.1357, -0.1085}};
constexpr Table kWalkOff{{{{{-13.36, 0.80, -96.69, -40.46}, 15.9},
                           {{8.80, 7.90, -89.95, -29.39}, 14.9},
                           {{24.47, 7.49, -20.91, 2.40}, 21.6},
                           {{-33.05, -53.65, -97.12, -71.34}, 15.5}}},
                         {-4.216, 0.1619, 0.1218, 0.3452, -0.3339}};
constexpr Table kRunStrike{{{{{13.21, -21.59, 19.25, 1.62}, 14.1},
                             {{13.21, -21.59, 19.25, 1.62}, 18.0},
                             {{20.05, -21.56, 28.71, 7.17}, 17.4},
                             {{-19.31, -21.55, 19.88, 2.21}, 14.0}}},
                           {2.936, 0.0379, -0.1238, 0.0983, -0.0375}};
constexpr Table kRunOff{{{{{50.03, 88.83, -74.29, 29.66}, 14.0},
                          {{50.03, 88.83, -74.29, 29.66}, 18.0},
                          {{48.60, 88.53, 20.96, 54.83}, 14.0},
                          {{-23.06, 63.19, -75.98, -36.51}, 14.0}}},
                        {1.043, -0.0343, 0.0296, 0.0496, -0.0261}};

constexpr double kMostApart_ms = 40.0, kOfSpread = 0.4;
constexpr double kLearntSpread_ms =
    20.0;                           // SD of the detectors of an event: the most of what was learnt from
constexpr double kFoot_ms = 3.0;    // and of the means of its feet about the mean of both
constexpr double kWithin_ms = 7.0;  // SD of the errors of one recording about their mean
// Frames of most recordings learnt from: what they add is in the SDs, and is not counted a second time.
constexpr double kLearntFrame_s = 0.01;
// Feet found by place have biases of heel and toe, and the SD that they showed there (251 events).
constexpr double kByPlaceStrike_ms = 19.0, kByPlaceOff_ms = 18.0;

const Table& table_of(FootEvent what, bool running) {
  if (running) return what == FootEvent::strike ? kRunStrike : kRunOff;
  return what == FootEvent::strike ? kWalkStrike : kWalkOff;
}

Row row_of(const Table& table, FootEvent what, FootSet set) {
  if (set != FootSet::by_place) return table.rows[static_cast<std::size_t>(set)];
  Row out = table.rows[0];
  out.sd = std::max(out.sd, what == FootEvent::strike ? kByPlaceStrike_ms : kByPlaceOff_ms);
  return out;
}

}  // namespace

FusedTime fuse(const DetectorTimes& times, FootEvent what, bool running, FootSet set, double frame_s) {
  const Table& table = table_of(what, running);
  const Row row = row_of(table, what, set);
  std::array<double, kDetectors> unbiased{};
  std::vector<double> found;
  for (std::size_t k = 0; k < kDetectors; ++k) {
    unbiased[k] = 1e3 * times[k] - row.bias[k];
    if (std::isfinite(unbiased[k])) found.push_back(unbiased[k]);
  }
  const double middle = math::median(found);
  double out = middle + table.weights[0];
  for (std::size_t k = 0; k < kDetectors; ++k)
    if (std::isfinite(unbiased[k]))
      out += table.weights[k + 1] * std::clamp(unbiased[k] - middle, -kMostApart_ms, kMostApart_ms);
  DetectorTimes apart{};
  for (std::size_t k = 0; k < kDetectors; ++k) apart[k] = 1e-3 * (unbiased[k] - middle);
  return {
      .after_s = 1e-3 * out,
      .error = {.kind_s = 1e-3 * std::sqrt(row.sd * row.sd - kWithin_ms * kWithin_ms - kFoot_ms * kFoot_ms),
                .foot_s = 1e-3 * kFoot_ms,
                .own_s =
                    std::sqrt(1e-6 * kWithin_ms * kWithin_ms +
                              std::max(0.0, frame_s * frame_s - kLearntFrame_s * kLearntFrame_s) / 12.0)},
      .apart_s = apart};
}

double error_of_apart(const DetectorTimes& apart_s) {
  double mean = 0.0, count = 0.0, squares = 0.0;
  for (const double x : apart_s)
    if (std::isfinite(x)) mean += x, count += 1.0;
  if (!(count > 0.0)) return 0.0;
  mean /= count;
  for (const double x : apart_s)
    if (std::isfinite(x)) squares += (x - mean) * (x - mean) / count;
  const double beyond = std::max(0.0, squares - 1e-6 * kLearntSpread_ms * kLearntSpread_ms);
  return std::sqrt(kOfSpread * kOfSpread * squares + beyond);
}

}  // namespace kinemark::analysis
