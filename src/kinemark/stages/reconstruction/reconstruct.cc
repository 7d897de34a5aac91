// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Selects the usable observations of a recording.
#include "kinemark/stages/reconstruction/reconstruct.h"

#include <fmt/core.h>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "kinemark/camera/light.h"
#include "kinemark/camera/noise.h"
#include "kinemark/camera/response.h"
#include "kinemark/camera/usable.h"
#include "kinemark/core/parallel.h"
#include "kinemark/math/symmetric3.h"
#include "kinemark/stages/reconstruction/calibration_fields.h"
#include "kinemark/stages/reconstruction/grid_lookup.h"
#include "kinemark/stages/reconstruction/light.h"
#include "kinemark/stages/reconstruction/locate.h"

namespace kinemark::reconstruction {
namespace {

constexpr std::int64_t kGrain = 256;  // frames; each chunk finds its own start

Result<Reconstruction> begin(const data::Counts& counts, const data::Rig& rig,
                             const ReconstructOptions& options) {
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  if (auto s = check_fit(counts, rig); !s) return std::unexpected(s.error());
  auto used = usable_observations(counts, options.dim_share);
  if (!used) return std::unexpected(used.error());
  Reconstruction out;
  out.points = data::Trajectories::all_missing(counts.leds, counts.time);
  out.points.sample_offset_s.resize(counts.leds.size());
  for (std::int64_t led = 0; led < counts.led_count(); ++led) {
    double sum = 0.0;
    for (std::int64_t c = 0; c < counts.camera_count(); ++c) sum += counts.offset_s(led, c).mean();
    out.points.sample_offset_s[static_cast<std::size_t>(led)] =
        sum / static_cast<double>(counts.camera_count()) - rig.electronics.time_constant_s;
  }
  out.used = std::move(*used);
  out.near_edge.assign(static_cast<std::size_t>(counts.frames() * counts.led_count()), 0);
  return out;
}

void put_covariance(data::Trajectories& points, std::size_t index, const Eigen::Matrix3d& c) {
  math::pack_symmetric3(c, points.covariance.data() + 6 * index);
}

void add_covariance(data::Trajectories& points, std::size_t index, const Eigen::Matrix3d& c) {
  std::array<double, 6> six{};
  math::pack_symmetric3(c, six.data());
  for (std::size_t i = 0; i < 6; ++i) points.covariance[6 * index + i] += six[i];
}

/// The cell of 2 cm that a point lies in, and which cameras saw it.
using Cell = std::array<std::int64_t, 4>;
constexpr double kCell_m = 0.02;

Cell cell_of(const data::Counts& counts, const Reconstruction& r, const data::Trajectories& points,
             std::int64_t f, std::int64_t led) {
  const auto x = points.x(f, led);
  Cell cell{};
  for (std::size_t a = 0; a < 3; ++a) cell[a] = std::llround(x[static_cast<Eigen::Index>(a)] / kCell_m);
  std::int64_t seen = 0;
  for (std::int64_t c = 0; c < counts.camera_count(); ++c) {
    const auto used = r.used[counts.index(f, led, c)];
    cell[3] = 2 * cell[3] + used;
    seen += used;
  }
  // A path carries a point through frames that fewer than two cameras saw, by frames that both did.
  if (seen < 2) cell[3] = (std::int64_t{1} << counts.camera_count()) - 1;
  return cell;
}

/// Counts that an LED makes in each camera.
std::vector<double> strengths_of(const Reconstruction& r, std::size_t led, std::size_t cameras) {
  constexpr double kUsual = 1000.0;  // where it is not known
  std::vector<double> out(cameras, kUsual);
  if (led < r.lights.size())
    for (std::size_t c = 0; c < cameras; ++c)
      if (r.lights[led].strength_counts[c] > 0.0) out[c] = r.lights[led].strength_counts[c];
  return out;
}

/// Error of the calibration and of an LED's light varies smoothly over the room: once for every cell is
/// enough.
void add_error_of(const data::Counts& counts, const data::Rig& rig, std::int64_t led, const Reconstruction& r,
                  data::Trajectories& points, int threads) {
  std::map<Cell, Eigen::Matrix3d> cells;
  for (std::int64_t f = 0; f < counts.frames(); ++f)
    if (points.present(f, led)) cells.emplace(cell_of(counts, r, points, f, led), Eigen::Matrix3d::Zero());
  std::vector<std::map<Cell, Eigen::Matrix3d>::iterator> list;
  for (auto it = cells.begin(); it != cells.end(); ++it) list.push_back(it);
  const auto cameras = static_cast<std::size_t>(rig.camera_count());
  const auto strength = strengths_of(r, static_cast<std::size_t>(led), cameras);
  parallel_for(static_cast<std::int64_t>(list.size()), 8, threads,
               [&](std::int64_t first, std::int64_t last) {
                 std::vector<double> weight(cameras);
                 for (std::int64_t i = first; i < last; ++i) {
                   auto& [cell, covariance] = *list[static_cast<std::size_t>(i)];
                   for (std::size_t c = 0; c < cameras; ++c)
                     weight[c] = (cell[3] >> (cameras - 1 - c)) & 1 ? strength[c] * strength[c] : 0.0;
                   const Eigen::Vector3d x =
                       kCell_m * Eigen::Vector3d(static_cast<double>(cell[0]), static_cast<double>(cell[1]),
                                                 static_cast<double>(cell[2]));
                   const auto by = by_parameters(rig, x, strength, weight);
                   covariance = by * rig.covariance * by.transpose();
                 }
               });
  for (std::int64_t f = 0; f < counts.frames(); ++f)
    if (points.present(f, led))
      add_covariance(points, points.index(f, led), cells.at(cell_of(counts, r, points, f, led)));
}

void summarise(const data::Counts& counts, Reconstruction& r) {
  for (std::int64_t led = 0; led < counts.led_count(); ++led) {
    LedSummary s{.name = counts.leds[static_cast<std::size_t>(led)], .frames = counts.frames()};
    for (std::int64_t f = 0; f < counts.frames(); ++f) {
      const auto i = r.points.index(f, led);
      const auto state = r.points.state[i];
      s.located += state == data::SampleState::measured;
      s.inconsistent += state == data::SampleState::rejected;
      s.near_edge += state == data::SampleState::measured && r.near_edge[i] != 0;
      if (state != data::SampleState::missing) continue;
      bool saturated = false;
      for (std::int64_t c = 0; c < counts.camera_count(); ++c)
        saturated = saturated || counts.has_flag(f, led, c, data::kCountSaturated);
      saturated ? ++s.saturated : ++s.occluded;
    }
    r.leds.push_back(std::move(s));
  }
}

const data::Rig& rig_of(const Reconstruction& r, std::int64_t led) {
  return r.rigs.size() == 1 ? r.rigs.front() : r.rigs[static_cast<std::size_t>(led)];
}

/// Velocity of a point by the frames beside it, m/s; 0 where there are none.
Eigen::Vector3d velocity_of(const data::Trajectories& points, std::int64_t f, std::int64_t led) {
  const auto there = [&](std::int64_t at) {
    return at >= 0 && at < points.frames() && points.present(at, led);
  };
  const std::int64_t first = there(f - 1) ? f - 1 : f, last = there(f + 1) ? f + 1 : f;
  if (first == last || !points.present(f, led)) return Eigen::Vector3d::Zero();
  return (points.x(last, led) - points.x(first, led)) * points.time.rate_hz /
         static_cast<double>(last - first);
}

/// Counts as they would be if the point had stood still where it is: conversions of a frame follow each
/// other.
/// @param late_s  of each conversion, behind the time of the point
Eigen::Vector4d at_one_time(const data::Camera& camera, const CountObservation& read,
                            const Eigen::Vector3d& x, const Eigen::Vector3d& velocity,
                            const Eigen::Vector4d& late_s) {
  return read.counts -
         strength_of(camera, read, x) * late_s.cwiseProduct(camera::respond(camera, x).d_point * velocity);
}

/// Points of all LEDs, by the rig that each shows.
/// @param before  the same from another pass, by which conversions are brought to one time; null: they are
/// not
void locate_all(const data::Counts& counts, const ReconstructOptions& options,
                const data::Trajectories* before, Reconstruction& r) {
  const Eigen::Vector3d middle = middle_of_view(r.rigs.front());
  const double flicker = 0.5 * options.flicker_counts * options.flicker_counts;
  parallel_for(counts.frames(), kGrain, options.threads, [&](std::int64_t first, std::int64_t last) {
    std::vector<Eigen::Vector3d> start(counts.leds.size(), middle);
    std::vector<CountObservation> observations;
    for (std::int64_t f = first; f < last; ++f)
      for (std::int64_t led = 0; led < counts.led_count(); ++led) {
        const auto& rig = rig_of(r, led);
        observations.clear();
        const Eigen::Vector3d velocity = before ? velocity_of(*before, f, led) : Eigen::Vector3d::Zero();
        const double middle_s =
            r.points.sample_offset_s[static_cast<std::size_t>(led)] + rig.electronics.time_constant_s;
        for (std::int64_t c = 0; c < counts.camera_count(); ++c) {
          if (r.used[counts.index(f, led, c)] == 0) continue;
          const Eigen::Vector4d read = counts.at(f, led, c);
          CountObservation one{static_cast<int>(c), read,
                               camera::conversion_variance(rig.electronics, read.mean()) + flicker,
                               camera::kept_channels(read, counts.highest_code)};
          if (!velocity.isZero(0.0))
            one.counts = at_one_time(rig.cameras[static_cast<std::size_t>(c)], one, before->x(f, led),
                                     velocity, (counts.offset_s(led, c).array() - middle_s).matrix());
          observations.push_back(one);
        }
        auto& from = start[static_cast<std::size_t>(led)];
        auto located = locate(rig, observations, from);
        if (!located && from != middle) located = locate(rig, observations, middle);
        if (!located) {
          r.points.set_missing(f, led, data::SampleState::missing);
          continue;
        }
        const auto i = r.points.index(f, led);
        if (located->chi2 > options.largest_chi2 * (static_cast<double>(observations.size()) - 1.0)) {
          r.points.set_missing(f, led, data::SampleState::rejected);
          continue;
        }
        from = located->x_in_world;
        r.points.x(f, led) = located->x_in_world;
        r.points.state[i] = data::SampleState::measured;
        r.near_edge[i] = located->farthest_spot > options.edge;
        put_covariance(r.points, i, located->information.inverse());
      }
  });
}

}  // namespace

Status ReconstructOptions::check() const {
  if (!(dim_share >= 0.0) || dim_share >= 1.0)
    return fail(Code::usage, fmt::format("a dim share of {}; 0 to below 1 was expected", dim_share));
  if (!(largest_chi2 > 0.0))
    return fail(Code::usage, fmt::format("a largest chi2 of {}; it must be positive", largest_chi2));
  if (!(edge > 0.0) || edge > 1.0)
    return fail(Code::usage, fmt::format("an edge of {} half-sides; above 0 to 1 was expected", edge));
  if (!(flicker_counts >= 0.0))
    return fail(Code::usage, fmt::format("a flicker of {} counts; it must not be negative", flicker_counts));
  return {};
}

Result<Reconstruction> reconstruct(const data::Counts& counts, const data::Rig& rig,
                                   const ReconstructOptions& options) {
  auto out = begin(counts, rig, options);
  if (!out) return out;
  Reconstruction& r = *out;
  r.points.covariance.assign(6 * r.points.state.size(), std::nan(""));
  r.rigs = {rig};
  locate_all(counts, options, nullptr, r);
  if (options.light) {
    r.lights = find_lights(counts, rig, r.points, r.used, options.flicker_counts);
    r.rigs.clear();
    for (const auto& found : r.lights)
      r.rigs.push_back(camera::with_light(rig, {.value = found.stray, .sd = found.stray_sd}));
  }
  const auto before = r.points;
  locate_all(counts, options, &before, r);
  if (options.calibration_error) add_calibration_error(counts, r, r.points, options.threads);
  summarise(counts, r);
  return out;
}

void add_calibration_error(const data::Counts& counts, const Reconstruction& from, data::Trajectories& points,
                           int threads) {
  for (std::int64_t led = 0; led < counts.led_count(); ++led)
    if (rig_of(from, led).covariance.size() > 0)
      add_error_of(counts, rig_of(from, led), led, from, points, threads);
}

data::CalibrationError calibration_error(const data::Counts& counts, const data::Rig& rig,
                                         const Reconstruction& from, const data::Trajectories& points,
                                         const data::Trajectories* other) {
  constexpr std::int64_t kPoints = 240;
  if (rig.covariance.size() == 0) return {};
  std::vector<std::array<std::int64_t, 2>> present;
  for (std::int64_t f = 0; f < counts.frames(); ++f)
    for (std::int64_t led = 0; led < counts.led_count(); ++led)
      if (points.present(f, led) && (other == nullptr || other->present(f, led))) present.push_back({f, led});
  const auto cameras = static_cast<std::size_t>(rig.camera_count());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(rig.covariance);
  const Eigen::MatrixXd root =
      eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  data::Points where(kPoints, 3);
  Eigen::MatrixXd by_draw = Eigen::MatrixXd::Zero(3 * kPoints, root.cols() + 1);
  Eigen::Index count = 0;
  const auto step = std::max<std::size_t>(1, (present.size() + kPoints - 1) / kPoints);
  for (std::size_t i = 0; i < present.size(); i += step) {
    const auto [f, led] = present[i];
    const auto strength = strengths_of(from, static_cast<std::size_t>(led), cameras);
    std::vector<double> weight(cameras);
    for (std::size_t c = 0; c < cameras; ++c)
      if (from.used[counts.index(f, led, static_cast<std::int64_t>(c))] != 0)
        weight[c] = strength[c] * strength[c];
    const Eigen::MatrixXd moved = by_parameters(rig, points.x(f, led), strength, weight) * root;
    if (!moved.allFinite()) continue;
    by_draw.block(3 * count, 0, 3, root.cols()) = moved;
    if (other != nullptr) by_draw.block<3, 1>(3 * count, root.cols()) = other->x(f, led) - points.x(f, led);
    where.row(count++) = points.x(f, led).transpose();
  }
  return fit_calibration_error(where.topRows(count), by_draw.topRows(3 * count));
}

Result<Reconstruction> reconstruct_classic(const data::Counts& counts, const data::Rig& rig,
                                           const ReconstructOptions& options) {
  auto out = begin(counts, rig, options);
  if (!out) return out;
  for (std::size_t c = 0; c < 2; ++c)
    if (rig.cameras[c].table.nodes < 3)
      return fail(Code::bad_input,
                  fmt::format("camera '{}' has no look-up table; calibrate with the grid first",
                              rig.cameras[c].name));
  Reconstruction& r = *out;
  parallel_for(counts.frames(), kGrain, options.threads, [&](std::int64_t first, std::int64_t last) {
    for (std::int64_t f = first; f < last; ++f)
      for (std::int64_t led = 0; led < counts.led_count(); ++led) {
        if (r.used[counts.index(f, led, 0)] == 0 || r.used[counts.index(f, led, 1)] == 0) continue;
        std::array<Eigen::Vector2d, 2> plane;
        for (std::size_t c = 0; c < 2; ++c)
          plane[c] =
              look_up(rig.cameras[c].table, detector_ratios(counts.at(f, led, static_cast<std::int64_t>(c))));
        const Eigen::Vector3d x = meet_midway(rig.cameras, plane);
        if (!x.allFinite()) continue;
        r.points.x(f, led) = x;
        r.points.state[r.points.index(f, led)] = data::SampleState::measured;
      }
  });
  summarise(counts, r);
  return out;
}

Status check_fit(const data::Counts& counts, const data::Rig& rig) {
  if (auto s = counts.validate(); !s) return s;
  if (auto s = rig.validate(); !s) return s;
  if (auto s = data::check_same_rig(counts, rig); !s) return s;
  if (rig.camera_count() < 2) return fail(Code::bad_input, "points need two cameras or more");
  for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
    if (rig.cameras[c].kind != data::CameraKind::lateral_effect)
      return fail(Code::not_supported,
                  fmt::format("camera '{}' is no lateral-effect camera", rig.cameras[c].name));
    if (rig.cameras[c].name != counts.cameras[c])
      return fail(Code::bad_input, fmt::format("camera {} is '{}' in the recording and '{}' in the rig",
                                               c + 1, counts.cameras[c], rig.cameras[c].name));
  }
  return {};
}

Result<Array<std::uint8_t>> usable_observations(const data::Counts& counts, double dim_share) {
  const auto views = camera::usable_views(counts, dim_share);
  Array<std::uint8_t> out(views.begin(), views.end());
  std::vector<std::int64_t> of_camera(counts.cameras.size(), 0);
  for (std::size_t i = 0; i < out.size(); ++i) of_camera[i % of_camera.size()] += out[i];
  if (std::ranges::all_of(of_camera, [](std::int64_t n) { return n == 0; }))
    return fail(Code::bad_input, "all LEDs are dark: no camera saw light in any frame");
  for (std::size_t c = 0; c < of_camera.size(); ++c)
    if (of_camera[c] == 0 && counts.camera_count() == 2)
      return fail(
          Code::bad_input,
          fmt::format("camera '{}' saw no light in any frame; points need two cameras", counts.cameras[c]));
  return out;
}

}  // namespace kinemark::reconstruction
