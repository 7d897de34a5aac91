// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <utility>

#include "kinemark/core/counted.h"
#include "kinemark/core/index.h"
#include "kinemark/core/text.h"
#include "kinemark/data/channels.h"
#include "kinemark/stages/skeleton/topology/marker_sets.h"
#include "kinemark/workflow/prepare/marker_screening.h"

namespace kinemark::workflow {
namespace {

constexpr double kExact_m = 1e-5;           ///< what files round coordinates to
constexpr double kMoveAgainst_m = 5e-3;     ///< least change of a distance that no rigid body has
constexpr std::int64_t kFewestFrames = 20;  ///< in which chance puts no point onto a line
constexpr std::int64_t kTriedFirst = 16;    ///< frames in which pairs are tried first
constexpr std::int64_t kMostMarkers = 200;  ///< beyond which no pairs are tried

/// A point and the two markers that it may lie between.
struct Between {
  std::int64_t point, from, to;
};

/// Whether the point is the middle of a way that changes its length, in every `step`-th frame that shows all
/// three.
bool is_middle_of(const data::Trajectories& markers, const Between& b, std::int64_t step) {
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  std::int64_t seen = 0;
  for (std::int64_t f = 0; f < markers.frames(); f += step) {
    if (!markers.present(f, b.point) || !markers.present(f, b.from) || !markers.present(f, b.to)) continue;
    const Eigen::Vector3d from = markers.x(f, b.from), to = markers.x(f, b.to);
    if ((markers.x(f, b.point) - 0.5 * (from + to)).norm() > kExact_m) return false;
    const double length = (to - from).norm();
    ++seen;
    least = std::min(least, length);
    most = std::max(most, length);
  }
  return step > 1 ? seen > 0 : seen >= kFewestFrames && most - least >= kMoveAgainst_m;
}

/// Whether a marker is the middle of two others of `real`.
bool is_middle(const data::Trajectories& markers, std::int64_t point, const std::vector<std::int64_t>& real) {
  const auto step = std::max<std::int64_t>(2, markers.frames() / kTriedFirst);
  for (std::size_t i = 0; i < real.size(); ++i)
    for (std::size_t k = i + 1; k < real.size(); ++k) {
      const Between b{.point = point, .from = real[i], .to = real[k]};
      if (b.from == point || b.to == point) continue;
      if (is_middle_of(markers, b, step) && is_middle_of(markers, b, 1)) return true;
    }
  return false;
}

std::string some_names(const std::vector<std::int64_t>& which, const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 4;
  std::vector<std::string> of;
  for (const auto m : which) of.push_back(names[at(m)]);
  return join_some(of, kShown);
}

}  // namespace

std::vector<std::int64_t> PointsApart::all() const {
  std::vector<std::int64_t> out;
  std::ranges::merge(computed, unnamed, std::back_inserter(out));
  return out;
}

std::string PointsApart::describe(const std::vector<std::string>& names) const {
  std::string out;
  if (!computed.empty())
    out =
        fmt::format("{} ({})", counted(std::ssize(computed), "computed point"), some_names(computed, names));
  if (unnamed.empty()) return out;
  if (out.empty()) return counted(std::ssize(unnamed), "point without a name", "points without a name");
  return fmt::format("{} and {} without a name", out, unnamed.size());
}

PointsApart find_points_apart(const data::Trajectories& markers) {
  PointsApart out;
  const auto by_name = skeleton::find_model_outputs(markers.names);
  std::vector<std::int64_t> real;
  for (std::int64_t m = 0; m < markers.markers(); ++m) {
    const bool unnamed = data::is_unlabelled(markers.names[at(m)]);
    (unnamed ? out.unnamed : by_name[at(m)] != 0 ? out.computed : real).push_back(m);
  }
  if (std::ssize(real) <= kMostMarkers) {
    std::vector<std::int64_t> middles;
    for (const auto m : real)
      if (is_middle(markers, m, real)) middles.push_back(m);
    std::erase_if(real, [&](std::int64_t m) { return std::ranges::binary_search(middles, m); });
    std::vector<std::int64_t> merged;
    std::ranges::merge(out.computed, middles, std::back_inserter(merged));
    out.computed = std::move(merged);
  }
  return real.empty() ? PointsApart{} : out;
}

}  // namespace kinemark::workflow
