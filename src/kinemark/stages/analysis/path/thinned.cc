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

}  // namespace

ThinnedExtremes thinned_extremes(const PathMatrix& x, const PrincipalAxes& axes, const PathMatrix& noise) {
  ThinnedExtremes out;
  const PathMatrix place = (x + noise) * axes.axes, value = (x - noise) * axes.axes;
  for (Eigen::Index k = 0; k < 3; ++k) {
    Eigen::Index most = 0, least = 0;
    place.col(k).maxCoeff(&most);
    place.col(k).minCoeff(&least);
    out.extents[k] = value(most, k) - value(least, k);
  }
  out.largest_distance = thinned_distance(x, noise);
  return out;
}

}  // namespace kinemark::analysis
