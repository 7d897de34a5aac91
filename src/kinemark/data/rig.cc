// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/rig.h"

#include <fmt/core.h>

#include <Eigen/LU>
#include <cmath>
#include <set>

#include "kinemark/core/enum_names.h"

namespace kinemark::data {
namespace {

constexpr EnumNames<CameraKind::lateral_effect> kCameraNames{"pinhole", "lateral-effect"};
constexpr EnumNames<DetectorKind::generic> kDetectorNames{"tetra-lateral", "duo-lateral", "pin-cushion",
                                                          "generic"};

std::unexpected<Error> wrong(const Camera& camera, const std::string& what) {
  return fail(Code::bad_input, fmt::format("camera '{}': {}", camera.name, what));
}

Status check_pose(const Camera& camera) {
  const auto& pose = camera.cam_from_world;
  if (!pose.translation.allFinite() || !pose.rotation.allFinite())
    return wrong(camera, "its pose has a number that is not finite");
  const double off =
      (pose.rotation * pose.rotation.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (off > 1e-6 || pose.rotation.determinant() < 0.0)
    return wrong(
        camera,
        fmt::format("its rotation is not orthonormal: R R' differs from 1 by {:.2g}, determinant {:.6g}", off,
                    pose.rotation.determinant()));
  return {};
}

Status check_optics(const Camera& camera) {
  if (!(camera.focal > 0.0) || !std::isfinite(camera.focal))
    return wrong(camera, fmt::format("focal length {}; need a positive number", camera.focal));
  if (!(camera.aspect > 0.0) || !std::isfinite(camera.aspect))
    return wrong(camera, fmt::format("aspect {}; need a positive number", camera.aspect));
  const auto& d = camera.distortion;
  if (!camera.principal_point.allFinite() || !std::isfinite(d.k1 + d.k2 + d.k3 + d.p1 + d.p2))
    return wrong(camera, "principal point or distortion is not finite");
  return {};
}

bool all_finite(const std::vector<double>& values) {
  for (const double v : values)
    if (!std::isfinite(v)) return false;
  return true;
}

Status check_polynomial(const Camera& camera, int degree, std::size_t have, int need, std::string_view what) {
  if (degree < 0 || degree > kHighestDegree)
    return wrong(camera, fmt::format("{} degree {}; need 0 to {}", what, degree, kHighestDegree));
  if (have != static_cast<std::size_t>(need))
    return wrong(camera, fmt::format("{} of degree {} has {} terms; need {}", what, degree, have, need));
  return {};
}

Status check_detector(const Camera& camera) {
  const auto& d = camera.detector;
  if (!(d.half_side_m > 0.0) || !std::isfinite(d.half_side_m))
    return wrong(camera, fmt::format("detector half-side {} m; need a positive number", d.half_side_m));
  if (!(d.edge > 0.0 && d.edge <= 1.0))
    return wrong(camera, fmt::format("detector edge at {} half-sides; need more than 0, at most 1", d.edge));
  for (const auto* warp : {&d.warp_x, &d.warp_y})
    if (auto s = check_polynomial(camera, d.warp_degree, warp->size(), d.warp_terms(), "warp"); !s) return s;
  const int generic = d.kind == DetectorKind::generic ? 3 * monomial_count(0, d.generic_degree) : 0;
  if (auto s = check_polynomial(camera, d.generic_degree, d.generic.size(), generic, "generic detector"); !s)
    return s;
  if (!all_finite(d.warp_x) || !all_finite(d.warp_y) || !all_finite(d.generic) || !d.crosstalk.allFinite() ||
      !d.gain.allFinite() || !d.offset_counts.allFinite())
    return wrong(camera, "the detector has a number that is not finite");
  if (!d.knows_dark() && !d.dark_counts.array().isNaN().all())
    return wrong(camera, "dark_counts of some channels; need all four, or none");
  if (!(d.dark_sd_counts >= 0.0) || !std::isfinite(d.dark_sd_counts))
    return wrong(camera, fmt::format("dark_sd_counts {}; need 0 or more", d.dark_sd_counts));
  if (!std::isnan(d.light_counts) && !(d.light_counts > 0.0 && std::isfinite(d.light_counts)))
    return wrong(camera, fmt::format("light_counts {}; need a positive number", d.light_counts));
  if (!(d.gain.minCoeff() > 0.0))
    return wrong(camera, fmt::format("a gain of {}; need positive ones", d.gain.minCoeff()));
  return {};
}

Status check_table(const Camera& camera) {
  const auto& t = camera.table;
  if (t.nodes == 0 && t.uv.empty()) return {};
  if (t.nodes < 3 || t.nodes > 1000)
    return wrong(camera, fmt::format("a table of {} nodes a side; need 3 to 1000", t.nodes));
  if (t.uv.size() != static_cast<std::size_t>(2 * t.nodes * t.nodes))
    return wrong(camera, fmt::format("a table of {} nodes a side holds {} numbers; need {}", t.nodes,
                                     t.uv.size(), 2 * t.nodes * t.nodes));
  if (!(t.spacing_m > 0.0) || !(t.distance_m > 0.0) || !std::isfinite(t.spacing_m + t.distance_m) ||
      !all_finite(t.uv))
    return wrong(camera, "its table needs a positive spacing and distance, and finite ratios");
  return {};
}

/// A number of the electronics and where it may lie.
struct Range {
  std::string_view key;
  double value, low, high;
  bool above_low;  ///< the lower end itself is no value
};

Status check_electronics(const Electronics& e) {
  // Wide enough for any amplifier and converter that was ever built.
  for (const Range& r : {Range{"time_constant_s", e.time_constant_s, 0.0, 1.0, true},
                         Range{"full_scale_a", e.full_scale_a, 0.0, 1.0, true},
                         Range{"interelectrode_ohm", e.interelectrode_ohm, 0.0, 1e12, true},
                         Range{"feedback_ohm", e.feedback_ohm, 0.0, 1e12, true},
                         Range{"temperature_k", e.temperature_k, 0.0, 1000.0, true},
                         Range{"converter_noise_counts", e.converter_noise_counts, 0.0, 1e5, false},
                         Range{"amplifier_noise_v_rthz", e.amplifier_noise_v_rthz, 0.0, 1.0, false},
                         Range{"ambient_a", e.ambient_a, 0.0, 1.0, false}})
    if (!(r.above_low ? r.value > r.low : r.value >= r.low) || !(r.value <= r.high))
      return fail(Code::bad_input,
                  fmt::format("electronics: {} is {}; need {} {}, at most {}", r.key, r.value,
                              r.above_low ? "more than" : "at least", r.low, r.high));
  if (e.bits < 1 || e.bits > 15)
    return fail(Code::bad_input, fmt::format("electronics: a converter of {} bits; need 1 to 15", e.bits));
  return {};
}

}  // namespace

std::string_view to_string(CameraKind kind) { return kCameraNames[kind]; }
std::string_view to_string(DetectorKind kind) { return kDetectorNames[kind]; }
Result<CameraKind> parse_camera_kind(std::string_view name) {
  return kCameraNames.parse(name, "kind of camera", Code::bad_input);
}
Result<DetectorKind> parse_detector_kind(std::string_view name) {
  return kDetectorNames.parse(name, "kind of detector", Code::bad_input);
}

int monomial_count(int lowest_degree, int highest_degree) {
  int n = 0;
  for (int k = lowest_degree; k <= highest_degree; ++k) n += k + 1;
  return n;
}

ParameterLayout::ParameterLayout(const Camera& camera) {
  if (camera.kind == CameraKind::pinhole) return;
  warp_terms = static_cast<int>(camera.detector.warp_x.size());
  warp_y = warp_x + warp_terms;
  crosstalk = warp_y + warp_terms;
  generic = crosstalk + 12;
  gain = generic + static_cast<int>(camera.detector.generic.size());
  offset = gain + 4;
  count = offset + 4;
}

double Electronics::count_a() const { return full_scale_a / std::exp2(bits); }

int Rig::first_parameter(int camera) const {
  int n = 0;
  for (int c = 0; c < camera; ++c) n += ParameterLayout(cameras[static_cast<std::size_t>(c)]).count;
  return n;
}

Status Rig::validate() const {
  if (cameras.empty()) return fail(Code::bad_input, "the rig has no camera");
  std::set<std::string_view> seen;
  for (const Camera& camera : cameras) {
    if (camera.name.empty()) return fail(Code::bad_input, "a camera has no name");
    if (!seen.insert(camera.name).second)
      return fail(Code::bad_input, fmt::format("camera name '{}' occurs twice", camera.name));
    if (auto s = check_pose(camera); !s) return s;
    if (auto s = check_optics(camera); !s) return s;
    if (camera.kind == CameraKind::pinhole) continue;
    if (auto s = check_detector(camera); !s) return s;
    if (auto s = check_table(camera); !s) return s;
  }
  if (auto s = check_electronics(electronics); !s) return s;
  for (const double v : {timing.settle_s, timing.conversion_s, timing.off_s})
    if (!(v >= 0.0) || !(v < 1.0))
      return fail(Code::bad_input, fmt::format("timing: {} s within a slot; need 0 or more, below 1 s", v));
  if (!(timing.conversion_s > 0.0)) return fail(Code::bad_input, "timing: conversions take no time");
  if (!(chi2_per_dof >= 0.0) || !std::isfinite(chi2_per_dof))
    return fail(Code::bad_input, fmt::format("the rig's chi2 per degree of freedom is {}", chi2_per_dof));
  if (covariance.size() == 0) return {};
  const auto n = static_cast<Eigen::Index>(parameter_count());
  if (covariance.rows() != n || covariance.cols() != n)
    return fail(Code::bad_input,
                fmt::format("the rig's covariance is {} by {}; its cameras have {} parameters",
                            covariance.rows(), covariance.cols(), n));
  if (!covariance.allFinite())
    return fail(Code::bad_input, "the rig's covariance has a number that is not finite");
  if (covariance.diagonal().minCoeff() < 0.0)
    return fail(Code::bad_input, "the rig's covariance has a negative variance");
  if ((covariance - covariance.transpose()).cwiseAbs().maxCoeff() > 1e-9 * covariance.cwiseAbs().maxCoeff())
    return fail(Code::bad_input, "the rig's covariance is not symmetric");
  return {};
}

}  // namespace kinemark::data
