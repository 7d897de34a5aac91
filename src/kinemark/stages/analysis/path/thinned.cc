// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/thinned.h"

#include <algorithm>
#include <cmath>

namespace kinemark::analysis {
namespace {

constexpr std::int64_t kThinnedSamples =
    240;  // samples between which all distances are taken, as of diameters()

double thinned_distance(const PathMatrix& x, const PathMatrix& noise) {
  const std::int64_t step = std::max<std::int64_t>(1, (x.rows() + kThinnedSamples - 1) / kThinnedSamples);
  const std::int64_t count = (x.rows() + step - 1) / step;
  Eigen::Matrix3Xd where(3, count);
  for (std::int64_t i = 0; i < count; ++i) where.col(i) = (x.row(i * step) + noise.row(i * step)).transpose();
  double farthest = -1.0;
  std::int64_t a = 0, b = 0;
  for (std::int64_t i = 0; i < count; ++i)
    for (std::int64_t k = 0; k < i; ++k)
      if (const double d = (where.col(i) - where.col(k)).squaredNorm(); d > farthest)
        farthest = d, a = i, b = k;
  if (!(farthest > 0.0)) return 0.0;
  const Eigen::Vector3d way = (where.col(a) - where.col(b)) / std::sqrt(farthest);
  return (x.row(a * step) - noise.row(a * step) - x.row(b * step) + noise.row(b * step)).dot(way);
}

Eigen::Vector3d thinned_sides(const PathMatrix& place, const PathMatrix& value, const Eigen::Matrix3d& axes) {
  const PathMatrix where = place * axes, how_much = value * axes;
  Eigen::Vector3d out;
  for (Eigen::Index k = 0; k < 3; ++k) {
    Eigen::Index most = 0, least = 0;
    where.col(k).maxCoeff(&most);
    where.col(k).minCoeff(&least);
    out[k] = how_much(most, k) - how_much(least, k);
  }
  return out;
}

}  // namespace

ThinnedExtremes thinned_extremes(const PathMatrix& x, const PrincipalAxes& axes, const Eigen::Matrix3d& box,
                                 const PathMatrix& noise) {
  const PathMatrix place = x + noise, value = x - noise;
  return {.extents = thinned_sides(place, value, axes.axes),
          .box = thinned_sides(place, value, box),
          .largest_distance = thinned_distance(x, noise)};
}

}  // namespace kinemark::analysis
