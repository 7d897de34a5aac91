// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/body/extremes.h"

#include <algorithm>
#include <cmath>

namespace kinemark::analysis {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

// The sample of the largest sign * value, the first of equal ones; -1 where there is none.
Index farthest(const VectorXd& curve, double sign) {
  Index out = -1;
  for (Index i = 0; i < curve.size(); ++i)
    if (!std::isnan(curve[i]) && (out < 0 || sign * curve[i] > sign * curve[out])) out = i;
  return out;
}

double value_at(const VectorXd& curve, Index i) { return i < 0 ? kNaN : curve[i]; }

// Mean over vectors of three values: the component of `value` along `place`. It is the mean over the time
// from the first to the last, which are weighed half each.
double mean_along(const VectorXd& place, const VectorXd& value) {
  const Index vectors = place.size() / 3;
  if (vectors == 0) return kNaN;
  double sum = 0.0;
  for (Index i = 0; i < vectors; ++i) {
    const double length = place.segment<3>(3 * i).norm();
    const double weight = i == 0 || i == vectors - 1 ? 0.5 : 1.0;
    if (length != 0.0) sum += weight * place.segment<3>(3 * i).dot(value.segment<3>(3 * i)) / length;
  }
  return vectors == 1 ? 2.0 * sum : sum / static_cast<double>(vectors - 1);
}

// `value` where `place` has the extreme.
double taken_from(Pick pick, const VectorXd& place, const VectorXd& value) {
  if (pick == Pick::mean_size) return mean_along(place, value);
  const Index most = farthest(place, 1.0), least = farthest(place, -1.0);
  switch (pick) {
    case Pick::largest:
      return value_at(value, most);
    case Pick::smallest:
      return value_at(value, least);
    case Pick::range:
      return value_at(value, most) - value_at(value, least);
    default:
      return value_at(place, most) > -value_at(place, least) ? value_at(value, most)
                                                             : -value_at(value, least);
  }
}

}  // namespace

double picked(Pick pick, const VectorXd& curve) {
  if (pick != Pick::time_of_largest && pick != Pick::time_of_smallest) return taken_from(pick, curve, curve);
  const Index at = farthest(curve, pick == Pick::time_of_largest ? 1.0 : -1.0);
  return at < 0 ? kNaN : static_cast<double>(at);
}

double thinned(Pick pick, const VectorXd& curve, const VectorXd& noise) {
  if (noise.size() != curve.size()) return kNaN;
  const VectorXd more = curve + noise, less = curve - noise;
  return 0.5 * (taken_from(pick, more, less) + taken_from(pick, less, more));
}

InstantSet::InstantSet(Pick pick, const VectorXd& curve)
    : below_(VectorXd::Constant(curve.size(), kNaN)),
      sum_(VectorXd::Zero(curve.size())),
      squares_(sum_),
      sign_(pick == Pick::time_of_largest ? 1.0 : -1.0) {
  extreme_ = farthest(curve, sign_);
  if (extreme_ >= 0) below_ = sign_ * (curve[extreme_] - curve.array());
}

void InstantSet::add(const VectorXd& noise) {
  if (extreme_ < 0 || noise.size() != below_.size()) return;
  const VectorXd difference = noise[extreme_] - noise.array();
  sum_ += difference;
  squares_ += difference.cwiseAbs2();
  count_ += 1.0;
}

PossibleInstants InstantSet::within(double deviations) const {
  PossibleInstants out{extreme_, extreme_};
  if (extreme_ < 0 || count_ < 2.0) return out;
  for (Index i = 0; i < below_.size(); ++i) {
    const double variance = (squares_[i] - sum_[i] * sum_[i] / count_) / (count_ - 1.0);
    if (!(below_[i] <= deviations * std::sqrt(std::max(0.0, variance)))) continue;
    out.first = std::min(out.first, i);
    out.last = std::max(out.last, i);
  }
  return out;
}

}  // namespace kinemark::analysis
