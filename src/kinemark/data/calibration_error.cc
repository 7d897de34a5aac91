// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/calibration_error.h"

#include <fmt/core.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>

#include "kinemark/core/number.h"

namespace kinemark::data {
namespace {

constexpr std::size_t kMostFields = 12;
constexpr double kLeftOut = 1e-3;     // share of the variance that fields need not hold
constexpr double kSameTerm = 1e-4;    // of the largest: below it terms do not differ over the points
constexpr std::size_t kNumbers = 13;  // before the fields
constexpr double kRotation = 1e-6;    // how far from one a rotation of a file may be

using Terms = Eigen::Matrix<double, Eigen::Dynamic, CalibrationError::kTerms>;

Terms terms_of(const CalibrationError& error, const Points& points_in_world) {
  const Points p =
      ((points_in_world.rowwise() - error.middle_in_world.transpose()) * error.world_from_field) /
      error.scale_m;
  Terms out(p.rows(), CalibrationError::kTerms);
  int term = 0;
  for (int i = 0; i <= 3; ++i)
    for (int j = 0; i + j <= 3; ++j)
      for (int k = 0; i + j + k <= 3; ++k)
        out.col(term++) = p.col(0).array().pow(i) * p.col(1).array().pow(j) * p.col(2).array().pow(k);
  return out;
}

bool is_rotation(const Eigen::Matrix3d& r) {
  return (r * r.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < kRotation &&
         r.determinant() > 0.0;
}

}  // namespace

CalibrationError fit_calibration_error(const Points& points_in_world, const Eigen::MatrixXd& by_draw) {
  CalibrationError out;
  const Eigen::Index n = points_in_world.rows(), draws = by_draw.cols();
  if (n == 0 || draws == 0) return out;
  out.middle_in_world = points_in_world.colwise().mean().transpose();
  const Points about = points_in_world.rowwise() - out.middle_in_world.transpose();
  out.scale_m = std::max(about.cwiseAbs().maxCoeff(), 1e-3);
  // Points on a line or in a plane leave terms open: the least ones that fit.
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  solver.setThreshold(kSameTerm);
  const Eigen::MatrixXd terms = terms_of(out, points_in_world);
  solver.compute(terms);
  Eigen::MatrixXd coefficients(3 * CalibrationError::kTerms, draws), fitted(3 * n, draws);
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::MatrixXd one = solver.solve(by_draw(Eigen::seqN(axis, n, 3), Eigen::all));
    coefficients.middleRows(axis * CalibrationError::kTerms, CalibrationError::kTerms) = one;
    fitted.middleRows(axis * n, n) = terms * one;
  }
  // By decreasing variance over the points.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(fitted.transpose() * fitted);
  const double all = modes.eigenvalues().sum();
  double left = all;
  for (Eigen::Index k = draws - 1; k >= 0 && out.fields.size() < kMostFields && left > kLeftOut * all; --k) {
    const Eigen::VectorXd field = coefficients * modes.eigenvectors().col(k);
    out.fields.emplace_back(field.reshaped(CalibrationError::kTerms, 3));
    left -= modes.eigenvalues()[k];
  }
  return out;
}

std::vector<Points> displacements(const CalibrationError& error, const Points& points_in_world) {
  const Terms terms = terms_of(error, points_in_world);
  std::vector<Points> out;
  out.reserve(error.fields.size());
  for (const auto& field : error.fields) out.emplace_back(terms * field * error.world_from_field.transpose());
  return out;
}

CalibrationError turned(const CalibrationError& error, const Eigen::Matrix3d& to_from) {
  CalibrationError out = error;
  out.middle_in_world = to_from * error.middle_in_world;
  out.world_from_field = to_from * error.world_from_field;
  return out;
}

std::string to_text(const CalibrationError& error) {
  std::string out;
  if (!error.known()) return out;
  const auto put = [&](double value) {
    fmt::format_to(std::back_inserter(out), "{}{:.9g}", out.empty() ? "" : " ", value);
  };
  for (const double v : error.middle_in_world) put(v);
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) put(error.world_from_field(i, k));
  put(error.scale_m);
  for (const auto& field : error.fields)
    for (const double v : field.reshaped()) put(v);
  return out;
}

std::optional<CalibrationError> calibration_error_of(std::string_view text) {
  constexpr std::size_t kOfField = 3 * CalibrationError::kTerms;
  std::vector<double> numbers;
  while (!(text = trim(text)).empty()) {
    const auto end = std::min(text.find(' '), text.size());
    const auto number = parse_number(text.substr(0, end));
    if (!number || !std::isfinite(*number) || numbers.size() > kNumbers + kMostFields * kOfField)
      return std::nullopt;
    numbers.push_back(*number);
    text.remove_prefix(end);
  }
  if (numbers.size() <= kNumbers || (numbers.size() - kNumbers) % kOfField != 0 ||
      numbers.size() > kNumbers + kMostFields * kOfField)
    return std::nullopt;
  CalibrationError out;
  out.middle_in_world = Eigen::Vector3d(numbers.data());
  out.world_from_field = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(numbers.data() + 3);
  out.scale_m = numbers[12];
  if (!is_rotation(out.world_from_field) || !(out.scale_m > 0.0)) return std::nullopt;
  for (std::size_t at = kNumbers; at < numbers.size(); at += kOfField)
    out.fields.emplace_back(Eigen::Map<const CalibrationError::Field>(numbers.data() + at));
  return out;
}

}  // namespace kinemark::data
