// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/gait_paths.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/random.h"
#include "kinemark/math/rotation_between.h"
#include "kinemark/math/smoothing_choice.h"

namespace kinemark::analysis {
namespace {

using math::SeriesMatrix;

constexpr double kLeastRate_hz = 20.0;
constexpr std::int64_t kLeastSamples = 8;
constexpr double kBridged_s = 0.25, kPelvisBridged_s = 1.0;  // gaps up to these are known all the same
constexpr int kOrder = 2;                                    // gain 1 / (1 + (f / cut-off)^4)
// A smoother that halves the amplitude at f halves the power at (sqrt(2) - 1)^(1/4) f.
constexpr double kHalfPowerOfHalfGain = 0.8022;
constexpr double kMostOfRate = 0.4;
constexpr std::uint64_t kNoiseStream = 0x67616974;

std::vector<FrameSpan> gaps_of(const std::vector<bool>& seen) {
  std::vector<FrameSpan> out;
  const auto n = static_cast<std::int64_t>(seen.size());
  for (std::int64_t f = 0; f < n; ++f) {
    if (seen[at(f)]) continue;
    std::int64_t last = f;
    while (last + 1 < n && !seen[at(last + 1)]) ++last;
    out.push_back({.first = f, .last = last});
    f = last;
  }
  return out;
}

// Seen, or within a gap of that many seconds between frames that are.
std::vector<bool> bridged(std::vector<bool> seen, double most_s, double rate_hz) {
  const auto n = static_cast<std::int64_t>(seen.size());
  for (const auto& gap : gaps_of(seen))
    if (gap.first > 0 && gap.last + 1 < n && static_cast<double>(gap.count()) <= most_s * rate_hz)
      std::fill(seen.begin() + gap.first, seen.begin() + gap.last + 1, true);
  return seen;
}

std::vector<bool> both(const std::vector<bool>& a, const std::vector<bool>& b) {
  std::vector<bool> out(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) out[i] = a[i] && b[i];
  return out;
}

SeriesMatrix samples_of(const data::Trajectories& markers, std::int64_t m, const std::vector<bool>& seen) {
  SeriesMatrix out = SeriesMatrix::Zero(markers.frames(), 3);
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    if (seen[at(f)]) out.row(f) = markers.x(f, m).transpose();
  return out;
}

// Mean of what is believed of some markers in each frame; NaN where none is.
SeriesMatrix mean_of_markers(const data::Trajectories& markers, const std::vector<std::int64_t>& of) {
  SeriesMatrix sum = SeriesMatrix::Zero(markers.frames(), 3);
  Eigen::VectorXd count = Eigen::VectorXd::Zero(markers.frames());
  for (const auto m : of) {
    const auto seen = believe_samples(markers, m).seen;
    for (std::int64_t f = 0; f < markers.frames(); ++f)
      if (seen[at(f)]) sum.row(f) += markers.x(f, m).transpose(), count[f] += 1.0;
  }
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    if (count[f] < static_cast<double>(of.size())) sum.row(f).setConstant(kNaN);
  return sum.array().colwise() / count.array();
}

}  // namespace

Result<GaitSmoother::Point> GaitSmoother::make_point(SeriesMatrix raw, std::vector<bool> seen,
                                                     double noise_sd_m, const std::string& what) {
  const auto count = std::ranges::count(seen, true);
  if (count < kLeastSamples)
    return fail(Code::bad_input,
                fmt::format("{} is usable in {} frames; need {} at least", what, count, kLeastSamples));
  double noise = math::noise_from_differences(raw, seen);
  if (!(noise > noise_sd_m)) noise = noise_sd_m;
  return Point{.name = what,
               .marker = -1,
               .raw = std::move(raw),
               .smoother = math::DifferenceSmoother(std::move(seen), kOrder),
               .noise_sd_m = noise,
               .smooth = {}};
}

Status GaitSmoother::add_foot(const data::Trajectories& markers, const FootMarkers& foot, data::Side side,
                              double noise_sd_m) {
  const auto i = data::index_of(side);
  heel_[i] = static_cast<int>(points_.size());
  set_[i] = foot.set;
  toe_[i] = heel_[i] + (foot.points() ? 1 : 0);
  auto& how = seen_[i];
  std::vector<bool> all(at(markers.frames()), true), known(at(markers.frames()), true);
  for (const auto m : {foot.heel, foot.toe}) {
    if (m == foot.toe && !foot.points() && static_cast<int>(points_.size()) > heel_[i]) break;  // one marker
    auto believed = believe_samples(markers, m);
    all = both(all, believed.seen);
    known = both(known, bridged(believed.seen, kBridged_s, markers.time.rate_hz));
    how.leaps += believed.leaps;
    how.held.insert(how.held.end(), believed.held.begin(), believed.held.end());
    auto raw = samples_of(markers, m, believed.seen);
    auto point = make_point(std::move(raw), std::move(believed.seen), noise_sd_m, markers.names[at(m)]);
    if (!point) return std::unexpected(point.error());
    point->marker = m;
    points_.push_back(std::move(*point));
  }
  std::ranges::sort(how.held, {}, &FrameSpan::first);
  for (const auto& gap : gaps_of(known))
    if (static_cast<double>(gap.count()) > kBridged_s * markers.time.rate_hz) how.hidden.push_back(gap);
  how.share = static_cast<double>(std::ranges::count(all, true)) / static_cast<double>(markers.frames());
  known_[i] = std::move(known);
  if (foot.ankle >= 0) ankle_[i] = mean_of_markers(markers, {foot.ankle});
  if (foot.knee >= 0) knee_[i] = mean_of_markers(markers, {foot.knee});
  return {};
}

Status GaitSmoother::add_pelvis(const data::Trajectories& markers, const GaitMarkers& which,
                                double noise_sd_m) {
  const std::int64_t n = markers.frames();
  std::vector<std::vector<bool>> seen;
  for (const auto m : which.pelvis) seen.push_back(believe_samples(markers, m).seen);
  const auto most =
      std::ranges::max_element(seen, {}, [](const auto& one) { return std::ranges::count(one, true); });
  const auto reference = static_cast<std::size_t>(most - seen.begin());
  // Each marker stands for the mean of all by its mean place among them, so that one that is missing makes no
  // jump.
  std::vector<Eigen::Vector3d> offset(seen.size(), Eigen::Vector3d::Zero());
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < seen.size(); ++k) {
    double count = 0.0;
    for (std::int64_t f = 0; f < n; ++f)
      if (seen[k][at(f)] && seen[reference][at(f)]) {
        offset[k] += markers.x(f, which.pelvis[k]) - markers.x(f, which.pelvis[reference]);
        count += 1.0;
      }
    if (count > 0.0) offset[k] /= count;
    middle += offset[k] / static_cast<double>(seen.size());
  }
  SeriesMatrix raw = SeriesMatrix::Zero(n, 3);
  std::vector<bool> any(at(n), false);
  for (std::int64_t f = 0; f < n; ++f) {
    double count = 0.0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < seen.size(); ++k)
      if (seen[k][at(f)]) sum += markers.x(f, which.pelvis[k]) - offset[k], count += 1.0;
    if (count == 0.0) continue;
    any[at(f)] = true;
    raw.row(f) = (sum / count + middle).transpose();
  }
  pelvis_known_ = bridged(any, kPelvisBridged_s, markers.time.rate_hz);
  auto point = make_point(std::move(raw), std::move(any), noise_sd_m, "the pelvis");
  if (!point) return std::unexpected(point.error());
  if (!which.pelvis.empty()) point->marker = which.pelvis[reference];
  points_.push_back(std::move(*point));
  if (!which.front.empty() && !which.back.empty())
    front_ = mean_of_markers(markers, which.front) - mean_of_markers(markers, which.back);
  if (which.front.size() == 2)
    across_ = mean_of_markers(markers, {which.front[0]}) - mean_of_markers(markers, {which.front[1]});
  return {};
}

Eigen::Vector3d GaitSmoother::standing() const {
  const auto& pelvis = points_.back();
  Eigen::Vector3d above = Eigen::Vector3d::Zero(), anyway = Eigen::Vector3d::Zero();
  for (const auto side : data::kBothSides) {
    if (heel_[data::index_of(side)] < 0) continue;
    for (const int k : {heel_[data::index_of(side)], toe_[data::index_of(side)]}) {
      const auto& point = points_[at(k)];
      for (std::int64_t f = 0; f < time_.frames; ++f)
        if (point.smoother.seen()[at(f)] && pelvis.smoother.seen()[at(f)])
          above += (pelvis.raw.row(f) - point.raw.row(f)).transpose();
      anyway -= point.raw.colwise().sum().transpose() /
                static_cast<double>(std::ranges::count(point.smoother.seen(), true));
      anyway += pelvis.raw.colwise().sum().transpose() /
                static_cast<double>(std::ranges::count(pelvis.smoother.seen(), true));
    }
  }
  if (above.isZero()) above = anyway;
  Eigen::Index axis = 0;
  above.cwiseAbs().maxCoeff(&axis);
  return (above[axis] < 0.0 ? -1.0 : 1.0) * Eigen::Vector3d::Unit(axis);
}

Result<GaitSmoother> GaitSmoother::create(const data::Trajectories& markers, const GaitMarkers& which,
                                          double noise_sd_m, const std::optional<Eigen::Vector3d>& up) {
  if (!(markers.time.rate_hz >= kLeastRate_hz))
    return fail(Code::bad_input,
                fmt::format("{:g} frames a second are too few for events of walking; need {:g}",
                            markers.time.rate_hz, kLeastRate_hz));
  GaitSmoother out;
  out.time_ = markers.time;
  out.stated_sd_m_ = noise_sd_m;
  out.filters_ = markers.filters;
  for (const auto side : data::kBothSides)
    if (which.foot(side).complete())
      if (auto s = out.add_foot(markers, which.foot(side), side, noise_sd_m); !s)
        return std::unexpected(s.error());
  if (auto s = out.add_pelvis(markers, which, noise_sd_m); !s) return std::unexpected(s.error());
  out.upright_ =
      math::rotation_between(up ? *up : out.standing(), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  if (auto s = out.smooth_at(kFirstCutOff_hz); !s) return std::unexpected(s.error());
  return out;
}

Status GaitSmoother::smooth_at(double cut_off_hz) {
  const double half_gain = std::min(cut_off_hz / time_.rate_hz, kMostOfRate) / kHalfPowerOfHalfGain;
  std::vector<SeriesMatrix> points;
  for (auto& point : points_) {
    if (!point.smoother.factor(half_gain))
      return fail(Code::bad_input, "no smoother fits the samples of the markers of walking");
    point.smooth = point.raw;
    point.smoother.smooth(point.smooth);
    points.push_back(point.smooth);
  }
  paths_ = arrange(points);
  return {};
}

void GaitSmoother::exchange_sides() {
  std::swap(heel_[0], heel_[1]);
  std::swap(set_[0], set_[1]);
  std::swap(toe_[0], toe_[1]);
  std::swap(known_[0], known_[1]);
  std::swap(seen_[0], seen_[1]);
  std::swap(ankle_[0], ankle_[1]);
  std::swap(knee_[0], knee_[1]);
  std::swap(paths_.feet[0], paths_.feet[1]);
}

std::array<std::string, 2> GaitSmoother::ends_of(data::Side side) const {
  const auto i = data::index_of(side);
  return {points_[at(heel_[i])].name, points_[at(toe_[i])].name};
}

void GaitSmoother::exchange_ends(data::Side side) {
  const auto i = data::index_of(side);
  std::swap(heel_[i], toe_[i]);
  std::swap(paths_.feet[i].heel, paths_.feet[i].toe);
}

GaitPaths GaitSmoother::arrange(const std::vector<SeriesMatrix>& points) const {
  GaitPaths out{.rate_hz = time_.rate_hz,
                .start_s = time_.t0_s,
                .feet = {},
                .pelvis = {},
                .pelvis_known = pelvis_known_,
                .pelvis_front = {},
                .pelvis_across = {}};
  const Eigen::Matrix3d turn = upright_.transpose();
  for (const auto side : data::kBothSides) {
    const auto i = data::index_of(side);
    if (heel_[i] < 0) continue;
    out.feet[i] = {.heel = points[at(heel_[i])] * turn,
                   .toe = points[at(toe_[i])] * turn,
                   .known = known_[i],
                   .set = set_[i],
                   .points = toe_[i] != heel_[i] && set_[i] != FootSet::by_place,
                   .ankle = {},
                   .knee = {}};
    if (ankle_[i].rows() > 0) out.feet[i].ankle = ankle_[i] * turn;
    if (knee_[i].rows() > 0) out.feet[i].knee = knee_[i] * turn;
  }
  out.pelvis = points.back() * turn;
  if (front_.rows() > 0) out.pelvis_front = (front_ * turn).leftCols<2>();
  if (across_.rows() > 0) out.pelvis_across = (across_ * turn).leftCols<2>();
  return out;
}

void GaitSmoother::find_noise(int threads) {
  std::vector<GaitPointSamples> samples;
  for (const auto& point : points_)
    samples.push_back(
        {.name = point.name,
         .x = &point.raw,
         .seen = &point.smoother.seen(),
         .filter = filters_.empty() || point.marker < 0 ? nullptr : &filters_[at(point.marker)]});
  noise_ = find_gait_noise(samples, time_, stated_sd_m_, threads);
}

// What noise leaves of itself: the smoother is linear.
std::vector<SeriesMatrix> GaitSmoother::smooth_noise(std::uint64_t seed, std::int64_t number) const {
  std::vector<SeriesMatrix> out;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const auto& point = points_[i];
    const SeriesMatrix none = SeriesMatrix::Zero(point.smooth.rows(), 3);
    const std::uint64_t stream = mix64(kNoiseStream + i);
    auto noise =
        noise_.of_points.empty()
            ? analysis::with_noise(none, point.smoother.seen(), point.noise_sd_m, seed, stream, number)
            : analysis::with_noise(none, noise_.of_points[i], seed, stream, number);
    point.smoother.smooth(noise);
    out.push_back(std::move(noise));
  }
  return out;
}

GaitPaths GaitSmoother::with_noise(std::uint64_t seed, std::int64_t number) const {
  auto points = smooth_noise(seed, number);
  for (std::size_t i = 0; i < points_.size(); ++i) points[i] += points_[i].smooth;
  auto out = arrange(points);
  out.go_back(belt_ahead_);
  return out;
}

GaitPaths GaitSmoother::in_laboratory() const {
  std::vector<SeriesMatrix> points;
  for (const auto& point : points_) points.push_back(point.smooth);
  return arrange(points);
}

void GaitSmoother::set_belt_ahead(SeriesMatrix way) {
  belt_ahead_ = std::move(way);
  paths_ = in_laboratory();
  paths_.go_back(belt_ahead_);
}

void GaitPaths::go_back(const SeriesMatrix& way) {
  if (way.rows() == 0) return;
  pelvis.leftCols<2>() -= way;
  for (auto& foot : feet)
    for (auto* marker : {&foot.heel, &foot.toe, &foot.ankle, &foot.knee})
      if (marker->rows() > 0) marker->leftCols<2>() -= way;
}

GaitPaths GaitSmoother::noise_alone(std::uint64_t seed, std::int64_t number) const {
  return arrange(smooth_noise(seed, number));
}

}  // namespace kinemark::analysis
