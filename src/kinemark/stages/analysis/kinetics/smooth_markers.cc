// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/kinetics/internal/smooth_markers.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/parallel.h"
#include "kinemark/math/difference_smoother.h"
#include "kinemark/math/smoothing_choice.h"
#include "kinemark/math/symmetric3.h"

namespace kinemark::analysis::internal {
namespace {

using Eigen::Vector3d;

constexpr std::int64_t kLeastSamples = 30;
constexpr double kLowestCutOff_hz = 1.0;
constexpr double kHighestCutOff = 0.45;  // cycles per sample
constexpr double kNoNoise_m = 1e-9;      // what rounding leaves of sixth differences

SeriesMatrix path_of(const data::Trajectories& paths, std::int64_t m) {
  SeriesMatrix x(paths.frames(), 3);
  for (std::int64_t f = 0; f < paths.frames(); ++f) x.row(f) = Vector3d(paths.x(f, m));
  return x;
}
void set_path(data::Trajectories& paths, std::int64_t m, const SeriesMatrix& x) {
  for (std::int64_t f = 0; f < paths.frames(); ++f) paths.x(f, m) = x.row(f);
}

double noise_of(const data::Trajectories& markers, std::int64_t m, const SeriesMatrix& x,
                const std::vector<bool>& seen, double stated) {
  if (stated > 0.0) return stated;
  if (markers.covariance.empty()) return math::noise_from_differences(x, seen);
  double sum = 0.0;
  std::int64_t count = 0;
  for (std::int64_t f = 0; f < markers.frames(); ++f) {
    const double trace = math::unpack_symmetric3(&markers.covariance[6 * markers.index(f, m)]).trace();
    if (!markers.present(f, m) || !std::isfinite(trace)) continue;
    sum += trace / 3.0;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0.0;
}

}  // namespace

SmoothMarkers::SmoothMarkers(const data::Trajectories& markers, const std::set<std::int64_t>& used,
                             double noise_sd_m, const MarkerNoise* noise, int threads)
    : paths_(markers),
      markers_(used.begin(), used.end()),
      recordings_(markers_.size()),
      smoothers_(markers_.size()) {
  paths_.covariance.clear();
  parallel_for(std::ssize(markers_), 1, threads, [&](std::int64_t begin, std::int64_t end) {
    for (auto i = begin; i < end; ++i) prepare(markers, at(i), noise_sd_m);
  });
  if (noise_sd_m > 0.0 || !markers.covariance.empty() || noise == nullptr) return;
  for (std::size_t i = 0; i < markers_.size(); ++i)
    if (const auto* found = noise->of(markers_[i]); found != nullptr)
      recordings_[i].noise = std::make_shared<const ColouredNoise>(found->model, found->draws);
}

data::Trajectories SmoothMarkers::refit(std::uint64_t seed, std::int64_t number) const {
  data::Trajectories out = paths_;
  for (std::size_t i = 0; i < markers_.size(); ++i) {
    const auto& recording = recordings_[i];
    if (recording.x.rows() == 0) continue;
    SeriesMatrix x = with_noise(path_of(paths_, markers_[i]), recording, seed,
                                static_cast<std::uint64_t>(markers_[i]), number);
    smoothers_[i]->smooth(x);
    set_path(out, markers_[i], x);
  }
  return out;
}

void SmoothMarkers::prepare(const data::Trajectories& markers, std::size_t i, double stated) {
  const auto m = markers_[i];
  std::vector<bool> seen(at(markers.frames()));
  SeriesMatrix x(markers.frames(), 3);
  Vector3d last = Vector3d::Zero();
  for (std::int64_t f = 0; f < markers.frames(); ++f) {
    seen[at(f)] = markers.present(f, m);
    if (seen[at(f)]) last = markers.x(f, m);
    x.row(f) = last;
  }
  if (std::ranges::count(seen, true) < kLeastSamples) return;
  const double noise = noise_of(markers, m, x, seen, stated);
  const bool whole = std::ranges::find(seen, false) == seen.end();
  Recording recording{.x = x,
                      .seen = seen,
                      .rate_hz = markers.time.rate_hz,
                      .noise_sd_m = std::max(noise, kNoNoise_m),
                      .choice = {}};
  const auto choice = math::choose_smoothing(x / recording.noise_sd_m, seen,
                                             {.lowest = std::min(0.1, kLowestCutOff_hz / recording.rate_hz)});
  if (!choice || (whole && !(noise > kNoNoise_m))) return;
  recording.choice = *choice;
  math::DifferenceSmoother smoother(seen, choice->order);
  if (!smoother.factor(std::min(kHighestCutOff, kLessSmooth * choice->half_power))) return;
  smoother.smooth(x);
  set_path(paths_, m, x);
  recordings_[i] = std::move(recording);
  smoothers_[i] = std::move(smoother);
}

}  // namespace kinemark::analysis::internal
