// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/internal/model_difference.h"

#include <fmt/core.h>

#include <cmath>
#include <map>
#include <string_view>

#include "kinemark/io/osim/internal/part_writer.h"

namespace kinemark::io::osim {
namespace {

using data::ModelDescription;

constexpr double kRounding = 1e-9;

bool same(double a, double b) { return std::abs(a - b) <= kRounding * std::max(1.0, std::abs(a)); }

template <typename Matrix>
bool same_numbers(const Matrix& a, const Matrix& b) {
  for (Eigen::Index i = 0; i < a.size(); ++i)
    if (!same(a.data()[i], b.data()[i])) return false;
  return true;
}

bool same_frame(const math::SE3& a, const math::SE3& b) {
  return same_numbers(a.rotation, b.rotation) && same_numbers(a.translation, b.translation);
}

bool values_agree(const math::ScalarFunction& a, const math::ScalarFunction& b) {
  for (const double x : {-2.1, -0.7, 0.0, 0.3, 1.4})
    if (!same(a(x).f, b(x).f)) return false;
  return true;
}

/// Two descriptions side by side; names are resolved in each.
struct Comparison {
  const ModelDescription& wanted;
  const ModelDescription& found;

  [[nodiscard]] bool same_body(int a, int b) const { return name(wanted, a) == name(found, b); }
  [[nodiscard]] bool same_coordinate(int a, int b) const {
    if (a < 0 || b < 0) return a < 0 && b < 0;
    return wanted.coordinates[static_cast<std::size_t>(a)].name ==
           found.coordinates[static_cast<std::size_t>(b)].name;
  }
  static std::string_view name(const ModelDescription& model, int body) {
    return body < 0 ? std::string_view("ground") : model.bodies[static_cast<std::size_t>(body)].name;
  }

  [[nodiscard]] bool operator()(const data::BodyDescription& a, const data::BodyDescription& b) const {
    return same(a.mass, b.mass) && same_numbers(a.com_in_body, b.com_in_body) &&
           same_numbers(a.inertia_about_com, b.inertia_about_com);
  }
  [[nodiscard]] bool operator()(const data::CoordinateDescription& a,
                                const data::CoordinateDescription& b) const {
    return a.is_rotation == b.is_rotation && same(a.default_value, b.default_value) &&
           a.clamped == b.clamped && a.locked == b.locked &&
           a.prescribed.has_value() == b.prescribed.has_value() &&
           (!a.prescribed || values_agree(*a.prescribed, *b.prescribed));
  }
  [[nodiscard]] bool operator()(const data::AxisDescription& a, const data::AxisDescription& b) const {
    return a.is_rotation == b.is_rotation && same_numbers(a.axis, b.axis) &&
           same_coordinate(a.coordinate_idx, b.coordinate_idx) && values_agree(a.function, b.function) &&
           same_coordinate(a.second_coordinate_idx, b.second_coordinate_idx) &&
           values_agree(a.second_function, b.second_function);
  }
  [[nodiscard]] bool operator()(const data::JointDescription& a, const data::JointDescription& b) const {
    return same_body(a.parent_body_idx, b.parent_body_idx) && same_body(a.child_body_idx, b.child_body_idx) &&
           same_frame(a.parent_from_joint, b.parent_from_joint) &&
           same_frame(a.child_from_joint, b.child_from_joint) && std::ranges::equal(a.axes, b.axes, *this);
  }
  [[nodiscard]] bool operator()(const data::CouplingDescription& a,
                                const data::CouplingDescription& b) const {
    return same_coordinate(a.dependent_idx, b.dependent_idx) &&
           same_coordinate(a.independent_idx, b.independent_idx) && values_agree(a.function, b.function);
  }
  [[nodiscard]] bool operator()(const data::PointConstraintDescription& a,
                                const data::PointConstraintDescription& b) const {
    return same_body(a.body_a_idx, b.body_a_idx) && same_body(a.body_b_idx, b.body_b_idx) &&
           same_numbers(a.point_in_a, b.point_in_a) && same_numbers(a.point_in_b, b.point_in_b);
  }
  [[nodiscard]] bool operator()(const data::MarkerDescription& a, const data::MarkerDescription& b) const {
    return same_body(a.body_idx, b.body_idx) && same_numbers(a.x_in_body, b.x_in_body);
  }

  /// Items by name: the first that is missing, new or different.
  template <typename Item>
  [[nodiscard]] std::string first(const char* what, const std::vector<Item>& a,
                                  const std::vector<Item>& b) const {
    std::map<std::string_view, const Item*> others;
    for (const auto& item : b) others.emplace(item.name, &item);
    for (const auto& item : a) {
      const auto other = others.find(item.name);
      if (other == others.end() || !(*this)(item, *other->second))
        return fmt::format("{} '{}'", what, item.name);
    }
    return a.size() == b.size() ? std::string() : fmt::format("the number of {}s", what);
  }
};

}  // namespace

std::string difference_of(const ModelDescription& wanted_raw, const ModelDescription& found_raw) {
  const ModelDescription wanted = with_legal_names(wanted_raw), found = with_legal_names(found_raw);
  const Comparison compare{wanted, found};
  if (!same_numbers(wanted.gravity, found.gravity)) return "gravity";
  for (const std::string& difference :
       {compare.first("body", wanted.bodies, found.bodies),
        compare.first("coordinate", wanted.coordinates, found.coordinates),
        compare.first("joint", wanted.joints, found.joints),
        compare.first("coupling", wanted.couplings, found.couplings),
        compare.first("point constraint", wanted.point_constraints, found.point_constraints),
        compare.first("marker", wanted.markers, found.markers)})
    if (!difference.empty()) return difference;
  return "";
}

}  // namespace kinemark::io::osim
