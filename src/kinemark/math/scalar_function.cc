// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/scalar_function.h"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>

namespace kinemark::math {

ScalarFunction::ScalarFunction() : coefficients_{0.0, 1.0} {}

void ScalarFunction::refresh() {
  is_identity_ =
      kind_ == Kind::polynomial && factor_ == 1.0 && coefficients_ == std::vector<double>{0.0, 1.0};
}

ScalarFunction ScalarFunction::constant(double value) {
  ScalarFunction f;
  f.kind_ = Kind::constant;
  f.coefficients_ = {value};
  f.refresh();
  return f;
}

ScalarFunction ScalarFunction::linear(double slope, double offset) { return polynomial({offset, slope}); }

ScalarFunction ScalarFunction::polynomial(std::vector<double> coefficients) {
  ScalarFunction f;
  f.coefficients_ = std::move(coefficients);
  if (f.coefficients_.empty()) f.coefficients_ = {0.0};
  f.refresh();
  return f;
}

ScalarFunction ScalarFunction::sine(double amplitude, double omega, double phase, double offset) {
  ScalarFunction f;
  f.kind_ = Kind::sine;
  f.coefficients_ = {amplitude, omega, phase, offset};
  f.refresh();
  return f;
}

Result<ScalarFunction> ScalarFunction::through_knots(Kind kind, std::vector<double> x,
                                                     std::vector<double> y) {
  if (x.size() != y.size())
    return fail(Code::bad_input,
                fmt::format("function has {} x and {} y values; need as many", x.size(), y.size()));
  if (x.size() < 2)
    return fail(Code::bad_input, fmt::format("function has {} knots; need two or more", x.size()));
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i]))
      return fail(Code::bad_input, fmt::format("knot {} of a function is not a finite number", i + 1));
    if (i > 0 && x[i] <= x[i - 1])
      return fail(Code::bad_input, fmt::format("knots of a function must increase, but x[{}] = {} follows {}",
                                               i + 1, x[i], x[i - 1]));
  }
  ScalarFunction f;
  f.kind_ = kind;
  f.coefficients_.clear();
  f.x_ = std::move(x);
  f.y_ = std::move(y);
  f.second_.assign(f.x_.size(), 0.0);
  f.refresh();
  return f;
}

namespace {

// Second derivatives m of the cubic spline through (x, y):
//   h[i-1] m[i-1] + 2 (h[i-1] + h[i]) m[i] + h[i] m[i+1] = 6 (d[i] - d[i-1]),   h, d = widths and slopes of
//   the pieces.
// SIMM's end condition fixes the third derivative of the end pieces, (m1 - m0) / h0, to that of the cubic
// through the four points next to the end; with fewer than four points it is zero.
// The matrix is tridiagonal and stays dominant under elimination without pivoting.
std::vector<double> second_derivatives(const std::vector<double>& x, const std::vector<double>& y,
                                       bool natural) {
  const std::size_t n = x.size();
  if (n < 3) return std::vector<double>(n, 0.0);
  const auto h = [&](std::size_t i) { return x[i + 1] - x[i]; };
  const auto d = [&](std::size_t i) { return (y[i + 1] - y[i]) / h(i); };
  const auto third = [&](std::size_t i) {  // divided difference of order 3 on points i .. i+3
    const double left = (d(i + 1) - d(i)) / (x[i + 2] - x[i]);
    const double right = (d(i + 2) - d(i + 1)) / (x[i + 3] - x[i + 1]);
    return (right - left) / (x[i + 3] - x[i]);
  };
  std::vector<double> lower(n, 0.0), diagonal(n, 1.0), upper(n, 0.0), m(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    lower[i] = h(i - 1);
    diagonal[i] = 2.0 * (h(i - 1) + h(i));
    upper[i] = h(i);
    m[i] = 6.0 * (d(i) - d(i - 1));
  }
  if (!natural) {
    upper[0] = lower[n - 1] = -1.0;
    if (n > 3) {
      m[0] = -6.0 * h(0) * third(0);
      m[n - 1] = 6.0 * h(n - 2) * third(n - 4);
    }
  }
  for (std::size_t i = 1; i < n; ++i) {
    const double w = lower[i] / diagonal[i - 1];
    diagonal[i] -= w * upper[i - 1];
    m[i] -= w * m[i - 1];
  }
  m[n - 1] /= diagonal[n - 1];
  for (std::size_t i = n - 1; i-- > 0;) m[i] = (m[i] - upper[i] * m[i + 1]) / diagonal[i];
  return m;
}

}  // namespace

Result<ScalarFunction> ScalarFunction::simm_spline(std::vector<double> x, std::vector<double> y) {
  auto f = through_knots(Kind::simm_spline, std::move(x), std::move(y));
  if (f) f->second_ = second_derivatives(f->x_, f->y_, false);
  return f;
}

Result<ScalarFunction> ScalarFunction::natural_spline(std::vector<double> x, std::vector<double> y) {
  auto f = through_knots(Kind::natural_spline, std::move(x), std::move(y));
  if (f) f->second_ = second_derivatives(f->x_, f->y_, true);
  return f;
}

Result<ScalarFunction> ScalarFunction::piecewise_linear(std::vector<double> x, std::vector<double> y) {
  return through_knots(Kind::piecewise_linear, std::move(x), std::move(y));
}

ScalarFunction ScalarFunction::scaled(double factor) const {
  ScalarFunction f = *this;
  f.factor_ *= factor;
  f.refresh();
  return f;
}

FunctionValue ScalarFunction::operator()(double x) const {
  FunctionValue v;
  switch (kind_) {
    case Kind::constant:
      v.f = coefficients_[0];
      break;
    case Kind::polynomial:
      for (std::size_t i = coefficients_.size(); i-- > 0;) {  // Horner, with derivatives
        v.ddf = v.ddf * x + 2.0 * v.df;
        v.df = v.df * x + v.f;
        v.f = v.f * x + coefficients_[i];
      }
      break;
    case Kind::sine: {
      const double omega = coefficients_[1], argument = omega * x + coefficients_[2];
      v.f = coefficients_[0] * std::sin(argument) + coefficients_[3];
      v.df = coefficients_[0] * omega * std::cos(argument);
      v.ddf = -coefficients_[0] * omega * omega * std::sin(argument);
      break;
    }
    case Kind::simm_spline:
    case Kind::natural_spline:
    case Kind::piecewise_linear: {
      const double s = std::clamp(x, x_.front(), x_.back());
      const auto next = std::upper_bound(x_.begin() + 1, x_.end() - 1, s);
      const auto i = static_cast<std::size_t>(next - x_.begin()) - 1;
      const double h = x_[i + 1] - x_[i], u = s - x_[i];
      const double cubic = (second_[i + 1] - second_[i]) / (6.0 * h);
      const double slope = (y_[i + 1] - y_[i]) / h - h * (2.0 * second_[i] + second_[i + 1]) / 6.0;
      v.f = y_[i] + u * (slope + u * (second_[i] / 2.0 + u * cubic));
      v.df = slope + u * (second_[i] + 3.0 * u * cubic);
      v.ddf = second_[i] + 6.0 * u * cubic;
      if (x != s) {
        v.f += (x - s) * v.df;
        v.ddf = 0.0;
      }
      break;
    }
  }
  v.f *= factor_;
  v.df *= factor_;
  v.ddf *= factor_;
  return v;
}

bool ScalarFunction::is_constant() const {
  return kind_ == Kind::constant || (kind_ == Kind::polynomial && coefficients_.size() == 1) ||
         factor_ == 0.0;
}

bool ScalarFunction::is_linear() const {
  return kind_ == Kind::constant || (kind_ == Kind::polynomial && coefficients_.size() <= 2);
}

double ScalarFunction::slope() const {
  return is_linear() && coefficients_.size() == 2 ? factor_ * coefficients_[1] : 0.0;
}

double ScalarFunction::offset() const { return is_linear() ? factor_ * coefficients_[0] : 0.0; }

}  // namespace kinemark::math
