// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A pair of cameras films a body; one of them goes dark for a second. What the other one sees of every marker
// must suffice for the smoother, and its error bars must be right.
#include <fmt/core.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <string>

#include "kinemark/camera/projection.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/random.h"
#include "kinemark/core/units.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/smoother/camera_observations.h"
#include "kinemark/stages/simulation/subject.h"
#include "support/acceptance.h"
#include "support/test_data.h"

namespace {

using namespace kinemark;
using Eigen::Vector3d;

constexpr double kNoise_px = 0.3;
constexpr std::int64_t kFirst = 240, kLast = 300;  // the second in the dark, at 60 Hz

data::Camera camera_at(const Vector3d& position, const Vector3d& target) {
  data::Camera camera;
  camera.kind = data::CameraKind::pinhole;
  camera.focal = 1500.0;
  const Vector3d z = (target - position).normalized(), x = Vector3d::UnitY().cross(z).normalized(),
                 y = z.cross(x);
  camera.cam_from_world.rotation.row(0) = x.transpose();
  camera.cam_from_world.rotation.row(1) = y.transpose();
  camera.cam_from_world.rotation.row(2) = z.transpose();
  camera.cam_from_world.translation = -camera.cam_from_world.rotation * position;
  return camera;
}

/// Position of a marker that fits the images of all cameras best.
Vector3d triangulate(const data::ImageTracks& tracks, std::int64_t f, std::size_t m, Vector3d x) {
  for (int i = 0; i < 6; ++i) {
    Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
    Vector3d g = Vector3d::Zero();
    for (std::size_t c = 0; c < tracks.cameras.size(); ++c) {
      const auto there = camera::project(tracks.cameras[c], x);
      H += there.d_point.transpose() * there.d_point;
      g += there.d_point.transpose() * (tracks.at(f, c, m) - there.image);
    }
    x += H.inverse() * g;
  }
  return x;
}

struct Filmed {
  data::ImageTracks tracks;
  data::Trajectories markers;
};

Filmed film(const simulation::SimulatedSubject& subject, std::uint64_t seed) {
  Filmed filmed;
  const auto& exact = subject.true_markers;
  Vector3d middle = Vector3d::Zero();
  for (std::int64_t m = 0; m < exact.markers(); ++m)
    middle += exact.x(0, m) / static_cast<double>(exact.markers());
  auto& tracks = filmed.tracks;
  tracks.names = exact.names;
  tracks.time = exact.time;
  tracks.cameras = {camera_at(middle + Vector3d(3.0, 0.8, 2.2), middle),
                    camera_at(middle + Vector3d(3.0, 0.8, -2.2), middle)};
  tracks.noise_sd = {kNoise_px, kNoise_px};
  Random random(seed, 501);
  for (std::int64_t f = 0; f < exact.frames(); ++f)
    for (const auto& camera : tracks.cameras)
      for (std::int64_t m = 0; m < exact.markers(); ++m) {
        const auto seen = camera::project(camera, exact.x(f, m));
        for (int axis = 0; axis < 2; ++axis)
          tracks.image.push_back(seen.image[axis] + kNoise_px * random.gaussian());
      }
  filmed.markers = exact;
  for (std::int64_t f = 0; f < exact.frames(); ++f)
    for (std::int64_t m = 0; m < exact.markers(); ++m)
      filmed.markers.x(f, m) = triangulate(tracks, f, static_cast<std::size_t>(m), exact.x(f, m));
  return filmed;
}

void darken(Filmed& filmed, std::size_t camera) {
  auto& tracks = filmed.tracks;
  for (std::int64_t f = kFirst; f < kLast; ++f)
    for (std::size_t m = 0; m < tracks.names.size(); ++m) {
      const auto i = tracks.index(f, camera, m);
      tracks.image[i] = tracks.image[i + 1] = kNaN;
      filmed.markers.set_missing(f, static_cast<std::int64_t>(m));
    }
}

struct Sums {
  double squares = 0.0, variances = 0.0, z = 0.0;
  std::int64_t count = 0, one = 0, two = 0;
  void add(const data::JointMotion& motion, const data::JointMotion& truth, std::int64_t first,
           std::int64_t last) {
    for (std::int64_t f = first; f < last; ++f)
      for (std::int64_t c = 0; c < motion.size(); ++c) {
        const auto i = motion.index(f, c);
        if (!motion.is_rotation[static_cast<std::size_t>(c)]) continue;
        const double error = motion.q[i] - truth.q[i];
        squares += error * error;
        ++count;
        if (motion.determined[i] == 0) continue;
        variances += motion.q_sd[i] * motion.q_sd[i];
        z += error * error / (motion.q_sd[i] * motion.q_sd[i]);
        one += std::abs(error) <= motion.q_sd[i];
        two += std::abs(error) <= 2.0 * motion.q_sd[i];
      }
  }
  [[nodiscard]] double mean(double sum) const { return std::sqrt(sum / static_cast<double>(count)); }
  [[nodiscard]] double share(std::int64_t n) const {
    return 100.0 * static_cast<double>(n) / static_cast<double>(count);
  }
};

/// accept_motion one_camera [SUBJECTS]
int run_check(int argc, char** argv) {
  const int subjects = argc > 1 ? std::stoi(argv[1]) : 2;
  const auto model = model::Model::compile(
                         io::read_osim(testing_support::project_folder() / "models" / "human.osim").value())
                         .value();
  Sums lit, one_camera, dropped;
  for (int s = 1; s <= subjects; ++s) {
    simulation::SubjectOptions options;
    options.duration_s = 9.0;
    options.rate_hz = 60.0;
    options.seed = static_cast<std::uint64_t>(40 + s);
    options.noise_sd_m = 0.0;
    const auto subject = simulation::simulate_subject(model, options).value();
    auto filmed = film(subject, options.seed);
    darken(filmed, 1);
    const auto with = motion::smooth_images(model, filmed.tracks, filmed.markers).value();
    lit.add(with.motion, subject.truth, 60, kFirst - 30);
    one_camera.add(with.motion, subject.truth, kFirst, kLast);
    darken(filmed, 0);
    const auto without = motion::smooth_images(model, filmed.tracks, filmed.markers).value();
    dropped.add(without.motion, subject.truth, kFirst, kLast);
  }
  const double error = kDegPerRad * one_camera.mean(one_camera.squares),
               bar = kDegPerRad * one_camera.mean(one_camera.variances),
               error_dropped = kDegPerRad * dropped.mean(dropped.squares),
               error_lit = kDegPerRad * lit.mean(lit.squares), bar_lit = kDegPerRad * lit.mean(lit.variances);
  testing_support::print_row(
      error_dropped >= 5.0 * error,
      fmt::format("camera-space, one of two cameras dark for 1 s, {} subjects", subjects),
      "joint error at most a fifth of that without its markers",
      fmt::format("{:.3f} deg RMS against {:.3f} deg: {:.1f} times better", error, error_dropped,
                  error_dropped / error));
  testing_support::print_row(
      one_camera.share(one_camera.one) >= 60.0 && one_camera.share(one_camera.two) >= 90.0 && bar > bar_lit &&
          error < 1.5 * bar,
      "camera-space, the error grows as its SD says", "60 / 90 % within 1 / 2 SD or more; RMS error < 1.5 SD",
      fmt::format("{:.0f} / {:.0f} %; error {:.3f} deg at an SD of {:.3f}, before the loss {:.3f} at {:.3f}",
                  one_camera.share(one_camera.one), one_camera.share(one_camera.two), error, bar, error_lit,
                  bar_lit));
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("one_camera", run_check);

}  // namespace
