// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinemark/core/missing.h"
#include "kinemark/math/euler.h"
#include "kinemark/stages/analysis/segments/constructions.h"
#include "kinemark/stages/analysis/segments/internal/functions.h"

namespace kinemark::analysis::internal {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Values = std::span<const StepValue* const>;

constexpr auto kNumber = StepType::number, kVector = StepType::vector, kFrame = StepType::frame;

double number(const StepValue& v) { return v[0]; }
Eigen::Map<const Vector3d> vector(const StepValue& v) { return Eigen::Map<const Vector3d>(v.data()); }
Eigen::Map<const Matrix3d> axes(const StepValue& v) { return Eigen::Map<const Matrix3d>(v.data()); }
Eigen::Map<const Vector3d> origin(const StepValue& v) { return Eigen::Map<const Vector3d>(v.data() + 9); }
void set(StepValue& out, const Vector3d& v) { Eigen::Map<Vector3d>(out.data()) = v; }
void set(StepValue& out, double v) { out[0] = v; }
void set_frame(StepValue& out, const Matrix3d& r, const Vector3d& o) {
  Eigen::Map<Matrix3d>(out.data()) = r;
  Eigen::Map<Vector3d>(out.data() + 9) = o;
}

template <class F>
FunctionForm numbers(std::string_view name, std::size_t count, F&& f) {
  return {name, std::vector<StepType>(count, kNumber), false, kNumber,
          [f](Values a, StepValue& out) { f(a, out); }};
}

void mean_of(Values a, StepValue& out, std::size_t size) {
  for (std::size_t k = 0; k < size; ++k) {
    double sum = 0.0;
    for (const auto* one : a) sum += (*one)[k];
    out[k] = sum / static_cast<double>(a.size());
  }
}

std::vector<FunctionForm> operators() {
  std::vector<FunctionForm> out;
  out.push_back(numbers("+", 2, [](Values a, StepValue& o) { set(o, number(*a[0]) + number(*a[1])); }));
  out.push_back({"+", {kVector, kVector}, false, kVector, [](Values a, StepValue& o) {
                   set(o, vector(*a[0]) + vector(*a[1]));
                 }});
  out.push_back(numbers("-", 2, [](Values a, StepValue& o) { set(o, number(*a[0]) - number(*a[1])); }));
  out.push_back({"-", {kVector, kVector}, false, kVector, [](Values a, StepValue& o) {
                   set(o, vector(*a[0]) - vector(*a[1]));
                 }});
  out.push_back(numbers("*", 2, [](Values a, StepValue& o) { set(o, number(*a[0]) * number(*a[1])); }));
  out.push_back({"*", {kNumber, kVector}, false, kVector, [](Values a, StepValue& o) {
                   set(o, number(*a[0]) * vector(*a[1]));
                 }});
  out.push_back({"*", {kVector, kNumber}, false, kVector, [](Values a, StepValue& o) {
                   set(o, vector(*a[0]) * number(*a[1]));
                 }});
  out.push_back(numbers("/", 2, [](Values a, StepValue& o) { set(o, number(*a[0]) / number(*a[1])); }));
  out.push_back({"/", {kVector, kNumber}, false, kVector, [](Values a, StepValue& o) {
                   set(o, vector(*a[0]) / number(*a[1]));
                 }});
  out.push_back(numbers("neg", 1, [](Values a, StepValue& o) { set(o, -number(*a[0])); }));
  out.push_back({"neg", {kVector}, false, kVector, [](Values a, StepValue& o) { set(o, -vector(*a[0])); }});
  return out;
}

void of_numbers(std::vector<FunctionForm>& out) {
  out.push_back(numbers("sin", 1, [](Values a, StepValue& o) { set(o, std::sin(number(*a[0]))); }));
  out.push_back(numbers("cos", 1, [](Values a, StepValue& o) { set(o, std::cos(number(*a[0]))); }));
  out.push_back(numbers("sqrt", 1, [](Values a, StepValue& o) { set(o, std::sqrt(number(*a[0]))); }));
  out.push_back(numbers("abs", 1, [](Values a, StepValue& o) { set(o, std::abs(number(*a[0]))); }));
  out.push_back(
      numbers("atan2", 2, [](Values a, StepValue& o) { set(o, std::atan2(number(*a[0]), number(*a[1]))); }));
  out.push_back({"mean", {kNumber}, true, kNumber, [](Values a, StepValue& o) { mean_of(a, o, 1); }});
}

void of_vectors(std::vector<FunctionForm>& out) {
  out.push_back({"mean", {kVector}, true, kVector, [](Values a, StepValue& o) { mean_of(a, o, 3); }});
  out.push_back({"vector", {kNumber, kNumber, kNumber}, false, kVector, [](Values a, StepValue& o) {
                   set(o, Vector3d(number(*a[0]), number(*a[1]), number(*a[2])));
                 }});
  for (int k = 0; k < 3; ++k)
    out.push_back({std::string_view("xyz").substr(static_cast<std::size_t>(k), 1),
                   {kVector},
                   false,
                   kNumber,
                   [k](Values a, StepValue& o) { set(o, vector(*a[0])[k]); }});
  out.push_back(
      {"length", {kVector}, false, kNumber, [](Values a, StepValue& o) { set(o, vector(*a[0]).norm()); }});
  out.push_back({"unit", {kVector}, false, kVector, [](Values a, StepValue& o) {
                   set(o, vector(*a[0]) / vector(*a[0]).norm());
                 }});
  out.push_back({"distance", {kVector, kVector}, false, kNumber, [](Values a, StepValue& o) {
                   set(o, (vector(*a[0]) - vector(*a[1])).norm());
                 }});
  out.push_back({"dot", {kVector, kVector}, false, kNumber, [](Values a, StepValue& o) {
                   set(o, vector(*a[0]).dot(vector(*a[1])));
                 }});
  out.push_back({"cross", {kVector, kVector}, false, kVector, [](Values a, StepValue& o) {
                   set(o, vector(*a[0]).cross(vector(*a[1])));
                 }});
  out.push_back({"angle", {kVector, kVector}, false, kNumber, [](Values a, StepValue& o) {
                   const Vector3d u = vector(*a[0]), v = vector(*a[1]);
                   set(o, std::atan2(u.cross(v).norm(), u.dot(v)));
                 }});
  out.push_back({"turn_about", {kVector, kVector, kVector}, false, kNumber, [](Values a, StepValue& o) {
                   set(o, turn_about(vector(*a[0]), vector(*a[1]), vector(*a[2])));
                 }});
  out.push_back({"corner", {kVector, kVector, kVector, kVector}, false, kVector, [](Values a, StepValue& o) {
                   set(o, corner(vector(*a[0]), vector(*a[1]), vector(*a[2]), vector(*a[3])));
                 }});
  out.push_back({"chord", {kVector, kVector, kVector, kNumber}, false, kVector, [](Values a, StepValue& o) {
                   set(o, chord(vector(*a[0]), vector(*a[1]), vector(*a[2]), number(*a[3])));
                 }});
  out.push_back(
      {"chord", {kVector, kVector, kVector, kNumber, kNumber}, false, kVector, [](Values a, StepValue& o) {
         set(o, chord(vector(*a[0]), vector(*a[1]), vector(*a[2]), number(*a[3]), number(*a[4])));
       }});
}

void of_frames(std::vector<FunctionForm>& out) {
  out.push_back({"at", {kFrame, kNumber, kNumber, kNumber}, false, kVector, [](Values a, StepValue& o) {
                   const Vector3d x(number(*a[1]), number(*a[2]), number(*a[3]));
                   set(o, axes(*a[0]) * x + origin(*a[0]));
                 }});
  out.push_back({"in", {kFrame, kVector}, false, kVector, [](Values a, StepValue& o) {
                   set(o, axes(*a[0]).transpose() * (vector(*a[1]) - origin(*a[0])));
                 }});
  for (const auto& [name, sequence] : {std::pair<std::string_view, AngleSequence>{"cardan_xyz", {0, 1, 2}},
                                       {"cardan_xzy", {0, 2, 1}},
                                       {"cardan_yxz", {1, 0, 2}},
                                       {"cardan_yzx", {1, 2, 0}},
                                       {"cardan_zxy", {2, 0, 1}},
                                       {"cardan_zyx", {2, 1, 0}}})
    out.push_back({name, {kFrame, kFrame}, false, kVector, [sequence](Values a, StepValue& o) {
                     const Vector3d angles = sequence_angles(axes(*a[0]).transpose() * axes(*a[1]), sequence);
                     for (std::size_t k = 0; k < 3; ++k)
                       o[static_cast<std::size_t>(sequence[k])] = angles[static_cast<Eigen::Index>(k)];
                   }});
}

}  // namespace

const std::vector<FunctionForm>& function_forms() {
  static const std::vector<FunctionForm> forms = [] {
    auto out = operators();
    of_numbers(out);
    of_vectors(out);
    of_frames(out);
    return out;
  }();
  return forms;
}

StepFunction frame_function(int first, int second) {
  return [first, second](Values a, StepValue& out) {
    const Vector3d u = vector(*a[1]).normalized();
    const Vector3d along = vector(*a[2]);
    const Vector3d across = along - along.dot(u) * u;
    Matrix3d r;
    r.col(first) = u;
    r.col(second) = across.norm() > 1e-12 * along.norm() ? Vector3d(across.normalized())
                                                         : Vector3d(Vector3d::Constant(kNaN));
    const int third = 3 - first - second;
    const Vector3d normal = u.cross(r.col(second));
    r.col(third) = (second - first + 3) % 3 == 1 ? normal : Vector3d(-normal);
    set_frame(out, r, vector(*a[0]));
  };
}

StepFunction turn_function(int axis) {
  return [axis](Values a, StepValue& out) {
    set_frame(out, axes(*a[0]) * math::axis_angle(Vector3d::Unit(axis), number(*a[1])), origin(*a[0]));
  };
}

StepFunction part_function(int part) {
  return [part](Values a, StepValue& out) {
    set(out, part == 3 ? Vector3d(origin(*a[0])) : Vector3d(axes(*a[0]).col(part)));
  };
}

StepFunction angle_function(const SegmentDefinition::Angle& angle) {
  return [helical = angle.helical, negative = angle.second_negative, sequence = angle.sequence,
          components = angle.components](Values a, StepValue& out) {
    const Matrix3d parent_from_child = axes(*a[0]).transpose() * axes(*a[1]);
    Vector3d angles = Vector3d::Constant(kNaN);
    if (!helical)
      angles = sequence_angles(parent_from_child, sequence);
    else if (parent_from_child.allFinite())
      angles = math::log_so3(parent_from_child);
    if (negative)
      angles = Vector3d(std::remainder(angles[0] + std::numbers::pi, 2.0 * std::numbers::pi), -angles[1],
                        std::remainder(angles[2] + std::numbers::pi, 2.0 * std::numbers::pi));
    for (std::size_t k = 0; k < 3; ++k) {
      out[k] = components[k].sign * angles[components[k].index] + components[k].offset_rad;
      if (components[k].offset_rad != 0.0) out[k] = std::remainder(out[k], 2.0 * std::numbers::pi);
    }
  };
}

}  // namespace kinemark::analysis::internal
