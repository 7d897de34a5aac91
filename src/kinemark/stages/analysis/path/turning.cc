// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/turning.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinemark/stages/analysis/path/shape.h"

namespace kinemark::analysis {
namespace {

constexpr double kOneWay = 0.95;  // net turn over all turning, from which it is one way
constexpr double kNearby = 0.02;  // of the radius: RMS distance from an ellipse on which a path lies
constexpr double kNoLine = 0.2;   // shorter over longer axis, below which an ellipse fits any line

}  // namespace

Turning turning_of(const PathMatrix& x) {
  Turning out;
  const auto principal = principal_axes(x);
  const PathMatrix along = along_axes(x, principal);
  const auto ellipse = ellipse_axes(along);
  if (!(ellipse.minor > 0.0)) return out;
  const Eigen::Index n = along.rows();
  const Eigen::MatrixX2d rays = along.leftCols<2>().rowwise() - ellipse.centre.transpose();
  const Eigen::ArrayXd radius = (rays * ellipse.form).cwiseProduct(rays).rowwise().sum().array().sqrt();
  Eigen::ArrayXd turned = Eigen::ArrayXd::Zero(n);  // rad, from the first sample on
  double there_and_back = 0.0;
  for (Eigen::Index i = 1; i < n; ++i) {
    const auto a = rays.row(i - 1), b = rays.row(i);
    const double step = std::atan2(a[0] * b[1] - a[1] * b[0], a.dot(b));
    turned[i] = turned[i - 1] + step;
    there_and_back += std::abs(step);
  }
  const double all = std::abs(turned[n - 1]), whole = 2.0 * std::numbers::pi;
  out.turns = all / whole;
  out.one_way = all >= kOneWay * there_and_back;
  out.on_an_ellipse =
      ellipse.minor >= kNoLine * ellipse.major && std::sqrt((radius - 1.0).square().mean()) <= kNearby;
  out.centre = principal.mean + ellipse.centre.transpose() * principal.axes.leftCols<2>().transpose();
  out.normal = std::copysign(1.0, turned[n - 1]) * principal.axes.col(2).transpose();
  if (!out.one_way || out.turns < 1.0) return out;
  const double end = whole * std::floor(out.turns);
  Eigen::Index last = n - 1;
  while (std::abs(turned[last - 1]) >= end) --last;  // the first is at 0
  const double before = std::abs(turned[last - 1]), behind = std::abs(turned[last]);
  out.whole_turns_end = static_cast<double>(last - 1) + (end - before) / (behind - before);
  return out;
}

double whole_turns_end(const PathMatrix& x, const Turning& near) {
  if (std::isnan(near.whole_turns_end)) return near.whole_turns_end;
  const auto ray = [&](Eigen::Index i) { return Eigen::RowVector3d(x.row(i) - near.centre); };
  const Eigen::RowVector3d first = ray(0);
  // Beyond the first sample's ray, by the sine of the angle times both distances.
  const auto beyond = [&](Eigen::Index i) { return first.cross(ray(i)).dot(near.normal); };
  auto i = std::min(static_cast<Eigen::Index>(near.whole_turns_end), x.rows() - 2);
  while (i > 0 && beyond(i) > 0.0) --i;
  while (i < x.rows() - 2 && beyond(i + 1) <= 0.0) ++i;
  const double before = beyond(i), behind = beyond(i + 1);
  if (!(behind > 0.0)) return static_cast<double>(x.rows() - 1);
  return static_cast<double>(i) + std::clamp(-before / (behind - before), 0.0, 1.0);
}

}  // namespace kinemark::analysis
