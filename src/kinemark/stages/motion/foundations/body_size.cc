// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/foundations/body_size.h"

#include <fmt/core.h>

#include <algorithm>
#include <vector>

#include "kinemark/data/name_index.h"
#include "kinemark/math/statistics.h"

namespace kinemark::motion {
namespace {

constexpr double kShortest_m = 0.08;  // below it laboratories differ by as much
constexpr std::int64_t kFewestPairs = 4;
constexpr std::int64_t kFramesOfSize = 25;

struct Pair {
  double factor = 1.0, apart_m = 0.0;
  std::size_t one = 0, other = 0;  ///< markers of the body
};

/// Median distance of two markers in the frames that see both; nothing where none does.
std::optional<double> distance(const data::Trajectories& recording, std::int64_t a, std::int64_t b) {
  std::vector<double> found;
  const std::int64_t step = std::max<std::int64_t>(1, recording.frames() / kFramesOfSize);
  for (std::int64_t f = 0; f < recording.frames(); f += step)
    if (recording.present(f, a) && recording.present(f, b))
      found.push_back((recording.x(f, a) - recording.x(f, b)).norm());
  if (found.empty()) return std::nullopt;
  return math::upper_median(found);
}

}  // namespace

std::string BodySize::sentence() const {
  return fmt::format(
      "markers on one segment lie {:.2g} times as far apart as those of a man of 1.75 m ({} pairs, such as "
      "{} and "
      "{} with {:.3g} m): the unit of length is another one, or this is no human body",
      factor, pairs, one, other, apart_m);
}

std::optional<BodySize> size_of_body(const StandingBody& body, const data::Trajectories& recording) {
  const data::NameIndex index(recording.names);
  std::vector<std::int64_t> place;
  for (const auto& marker : body.markers) place.push_back(index.find(marker.name));
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < body.markers.size(); ++i)
    for (std::size_t j = i + 1; j < body.markers.size(); ++j) {
      const auto &a = body.markers[i], &b = body.markers[j];
      const double expected = (a.x_in_segment - b.x_in_segment).norm();
      if (a.segment != b.segment || expected < kShortest_m || place[i] < 0 || place[j] < 0) continue;
      if (const auto apart = distance(recording, place[i], place[j]))
        pairs.push_back({.factor = *apart / expected, .apart_m = *apart, .one = i, .other = j});
    }
  if (std::ssize(pairs) < kFewestPairs) return std::nullopt;
  const auto middle = pairs.begin() + std::ssize(pairs) / 2;
  std::ranges::nth_element(pairs, middle, {}, &Pair::factor);
  return BodySize{.factor = middle->factor,
                  .pairs = std::ssize(pairs),
                  .one = body.markers[middle->one].name,
                  .other = body.markers[middle->other].name,
                  .apart_m = middle->apart_m};
}

}  // namespace kinemark::motion
