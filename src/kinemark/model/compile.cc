// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "kinemark/model/model.h"
#include "kinemark/model/state.h"

namespace kinemark::model {

using data::AxisDescription;
using data::JointDescription;

namespace {

bool is_unit_slope(const AxisDescription& axis) {
  return axis.coordinate_idx >= 0 && axis.second_coordinate_idx < 0 && axis.function.is_linear() &&
         std::abs(axis.function.slope()) == 1.0 && axis.function.offset() == 0.0;
}

bool is_still(const AxisDescription& axis) {
  return axis.coordinate_idx < 0 && axis.function.is_constant() && axis.function(0.0).f == 0.0;
}

int principal_axis(const Vector3d& axis) {
  for (int i = 0; i < 3; ++i)
    if (std::abs(axis[i]) == 1.0) return i;
  return -1;
}

bool orthonormal(const Matrix3d& axes) {
  return (axes.transpose() * axes - Matrix3d::Identity()).norm() < 1e-9;
}

}  // namespace

/// Builds a Model step by step; the order of the steps matters and is that of compile().
class Compiler {
 public:
  Compiler(data::ModelDescription description, const CompileOptions& options) : options_(options) {
    model_.description_ = std::move(description);
  }

  Result<Model> compile() {
    if (auto status = model_.description_.validate(); !status) return std::unexpected(status.error());
    order_bodies();
    couple_coordinates();
    if (options_.free_roots) find_free_joints();
    number_speeds();
    for (std::size_t b = 0; b < model_.bodies_.size(); ++b) add_primitives(static_cast<int>(b));
    place_markers_and_constraints();
    return std::move(model_);
  }

 private:
  const data::ModelDescription& description() const { return model_.description_; }

  void order_bodies() {
    const auto n = description().bodies.size();
    std::vector<const JointDescription*> joint_of(n, nullptr);
    for (const auto& joint : description().joints)
      joint_of[static_cast<std::size_t>(joint.child_body_idx)] = &joint;
    model_.body_of_.assign(n, -2);
    while (model_.bodies_.size() < n) {
      for (std::size_t i = 0; i < n; ++i) {
        const JointDescription& joint = *joint_of[i];
        if (model_.body_of_[i] != -2) continue;
        const int parent = joint.parent_body_idx;
        if (parent != data::kGround && model_.body_of_[static_cast<std::size_t>(parent)] == -2) continue;
        Model::Body body;
        const auto& described = description().bodies[i];
        body.description_idx = static_cast<int>(i);
        body.parent =
            parent == data::kGround ? data::kGround : model_.body_of_[static_cast<std::size_t>(parent)];
        body.parent_from_joint = joint.parent_from_joint;
        body.body_from_joint = joint.child_from_joint;
        body.plain_parent_rotation = body.parent_from_joint.rotation.isIdentity(0.0);
        body.plain_child_rotation = body.body_from_joint.rotation.isIdentity(0.0);
        body.mass = described.mass;
        body.com_in_body = described.com_in_body;
        body.inertia_about_com = described.inertia_about_com;
        model_.body_of_[i] = static_cast<int>(model_.bodies_.size());
        model_.bodies_.push_back(body);
        joints_.push_back(&joint);
      }
    }
  }

  void couple_coordinates() {
    model_.coordinates_.resize(description().coordinates.size());
    for (const auto& coupling : description().couplings) {
      auto& c = model_.coordinates_[static_cast<std::size_t>(coupling.dependent_idx)];
      c.source = coupling.independent_idx;
      c.coupling = coupling.function;
    }
    std::vector<bool> done(model_.coordinates_.size(), false);
    while (model_.coordinate_order_.size() < model_.coordinates_.size())
      for (std::size_t c = 0; c < done.size(); ++c) {
        const int source = model_.coordinates_[c].source;
        if (done[c] || (source >= 0 && !done[static_cast<std::size_t>(source)])) continue;
        done[c] = true;
        model_.coordinate_order_.push_back(static_cast<int>(c));
      }
  }

  // A joint to the ground becomes free when three orthogonal rotations and three orthogonal translations
  // follow six coordinates one to one, and nothing else uses or fixes these coordinates.
  void find_free_joints() {
    std::vector<int> uses(description().coordinates.size(), 0);
    for (const auto& joint : description().joints)
      for (const auto& axis : joint.axes)
        for (const int c : {axis.coordinate_idx, axis.second_coordinate_idx})
          if (c >= 0) ++uses[static_cast<std::size_t>(c)];
    for (const auto& coupling : description().couplings)
      for (const int c : {coupling.dependent_idx, coupling.independent_idx})
        uses[static_cast<std::size_t>(c)] += 2;

    for (std::size_t b = 0; b < joints_.size(); ++b) {
      if (model_.bodies_[b].parent != data::kGround) continue;
      Model::FreeJoint free;
      int rotations = 0, translations = 0;
      bool fits = true;
      for (const auto& axis : joints_[b]->axes) {
        if (is_still(axis)) continue;
        int& count = axis.is_rotation ? rotations : translations;
        fits = fits && is_unit_slope(axis) && count < 3 &&
               uses[static_cast<std::size_t>(axis.coordinate_idx)] == 1 &&
               !description().coordinates[static_cast<std::size_t>(axis.coordinate_idx)].held();
        if (!fits) break;
        auto& axes = axis.is_rotation ? free.rotation_axes : free.translation_axes;
        axes.col(count) = axis.axis.normalized() * axis.function.slope();
        (axis.is_rotation ? free.rotation_coordinate : free.translation_coordinate)[count] =
            axis.coordinate_idx;
        ++count;
      }
      if (!fits || rotations != 3 || translations != 3) continue;
      if (!orthonormal(free.rotation_axes) || !orthonormal(free.translation_axes)) continue;
      free.body = static_cast<int>(b);
      const int index = static_cast<int>(model_.free_joints_.size());
      model_.bodies_[b].free_joint = index;
      for (int i = 0; i < 3; ++i) {
        auto& rotation = model_.coordinates_[static_cast<std::size_t>(free.rotation_coordinate[i])];
        rotation.free_joint = index;
        rotation.free_axis = i;
        auto& slide = model_.coordinates_[static_cast<std::size_t>(free.translation_coordinate[i])];
        slide.free_joint = index;
        slide.free_axis = 3 + i;
      }
      model_.free_joints_.push_back(free);
    }
  }

  void number_speeds() {
    std::set<int> driving;
    for (const auto& joint : description().joints)
      for (const auto& axis : joint.axes)
        for (int c : {axis.coordinate_idx, axis.second_coordinate_idx})
          for (; c >= 0; c = model_.coordinates_[static_cast<std::size_t>(c)].source) driving.insert(c);
    std::vector<bool> numbered(model_.free_joints_.size(), false);
    for (std::size_t c = 0; c < model_.coordinates_.size(); ++c) {
      auto& coordinate = model_.coordinates_[c];
      if (coordinate.free_joint >= 0) {
        const auto j = static_cast<std::size_t>(coordinate.free_joint);
        if (numbered[j]) continue;
        numbered[j] = true;
        model_.free_joints_[j].state_idx = model_.state_count_;
        model_.free_joints_[j].speed_idx = model_.speed_count_;
        model_.state_count_ += 7;
        model_.speed_count_ += 6;
      } else if (coordinate.source < 0 && driving.contains(static_cast<int>(c))) {
        coordinate.state_idx = model_.state_count_++;
        coordinate.speed_idx = model_.speed_count_++;
      }
    }
  }

  /// Speed of the independent coordinate behind a coordinate, or -1.
  int speed_behind(int coordinate) const {
    while (coordinate >= 0 && model_.coordinates_[static_cast<std::size_t>(coordinate)].source >= 0)
      coordinate = model_.coordinates_[static_cast<std::size_t>(coordinate)].source;
    return coordinate < 0 ? -1 : model_.coordinates_[static_cast<std::size_t>(coordinate)].speed_idx;
  }

  int column_for(Model::Body& body, int b, int speed) {
    if (speed < 0) return -1;
    for (int c = body.first_column; c < static_cast<int>(model_.columns_.size()); ++c)
      if (model_.columns_[static_cast<std::size_t>(c)].speed == speed) return c;
    model_.columns_.push_back({.body = b, .speed = speed});
    return static_cast<int>(model_.columns_.size()) - 1;
  }

  void add_primitives(int b) {
    auto& body = model_.bodies_[static_cast<std::size_t>(b)];
    body.first_primitive = static_cast<int>(model_.primitives_.size());
    body.first_column = static_cast<int>(model_.columns_.size());
    if (body.free_joint >= 0) {
      const int speed = model_.free_joints_[static_cast<std::size_t>(body.free_joint)].speed_idx;
      for (int i = 0; i < 6; ++i) model_.columns_.push_back({.body = b, .speed = speed + i});
    } else {
      for (const bool rotation : {false, true})
        for (const auto& axis : joints_[static_cast<std::size_t>(b)]->axes) {
          if (axis.is_rotation != rotation || is_still(axis)) continue;
          Model::Primitive primitive;
          primitive.is_rotation = rotation;
          primitive.axis = axis.axis.normalized();
          primitive.principal = principal_axis(primitive.axis);
          primitive.coordinate = axis.coordinate_idx;
          primitive.function = axis.function;
          primitive.second_coordinate = axis.second_coordinate_idx;
          primitive.second_function = axis.second_function;
          primitive.is_identity =
              axis.coordinate_idx >= 0 && axis.second_coordinate_idx < 0 && axis.function.is_identity();
          primitive.column = column_for(body, b, speed_behind(axis.coordinate_idx));
          primitive.second_column = column_for(body, b, speed_behind(axis.second_coordinate_idx));
          model_.primitives_.push_back(std::move(primitive));
        }
    }
    body.last_primitive = static_cast<int>(model_.primitives_.size());
    body.last_column = static_cast<int>(model_.columns_.size());
    if (body.parent >= 0) body.support = model_.bodies_[static_cast<std::size_t>(body.parent)].support;
    for (int c = body.first_column; c < body.last_column; ++c) body.support.push_back(c);
  }

  void place_markers_and_constraints() {
    for (const auto& marker : description().markers)
      model_.markers_.push_back({.body = model_.body_of(marker.body_idx), .x_in_body = marker.x_in_body});
    for (const auto& constraint : description().point_constraints)
      model_.point_constraints_.push_back({.body_a = model_.body_of(constraint.body_a_idx),
                                           .body_b = model_.body_of(constraint.body_b_idx),
                                           .point_in_a = constraint.point_in_a,
                                           .point_in_b = constraint.point_in_b});
  }

  CompileOptions options_;
  Model model_;
  std::vector<const JointDescription*> joints_;  // in the order of model_.bodies_
};

Result<Model> Model::compile(data::ModelDescription description, const CompileOptions& options) {
  return Compiler(std::move(description), options).compile();
}

int Model::body_of(int description_idx) const {
  return description_idx == data::kGround ? data::kGround
                                          : body_of_[static_cast<std::size_t>(description_idx)];
}

VectorXd Model::default_state() const {
  VectorXd q(coordinate_count());
  for (int c = 0; c < coordinate_count(); ++c)
    q[c] = description_.coordinates[static_cast<std::size_t>(c)].default_value;
  return state_from_coordinates(*this, q);
}

}  // namespace kinemark::model
