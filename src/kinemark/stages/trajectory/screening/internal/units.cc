// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <vector>

#include "kinemark/stages/trajectory/screening/internal/defects.h"

namespace kinemark::trajectory::internal {
namespace {

constexpr double kThousand = 1000.0;
constexpr double kNeighbour = 1.0;   // m, on the same body
constexpr double kLargest_m = 20.0;  // of what is recorded at once

struct Extent {
  double distance = 0.0;  ///< median distance from the origin, m
  double spread = 0.0;    ///< median distance from its own middle, m
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
};

Extent extent_of(const data::Trajectories& t, std::int64_t marker) {
  std::vector<double> distance;
  std::array<std::vector<double>, 3> axis;
  for (std::int64_t f = 0; f < t.frames(); ++f) {
    if (!t.present(f, marker)) continue;
    distance.push_back(t.x(f, marker).norm());
    for (std::size_t a = 0; a < 3; ++a) axis[a].push_back(t.x(f, marker)(static_cast<int>(a)));
  }
  const Eigen::Vector3d middle(median_of(axis[0]), median_of(axis[1]), median_of(axis[2]));
  Extent e;
  e.distance = median_of(distance);
  e.middle = middle;
  for (double& d : distance) d = 0.0;
  std::size_t i = 0;
  for (std::int64_t f = 0; f < t.frames(); ++f)
    if (t.present(f, marker)) distance[i++] = (t.x(f, marker) - middle).norm();
  e.spread = median_of(distance);
  return e;
}

/// Positions of one marker where it is seen.
class Path {
 public:
  Path(const data::Trajectories& t, std::int64_t marker) {
    for (std::int64_t f = 0; f < t.frames(); ++f) {
      if (!t.present(f, marker)) continue;
      if (!x_.empty())
        steps_.push_back((t.x(f, marker) - x_.back()).norm() / static_cast<double>(f - frame_.back()));
      frame_.push_back(f);
      x_.emplace_back(t.x(f, marker));
    }
  }
  [[nodiscard]] std::size_t size() const { return x_.size(); }
  [[nodiscard]] std::int64_t frame(std::size_t i) const { return frame_[i]; }

  /// Median way of a frame among the samples [begin, end), m; 0 for fewer than two.
  [[nodiscard]] double typical_step(std::size_t begin, std::size_t end) const {
    if (end < begin + 2) return 0.0;
    return median_of(std::vector<double>(steps_.begin() + static_cast<std::ptrdiff_t>(begin),
                                         steps_.begin() + static_cast<std::ptrdiff_t>(end - 1)));
  }

  /// 1 when sample `i` is a thousand times what would follow the one before, -1 for the reverse, else 0.
  /// Either lies in the direction of the other; or, so near the origin that a step changes the direction, it
  /// is within some steps of it, and steps are a thousand times as long from there on. `begin` is the first
  /// sample in the unit of the one before.
  [[nodiscard]] int slip_at(std::size_t begin, std::size_t i) const {
    const Eigen::Vector3d &a = x_[i - 1], &b = x_[i];
    const double before = typical_step(std::max(begin, i - std::min(i, kSteps + 1)), i);
    const double after = typical_step(i, std::min(size(), i + kSteps + 1));
    const auto way = static_cast<double>(frame_[i] - frame_[i - 1]);
    const auto follows = [&](const Eigen::Vector3d& p, const Eigen::Vector3d& q, double p_step,
                             double q_step) {
      const double off = (p - q).norm();
      if (off < kSameDirection * p.norm()) return true;
      return p_step > 0.0 && off < kSteps * way * p_step &&
             std::abs(std::log(q_step / p_step)) < std::log(kAlike) && (a - b).norm() > kJump * way * p_step;
    };
    if (follows(a, b / kThousand, before, after / kThousand)) return 1;
    if (follows(b, a / kThousand, after, before / kThousand)) return -1;
    return 0;
  }

  /// True when a slip among the samples [begin, end) went unseen: beside the origin, where a sample is the
  /// same in any unit, steps become a thousand times as long or short.
  [[nodiscard]] bool hides_slip(std::size_t begin, std::size_t end) const {
    for (std::size_t i = begin + 2; i + 2 < end; ++i) {
      const double before = typical_step(std::max(begin, i - std::min(i, kSteps + 1)), i);
      const double after = typical_step(i, std::min(end, i + kSteps + 1));
      if (!(before > 0.0 && after > 0.0)) continue;
      const double ratio = std::abs(std::log(after / before)) - std::log(kThousand);
      if (std::abs(ratio) < std::log(kAlike) && x_[i].norm() < kSteps * std::max(before, after)) return true;
    }
    return false;
  }

 private:
  static constexpr std::size_t kSteps = 3;
  static constexpr double kSameDirection = 0.05;  ///< of the distance from the origin
  static constexpr double kAlike = 5.0;           ///< steps differ by less in the same unit
  static constexpr double kJump = 100.0;          ///< steps: no movement goes so far at once

  std::vector<std::int64_t> frame_;
  std::vector<Eigen::Vector3d> x_;
  std::vector<double> steps_;  ///< m a frame, from each sample to the next
};

/// Samples in one unit.
struct UnitRun {
  std::size_t begin = 0, end = 0;
  int power = 0;  ///< of a thousand, beside the first run
};

/// Slips with time: the part that is in another unit than most of the marker.
void find_slips_in_time(const data::Trajectories& t, std::int64_t m, Defects& out) {
  constexpr double kSameSteps = 30.0;
  const Path path(t, m);
  std::vector<UnitRun> runs{{0, path.size(), 0}};
  for (std::size_t i = 1; i < path.size(); ++i) {
    const int slip = path.slip_at(runs.back().begin, i);
    if (slip == 0) continue;
    runs.back().end = i;
    runs.push_back({i, path.size(), runs.back().power + slip});
  }
  if (runs.size() == 1 ||
      std::ranges::any_of(runs, [&](const UnitRun& run) { return path.hides_slip(run.begin, run.end); }))
    return;  // where one end of a slip is not known, neither are its frames
  std::map<int, std::size_t> share;
  for (const UnitRun& run : runs) share[run.power] += run.end - run.begin;
  const int usual =
      std::ranges::max_element(share, {}, [](const auto& entry) { return entry.second; })->first;
  std::vector<double> usual_steps;
  for (const UnitRun& run : runs)
    if (const double step = path.typical_step(run.begin, run.end); run.power == usual && step > 0.0)
      usual_steps.push_back(step);
  for (const UnitRun& run : runs) {
    if (run.power == usual) continue;
    // In its own unit a slip moves as the other parts do; frames that do not are not those that slip.
    const double step = path.typical_step(run.begin, run.end) * std::pow(kThousand, usual - run.power);
    if (step > 0.0 && !usual_steps.empty() &&
        std::abs(std::log(step / median_of(usual_steps))) > std::log(kSameSteps))
      continue;
    const std::int64_t first = path.frame(run.begin);
    const std::int64_t last = run.end < path.size() ? path.frame(run.end) - 1 : t.frames() - 1;
    const bool large = run.power > usual;
    out.push_back({.kind = FindingKind::unit_slip,
                   .marker = m,
                   .first_frame = first,
                   .last_frame = last,
                   .size = large ? kThousand : 1.0 / kThousand,
                   .confidence = 0.99,
                   .description = fmt::format(
                       "marker '{}' is a thousand times too {} in {}: times or divided by 1000 it "
                       "joins the frames beside",
                       t.names[static_cast<std::size_t>(m)], large ? "large" : "small",
                       describe_frames(t.time, first, last))});
  }
}

/// True when some other marker goes along with this one once it is scaled: their distance hardly changes.
/// Forces and angles that a file stores as points are small or large, but do not move with any marker.
bool goes_along(const data::Trajectories& t, std::int64_t marker, double scale, double spread) {
  for (std::int64_t m = 0; m < t.markers(); ++m) {
    if (m == marker) continue;
    std::vector<double> distance;
    for (std::int64_t f = 0; f < t.frames(); ++f)
      if (t.present(f, marker) && t.present(f, m))
        distance.push_back((scale * t.x(f, marker) - t.x(f, m)).norm());
    if (distance.size() < 10) continue;
    const double middle = median_of(distance);
    for (double& d : distance) d = std::abs(d - middle);
    if (middle < kNeighbour && median_of(distance) < 0.1 * spread) return true;
  }
  return false;
}

/// Median distance of the markers from the middle of them all, or of a marker from its own where it is
/// larger, m: a body far from the origin is no larger than one beside it.
double size_of(const std::vector<Extent>& extents, double spread) {
  std::array<std::vector<double>, 3> axis;
  for (const Extent& e : extents)
    for (std::size_t a = 0; a < 3 && e.distance > 0.0; ++a) axis[a].push_back(e.middle(static_cast<int>(a)));
  const Eigen::Vector3d middle(median_of(axis[0]), median_of(axis[1]), median_of(axis[2]));
  std::vector<double> apart;
  for (const Extent& e : extents)
    if (e.distance > 0.0) apart.push_back((e.middle - middle).norm());
  return std::max(median_of(apart), spread);
}

/// Defects of all markers over the same frames are one defect of the recording.
void merge_common(const data::Trajectories& t, Defects& slips) {
  for (std::size_t i = 0; i < slips.size(); ++i) {
    if (slips[i].marker < 0) continue;
    std::int64_t with = 0;
    std::int64_t seen = 0;
    const auto same = [&](const Defect& f) {
      return f.first_frame == slips[i].first_frame && f.last_frame == slips[i].last_frame && f.marker >= 0;
    };
    for (std::int64_t m = 0; m < t.markers(); ++m) seen += t.present(slips[i].first_frame, m) ? 1 : 0;
    with = std::ranges::count_if(slips, same);
    if (with < 2 || with < seen) continue;
    Defect all = slips[i];
    all.marker = -1;
    all.description = fmt::format("all {} markers that are seen change by a factor of a thousand in {}", seen,
                                  describe_frames(t.time, all.first_frame, all.last_frame));
    const Defect key = slips[i];
    std::erase_if(slips, [&](const Defect& f) {
      return f.first_frame == key.first_frame && f.last_frame == key.last_frame && f.marker >= 0;
    });
    slips.insert(slips.begin() + static_cast<std::ptrdiff_t>(std::min(i, slips.size())), all);
  }
}

}  // namespace

void find_unit_slips(const data::Trajectories& t, Defects& out) {
  Defects slips;
  for (std::int64_t m = 0; m < t.markers(); ++m) find_slips_in_time(t, m, slips);
  merge_common(t, slips);
  std::vector<Extent> extents;
  std::vector<double> distances;
  std::vector<double> spreads;
  for (std::int64_t m = 0; m < t.markers(); ++m) {
    extents.push_back(extent_of(t, m));
    if (extents.back().distance > 0.0) {
      distances.push_back(extents.back().distance);
      spreads.push_back(extents.back().spread);
    }
  }
  const double distance = median_of(distances);
  const double spread = median_of(spreads);
  const auto near = [](double ratio, double factor, double tolerance) {
    return ratio > factor / tolerance && ratio < factor * tolerance;
  };
  for (std::int64_t m = 0; m < t.markers() && distances.size() >= 4; ++m) {
    const Extent& e = extents[static_cast<std::size_t>(m)];
    for (const double factor : {kThousand, 1.0 / kThousand}) {
      if (!near(e.distance / distance, factor, 3.0) || !near(e.spread / spread, factor, 10.0)) continue;
      if (!goes_along(t, m, 1.0 / factor, spread)) continue;
      slips.push_back({.kind = FindingKind::unit_slip,
                       .marker = m,
                       .first_frame = 0,
                       .last_frame = t.frames() - 1,
                       .size = factor,
                       .confidence = 0.85,
                       .description = fmt::format(
                           "marker '{}' is {:.3g} m from the origin and moves by {:.3g} m; the others "
                           "{:.3g} m and {:.3g} m: another unit",
                           t.names[static_cast<std::size_t>(m)], e.distance, e.spread, distance, spread)});
    }
  }
  // Markers are neither 200 m away on something larger than a hall, nor all within 2 mm of the origin.
  if (!distances.empty() &&
      ((distance > 200.0 && size_of(extents, spread) > kLargest_m) || (distance < 0.002 && distance > 0.0)))
    slips.push_back(
        {.kind = FindingKind::unit_slip,
         .first_frame = 0,
         .last_frame = t.frames() - 1,
         .confidence = 0.7,
         .description = fmt::format("markers are {:.3g} m from the origin (median): the unit of the whole "
                                    "recording is wrong by a thousand or so",
                                    distance)});
  out.insert(out.end(), slips.begin(), slips.end());
}

}  // namespace kinemark::trajectory::internal
