// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/calibration_error.h"

#include <fmt/core.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "kinemark/core/number.h"

namespace kinemark::data {
namespace {

constexpr std::size_t kNumbers = 13;  // before the fields
constexpr double kRotation = 1e-6;    // how far from one a rotation of a file may be

bool is_rotation(const Eigen::Matrix3d& r) {
  return (r * r.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < kRotation &&
         r.determinant() > 0.0;
}

}  // namespace

CalibrationTerms terms_of(const CalibrationError& error, const Points& points_in_world) {
  const Points p =
      ((points_in_world.rowwise() - error.middle_in_world.transpose()) * error.world_from_field) /
      error.scale_m;
  CalibrationTerms out(p.rows(), CalibrationError::kTerms);
  int term = 0;
  for (int i = 0; i <= 3; ++i)
    for (int j = 0; i + j <= 3; ++j)
      for (int k = 0; i + j + k <= 3; ++k)
        out.col(term++) = p.col(0).array().pow(i) * p.col(1).array().pow(j) * p.col(2).array().pow(k);
  return out;
}

std::vector<Points> displacements(const CalibrationError& error, const Points& points_in_world) {
  const CalibrationTerms terms = terms_of(error, points_in_world);
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

double rms_of(const CalibrationError& error, const Trajectories& markers) {
  constexpr std::int64_t kFrames = 200;
  const std::int64_t step = std::max<std::int64_t>(1, markers.frames() / kFrames);
  std::vector<Eigen::Vector3d> found;
  for (std::int64_t f = 0; f < markers.frames(); f += step)
    for (std::int64_t m = 0; m < markers.markers(); ++m)
      if (markers.present(f, m)) found.push_back(markers.x(f, m));
  if (found.empty() || !error.known()) return 0.0;
  Points points(static_cast<Eigen::Index>(found.size()), 3);
  for (std::size_t i = 0; i < found.size(); ++i)
    points.row(static_cast<Eigen::Index>(i)) = found[i].transpose();
  double squares = 0.0;
  for (const auto& field : displacements(error, points)) squares += field.squaredNorm();
  return std::sqrt(squares / static_cast<double>(found.size()));
}

std::string describe(const CalibrationError& error, const Trajectories& markers) {
  if (!error.known()) return {};
  return fmt::format("the calibration leaves unknown {:.2g} mm of positions, in common (RMS over samples)",
                     1e3 * rms_of(error, markers));
}

std::string note_held(std::string_view what, double unknown_m) {
  if (!(unknown_m > 0.0)) return {};
  return fmt::format("{} hold what the calibration leaves unknown of all positions: {:.2g} mm (RMS)", what,
                     1e3 * unknown_m);
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
    if (!number || !std::isfinite(*number) ||
        numbers.size() > kNumbers + CalibrationError::kMostFields * kOfField)
      return std::nullopt;
    numbers.push_back(*number);
    text.remove_prefix(end);
  }
  if (numbers.size() <= kNumbers || (numbers.size() - kNumbers) % kOfField != 0 ||
      numbers.size() > kNumbers + CalibrationError::kMostFields * kOfField)
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
