// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/reconstruction/light.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "kinemark/camera/light.h"
#include "kinemark/camera/noise.h"
#include "kinemark/camera/response.h"
#include "kinemark/camera/usable.h"
#include "kinemark/core/enum_names.h"
#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/math/scale_free.h"
#include "kinemark/math/statistics.h"
#include "kinemark/stages/reconstruction/locate.h"

namespace kinemark::reconstruction {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr std::int64_t kFrames = 400;  // of each LED that are looked at
constexpr int kRounds = 3;             // of light and points in turns: each leaves 1 % of the error
constexpr std::size_t kFewestFrames = 20;
constexpr double kFacing = 0.36;  // tan 20 deg: how far from the cameras an LED may point, SD
constexpr double kSteady = 0.01;  // misfit of strengths, of the light, up to which the direction stays
constexpr double kEven = 0.001;   // error of strengths over the field, of the light: what calibrations leave
constexpr double kRoom = 0.1;     // SD of the room's share from one LED to another, of its light
// Error of an LED's light by the cameras' constants, of itself: 0.0004 RMS over 12 simulated rigs.
constexpr double kConstants = 0.0004;

/// One frame of an LED: where it is, and what the cameras read.
struct Frame {
  std::int64_t index = 0;
  Vector3d x;
  std::vector<CountObservation> read;
};

/// Light as one camera sees it.
struct Sight {
  Vector3d to_camera;  ///< of length 1
  double light = 0.0;  ///< times the cosine of the LED's direction
};

std::vector<Frame> frames_of(const data::Counts& counts, const data::Rig& rig,
                             const data::Trajectories& points, std::span<const std::uint8_t> used,
                             std::int64_t led, double flicker_counts) {
  std::vector<std::int64_t> located;
  for (std::int64_t f = 0; f < counts.frames(); ++f)
    if (points.present(f, led)) located.push_back(f);
  const auto step = std::max<std::int64_t>(1, std::ssize(located) / kFrames);
  std::vector<Frame> out;
  for (std::int64_t i = 0; i < std::ssize(located); i += step) {
    Frame frame{.index = located[at(i)], .x = points.x(located[at(i)], led), .read = {}};
    for (std::int64_t c = 0; c < counts.camera_count(); ++c) {
      if (used[counts.index(frame.index, led, c)] == 0) continue;
      const Vector4d read = counts.at(frame.index, led, c);
      frame.read.push_back(
          {static_cast<int>(c), read,
           camera::conversion_variance(rig.electronics, read.mean()) + 0.5 * flicker_counts * flicker_counts,
           camera::kept_channels(read, counts.highest_code)});
    }
    out.push_back(std::move(frame));
  }
  return out;
}

Sight sight(const data::Camera& camera, const CountObservation& read, const Vector3d& x) {
  const Vector3d to_camera = camera.centre_in_world() - x;
  const double distance = to_camera.norm(), depth = (camera.cam_from_world * x).z();
  return {.to_camera = to_camera / distance,
          .light = strength_of(camera, read, x) * distance * distance * distance /
                   (depth * camera.detector.light_counts)};
}

/// Light of an LED that keeps its direction, and how far strengths are from saying so, of that light.
struct Steady {
  camera::Light light;
  double misfit = 0.0;
};

/// Strengths are light * direction . to_camera: a vector by least squares. What the cameras do not see of it,
/// as it lies across their plane, a prior bounds: an LED points to the cameras that see it, give or take.
Steady steady_light(const std::vector<Sight>& sights) {
  Matrix3d square = Matrix3d::Zero();
  Vector3d right = Vector3d::Zero(), mean = Vector3d::Zero();
  double sum = 0.0;
  for (const auto& s : sights) {
    square += s.to_camera * s.to_camera.transpose();
    right += s.light * s.to_camera;
    mean += s.to_camera;
    sum += s.light;
  }
  const auto n = static_cast<double>(sights.size());
  const double average = sum / n;
  const Vector3d facing = mean.normalized() * average * n / mean.norm();
  const double prior = 1.0 / std::pow(kFacing * average, 2);
  // Twice: the misfit that weighs the strengths against the prior is that of the first fit.
  double noise = kSteady * average;
  Vector3d shining = facing;
  Matrix3d covariance;
  for (int round = 0; round < 2; ++round) {
    const Matrix3d information = square / (noise * noise) + prior * Matrix3d::Identity();
    covariance = information.inverse();
    shining = covariance * (right / (noise * noise) + prior * facing);
    double squares = 0.0;
    for (const auto& s : sights) squares += std::pow(s.light - shining.dot(s.to_camera), 2);
    noise = std::max(std::sqrt(squares / n), kEven * average);
  }
  const double length = shining.norm();
  const Vector3d along = shining / length;
  const double across = covariance.trace() - along.dot(covariance * along);
  // Points of an LED at rest err alike in all frames, and their distances with them: half as much again. What
  // lies across only lengthens the vector.
  const double of_length = 2.0 * along.dot(covariance * along) + std::pow(0.5 * across / length, 2);
  return {.light = {.value = length, .sd = std::sqrt(of_length + std::pow(kConstants * length, 2))},
          .misfit = noise / length};
}

/// Of an LED that turns each frame bounds its light from below: what it shows in the plane of two cameras.
std::optional<camera::Light> turning_light(const std::vector<std::array<Sight, 2>>& pairs) {
  constexpr double kQuantile = 0.98, kShare = 0.1;
  std::vector<double> in_plane;
  for (const auto& [a, b] : pairs) {
    const double g = a.to_camera.dot(b.to_camera);
    const double square =
        (a.light * a.light + b.light * b.light - 2.0 * g * a.light * b.light) / (1.0 - g * g);
    if (square > 0.0) in_plane.push_back(std::sqrt(square));
  }
  if (in_plane.size() < kFewestFrames) return std::nullopt;
  const double most = math::quantile(in_plane, kQuantile);
  return camera::Light{.value = most, .sd = kShare * most};
}

/// What the misfit of the counts says of an LED's stray light, with all else as it is.
struct Misfit {
  double step = 0.0, sd = 0.0;  ///< to be added to its light; infinite SD when nothing is said
  double chi2_per_dof = 0.0;
};

/// One frame's part in it: residuals and their derivatives by the light, less what moving the point takes up.
class StrayMisfit {
 public:
  explicit StrayMisfit(const data::Rig& rig, const data::Rig& by_light)
      : rig_(rig), lit_(by_light), by_parameters_(Eigen::VectorXd::Zero(rig.parameter_count())) {}

  void add(const Frame& frame) {
    const auto n = static_cast<Eigen::Index>(3 * frame.read.size());
    Eigen::Matrix<double, Eigen::Dynamic, 3> j(n, 3);
    Eigen::VectorXd r(n), g(n);
    Eigen::MatrixXd parameters = Eigen::MatrixXd::Zero(n, rig_.parameter_count());
    Eigen::Matrix<double, 4, Eigen::Dynamic> d;
    for (std::size_t i = 0; i < frame.read.size(); ++i) {
      const auto& read = frame.read[i];
      const auto& camera = lit_.cameras[at(read.camera)];
      const data::ParameterLayout layout(camera);
      d.resize(4, layout.count);
      const auto response = camera::respond(camera, frame.x, d);
      const auto keep = read.keep.asDiagonal();
      const auto left =
          math::eliminate_scale(keep * (read.counts - camera.detector.offset_counts), keep * response.phi);
      const double weight = 1.0 / std::sqrt(read.variance);
      const auto row = static_cast<Eigen::Index>(3 * i);
      j.middleRows<3>(row) = -weight * left.scale * (left.basis * keep * response.d_point);
      r.segment<3>(row) = weight * left.residual;
      g.segment<3>(row) =
          -weight * left.basis * keep * camera::stray_light(rig_.cameras[at(read.camera)].detector).counts;
      d *= left.scale;
      d.middleCols<4>(layout.offset).setIdentity();
      parameters.block(row, rig_.first_parameter(read.camera), 3, layout.count) =
          -weight * left.basis * keep * d;
    }
    const auto solver = (j.transpose() * j).eval().ldlt();
    const Eigen::VectorXd free = g - j * solver.solve(j.transpose() * g);
    const Eigen::VectorXd rest = r - j * solver.solve(j.transpose() * r);
    if (!free.allFinite() || !rest.allFinite()) return;
    information_ += free.squaredNorm();
    score_ -= free.dot(r);
    by_parameters_ += parameters.transpose() * free;
    chi2_ += rest.squaredNorm();
    freedom_ += static_cast<double>(n - 3);
  }

  [[nodiscard]] Misfit result() const {
    Misfit out{.step = 0.0, .sd = std::numeric_limits<double>::infinity(), .chi2_per_dof = kNaN};
    if (!(information_ > 0.0) || !(freedom_ > 0.0)) return out;
    out.step = score_ / information_;
    out.chi2_per_dof = (chi2_ - out.step * score_) / freedom_;
    double variance = std::max(1.0, out.chi2_per_dof) / information_;
    if (rig_.covariance.size() > 0)  // errors of the calibration feed the misfit as well
      variance += by_parameters_.dot(rig_.covariance * by_parameters_) / (information_ * information_);
    out.sd = std::sqrt(variance);
    return out;
  }

 private:
  const data::Rig& rig_;
  const data::Rig& lit_;
  double information_ = 0.0, score_ = 0.0, chi2_ = 0.0, freedom_ = 0.0;
  Eigen::VectorXd by_parameters_;
};

camera::Light joined(const camera::Light& a, const camera::Light& b) {
  const double wa = 1.0 / (a.sd * a.sd), wb = std::isfinite(b.sd) ? 1.0 / (b.sd * b.sd) : 0.0;
  return {.value = (wa * a.value + wb * b.value) / (wa + wb), .sd = 1.0 / std::sqrt(wa + wb)};
}

/// What is known of a light before it is looked at: most LEDs are like those of the calibration, the others
/// shine with anything from a tenth to five times as much. What an LED at rest says of itself is too little
/// to move it from there.
camera::Light with_prior(const camera::Light& seen) {
  constexpr double kAlike = 0.9, kSpread = 0.05;  // share of LEDs, and SD of their lights
  const double logs = std::log(5.0 / 0.1);
  const double both = seen.sd * seen.sd + kSpread * kSpread, off = seen.value - 1.0;
  const double alike = kAlike * std::exp(-0.5 * off * off / both) / std::sqrt(2.0 * std::numbers::pi * both);
  const double other = (1.0 - kAlike) / (logs * seen.value);
  const double share = alike / (alike + other);
  const auto joint = joined(seen, {.value = 1.0, .sd = kSpread});
  const double between = joint.value - seen.value;
  const double variance = share * joint.sd * joint.sd + (1.0 - share) * seen.sd * seen.sd +
                          share * (1.0 - share) * between * between;
  return {.value = seen.value + share * between, .sd = std::sqrt(variance)};
}

bool knows_light(const data::Rig& rig) {
  return std::ranges::all_of(rig.cameras,
                             [](const auto& c) { return std::isfinite(c.detector.light_counts); });
}

bool knows_stray(const data::Rig& rig) {
  return std::ranges::all_of(rig.cameras, [](const auto& c) { return c.detector.knows_dark(); });
}

/// Means over `count` sights of one camera: noise of points, which moves direction and distance together,
/// must not look like an LED that moves.
class Means {
 public:
  void add(const Sight& sight, std::vector<Sight>& out) {
    sum_.to_camera += sight.to_camera;
    sum_.light += sight.light;
    if (++count_ < kTogether) return;
    out.push_back({.to_camera = sum_.to_camera / kTogether, .light = sum_.light / kTogether});
    *this = {};
  }

 private:
  static constexpr int kTogether = 10;
  Sight sum_{.to_camera = Vector3d::Zero()};
  int count_ = 0;
};

/// An LED's light, and what it stands on.
struct Seen {
  LightSource source = LightSource::direction;
  camera::Light light;
};

/// Light by the strengths, with the points as they are now; no value with too few sights.
std::optional<Seen> by_strengths(const data::Rig& lit, const std::vector<Frame>& frames) {
  std::vector<Sight> sights;
  std::vector<Means> means(lit.cameras.size());
  std::vector<std::array<Sight, 2>> pairs;
  for (const auto& frame : frames) {
    std::vector<Sight> here;
    for (const auto& read : frame.read) {
      here.push_back(sight(lit.cameras[at(read.camera)], read, frame.x));
      means[at(read.camera)].add(here.back(), sights);
    }
    if (here.size() >= 2) pairs.push_back({here[0], here[1]});
  }
  if (sights.empty()) return std::nullopt;
  const Steady steady = steady_light(sights);
  if (steady.misfit > kSteady)
    if (const auto turning = turning_light(pairs)) return Seen{LightSource::turning, *turning};
  return Seen{LightSource::direction, steady.light};
}

/// Light of the stray light by the misfit of the counts, with the points as they are now.
std::optional<camera::Light> by_misfit(const data::Rig& rig, const data::Rig& lit, double stray,
                                       const std::vector<Frame>& frames) {
  StrayMisfit misfit(rig, lit);
  for (const auto& frame : frames) misfit.add(frame);
  const auto said = misfit.result();
  if (!std::isfinite(said.sd) || !(stray + said.step > 0.0)) return std::nullopt;
  return camera::Light{.value = stray + said.step, .sd = said.sd};
}

/// Points where the rig, as it is lit, has them.
void locate_again(const data::Rig& lit, std::vector<Frame>& frames) {
  for (auto& frame : frames)
    if (const auto found = locate(lit, frame.read, frame.x)) frame.x = found->x_in_world;
}

/// How far the light by the strengths lies off where the stray light is another by its SD.
double error_by_share(const data::Rig& rig, double stray, double light, const std::vector<Frame>& frames) {
  const double share = camera::stray_light(rig.cameras.front().detector).share_sd;
  const auto lit = camera::with_light(rig, {.value = 1.0 + (stray - 1.0) * (1.0 + share)});
  auto moved = frames;
  locate_again(lit, moved);
  const auto seen = by_strengths(lit, moved);
  return seen ? std::abs(with_prior(seen->light).value - light) : 0.0;
}

/// Rounds of light and points for one LED.
void find_light(const data::Rig& rig, std::vector<Frame>& frames, LedLight& out) {
  constexpr double kLeast = 0.01;
  const bool knows_strength = knows_light(rig), knows_room = knows_stray(rig);
  camera::Light light, stray;
  for (int round = 0; round < kRounds; ++round) {
    const auto lit = camera::with_light(rig, {.value = stray.value});
    locate_again(lit, frames);
    const auto room = knows_room ? by_misfit(rig, lit, stray.value, frames) : std::nullopt;
    const auto seen = knows_strength ? by_strengths(lit, frames) : std::nullopt;
    if (!seen && !room) return;
    out.source = seen ? seen->source : LightSource::stray;
    light = with_prior(seen ? seen->light : *room);
    light.value = std::max(light.value, kLeast);
    stray = light;
    if (seen) stray.sd = std::hypot(light.sd, kRoom * light.value);
    if (seen && room) stray = joined(stray, *room);
    stray.value = std::max(stray.value, kLeast);
  }
  if (knows_strength && !knows_room && out.source != LightSource::unknown)
    light.sd = std::hypot(light.sd, error_by_share(rig, stray.value, light.value, frames));
  out.light = light.value, out.light_sd = light.sd;
  out.stray = stray.value, out.stray_sd = stray.sd;
}

}  // namespace

std::string_view to_string(LightSource source) {
  constexpr EnumNames<LightSource::stray> kNames{"unknown", "direction", "turning", "stray"};
  return kNames[source];
}

std::vector<LedLight> find_lights(const data::Counts& counts, const data::Rig& rig,
                                  const data::Trajectories& points, std::span<const std::uint8_t> used,
                                  double flicker_counts) {
  std::vector<LedLight> out(counts.leds.size());
  for (std::int64_t led = 0; led < counts.led_count(); ++led) {
    auto& found = out[at(led)];
    found.strength_counts.assign(counts.cameras.size(), 0.0);
    found.seen.assign(static_cast<std::size_t>(counts.frames() * counts.camera_count()), kNaN);
    auto frames = frames_of(counts, rig, points, used, led, flicker_counts);
    if (frames.size() < kFewestFrames) continue;
    find_light(rig, frames, found);
    std::vector<std::vector<double>> strengths(counts.cameras.size());
    const auto lit = camera::with_light(rig, {.value = found.stray});
    for (const auto& frame : frames)
      for (const auto& read : frame.read) {
        const auto& camera = lit.cameras[at(read.camera)];
        strengths[at(read.camera)].push_back(strength_of(camera, read, frame.x));
        found.seen[at(frame.index * counts.camera_count() + read.camera)] =
            sight(camera, read, frame.x).light;
      }
    for (std::size_t c = 0; c < strengths.size(); ++c)
      if (!strengths[c].empty()) found.strength_counts[c] = math::upper_median(strengths[c]);
  }
  return out;
}

}  // namespace kinemark::reconstruction
