// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/markers/plausible.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/text.h"
#include "kinemark/core/utf8.h"

namespace kinemark::io {
namespace {

using data::Trajectories;
using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kNamed = 6;  // samples in the warning
constexpr std::size_t kNameCharacters = 40;
constexpr std::int64_t kFramesOfBody = 101;  // whose extent is looked at
constexpr double kUsualSteps = 5.0;
constexpr double kOnePoint_m = 1e-6;  // no two markers lie so near
constexpr double kStaysWithin_m = 20.0;

/// Median of values that are there; NaN of none. Changes their order.
double median_of(std::vector<double>& values) {
  if (values.empty()) return kNaN;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// Within such a box no sample is 10 m from another, nor from the middle of any, so none is wrong. The margin
/// is for what rounding does to sums of squares.
bool is_small(const Eigen::AlignedBox3d& box_m) {
  return !box_m.isEmpty() && box_m.diagonal().norm() < 0.999 * kFarFromNeighbours_m;
}

/// No marker leaps from one of its samples to the next, and all are near each other: then no sample is wrong
/// by the rules here. The one pass that recordings take whose box is not known.
bool all_near(const Trajectories& markers) {
  constexpr double kLeap_m = kFarFromNeighbours_m / 2.0;  // along one axis; along three at once still no 10 m
  const auto width = 3 * markers.names.size();
  std::vector<double> lows(width, kInfinity), highs(width, -kInfinity), leaps_of(width, 0.0),
      lasts(width, kNaN);
  // None of them overlaps another, so that the compiler takes several columns at once.
  double *__restrict low = lows.data(), *__restrict high = highs.data(), *__restrict leap = leaps_of.data(),
                    *__restrict last = lasts.data();
  const double* __restrict x = markers.x_in_world.data();
  for (std::int64_t f = 0; f < markers.frames(); ++f, x += width)
    for (std::size_t k = 0; k < width; ++k) {
      // NaN is neither less nor more.
      const double step = std::abs(x[k] - last[k]);
      low[k] = x[k] < low[k] ? x[k] : low[k];
      high[k] = x[k] > high[k] ? x[k] : high[k];
      leap[k] = step > leap[k] ? step : leap[k];
      last[k] = x[k] == x[k] ? x[k] : last[k];
    }
  bool leaps = std::ranges::any_of(leaps_of, [](double step) { return step > kLeap_m; });
  for (std::size_t axis = 0; axis < 3 && !leaps; ++axis) {
    double least = kInfinity, most = -kInfinity;
    for (std::size_t k = axis; k < width; k += 3) {
      least = std::min(least, low[k]);
      most = std::max(most, high[k]);
    }
    leaps = most - least > kLargestLaboratory_m / 2.0;
  }
  return !leaps;
}

/// Diagonal of the box around the markers in the frame of middle size, and that frame. NaN: below three
/// markers in all frames looked at.
struct Extent {
  double size_m = kNaN;
  std::int64_t frame = 0;
};

Extent find_extent(const Trajectories& markers) {
  std::vector<std::pair<double, std::int64_t>> found;
  const std::int64_t step = std::max<std::int64_t>(1, markers.frames() / kFramesOfBody);
  for (std::int64_t f = 0; f < markers.frames(); f += step) {
    Vector3d low = Vector3d::Constant(kInfinity), high = -low;
    int seen = 0;
    for (std::int64_t m = 0; m < markers.markers(); ++m) {
      if (!markers.present(f, m)) continue;
      low = low.cwiseMin(markers.x(f, m));
      high = high.cwiseMax(markers.x(f, m));
      ++seen;
    }
    if (seen >= 3) found.emplace_back((high - low).norm(), f);
  }
  if (found.empty()) return {};
  const auto middle = found.begin() + static_cast<std::ptrdiff_t>((found.size() - 1) / 2);
  std::ranges::nth_element(found, middle);
  return {.size_m = middle->first, .frame = middle->second};
}

/// Says that the unit is in doubt; false when the size is that of something alive.
bool note_size(data::Trial& trial) {
  const Extent extent = find_extent(trial.markers);
  if (extent.size_m < kOnePoint_m) {
    trial.warnings.push_back(
        fmt::format("the markers of frame {} lie all at one point", trial.first_frame + extent.frame));
    return true;
  }
  if (!(extent.size_m > kLargestBody_m || extent.size_m < kSmallestBody_m)) return false;
  trial.warnings.push_back(fmt::format(
      "the markers of frame {} span {:.3g} m; expected {} to {:.0f} m, so the unit ({}) is probably wrong",
      trial.first_frame + extent.frame, extent.size_m, kSmallestBody_m, kLargestBody_m,
      trial.units_in_file.empty() ? "none is stated" : trial.units_in_file));
  return true;
}

/// One marker: where it is usually, and how it moves.
struct Habit {
  Vector3d middle = Vector3d::Constant(kNaN);
  double usual_step_m = 0.0;
  bool stays = false;  ///< nine samples in ten lie within 20 m of the middle
};

/// A share of the values is below; of few values a smaller share, in which one wrong sample has no part.
double usual(std::vector<double>& values) {
  if (values.size() < 4) return 0.0;
  const double share = values.size() < 20 ? 0.25 : 0.9;
  const auto k = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, values.begin() + k);
  return values[at(k)];
}

Habit find_habit(const Trajectories& markers, std::int64_t m, const std::vector<std::int64_t>& frames) {
  Habit habit;
  std::vector<double> values;
  for (int axis = 0; axis < 3; ++axis) {
    values.clear();
    for (const auto f : frames) values.push_back(markers.x(f, m)(axis));
    habit.middle(axis) = median_of(values);
  }
  values.clear();
  for (const auto f : frames) values.push_back((markers.x(f, m) - habit.middle).norm());
  habit.stays = values.size() < 4 || usual(values) <= kStaysWithin_m;
  values.clear();
  for (std::size_t i = 1; i < frames.size(); ++i)
    values.push_back((markers.x(frames[i], m) - markers.x(frames[i - 1], m)).norm());
  habit.usual_step_m = usual(values);
  return habit;
}

std::vector<std::int64_t> frames_of(const Trajectories& markers, std::int64_t m) {
  std::vector<std::int64_t> out;
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    if (markers.present(f, m)) out.push_back(f);
  return out;
}

/// A sample to reject.
struct Suspect {
  std::int64_t frame, marker;
  double distance_m;  ///< from where it would be expected
};

/// Samples of one marker that are far from those around them, or from everything.
void find_suspects(const Trajectories& markers, std::int64_t m, const std::vector<std::int64_t>& frames,
                   const Habit& habit, const Vector3d& middle, std::vector<Suspect>& out) {
  const bool at_home = habit.stays && (habit.middle - middle).norm() <= kLargestLaboratory_m;
  const auto is_far = [&](std::size_t i, std::size_t j) {
    const double between_s = std::abs(static_cast<double>(frames[i] - frames[j])) / markers.time.rate_hz;
    const double reach_m =
        std::max({kFarFromNeighbours_m, kUsualSteps * habit.usual_step_m, kFastestMarker_m_s * between_s});
    return (markers.x(frames[i], m) - markers.x(frames[j], m)).norm() > reach_m;
  };
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double from_middle_m = (markers.x(frames[i], m) - middle).norm();
    const double from_habit_m = (markers.x(frames[i], m) - habit.middle).norm();
    // Of two samples neither tells which is wrong.
    const bool alone = frames.size() > 2 && from_habit_m > kFarFromNeighbours_m &&
                       (i == 0 || is_far(i, i - 1)) && (i + 1 == frames.size() || is_far(i, i + 1));
    if (alone)
      out.push_back({frames[i], m, from_habit_m});
    else if (from_middle_m > kBeyondAnyMarker_m || (at_home && from_middle_m > kLargestLaboratory_m))
      out.push_back({frames[i], m, from_middle_m});
  }
}

void reject(data::Trial& trial, const Suspect& s) {
  const std::size_t i = trial.markers.index(s.frame, s.marker);
  trial.markers.set_missing(s.frame, s.marker, data::SampleState::rejected);
  if (!trial.markers.covariance.empty())
    std::fill_n(trial.markers.covariance.begin() + static_cast<std::ptrdiff_t>(6 * i), 6, kNaN);
  if (!trial.residual_m.empty()) trial.residual_m[i] = std::numeric_limits<float>::quiet_NaN();
  if (!trial.camera_mask.empty()) trial.camera_mask[i] = 0;
}

std::string say(const data::Trial& trial, const std::vector<Suspect>& suspects) {
  std::vector<std::string> named;
  for (const auto& s : suspects) {
    if (named.size() == kNamed) break;
    named.push_back(fmt::format("'{}' in frame {}, {:.3g} m away",
                                printable(trial.markers.names[at(s.marker)], kNameCharacters),
                                trial.first_frame + s.frame, s.distance_m));
  }
  std::string sentence = join(named, "; ");
  if (suspects.size() > kNamed) sentence += fmt::format(" and {} more", suspects.size() - kNamed);
  return fmt::format("{} where no marker can be and {}: {}",
                     suspects.size() == 1 ? "1 sample is" : fmt::format("{} samples are", suspects.size()),
                     suspects.size() == 1 ? "is rejected" : "are rejected", sentence);
}

}  // namespace

void reject_implausible(data::Trial& trial, const Eigen::AlignedBox3d& box_m) {
  Trajectories& markers = trial.markers;
  if (markers.frames() == 0 || markers.markers() == 0) return;
  if (note_size(trial) || is_small(box_m) || all_near(markers)) return;

  std::vector<Habit> habits;
  for (std::int64_t m = 0; m < markers.markers(); ++m)
    habits.push_back(find_habit(markers, m, frames_of(markers, m)));
  Vector3d middle;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const auto& habit : habits)
      if (!std::isnan(habit.middle(axis))) values.push_back(habit.middle(axis));
    middle(axis) = median_of(values);
  }
  std::vector<Suspect> suspects;
  for (std::int64_t m = 0; m < markers.markers(); ++m)
    find_suspects(markers, m, frames_of(markers, m), habits[at(m)], middle, suspects);
  if (suspects.empty()) return;
  std::ranges::sort(suspects, {}, [](const Suspect& s) { return std::pair(s.frame, s.marker); });
  trial.warnings.push_back(say(trial, suspects));
  for (const auto& s : suspects) reject(trial, s);
}

}  // namespace kinemark::io
