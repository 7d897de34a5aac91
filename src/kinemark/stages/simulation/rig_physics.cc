// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/rig_physics.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinemark/camera/parameters.h"
#include "kinemark/camera/response.h"
#include "kinemark/core/random.h"
#include "kinemark/core/units.h"
#include "kinemark/math/euler.h"

namespace kinemark::simulation {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector4d;
using std::numbers::pi;

Vector2d gaussians2(Random& random, double sd) {
  const double x = random.gaussian();
  const double y = random.gaussian();
  return {sd * x, sd * y};
}

Vector3d gaussians3(Random& random) {
  const double x = random.gaussian();
  const double y = random.gaussian();
  const double z = random.gaussian();
  return {x, y, z};
}

Vector4d gaussians4(Random& random, double sd) {
  Vector4d out;
  for (double& v : out) v = sd * random.gaussian();
  return out;
}

data::Camera nominal_camera(const RigDrawOptions& options, const RigLight& light, int index) {
  data::Camera camera;
  camera.name = index == 0 ? "A" : "B";
  const double half_angle = 0.5 * options.convergence_deg * kRadPerDeg;
  const double side = index == 0 ? -1.0 : 1.0;
  camera.cam_from_world = looking_at_origin(
      {side * light.distance_m * std::sin(half_angle), 0.0, light.distance_m * std::cos(half_angle)});
  camera.detector.kind = options.detector;
  camera.focal =
      light.focal_length_m * (1.0 + light.focal_length_m / light.distance_m) / camera.detector.half_side_m;
  return camera;
}

/// The order of draws is part of the interface: see draw_rig().
void draw_camera(const RigDrawOptions& options, int index, data::Camera& camera, RoomLight& room) {
  Random random(options.seed, 100 + static_cast<std::uint64_t>(index));
  const double z = options.imperfection;
  const double half_side = camera.detector.half_side_m;
  const Vector3d centre = camera.centre_in_world() + options.misalignment * 10e-3 * gaussians3(random);
  const Vector3d rotation =
      options.misalignment * gaussians3(random).cwiseProduct(Vector3d(3e-3, 0.5e-3, 0.5e-3));
  camera.cam_from_world = looking_at_origin(centre, rotation.x(), rotation.y(), rotation.z());
  camera.focal *= 1.0 + z * 0.006 * random.gaussian();
  camera.principal_point = gaussians2(random, z * 0.08e-3) / half_side;
  camera.distortion.k1 = -0.20 * (1.0 + z * 0.15 * random.gaussian());
  camera.distortion.k2 = 0.30;
  const Vector2d tangential = gaussians2(random, z * 5e-4);
  camera.distortion.p1 = tangential.x();
  camera.distortion.p2 = tangential.y();
  auto& detector = camera.detector;
  camera = camera::with_warp_degree(camera, 5);
  for (std::size_t n = 0; n < detector.warp_x.size(); ++n) {
    const Vector2d term = gaussians2(random, z * 0.0030);
    detector.warp_x[n] = term.x();
    detector.warp_y[n] = term.y();
  }
  detector.gain += gaussians4(random, z * 0.005);
  detector.offset_counts += gaussians4(random, z * 2.0);
  room.flicker_counts = z;
  room.flicker_phase_rad = random.uniform() * 2.0 * pi;
  room.stray = Vector4d(1.0, 1.0, 1.3, 0.7) / 4.0;  // more of it comes from the floor
}

void spoil_detector(const RigDrawOptions& options, int index, data::Camera& camera) {
  Random random(options.seed, 900 + static_cast<std::uint64_t>(index));
  auto& detector = camera.detector;
  Matrix4d strays;
  for (int j = 0; j < 4; ++j)
    for (int k = 0; k < 4; ++k) strays(j, k) = random.uniform();
  for (int j = 0; j < 4; ++j) strays.row(j) /= strays.row(j).sum();
  detector.crosstalk = options.crosstalk * (strays - Matrix4d::Identity());
  if (options.ripple <= 0.0) return;
  const std::size_t smooth = detector.warp_x.size();
  camera = camera::with_warp_degree(camera, 10);
  for (std::size_t n = smooth; n < detector.warp_x.size(); ++n) {
    const Vector2d term = gaussians2(random, options.ripple);
    detector.warp_x[n] = term.x();
    detector.warp_y[n] = term.y();
  }
}

/// Photocurrent of the LED itself in one camera, A. Beyond 89 degrees a diode still shines a little.
double direct_current_a(const PhysicalRig& rig, const data::Camera& camera, const LedState& led,
                        double intensity) {
  const Vector3d x_in_cam = camera.cam_from_world * led.x_in_world;
  const double distance = x_in_cam.norm();
  const double cos_led =
      std::clamp((camera.centre_in_world() - led.x_in_world).dot(led.normal) / distance, 0.02, 1.0);
  return intensity * photocurrent_a(rig.light, distance, cos_led, x_in_cam.z() / distance);
}

/// Counts of what the room returns of an LED's light.
Vector4d stray_counts(const PhysicalRig& rig, int camera_idx, double intensity) {
  const auto& camera = rig.rig.cameras[static_cast<std::size_t>(camera_idx)];
  const auto& room = rig.room[static_cast<std::size_t>(camera_idx)];
  const double stray_a =
      rig.light.stray_share * intensity * photocurrent_a(rig.light, rig.light.distance_m, 1.0, 1.0);
  return camera.detector.gain.cwiseProduct(room.stray) * (stray_a / rig.rig.electronics.count_a());
}

}  // namespace

Status RigDrawOptions::check() const {
  for (const double v : {imperfection, misalignment, ripple})
    if (!(v >= 0.0) || !std::isfinite(v))
      return fail(Code::usage,
                  fmt::format("imperfection, misalignment and ripple are 0 or more; one is {}", v));
  if (!(crosstalk >= 0.0 && crosstalk <= 0.5))
    return fail(Code::usage, fmt::format("crosstalk is 0 to 0.5; it is {}", crosstalk));
  if (!(convergence_deg >= 10.0 && convergence_deg <= 150.0))
    return fail(Code::usage,
                fmt::format("cameras whose axes are {} deg apart; need 10 to 150 deg", convergence_deg));
  if (bits < 8 || bits > 14)
    return fail(Code::usage, fmt::format("a converter of {} bits; need 8 to 14", bits));
  if (!(conversion_s >= 1e-6 && conversion_s <= 1e-3))
    return fail(Code::usage, fmt::format("conversions of {:.6g} us; need 1 to 1000 us", conversion_s * 1e6));
  if (detector == data::DetectorKind::generic)
    return fail(Code::usage,
                "a generic detector has no physics to simulate; choose tetra-lateral, duo-lateral or "
                "pin-cushion");
  return {};
}

double photocurrent_a(const RigLight& light, double distance_m, double cos_led, double cos_camera) {
  const double diameter = light.focal_length_m / light.f_number;
  const double lens_area = pi / 4.0 * diameter * diameter;
  return light.led_power_w / pi * cos_led * cos_camera * lens_area / (distance_m * distance_m) *
         light.transmission * light.responsivity_a_w;
}

math::SE3 looking_at_origin(const Vector3d& centre, double roll_rad, double yaw_rad, double pitch_rad) {
  const Vector3d forward = -centre.normalized();
  const Vector3d right = forward.cross(Vector3d::UnitY()).normalized();
  Eigen::Matrix3d level;
  level << right.transpose(), forward.cross(right).transpose(), forward.transpose();
  math::SE3 pose;
  pose.rotation = math::axis_angle(Vector3d::UnitZ(), roll_rad) *
                  math::axis_angle(Vector3d::UnitX(), pitch_rad) *
                  math::axis_angle(Vector3d::UnitY(), yaw_rad) * level;
  pose.translation = -(pose.rotation * centre);
  return pose;
}

Result<PhysicalRig> draw_rig(const RigDrawOptions& options) {
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  PhysicalRig out;
  out.seed = options.seed;
  out.rig.id = fmt::format("simulated-{}-{}", to_string(options.detector), options.seed);
  out.rig.timing.dark_slot = options.dark_slot;
  out.rig.timing.conversion_s = options.conversion_s;
  out.rig.electronics.bits = options.bits;
  for (int c = 0; c < 2; ++c) out.rig.cameras.push_back(nominal_camera(options, out.light, c));
  out.nominal = out.rig;
  out.nominal.method = "nominal";
  out.rig.method = "simulated";
  for (int c = 0; c < 2; ++c) {
    auto& camera = out.rig.cameras[static_cast<std::size_t>(c)];
    draw_camera(options, c, camera, out.room.emplace_back());
    if (options.crosstalk > 0.0 || options.ripple > 0.0) spoil_detector(options, c, camera);
    if (options.dark_slot) camera.detector.offset_counts.array() += kPedestal_counts;
    const double codes = std::ldexp(1.0, options.bits - 12);
    camera.detector.offset_counts *= codes;
    out.room.back().flicker_counts *= codes;
  }
  return out;
}

ExpectedCounts expected_counts(const PhysicalRig& rig, int camera_idx, const LedState& led,
                               double intensity) {
  const auto& camera = rig.rig.cameras[static_cast<std::size_t>(camera_idx)];
  ExpectedCounts out;
  out.counts = camera.detector.offset_counts + stray_counts(rig, camera_idx, led.shining ? intensity : 0.0);
  const auto response = camera::respond(camera, led.x_in_world);
  out.on_sheet = response.in_front && response.on_sheet;
  if (out.on_sheet && led.shining)
    out.counts +=
        response.phi * (direct_current_a(rig, camera, led, intensity) / rig.rig.electronics.count_a());
  return out;
}

data::Rig rig_in_room(const PhysicalRig& rig) {
  data::Rig out = rig.rig;
  for (int c = 0; c < out.camera_count(); ++c) {
    auto& detector = out.cameras[static_cast<std::size_t>(c)].detector;
    detector.dark_counts = detector.offset_counts;
    detector.offset_counts += stray_counts(rig, c, 1.0);
    detector.light_counts = photocurrent_a(rig.light, 1.0, 1.0, 1.0) / rig.rig.electronics.count_a();
  }
  return out;
}

Vector4d reflected_counts(const PhysicalRig& rig, int camera_idx, const LedState& led, double intensity,
                          const Vector3d& position_in_world, double share) {
  const auto& camera = rig.rig.cameras[static_cast<std::size_t>(camera_idx)];
  const auto response = camera::respond(camera, position_in_world);
  if (!response.in_front || !response.on_sheet || !led.shining) return Vector4d::Zero();
  const double current_a = share * direct_current_a(rig, camera, led, intensity);
  return response.phi * (current_a / rig.rig.electronics.count_a());
}

}  // namespace kinemark::simulation
