// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/gait_paths.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/random.h"
#include "kinemark/core/text.h"
#include "kinemark/math/smoothing_choice.h"

namespace kinemark::analysis {
namespace {

using math::SeriesMatrix;

constexpr double kLeastRate_hz = 20.0;
constexpr std::int64_t kLeastFrames = 20;
constexpr double kUnknown_s = 0.1;  // from the nearest frame in which a foot was measured
constexpr int kOrder = 2;           // gain 1 / (1 + (f / cut-off)^4)

bool measured(const data::Trajectories& markers, std::int64_t f, std::int64_t m) {
  return markers.state[markers.index(f, m)] == data::SampleState::measured;
}

std::int64_t frames_measured(const data::Trajectories& markers, const std::vector<std::int64_t>& of) {
  std::int64_t count = 0;
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    count += std::ranges::all_of(of, [&](auto m) { return measured(markers, f, m); });
  return count;
}

std::vector<bool> known_frames(const data::Trajectories& markers, const FootMarkers& foot) {
  const std::int64_t n = markers.frames();
  const std::int64_t reach = std::llround(kUnknown_s * markers.time.rate_hz);
  std::vector<bool> out(at(n), false);
  std::int64_t filled = 0;  // frames before this one are settled
  for (std::int64_t f = 0; f < n; ++f) {
    if (!measured(markers, f, foot.heel) || !measured(markers, f, foot.toe)) continue;
    const std::int64_t end = std::min(n, f + reach + 1);
    for (std::int64_t k = std::max(filled, f - reach); k < end; ++k) out[at(k)] = true;
    filled = end;
  }
  return out;
}

// The laboratory's axis along which the body stands above its feet: its pelvis, else all markers but the
// feet's.
Result<Eigen::Vector3d> find_up(const data::Trajectories& markers, const GaitMarkers& which,
                                const std::vector<std::int64_t>& pelvis) {
  std::vector<bool> of_foot(at(markers.markers()), false);
  for (const auto& foot : which.feet)
    if (foot.complete()) of_foot[at(foot.heel)] = of_foot[at(foot.toe)] = true;
  Eigen::Vector3d feet = Eigen::Vector3d::Zero(), body = Eigen::Vector3d::Zero();
  double feet_count = 0.0, body_count = 0.0;
  const auto add = [&](std::int64_t f, std::int64_t m) {
    if (!measured(markers, f, m)) return;
    (of_foot[at(m)] ? feet : body) += markers.x(f, m);
    (of_foot[at(m)] ? feet_count : body_count) += 1.0;
  };
  const auto step = std::max<std::int64_t>(1, markers.frames() / 500);
  for (std::int64_t f = 0; f < markers.frames(); f += step) {
    for (std::int64_t m = 0; m < markers.markers(); ++m)
      if (of_foot[at(m)] || pelvis.empty()) add(f, m);
    for (const auto m : pelvis) add(f, m);
  }
  const Eigen::Vector3d upward = body / body_count - feet / feet_count;
  Eigen::Index axis = 0;
  if (!(upward.cwiseAbs().maxCoeff(&axis) > 0.8 * upward.norm()))
    return fail(Code::bad_input, "nobody can tell which way is up: no marker stands above those of the feet");
  return Eigen::Vector3d((upward[axis] < 0.0 ? -1.0 : 1.0) * Eigen::Vector3d::Unit(axis));
}

// Where the feet point to, over a second around each frame.
SeriesMatrix forward_of(const std::array<FootPaths, 2>& feet, std::int64_t n, double rate_hz) {
  SeriesMatrix sums = SeriesMatrix::Zero(n + 1, 2);
  for (std::int64_t f = 0; f < n; ++f) {
    sums.row(f + 1) = sums.row(f);
    for (const auto& foot : feet)
      if (foot.present() && foot.known[at(f)])
        sums.row(f + 1) += (foot.toe.row(f) - foot.heel.row(f)).leftCols<2>();
  }
  SeriesMatrix out(n, 2);
  const std::int64_t half = std::llround(0.5 * rate_hz);
  Eigen::RowVector2d before =
      sums.row(n).norm() > 0.0 ? Eigen::RowVector2d(sums.row(n).normalized()) : Eigen::RowVector2d(1.0, 0.0);
  for (std::int64_t f = 0; f < n; ++f) {
    const Eigen::RowVector2d sum =
        sums.row(std::min(n, f + half + 1)) - sums.row(std::max<std::int64_t>(0, f - half));
    if (sum.norm() > 0.0) before = sum.normalized();
    out.row(f) = before;
  }
  return out;
}

}  // namespace

Result<GaitSmoother::Point> GaitSmoother::smooth_point(const data::Trajectories& markers,
                                                       const std::vector<std::int64_t>& of,
                                                       double noise_sd_m) {
  const std::int64_t n = markers.frames();
  SeriesMatrix x = SeriesMatrix::Zero(n, 3);
  std::vector<bool> seen(at(n), false);
  std::int64_t count = 0;
  for (std::int64_t f = 0; f < n; ++f) {
    if (!std::ranges::all_of(of, [&](auto m) { return measured(markers, f, m); })) continue;
    for (const auto m : of) x.row(f) += markers.x(f, m).transpose() / static_cast<double>(of.size());
    seen[at(f)] = true;
    ++count;
  }
  std::vector<std::string> names;
  for (const auto m : of) names.push_back(markers.names[at(m)]);
  if (count < kLeastFrames)
    return fail(Code::bad_input, fmt::format("{} was measured in {} frames; need {} at least",
                                             join_names(names, 3), count, kLeastFrames));
  double noise = math::noise_from_differences(x, seen);
  if (!(noise > noise_sd_m)) noise = noise_sd_m;
  Point out{.smoother = math::DifferenceSmoother(std::move(seen), kOrder), .noise_sd_m = noise, .smooth = {}};
  if (!out.smoother.factor(kGaitCutOff_hz / markers.time.rate_hz))
    return fail(Code::bad_input, fmt::format("no smoother fits the samples of {}", join_names(names, 3)));
  out.smoother.smooth(x);
  out.smooth = std::move(x);
  return out;
}

Result<GaitSmoother> GaitSmoother::create(const data::Trajectories& markers, const GaitMarkers& which,
                                          double noise_sd_m) {
  if (!(markers.time.rate_hz >= kLeastRate_hz))
    return fail(Code::bad_input,
                fmt::format("{:g} frames a second are too few for events of walking; need {:g}",
                            markers.time.rate_hz, kLeastRate_hz));
  GaitSmoother out;
  out.time_ = markers.time;
  for (const auto side : data::kBothSides) {
    const auto& foot = which.foot(side);
    if (!foot.complete()) continue;
    out.heel_[data::index_of(side)] = static_cast<int>(out.points_.size());
    for (const auto m : {foot.heel, foot.toe}) {
      auto point = smooth_point(markers, {m}, noise_sd_m);
      if (!point) return std::unexpected(point.error());
      out.points_.push_back(std::move(*point));
    }
    out.known_[data::index_of(side)] = known_frames(markers, foot);
  }
  std::vector<std::int64_t> pelvis;
  std::int64_t most = kLeastFrames - 1;
  for (const auto& set : which.pelvis)  // a later set has to be seen in a fifth more frames
    if (const auto count = frames_measured(markers, set); count > most + (pelvis.empty() ? 0 : most / 5)) {
      pelvis = set;
      most = count;
    }
  if (!pelvis.empty()) {
    auto point = smooth_point(markers, pelvis, noise_sd_m);
    if (!point) return std::unexpected(point.error());
    out.pelvis_ = static_cast<int>(out.points_.size());
    out.points_.push_back(std::move(*point));
  }
  const auto up = find_up(markers, which, pelvis);
  if (!up) return std::unexpected(up.error());
  out.upright_ = Eigen::Quaterniond::FromTwoVectors(*up, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  std::vector<SeriesMatrix> points;
  for (const auto& point : out.points_) points.push_back(point.smooth);
  out.paths_ = out.arrange(points);
  return out;
}

GaitPaths GaitSmoother::arrange(const std::vector<SeriesMatrix>& points) const {
  GaitPaths out{.rate_hz = time_.rate_hz, .start_s = time_.t0_s, .feet = {}, .pelvis = {}, .forward = {}};
  const Eigen::Matrix3d turn = upright_.transpose();
  for (const auto side : data::kBothSides) {
    const int heel = heel_[data::index_of(side)];
    if (heel < 0) continue;
    out.feet[data::index_of(side)] = {.heel = points[at(heel)] * turn,
                                      .toe = points[at(heel + 1)] * turn,
                                      .known = known_[data::index_of(side)]};
  }
  if (pelvis_ >= 0) out.pelvis = points[at(pelvis_)] * turn;
  out.forward = forward_of(out.feet, time_.frames, time_.rate_hz);
  return out;
}

GaitPaths GaitSmoother::with_noise(std::uint64_t seed, std::int64_t number) const {
  Random random(seed, mix64(0x67616974) ^ static_cast<std::uint64_t>(number));
  std::vector<SeriesMatrix> points;
  for (const auto& point : points_) {
    SeriesMatrix noise(point.smooth.rows(), 3);
    for (Eigen::Index i = 0; i < noise.size(); ++i) noise.data()[i] = point.noise_sd_m * random.gaussian();
    point.smoother.smooth(noise);  // linear: what noise adds is what it would leave alone
    points.push_back(point.smooth + noise);
  }
  return arrange(points);
}

}  // namespace kinemark::analysis
