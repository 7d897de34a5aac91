// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/camera/light.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace kinemark::camera {
namespace {

constexpr double kUnknownCounts = 1.0;  // SD of each channel's stray light by itself where it is not known
constexpr std::int64_t kFewestFrames = 16;

}  // namespace

StrayLight stray_light(const data::Detector& detector) {
  if (detector.knows_dark())
    return {.counts = detector.offset_counts - detector.dark_counts,
            .sd_counts = detector.dark_sd_counts,
            .known = true};
  // Of an even chance between 0 and 1 the mean is 1/2 and the SD 1/sqrt(12), which is 1/sqrt(3) of the mean.
  return {.counts = 0.5 * detector.offset_counts.cwiseMax(0.0),
          .sd_counts = kUnknownCounts,
          .share_sd = 1.0 / std::numbers::sqrt3};
}

data::Rig with_light(const data::Rig& rig, const Light& light) {
  data::Rig out = rig;
  const double more = light.value - 1.0;
  if (more == 0.0 && light.sd == 0.0) return out;
  if (out.covariance.size() == 0)
    out.covariance = Eigen::MatrixXd::Zero(rig.parameter_count(), rig.parameter_count());
  Eigen::VectorXd factor = Eigen::VectorXd::Ones(rig.parameter_count());
  Eigen::VectorXd by_light = Eigen::VectorXd::Zero(rig.parameter_count()), by_share = by_light;
  Eigen::VectorXd variance = Eigen::VectorXd::Zero(rig.parameter_count());
  for (int c = 0; c < rig.camera_count(); ++c) {
    auto& camera = out.cameras[static_cast<std::size_t>(c)];
    if (camera.kind != data::CameraKind::lateral_effect) continue;
    const auto stray = stray_light(camera.detector);
    const int at = rig.first_parameter(c) + data::ParameterLayout(camera).offset;
    camera.detector.offset_counts += more * stray.counts;
    by_light.segment<4>(at) = stray.counts;
    by_share.segment<4>(at) = more * stray.share_sd * stray.counts;
    if (stray.known) factor.segment<4>(at).setConstant(light.value);  // offset' = s offset - (s - 1) dark
    variance.segment<4>(at).setConstant(more * more * stray.sd_counts * stray.sd_counts);
  }
  out.covariance = factor.asDiagonal() * out.covariance * factor.asDiagonal();
  out.covariance.diagonal() += variance;
  out.covariance += light.sd * light.sd * by_light * by_light.transpose();
  out.covariance += by_share * by_share.transpose();
  return out;
}

std::optional<DarkSlot> dark_slot(const data::Counts& counts, std::int64_t camera, double flicker_hz) {
  if (!counts.has_dark_slot() || counts.frames() < kFewestFrames) return std::nullopt;
  const double omega = 2.0 * std::numbers::pi * flicker_hz;
  using Vector6d = Eigen::Matrix<double, 6, 1>;
  // Each channel has an offset of its own; the flicker is common.
  Eigen::Matrix<double, 6, 6> square = Eigen::Matrix<double, 6, 6>::Zero();
  Vector6d right = Vector6d::Zero();
  double squares = 0.0;
  Eigen::Vector4d at_zero = Eigen::Vector4d::Zero();
  for (std::int64_t f = 0; f < counts.frames(); ++f) {
    const Eigen::Vector4d read = counts.dark_at(f, camera), offset = counts.dark_offset_s(camera);
    for (int k = 0; k < 4; ++k) {
      const double phase = omega * (counts.time.time_s(f) + offset[k]);
      Vector6d row = Vector6d::Zero();
      row[k] = 1.0, row[4] = std::cos(phase), row[5] = std::sin(phase);
      square += row * row.transpose();
      right += row * read[k];
      squares += read[k] * read[k];
      at_zero[k] += read[k] <= 0.0;
    }
  }
  const auto frames = static_cast<double>(counts.frames());
  const Eigen::FullPivLU<Eigen::Matrix<double, 6, 6>> lu(square);
  if (!lu.isInvertible() || at_zero.maxCoeff() > 0.05 * frames) return std::nullopt;
  const Vector6d found = lu.solve(right);
  const double variance = std::max(0.0, squares - found.dot(right)) / (4.0 * frames - 6.0);
  return DarkSlot{
      .counts = found.head<4>(), .sd_counts = std::sqrt(variance / frames), .flicker = found.tail<2>()};
}

void find_dark_counts(const data::Counts& counts, data::Rig& rig) {
  for (std::size_t c = 0; c < rig.cameras.size() && c < counts.cameras.size(); ++c)
    if (const auto dark = dark_slot(counts, static_cast<std::int64_t>(c))) {
      rig.cameras[c].detector.dark_counts = dark->counts;
      rig.cameras[c].detector.dark_sd_counts = dark->sd_counts;
    }
}

void begin_in_the_dark(const data::Counts& counts, data::Rig& rig) {
  find_dark_counts(counts, rig);
  for (auto& camera : rig.cameras)
    if (camera.detector.knows_dark()) camera.detector.offset_counts = camera.detector.dark_counts;
}

std::vector<double> follow_dark_counts(const data::Counts& counts, data::Rig& rig) {
  constexpr double kSure = 5.0;  // deviations
  std::vector<double> out(rig.cameras.size(), 0.0);
  for (std::size_t c = 0; c < rig.cameras.size() && c < counts.cameras.size(); ++c) {
    auto& detector = rig.cameras[c].detector;
    if (!detector.knows_dark()) continue;
    const auto dark = dark_slot(counts, static_cast<std::int64_t>(c));
    if (!dark) continue;
    const Eigen::Vector4d change = dark->counts - detector.dark_counts;
    const double largest = change.cwiseAbs().maxCoeff(),
                 sd = std::hypot(dark->sd_counts, detector.dark_sd_counts);
    if (largest < kDrifted_counts || largest < kSure * sd) continue;
    detector.offset_counts += change;
    detector.dark_counts = dark->counts;
    detector.dark_sd_counts = dark->sd_counts;
    if (rig.covariance.size() > 0) {
      const int first =
          rig.first_parameter(static_cast<int>(c)) + data::ParameterLayout(rig.cameras[c]).offset;
      rig.covariance.diagonal().segment<4>(first).array() += sd * sd;
    }
    out[c] = largest;
  }
  return out;
}

}  // namespace kinemark::camera
