// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/noise_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "kinemark/core/check.h"

namespace kinemark::math {
namespace {

constexpr double kHalfTurn = std::numbers::pi;
constexpr double kHighest = 0.4995;  // where a tangent still has a value

// Transform of the cardinal B-spline of order 2m at the integers (Unser, Aldroubi & Eden 1993).
double spline_transform(int order, double frequency) {
  static constexpr std::array<std::array<double, 5>, 5> kValues{
      {{1.0, 0.0, 0.0, 0.0, 0.0},
       {4.0 / 6, 1.0 / 6, 0.0, 0.0, 0.0},
       {66.0 / 120, 26.0 / 120, 1.0 / 120, 0.0, 0.0},
       {2416.0 / 5040, 1191.0 / 5040, 120.0 / 5040, 1.0 / 5040, 0.0},
       {156190.0 / 362880, 88234.0 / 362880, 14608.0 / 362880, 502.0 / 362880, 1.0 / 362880}}};
  check(order >= 1 && order <= 5, "a spline's order is 1 to 5");
  const auto& values = kValues[static_cast<std::size_t>(order - 1)];
  double out = values[0];
  for (int k = 1; k < order; ++k)
    out += 2.0 * values[static_cast<std::size_t>(k)] * std::cos(2.0 * kHalfTurn * k * frequency);
  return out;
}

}  // namespace

std::string_view to_string(NoiseKind kind) {
  switch (kind) {
    case NoiseKind::white:
      return "white";
    case NoiseKind::correlated:
      return "correlated";
    case NoiseKind::correlated_and_white:
      return "correlated and white";
    case NoiseKind::filtered:
      return "filtered";
  }
  return "";
}

std::string name_of(LowPass form, int order) {
  static constexpr std::array<std::string_view, 5> kSplines{"linear", "cubic", "quintic", "heptic", "nonic"};
  if (form == LowPass::butterworth)
    return "Butterworth filter of order " + std::to_string(order) + ", both ways";
  return std::string(kSplines[static_cast<std::size_t>(std::clamp(order, 1, 5) - 1)]) + " spline";
}

double roll_off(LowPass form, int order, double frequency) {
  if (form == LowPass::butterworth)
    return std::pow(std::tan(kHalfTurn * std::min(frequency, kHighest)), 2 * order);
  return std::pow(2.0 * std::sin(kHalfTurn * frequency), 2 * order) / spline_transform(order, frequency);
}

double roll_off_at_half(LowPass form, int order, double half) {
  if (form == LowPass::butterworth) return std::pow(std::tan(kHalfTurn * std::min(half, 0.49)), 2 * order);
  return std::pow(2.0 * kHalfTurn * half, 2 * order);
}

double gain_of(LowPass form, int order, double half, double frequency) {
  return 1.0 / (1.0 + roll_off(form, order, frequency) / roll_off_at_half(form, order, half));
}

double three_db_of_half(LowPass form, int order, double half) {
  const double wanted = (std::numbers::sqrt2 - 1.0) * roll_off_at_half(form, order, half);
  double low = 0.0, high = kHighest;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (roll_off(form, order, middle) < wanted ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double half_of_three_db(LowPass form, int order, double three_db) {
  const double there = roll_off(form, order, three_db) / (std::numbers::sqrt2 - 1.0);
  const double root = std::pow(there, 0.5 / order);
  return form == LowPass::butterworth ? std::atan(root) / kHalfTurn : root / (2.0 * kHalfTurn);
}

double NoiseModel::before_filter(double frequency) const {
  const double rho = correlation;
  const double shape =
      rho == 0.0 ? 1.0
                 : (1.0 - rho * rho) / (1.0 - 2.0 * rho * std::cos(2.0 * kHalfTurn * frequency) + rho * rho);
  return variance * shape + floor;
}

double NoiseModel::gain(double frequency) const {
  return order == 0 ? 1.0 : gain_of(form, order, half, frequency);
}

double NoiseModel::power(double frequency) const {
  const double h = gain(frequency);
  return h * h * (before_filter(frequency) - floor) + floor;
}

double NoiseModel::sd(bool before) const {
  if (before || order == 0) return std::sqrt(variance + floor);
  constexpr int kSteps = 2000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) sum += power(0.5 * (i + 0.5) / kSteps) / kSteps;
  return std::sqrt(sum);
}

}  // namespace kinemark::math
