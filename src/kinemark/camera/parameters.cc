// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/camera/parameters.h"

#include <fmt/core.h>

#include "kinemark/core/check.h"
#include "kinemark/math/euler.h"

namespace kinemark::camera {
namespace {

using data::ParameterLayout;
using Eigen::VectorXd;

/// Calls visit(index, value) for every parameter that is a plain number of the camera: all but the pose.
template <class Camera, class Visit>
void visit_numbers(Camera& camera, const ParameterLayout& layout, const Visit& visit) {
  visit(ParameterLayout::focal, camera.focal);
  visit(ParameterLayout::aspect, camera.aspect);
  for (int i = 0; i < 2; ++i) visit(ParameterLayout::principal + i, camera.principal_point[i]);
  auto& lens = camera.distortion;
  int at = ParameterLayout::distortion;
  for (auto* k : {&lens.k1, &lens.k2, &lens.k3, &lens.p1, &lens.p2}) visit(at++, *k);
  if (camera.kind == data::CameraKind::pinhole) return;
  auto& detector = camera.detector;
  at = ParameterLayout::warp_x;
  for (auto& v : detector.warp_x) visit(at++, v);
  for (auto& v : detector.warp_y) visit(at++, v);
  for (int j = 0; j < 4; ++j)
    for (int k = 0; k < 4; ++k)
      if (j != k) visit(at++, detector.crosstalk(j, k));
  for (auto& v : detector.generic) visit(at++, v);
  for (int k = 0; k < 4; ++k) visit(layout.gain + k, detector.gain[k]);
  for (int k = 0; k < 4; ++k) visit(layout.offset + k, detector.offset_counts[k]);
}

void add_polynomial(std::vector<std::string>& names, const char* what, int lowest, int highest) {
  for (int k = lowest; k <= highest; ++k)
    for (int j = 0; j <= k; ++j) names.push_back(fmt::format("{}_{}_{}", what, k - j, j));
}

}  // namespace

std::vector<std::string> parameter_names(const data::Camera& camera) {
  std::vector<std::string> names{"rotation_x", "rotation_y", "rotation_z", "centre_x",    "centre_y",
                                 "centre_z",   "focal",      "aspect",     "principal_x", "principal_y",
                                 "k1",         "k2",         "k3",         "p1",          "p2"};
  if (camera.kind == data::CameraKind::pinhole) return names;
  const auto& detector = camera.detector;
  add_polynomial(names, "warp_x", 2, detector.warp_degree);
  add_polynomial(names, "warp_y", 2, detector.warp_degree);
  for (int j = 0; j < 4; ++j)
    for (int k = 0; k < 4; ++k)
      if (j != k) names.push_back(fmt::format("crosstalk_{}_{}", j, k));
  if (detector.kind == data::DetectorKind::generic)
    for (int k = 0; k < 3; ++k)
      add_polynomial(names, fmt::format("generic_{}", k).c_str(), 0, detector.generic_degree);
  for (const char* what : {"gain", "offset"})
    for (int k = 0; k < 4; ++k) names.push_back(fmt::format("{}_{}", what, k));
  return names;
}

data::Camera moved(const data::Camera& camera, const Eigen::Ref<const VectorXd>& step) {
  const ParameterLayout layout(camera);
  check(step.size() == layout.count, "a step has one number per parameter of the camera");
  data::Camera out = camera;
  const Eigen::Vector3d centre = camera.centre_in_world() + step.segment<3>(ParameterLayout::centre);
  out.cam_from_world.rotation =
      math::exp_so3(step.segment<3>(ParameterLayout::rotation)) * camera.cam_from_world.rotation;
  out.cam_from_world.translation = -(out.cam_from_world.rotation * centre);
  visit_numbers(out, layout, [&step](int i, double& value) { value += step[i]; });
  return out;
}

VectorXd step_between(const data::Camera& from, const data::Camera& to) {
  const ParameterLayout layout(from);
  check(ParameterLayout(to).count == layout.count, "both cameras have the same parameters");
  VectorXd step(layout.count);
  step.segment<3>(ParameterLayout::rotation) =
      math::log_so3(to.cam_from_world.rotation * from.cam_from_world.rotation.transpose());
  step.segment<3>(ParameterLayout::centre) = to.centre_in_world() - from.centre_in_world();
  visit_numbers(to, layout, [&step](int i, double value) { step[i] = value; });
  visit_numbers(from, layout, [&step](int i, double value) { step[i] -= value; });
  return step;
}

data::Camera with_warp_degree(const data::Camera& camera, int degree) {
  check(degree >= 0 && degree <= data::kHighestDegree, "a warp has degree 0 to kHighestDegree");
  data::Camera out = camera;
  out.detector.warp_degree = degree;
  const auto terms = static_cast<std::size_t>(data::monomial_count(2, degree));
  out.detector.warp_x.resize(terms, 0.0);
  out.detector.warp_y.resize(terms, 0.0);
  return out;
}

}  // namespace kinemark::camera
