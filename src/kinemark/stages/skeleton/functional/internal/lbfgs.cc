// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/internal/lbfgs.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>
#include <vector>

namespace kinemark::skeleton::internal {
namespace {

using Cost = std::function<double(const Eigen::VectorXd&, Eigen::VectorXd&)>;

constexpr double kDecrease = 1e-3, kCurvature = 0.9;
constexpr int kTrials = 20;

struct Point {
  double step = 0.0, value = 0.0, slope = 0.0;
};

/// Step between two points by the cubic through their values and slopes, kept off the ends.
double between(const Point& a, const Point& b) {
  const double d1 = a.slope + b.slope - 3.0 * (a.value - b.value) / (a.step - b.step);
  const double square = d1 * d1 - a.slope * b.slope;
  const double low = std::min(a.step, b.step), high = std::max(a.step, b.step), margin = 0.1 * (high - low);
  double step = 0.5 * (a.step + b.step);
  if (square >= 0.0) {
    const double d2 = std::copysign(std::sqrt(square), b.step - a.step);
    const double cubic = b.step - (b.step - a.step) * (b.slope + d2 - d1) / (b.slope - a.slope + 2.0 * d2);
    if (std::isfinite(cubic)) step = cubic;
  }
  return std::clamp(step, low + margin, high - margin);
}

/// Step along `direction` that meets the strong Wolfe conditions, or the best that was tried. x, value and
/// gradient move there. False when nothing lowers the value.
bool search_line(const Cost& cost, const Eigen::VectorXd& direction, double first_step, Eigen::VectorXd& x,
                 double& value, Eigen::VectorXd& gradient) {
  const Eigen::VectorXd from = x;
  const Point start{0.0, value, gradient.dot(direction)};
  Eigen::VectorXd at, g(gradient.size());
  const auto try_step = [&](double step) {
    at = from + step * direction;
    const double v = cost(at, g);
    return Point{step, v, g.dot(direction)};
  };
  Point low = start, high{};
  bool bracketed = false, lowered = false;
  double step = first_step;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Point now = try_step(step);
    const bool enough =
        now.value <= start.value + kDecrease * now.step * start.slope && now.value < low.value;
    if (!enough && !(low.step == 0.0 && now.value <= start.value + kDecrease * now.step * start.slope)) {
      high = now;
      bracketed = true;
    } else {
      x = at;
      value = now.value;
      gradient = g;
      lowered = true;
      if (std::abs(now.slope) <= -kCurvature * start.slope) return true;
      if (bracketed ? now.slope * (high.step - low.step) >= 0.0 : now.slope >= 0.0) {
        high = low;
        bracketed = true;
      }
      low = now;
    }
    step = bracketed ? between(low, high) : 2.0 * step;
    if (bracketed && std::abs(high.step - low.step) <= 1e-14 * std::max(1.0, std::abs(low.step))) break;
  }
  return lowered;
}

}  // namespace

double minimise_lbfgs(const Cost& cost, Eigen::VectorXd& x, const LbfgsOptions& options) {
  Eigen::VectorXd gradient(x.size());
  double value = cost(x, gradient);
  std::deque<std::pair<Eigen::VectorXd, Eigen::VectorXd>> pairs;  // steps and changes of the gradient
  for (int i = 0; i < options.iterations; ++i) {
    if (gradient.lpNorm<Eigen::Infinity>() <= options.gradient_tolerance) break;
    Eigen::VectorXd direction = -gradient;
    std::vector<double> weights(pairs.size());
    for (std::size_t k = pairs.size(); k-- > 0;) {
      weights[k] = pairs[k].first.dot(direction) / pairs[k].first.dot(pairs[k].second);
      direction -= weights[k] * pairs[k].second;
    }
    if (!pairs.empty())
      direction *= pairs.back().first.dot(pairs.back().second) / pairs.back().second.squaredNorm();
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const double beta = pairs[k].second.dot(direction) / pairs[k].first.dot(pairs[k].second);
      direction += (weights[k] - beta) * pairs[k].first;
    }
    if (direction.dot(gradient) >= 0.0) {
      pairs.clear();
      direction = -gradient;
    }
    const Eigen::VectorXd x0 = x, g0 = gradient;
    const double before = value;
    const double first = pairs.empty() ? std::min(1.0, 1.0 / gradient.norm()) : 1.0;
    if (!search_line(cost, direction, first, x, value, gradient)) {
      if (pairs.empty()) break;
      pairs.clear();
      continue;
    }
    const Eigen::VectorXd s = x - x0, y = gradient - g0;
    if (s.dot(y) > 1e-16 * y.squaredNorm()) {
      pairs.emplace_back(s, y);
      if (static_cast<int>(pairs.size()) > options.memory) pairs.pop_front();
    }
    if (before - value <= options.cost_tolerance * std::max({std::abs(before), std::abs(value), 1e-300}))
      break;
  }
  return value;
}

}  // namespace kinemark::skeleton::internal
