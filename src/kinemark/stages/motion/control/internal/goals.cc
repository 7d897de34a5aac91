// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/goals.h"

#include <algorithm>
#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/math/digital_filter.h"

namespace kinemark::motion::internal {
namespace {

constexpr double kNoLowpass = 0.45;            // of the rate: a cut-off beyond it changes nothing
constexpr double kPole = -0.2679491924311227;  // sqrt(3) - 2, of the inverse B-spline
constexpr int kShortest = 12;                  // frames on each side: what the inverse B-spline needs
constexpr double kFar = 1e9;

/// Impulse response of the two-pass low-pass, from the middle outwards.
std::vector<double> lowpass_response(double cutoff, std::int64_t reach) {
  std::vector<double> response(at(reach + 1), 0.0);
  response[0] = 1.0;
  if (cutoff <= 0.0 || cutoff >= kNoLowpass) return response;
  const auto sections = math::butterworth_lowpass(2, math::two_pass_cutoff(2, cutoff));
  // Long enough for the effect of the ends to decay.
  const auto half = reach + static_cast<std::int64_t>(std::ceil(3.0 / cutoff));
  std::vector<double> impulse(at(2 * half + 1), 0.0);
  impulse[at(half)] = 1.0;
  math::filter_both_ways(sections, 0, impulse);
  for (std::int64_t k = 0; k <= reach; ++k) response[at(k)] = impulse[at(half + k)];
  return response;
}

std::vector<double> make_kernel(double cutoff, std::int64_t reach) {
  const auto response = lowpass_response(cutoff, reach + 40);
  std::vector<double> kernel(at(reach + 1));
  const double gain = -6.0 * kPole / (1.0 - kPole * kPole);
  for (std::int64_t k = 0; k <= reach; ++k) {
    double sum = 0.0;
    for (std::int64_t j = -40; j <= 40; ++j)
      sum += response[at(std::abs(k - j))] * gain * std::pow(kPole, static_cast<double>(std::abs(j)));
    kernel[at(k)] = sum;
  }
  // Sum 1 and second moment -1/3, which the B-spline's own +1/3 cancels: parabolas pass unchanged.
  double m0 = kernel[0], m2 = 0.0, m4 = 0.0;
  for (std::int64_t k = 1; k <= reach; ++k) {
    const double square = static_cast<double>(k * k);
    m0 += 2.0 * kernel[at(k)];
    m2 += 2.0 * kernel[at(k)] * square;
    m4 += 2.0 * kernel[at(k)] * square * square;
  }
  const double determinant = m0 * m4 - m2 * m2;
  const double level = (m4 + m2 / 3.0) / determinant, curvature = (-m0 / 3.0 - m2) / determinant;
  for (std::int64_t k = 0; k <= reach; ++k) kernel[at(k)] *= level + curvature * static_cast<double>(k * k);
  return kernel;
}

}  // namespace

SampleWindow::SampleWindow(int markers, std::int64_t capacity)
    : x_(Eigen::MatrixXd::Zero(3 * markers, capacity)), weight_(Eigen::MatrixXd::Zero(markers, capacity)) {}

void SampleWindow::push(const Eigen::Matrix3Xd& x, const Eigen::VectorXd& weight) {
  const Eigen::Index column = frames_++ % weight_.cols();
  for (Eigen::Index m = 0; m < weight.size(); ++m) x_.block<3, 1>(3 * m, column) = x.col(m);
  weight_.col(column) = weight;
}

double SampleWindow::weight(std::int64_t frame, int marker) const {
  if (frame < 0 || frame >= frames_ || frame < frames_ - weight_.cols()) return 0.0;
  return weight_(marker, frame % weight_.cols());
}

Eigen::Vector3d SampleWindow::x(std::int64_t frame, int marker) const {
  return x_.block<3, 1>(3 * static_cast<Eigen::Index>(marker), frame % weight_.cols());
}

GoalValues::GoalValues(int markers)
    : x(Eigen::Matrix3Xd::Zero(3, markers)), v(x), a(x), weight(Eigen::VectorXd::Zero(markers)) {}

GoalCell::GoalCell(int markers) : weight_(Eigen::VectorXd::Zero(markers)), since_(weight_), until_(weight_) {
  power_.fill(Eigen::Matrix3Xd::Zero(3, markers));
}

void GoalCell::at(double u, GoalValues& out) const {
  const auto& p = power_;
  out.x = ((((p[5] * u + p[4]) * u + p[3]) * u + p[2]) * u + p[1]) * u + p[0];
  out.v = (((p[5] * (5.0 * u) + 4.0 * p[4]) * u + 3.0 * p[3]) * u + 2.0 * p[2]) * u + p[1];
  out.v *= rate_hz_;
  out.a = ((p[5] * (20.0 * u) + 12.0 * p[4]) * u + 6.0 * p[3]) * u + 2.0 * p[2];
  out.a *= rate_hz_ * rate_hz_;
  for (Eigen::Index m = 0; m < weight_.size(); ++m)
    out.weight[m] = weight_[m] * smooth_step((since_[m] + u) / fade_frames_) *
                    smooth_step((until_[m] - u) / fade_frames_);
}

void GoalCell::acceleration_at(double u, Eigen::Matrix3Xd& out) const {
  const auto& p = power_;
  const double inside = std::min(u, 1.0);
  out = ((p[5] * (20.0 * inside) + 12.0 * p[4]) * inside + 6.0 * p[3]) * inside + 2.0 * p[2];
  if (u > inside) out += (u - inside) * ((p[5] * (60.0 * inside) + 24.0 * p[4]) * inside + 6.0 * p[3]);
  out *= rate_hz_ * rate_hz_;
}

GoalFilter::GoalFilter(double rate_hz, double cutoff_hz, double lookahead_s, double fade_s)
    : rate_hz_(rate_hz), fade_frames_(std::max(1.0, fade_s * rate_hz)) {
  const double cutoff = cutoff_hz / rate_hz;
  const bool none = cutoff <= 0.0 || cutoff >= kNoLowpass;
  const double wished = lookahead_s > 0.0 ? lookahead_s : (none ? 0.0 : 1.2 / cutoff_hz);
  kernel_ = make_kernel(
      cutoff, std::max<std::int64_t>(kShortest, static_cast<std::int64_t>(std::ceil(wished * rate_hz))));
}

std::int64_t GoalFilter::delay_frames() const {
  return std::max(static_cast<std::int64_t>(kernel_.size()),
                  static_cast<std::int64_t>(std::ceil(fade_frames_)) + 1);
}

double GoalFilter::response(std::int64_t k) const {
  const auto coefficient = [&](std::int64_t j) {
    return at(std::abs(j)) < kernel_.size() ? kernel_[at(std::abs(j))] : 0.0;
  };
  return (coefficient(k - 1) + 4.0 * coefficient(k) + coefficient(k + 1)) / 6.0;
}

double GoalFilter::noise_in_goal() const {
  double sum = 0.0;
  for (std::int64_t k = 0; k <= static_cast<std::int64_t>(kernel_.size()); ++k)
    sum += (k == 0 ? 1.0 : 2.0) * response(k) * response(k);
  return sum;
}

double GoalFilter::noise_in_rest() const { return 1.0 - 2.0 * response(0) + noise_in_goal(); }

void GoalFilter::find_gaps(const SampleWindow& samples, std::int64_t first, GoalCell& cell) const {
  cell.rate_hz_ = rate_hz_;
  cell.fade_frames_ = fade_frames_;
  const auto reach = static_cast<std::int64_t>(std::ceil(fade_frames_));
  for (int m = 0; m < samples.markers(); ++m) {
    cell.weight_[m] = samples.present(first + 1, m) ? samples.weight(first, m) : 0.0;
    if (cell.weight_[m] == 0.0) continue;
    std::int64_t back = 0, ahead = 0;  // frames seen in a row on either side
    while (back < reach && samples.present(first - back - 1, m)) ++back;
    while (ahead < reach && samples.present(first + 1 + ahead + 1, m)) ++ahead;
    // The ends of the recording are no gaps: nothing is faded there.
    cell.since_[m] = back == reach || first - back == 0 ? kFar : static_cast<double>(back);
    cell.until_[m] = ahead == reach || (samples.ended() && first + ahead + 2 == samples.frames())
                         ? kFar
                         : static_cast<double>(ahead + 1);
  }
}

void GoalFilter::build(const SampleWindow& samples, std::int64_t first, GoalCell& cell) const {
  find_gaps(samples, first, cell);
  const auto reach = static_cast<std::int64_t>(kernel_.size()) - 1;
  for (int m = 0; m < samples.markers(); ++m) {
    if (cell.weight_[m] == 0.0) {
      for (auto& power : cell.power_) power.col(m).setZero();
      continue;
    }
    // The run of frames that holds the cell, as far as the kernel sees.
    std::int64_t begin = first, end = first + 1;
    while (begin > first - 1 - reach && samples.present(begin - 1, m)) --begin;
    while (end < first + 2 + reach && samples.present(end + 1, m)) ++end;
    const auto sample = [&](std::int64_t k) -> Eigen::Vector3d {
      if (k < begin) return 2.0 * samples.x(begin, m) - samples.x(std::min(2 * begin - k, end), m);
      if (k > end) return 2.0 * samples.x(end, m) - samples.x(std::max(2 * end - k, begin), m);
      return samples.x(k, m);
    };
    std::array<Eigen::Vector3d, 4> c;
    for (int i = 0; i < 4; ++i) {
      const std::int64_t middle = first - 1 + i;
      Eigen::Vector3d sum = kernel_[0] * sample(middle);
      for (std::int64_t k = 1; k <= reach; ++k)
        sum += kernel_[at(k)] * (sample(middle - k) + sample(middle + k));
      c[at(i)] = sum;
    }
    cell.power_[0].col(m) = (c[0] + 4.0 * c[1] + c[2]) / 6.0;
    cell.power_[1].col(m) = (c[2] - c[0]) / 2.0;
    cell.power_[2].col(m) = (c[0] - 2.0 * c[1] + c[2]) / 2.0;
    cell.power_[3].col(m) = (c[3] - 3.0 * c[2] + 3.0 * c[1] - c[0]) / 6.0;
  }
}

void GoalFilter::build(const SampleWindow& samples, std::int64_t first, const data::Derivatives& d,
                       const std::vector<int>& marker, std::int64_t markers_in_d, std::int64_t first_frame,
                       GoalCell& cell) const {
  find_gaps(samples, first, cell);
  const double h = 1.0 / rate_hz_;
  const auto rate = [&](const Array<double>& values, std::int64_t frame, int m) {
    const auto index = 3 * at((first_frame + frame) * markers_in_d + marker[at(m)]);
    return Eigen::Vector3d(values[index], values[index + 1], values[index + 2]);
  };
  for (int m = 0; m < samples.markers(); ++m) {
    Eigen::Vector3d v0, v1, a0, a1;
    if (cell.weight_[m] > 0.0) {
      v0 = h * rate(d.velocity, first, m);
      v1 = h * rate(d.velocity, first + 1, m);
      a0 = h * h * rate(d.acceleration, first, m);
      a1 = h * h * rate(d.acceleration, first + 1, m);
      // A sample without derivatives is not used as a goal.
      if (!v0.allFinite() || !v1.allFinite() || !a0.allFinite() || !a1.allFinite()) cell.weight_[m] = 0.0;
    }
    for (auto& power : cell.power_) power.col(m).setZero();
    if (cell.weight_[m] == 0.0) continue;
    const Eigen::Vector3d x0 = samples.x(first, m), way = samples.x(first + 1, m) - x0;
    const Eigen::Vector3d p = way - v0 - 0.5 * a0, q = v1 - v0 - a0, r = a1 - a0;
    cell.power_[0].col(m) = x0;
    cell.power_[1].col(m) = v0;
    cell.power_[2].col(m) = 0.5 * a0;
    cell.power_[3].col(m) = 10.0 * p - 4.0 * q + 0.5 * r;
    cell.power_[4].col(m) = -15.0 * p + 7.0 * q - r;
    cell.power_[5].col(m) = 6.0 * p - 3.0 * q + 0.5 * r;
  }
}

}  // namespace kinemark::motion::internal
