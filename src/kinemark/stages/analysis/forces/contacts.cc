// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/forces/contacts.h"

#include <algorithm>
#include <cmath>

namespace kinemark::analysis {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kBegins_n = 20.0, kEnds_n = 10.0;
constexpr double kShortest_s = 0.05;
constexpr double kValley = 0.97;  // of both humps
constexpr double kTravel_m = 0.02;

// Index between samples at which the load first passes `level`, up to `last`; NaN where it is above from the
// start.
double passes(const VectorXd& load, double level, Index last) {
  if (load[0] >= level) return kNaN;
  for (Index i = 1; i <= last; ++i)
    if (load[i] >= level) return static_cast<double>(i) - (load[i] - level) / (load[i] - load[i - 1]);
  return kNaN;
}

}  // namespace

std::vector<PlateContact> find_contacts(const VectorXd& load, double rate_hz) {
  std::vector<PlateContact> out;
  const auto least = static_cast<std::int64_t>(std::ceil(kShortest_s * rate_hz));
  for (Index f = 0; f < load.size(); ++f) {
    if (!(load[f] > kBegins_n)) continue;
    PlateContact contact{.first = f, .whole = f > 0 && !std::isnan(load[f - 1])};
    while (f < load.size() && load[f] >= kEnds_n) ++f;
    contact.count = f - contact.first;
    contact.whole = contact.whole && f < load.size() && !std::isnan(load[f]);
    if (contact.count >= least) out.push_back(contact);
  }
  return out;
}

LoadHumps load_humps(const VectorXd& load) {
  const auto n = load.size();
  if (n < 5) return {};
  Index first = 0, second = 0;
  LoadHumps out{.first = load.head(n / 2).maxCoeff(&first), .second = load.tail(n - n / 2).maxCoeff(&second)};
  second += n / 2;
  out.valley = load.segment(first, second - first + 1).minCoeff();
  if (!(out.valley < kValley * std::min(out.first, out.second))) return {};
  return out;
}

double loading_rate(const VectorXd& load, double rate_hz) {
  Index at = 0;
  const auto humps = load_humps(load);
  double peak = load.maxCoeff(&at);
  if (std::isfinite(humps.first)) peak = load.head(load.size() / 2).maxCoeff(&at);
  const double from = passes(load, 0.2 * peak, at), to = passes(load, 0.8 * peak, at);
  return to > from ? 0.6 * peak * rate_hz / (to - from) : kNaN;
}

BrakingPropulsion braking_propulsion(const VectorXd& along, double rate_hz) {
  return {.braking = along.cwiseMin(0.0).sum() / rate_hz, .propulsion = along.cwiseMax(0.0).sum() / rate_hz};
}

Eigen::Vector3d direction_of_travel(const Eigen::MatrixX3d& x, const VectorXd& load) {
  const auto third = x.rows() / 3;
  const auto centre = [&](Index begin, Index count) -> Eigen::Vector3d {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double weight = 0.0;
    for (Index i = begin; i < begin + count; ++i)
      if (load[i] > 0.0 && x.row(i).allFinite()) sum += load[i] * x.row(i).transpose(), weight += load[i];
    return weight > 0.0 ? Eigen::Vector3d(sum / weight) : Eigen::Vector3d::Constant(kNaN);
  };
  if (third < 1) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d way = centre(x.rows() - third, third) - centre(0, third);
  return way.norm() > kTravel_m ? Eigen::Vector3d(way.normalized()) : Eigen::Vector3d::Zero();
}

}  // namespace kinemark::analysis
