// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/model/testing/mjcf.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

namespace kinemark::model::testing {
namespace {

std::string numbers(const Vector3d& v) { return fmt::format("{:.17g} {:.17g} {:.17g}", v.x(), v.y(), v.z()); }

class Mjcf {
 public:
  explicit Mjcf(const Model& model) : model_(model) {}

  std::string text() const {
    return "<mujoco><compiler angle=\"radian\" balanceinertia=\"false\" boundmass=\"0\" boundinertia=\"0\"/>"
           "<option gravity=\"" +
           numbers(model_.gravity()) + "\"/><worldbody>" + children_of(data::kGround) +
           "</worldbody></mujoco>";
  }

 private:
  std::string children_of(int parent) const {
    std::string out;
    for (int b = 0; b < static_cast<int>(model_.bodies().size()); ++b)
      if (model_.bodies()[static_cast<std::size_t>(b)].parent == parent) out += body_text(b);
    return out;
  }

  std::string body_text(int b) const {
    const auto& body = model_.bodies()[static_cast<std::size_t>(b)];
    const math::SE3 at_zero = body.parent_from_joint * body.body_from_joint.inverse();
    EXPECT_LT((at_zero.rotation - Matrix3d::Identity()).norm(), 1e-12) << "this test writes no turned bodies";
    const Matrix3d& I = body.inertia_about_com;
    std::string out = fmt::format(
        "<body pos=\"{}\"><inertial pos=\"{}\" mass=\"{:.17g}\" fullinertia=\"{} {:.17g} {:.17g} {:.17g}\"/>",
        numbers(at_zero.translation), numbers(body.com_in_body), body.mass, numbers(I.diagonal()), I(0, 1),
        I(0, 2), I(1, 2));
    if (body.free_joint >= 0) out += "<freejoint/>";
    for (int k = body.first_primitive; k < body.last_primitive; ++k) {
      const auto& primitive = model_.primitives()[static_cast<std::size_t>(k)];
      EXPECT_TRUE(primitive.is_rotation && primitive.is_identity);
      out += fmt::format("<joint name=\"c{}\" type=\"hinge\" axis=\"{}\" pos=\"{}\"/>", primitive.coordinate,
                         numbers(body.body_from_joint.rotation * primitive.axis),
                         numbers(body.body_from_joint.translation));
    }
    for (int m = 0; m < model_.marker_count(); ++m) {
      const auto& marker = model_.markers()[static_cast<std::size_t>(m)];
      if (marker.body == b)
        out += fmt::format("<site name=\"m{}\" pos=\"{}\"/>", m, numbers(marker.x_in_body));
    }
    return out + children_of(b) + "</body>";
  }

  const Model& model_;
};

}  // namespace

std::string mjcf(const Model& model) { return Mjcf(model).text(); }

}  // namespace kinemark::model::testing
