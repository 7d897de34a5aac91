// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Functions of one variable with two derivatives: every kind that OpenSim joints and couplers use.
#pragma once

#include <string>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::math {

/// Value and first two derivatives at one argument.
struct FunctionValue {
  double f = 0.0;    ///< f(x)
  double df = 0.0;   ///< f'(x)
  double ddf = 0.0;  ///< f''(x)
};

/// A smooth function R -> R. Angles in radians, lengths in metres, as the owner defines.
class ScalarFunction {
 public:
  /// How the function is written down.
  enum class Kind { constant, polynomial, sine, simm_spline, natural_spline, piecewise_linear };

  /// The identity, x.
  ScalarFunction();
  /// The same value everywhere.
  static ScalarFunction constant(double value);
  /// slope * x + offset.
  static ScalarFunction linear(double slope, double offset);
  /// Coefficients from the constant upwards: c0 + c1 x + c2 x^2 ... (OpenSim files write the highest first.)
  static ScalarFunction polynomial(std::vector<double> coefficients);
  /// amplitude * sin(omega * x + phase) + offset.
  static ScalarFunction sine(double amplitude, double omega, double phase, double offset);
  /// Cubic spline as SIMM and OpenSim evaluate it: third derivatives at both ends from four-point divided
  /// differences, linear beyond the knots (so the second derivative jumps there). Two knots: a line.
  /// Fails unless x increases strictly and both lists have the same length, two or more.
  static Result<ScalarFunction> simm_spline(std::vector<double> x, std::vector<double> y);
  /// Natural cubic spline (second derivative zero at both ends), linear beyond the knots.
  static Result<ScalarFunction> natural_spline(std::vector<double> x, std::vector<double> y);
  /// Straight lines between the knots; the end pieces go on.
  static Result<ScalarFunction> piecewise_linear(std::vector<double> x, std::vector<double> y);

  /// The same function times a factor (OpenSim's MultiplierFunction).
  [[nodiscard]] ScalarFunction scaled(double factor) const;

  /// Value, first and second derivative. O(1), O(log knots) for splines; allocates nothing.
  [[nodiscard]] FunctionValue operator()(double x) const;

  [[nodiscard]] Kind kind() const { return kind_; }                ///< how it is written down
  [[nodiscard]] bool is_identity() const { return is_identity_; }  ///< f(x) = x, exactly
  /// True for a polynomial of degree 0.
  [[nodiscard]] bool is_constant() const;
  /// True for a polynomial of degree one or less; then slope() and offset() hold.
  [[nodiscard]] bool is_linear() const;
  /// f'(x) of a line.
  [[nodiscard]] double slope() const;
  /// f(0) of a line.
  [[nodiscard]] double offset() const;
  /// Multiplier in front of everything below.
  [[nodiscard]] double factor() const { return factor_; }
  /// polynomial: coefficients from the constant upwards; sine: amplitude, omega, phase, offset.
  [[nodiscard]] const std::vector<double>& coefficients() const { return coefficients_; }
  /// splines and piecewise lines: increasing
  [[nodiscard]] const std::vector<double>& knots_x() const { return x_; }
  /// splines and piecewise lines: one a knot
  [[nodiscard]] const std::vector<double>& knots_y() const { return y_; }

 private:
  static Result<ScalarFunction> through_knots(Kind kind, std::vector<double> x, std::vector<double> y);
  void refresh();

  Kind kind_ = Kind::polynomial;
  bool is_identity_ = true;
  double factor_ = 1.0;
  std::vector<double> coefficients_;
  std::vector<double> x_, y_, second_;  // second_: second derivatives at the knots
};

}  // namespace kinemark::math
