// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/foot_ends.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/math/statistics.h"
#include "kinemark/stages/analysis/gait/kinematic_events.h"

namespace kinemark::analysis {
namespace {

using data::Side;
using Eigen::RowVector2d;

constexpr double kAgainst = 0.5;       // cosine: points the same way, or against
constexpr double kRatio = 1.25;        // of two distances or heights that differ
constexpr double kLeastRise_m = 0.02;  // of an end that takes part in steps
constexpr std::size_t kFewest = 8;     // frames

double median_of(const std::vector<double>& x) { return x.size() < kFewest ? kNaN : math::median(x); }

// 1 where the first is greater, -1 where the second is, 0 where neither is by much or is seen.
int greater(double first, double second) {
  return first > kRatio * second ? 1 : second > kRatio * first ? -1 : 0;
}
int sign_of(double cosine) { return cosine > kAgainst ? 1 : cosine < -kAgainst ? -1 : 0; }

RowVector2d along(const FootPaths& foot, std::int64_t f) {
  return (foot.toe.row(f) - foot.heel.row(f)).leftCols<2>().normalized();
}

FootEvidence evidence_of(const GaitPaths& paths, const FootPaths& foot, const Progress& progress) {
  FootEvidence out;
  std::vector<double> pelvis, way, heel, toe, heel_height, toe_height;
  for (std::int64_t f = 0; f < paths.frames(); ++f) {
    if (!foot.known[at(f)]) continue;
    const RowVector2d points = along(foot, f);
    way.push_back(points.dot(progress.direction.row(f)));
    if (paths.pelvis_front.rows() > 0 && paths.pelvis_front.row(f).allFinite())
      pelvis.push_back(points.dot(paths.pelvis_front.row(f).normalized()));
    if (foot.ankle.rows() > 0 && foot.ankle.row(f).allFinite()) {
      heel.push_back((foot.heel.row(f) - foot.ankle.row(f)).norm());
      toe.push_back((foot.toe.row(f) - foot.ankle.row(f)).norm());
    }
    heel_height.push_back(foot.heel(f, 2)), toe_height.push_back(foot.toe(f, 2));
  }
  out.pelvis = median_of(pelvis), out.way = median_of(way);
  out.heel_m = median_of(heel), out.toe_m = median_of(toe);
  if (heel_height.size() >= kFewest) {
    out.heel_rise_m = math::quantile(heel_height, 0.95) - math::quantile(heel_height, 0.05);
    out.toe_rise_m = math::quantile(toe_height, 0.95) - math::quantile(toe_height, 0.05);
  }
  return out;
}

int rises(const FootEvidence& e) {
  return std::max(e.heel_rise_m, e.toe_rise_m) > kLeastRise_m ? greater(e.heel_rise_m, e.toe_rise_m) : 0;
}

}  // namespace

int FootEvidence::score() const { return 2 * sign_of(pelvis) + greater(toe_m, heel_m) + rises(*this); }

std::string FootEnds::why(Side side, const std::string& heel, const std::string& toe) const {
  const auto& e = evidence[data::index_of(side)];
  std::vector<std::string> out;
  const std::string foot = side == Side::left ? "the left foot" : "the right foot";
  if (sign_of(e.pelvis) < 0) out.push_back(foot + " points against the front of the pelvis");
  if (sign_of(between) < 0) out.push_back(foot + " points against the other one");
  if (greater(e.toe_m, e.heel_m) < 0)
    out.push_back(fmt::format("its ankle is {:.0f} mm from {} and {:.0f} mm from {}", 1e3 * e.heel_m, heel,
                              1e3 * e.toe_m, toe));
  if (rises(e) < 0)
    out.push_back(fmt::format("{} rises by {:.0f} mm and {} by {:.0f} mm", heel, 1e3 * e.heel_rise_m, toe,
                              1e3 * e.toe_rise_m));
  if (out.empty() || (out.size() == 1 && sign_of(between) < 0 && sign_of(e.way) < 0))
    out.push_back(foot + " points against the way");
  return fmt::format("{}", fmt::join(out, ", "));
}

FootEnds judge_foot_ends(const GaitPaths& paths, const Progress& progress) {
  FootEnds out;
  std::vector<Side> feet;
  for (const Side side : data::kBothSides)
    if (const auto& foot = paths.foot(side); foot.present() && foot.points) {
      out.evidence[data::index_of(side)] = evidence_of(paths, foot, progress);
      feet.push_back(side);
    }
  if (feet.empty()) return out;
  if (feet.size() == 2) {
    const auto &left = paths.foot(Side::left), &right = paths.foot(Side::right);
    std::vector<double> cosines;
    for (std::int64_t f = 0; f < paths.frames(); ++f)
      if (left.known[at(f)] && right.known[at(f)]) cosines.push_back(along(left, f).dot(along(right, f)));
    out.between = median_of(cosines);
  }
  const bool opposed = sign_of(out.between) < 0;
  int all = 0;
  bool against_way = true, pelvis_seen = false;
  out.pelvis_exchanged = true;
  for (const Side side : feet) {
    const auto i = data::index_of(side);
    const auto& e = out.evidence[i];
    const auto& other = out.evidence[1 - i];
    out.exchanged[i] =
        e.score() <= -2 ||
        (opposed && (e.score() < other.score() ||
                     (e.score() == other.score() && sign_of(e.way) < 0 && sign_of(other.way) > 0)));
    all += e.score();
    against_way = against_way && sign_of(e.way) < 0;
    pelvis_seen = pelvis_seen || std::isfinite(e.pelvis);
    out.pelvis_exchanged = out.pelvis_exchanged && (out.exchanged[i] ? -1 : 1) * sign_of(e.pelvis) < 0;
  }
  out.doubtful = !pelvis_seen && !out.exchanged[0] && !out.exchanged[1] &&
                 ((against_way && all <= 0) || all <= -static_cast<int>(feet.size()));
  return out;
}

}  // namespace kinemark::analysis
