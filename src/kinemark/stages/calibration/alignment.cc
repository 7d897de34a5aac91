// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/calibration/alignment.h"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <limits>

#include "kinemark/core/units.h"
#include "kinemark/math/euler.h"
#include "kinemark/math/rotation_fit.h"
#include "kinemark/stages/calibration/bundle.h"

namespace kinemark::calibration {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Lens and three points of the line of sight and the frame around it, in the world.
Eigen::Matrix3Xd marks(const data::Rig& rig) {
  constexpr double kAhead_m = 3.0, kAside_m = 0.5;
  Eigen::Matrix3Xd out(3, 4 * rig.camera_count());
  for (int c = 0; c < rig.camera_count(); ++c) {
    const math::SE3 world_from_cam = rig.cameras[static_cast<std::size_t>(c)].cam_from_world.inverse();
    out.col(4 * c) = world_from_cam.translation;
    out.col(4 * c + 1) = world_from_cam * Vector3d(0.0, 0.0, kAhead_m);
    out.col(4 * c + 2) = world_from_cam * Vector3d(kAside_m, 0.0, 0.0);
    out.col(4 * c + 3) = world_from_cam * Vector3d(0.0, kAside_m, 0.0);
  }
  return out;
}

void add_deviations(const data::Rig& found, int camera, const Matrix3d& cam_from_world, CameraAlignment& to) {
  if (found.covariance.size() == 0) return;
  const int first = found.first_parameter(camera);
  const auto block = [&](int at) { return Matrix3d(found.covariance.block<3, 3>(first + at, first + at)); };
  to.rotation_sd_deg =
      kDegPerRad * block(data::ParameterLayout::rotation).diagonal().cwiseMax(0.0).cwiseSqrt();
  to.shift_sd_m = (cam_from_world * block(data::ParameterLayout::centre) * cam_from_world.transpose())
                      .diagonal()
                      .cwiseMax(0.0)
                      .cwiseSqrt();
}

/// Description of the worst deviation of all cameras.
void say_next(const AlignmentOptions& options, Alignment& out) {
  using Phrases = std::array<const char*, 2>;  // for a positive and a negative deviation
  constexpr std::array<Phrases, 3> kMove{
      {{"to the left", "to the right"}, {"up", "down"}, {"back", "forward"}}};
  constexpr std::array<Phrases, 3> kRotate{{{"tilt it up", "tilt it down"},
                                            {"pan it to the right", "pan it to the left"},
                                            {"roll it clockwise", "roll it counter-clockwise"}}};
  double worst = 1.0;
  out.aligned = true;
  out.next = "nothing: all cameras are within tolerance";
  for (const auto& c : out.cameras)
    for (std::size_t a = 0; a < 3; ++a) {
      const auto axis = static_cast<Eigen::Index>(a);
      if (const double share = std::abs(c.shift_m[axis]) / options.shift_tolerance_m; share > worst) {
        worst = share;
        out.next = fmt::format("camera '{}': move it {:.1f} mm {}", c.camera, 1e3 * std::abs(c.shift_m[axis]),
                               kMove[a][c.shift_m[axis] < 0.0]);
      }
      if (const double share = std::abs(c.rotation_deg[axis]) / options.rotation_tolerance_deg;
          share > worst) {
        worst = share;
        out.next = fmt::format("camera '{}': {} by {:.2f} deg", c.camera,
                               kRotate[a][c.rotation_deg[axis] < 0.0], std::abs(c.rotation_deg[axis]));
      }
    }
  out.aligned = worst <= 1.0;
}

}  // namespace

Status AlignmentOptions::check() const {
  if (shift_tolerance_m > 0.0 && rotation_tolerance_deg > 0.0) return {};
  return fail(Code::usage, fmt::format("tolerances of {} m and {} deg; both must be positive",
                                       shift_tolerance_m, rotation_tolerance_deg));
}

Result<Alignment> compare_alignment(const data::Rig& wanted, const data::Rig& found,
                                    const AlignmentOptions& options) {
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  if (wanted.camera_count() != found.camera_count() || wanted.camera_count() == 0)
    return fail(Code::bad_input, fmt::format("{} cameras are wanted and {} were found", wanted.camera_count(),
                                             found.camera_count()));
  const math::SE3 wanted_from_found = math::fit_rigid(marks(found), marks(wanted)).target_from_source;
  Alignment out;
  for (int c = 0; c < wanted.camera_count(); ++c) {
    const auto at = static_cast<std::size_t>(c);
    const math::SE3& should = wanted.cameras[at].cam_from_world;
    const math::SE3 is = found.cameras[at].cam_from_world * wanted_from_found.inverse();
    CameraAlignment one;
    one.camera = wanted.cameras[at].name;
    one.shift_m = should.rotation * (is.inverse().translation - should.inverse().translation);
    // A point on the nominal axis appears to the right in a camera that points too far left: it has to pan
    // right.
    one.rotation_deg = kDegPerRad * math::log_so3(is.rotation * should.rotation.transpose());
    add_deviations(found, c, found.cameras[at].cam_from_world.rotation, one);
    out.cameras.push_back(one);
  }
  say_next(options, out);
  return out;
}

Result<Alignment> align_by_tree(const data::Rig& wanted, const StillPoses& tree,
                                const AlignmentOptions& options) {
  BundleOptions bundle;
  bundle.escalate = false;
  bundle.refuse_above = std::numeric_limits<double>::infinity();
  const auto found = calibrate_bundle(wanted, tree, {}, bundle);
  if (!found) return std::unexpected(found.error());
  return compare_alignment(wanted, found->rig, options);
}

}  // namespace kinemark::calibration
