// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/internal/model_editor.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/io/osim/internal/format_xml.h"
#include "kinemark/io/osim/internal/frame_table.h"
#include "kinemark/io/osim/internal/function_edit.h"
#include "kinemark/io/osim/internal/function_xml.h"
#include "kinemark/io/osim/internal/joint_types.h"
#include "kinemark/io/osim/internal/joint_writer.h"
#include "kinemark/io/osim/internal/part_writer.h"
#include "kinemark/io/osim/internal/path_xml.h"
#include "kinemark/math/euler.h"

namespace kinemark::io::osim {
namespace {

using data::AxisDescription;
using data::JointDescription;
using data::ModelDescription;
using Eigen::Vector3d;

constexpr int kSockets = 40000;       // documents from here on name frames by sockets
constexpr double kSamePlace = 1e-14;  // m; below is the rounding of products of frames

using Nodes = std::map<std::string, pugi::xml_node, std::less<>>;

/// Objects of a set by name, and those among the model's components.
Nodes by_name(pugi::xml_node model, const char* set, std::string_view ending) {
  Nodes nodes;
  for (const pugi::xml_node node : objects_of(model, set)) nodes.emplace(name_of(node), node);
  for (const pugi::xml_node node : model.child("components").children())
    if (std::string_view(node.name()).ends_with(ending)) nodes.emplace(name_of(node), node);
  return nodes;
}

template <typename Item>
const Item* find(const std::vector<Item>& items, std::string_view name) {
  const auto found = std::ranges::find(items, name, &Item::name);
  return found == items.end() ? nullptr : &*found;
}

pugi::xml_node child_of(pugi::xml_node node, const char* tag) {
  const pugi::xml_node child = node.child(tag);
  return child ? child : node.append_child(tag);
}

bool same_rotation(const math::SE3& a, const math::SE3& b) {
  return (a.rotation - b.rotation).cwiseAbs().maxCoeff() <= kSamePlace;
}

bool same_place(const math::SE3& a, const math::SE3& b) {
  return (a.translation - b.translation).norm() <= kSamePlace && same_rotation(a, b);
}

class ModelEditor {
 public:
  ModelEditor(XmlFile& file, pugi::xml_node model, const ModelDescription& before,
              const ModelDescription& after)
      : file_(file),
        model_(model),
        before_(before),
        after_(after),
        frames_(file, model, after),
        bodies_(by_name(model, "BodySet", "Body")),
        joints_(by_name(model, "JointSet", "Joint")),
        sockets_(file.version() >= kSockets) {
    for (const auto& [name, body] : bodies_)  // before 4.0 joints stand in their child bodies
      if (const pugi::xml_node joint = first_element(body.child("Joint")))
        joints_.emplace(name_of(joint).empty() ? name + "_joint" : name_of(joint), joint);
  }

  void edit_bodies() {
    for (const auto& body : after_.bodies) {
      const auto* old = find(before_.bodies, body.name);
      const auto node = bodies_.find(body.name);
      if (old == nullptr) {
        if (sockets_) write_body(child_of(child_of(model_, "BodySet"), "objects"), body);
      } else if (node != bodies_.end() && (old->mass != body.mass || old->com_in_body != body.com_in_body ||
                                           old->inertia_about_com != body.inertia_about_com)) {
        set_mass(node->second, body);
      }
    }
  }

  Status edit_joints() {
    for (const auto& joint : after_.joints) {
      const auto* old = find(before_.joints, joint.name);
      if (old == nullptr) {
        if (sockets_)
          if (auto s = write_joint(child_of(child_of(model_, "JointSet"), "objects"), after_, joint); !s)
            return s;
        continue;
      }
      const pugi::xml_node node = node_of(joint);
      if (!node) continue;
      if (joint.type != old->type) {
        if (auto s = replace_motion(node, joint); !s) return s;
      } else {
        scale_translations(node, *old, joint);
        edit_parameters(node, *old, joint);
      }
    }
    for (const auto& joint : after_.joints) edit_frames(joint);
    return {};
  }

  void edit_points() {
    edit_loops();
    edit_markers();
  }

 private:
  void edit_loops() {
    const Nodes nodes = by_name(model_, "ConstraintSet", "Constraint");
    for (const auto& loop : after_.point_constraints) {
      const auto* old = find(before_.point_constraints, loop.name);
      const auto node = nodes.find(loop.name);
      if (old == nullptr || node == nodes.end()) continue;
      const auto edit = [&](const char* socket, const char* place, const Vector3d& was, const Vector3d& is) {
        const auto frame = was == is ? std::nullopt : frames_.socket(node->second, socket);
        if (frame) set_vector3(node->second, place, frame->body_from_frame.inverse() * is);
      };
      edit("body_1", "location_body_1", old->point_in_a, loop.point_in_a);
      edit("body_2", "location_body_2", old->point_in_b, loop.point_in_b);
    }
  }

  void edit_markers() {
    const Nodes nodes = by_name(model_, "MarkerSet", "Marker");
    for (const auto& marker : after_.markers) {
      const auto* old = find(before_.markers, marker.name);
      const auto node = nodes.find(marker.name);
      if (node == nodes.end()) {
        add_marker(marker);
      } else if (old == nullptr || old->body_idx != marker.body_idx) {
        hang(node->second, marker);
      } else if (const auto frame = frame_of_point(frames_, node->second)) {
        // The frame may have moved under a marker that stays.
        const Vector3d place = frame->body_from_frame.inverse() * marker.x_in_body;
        if ((place - file_.vector3(node->second, "location")).norm() > kSamePlace)
          set_vector3(node->second, "location", place);
      }
    }
  }

  /// Element of a joint; both halves of a scapulothoracic joint have the same.
  [[nodiscard]] pugi::xml_node node_of(const JointDescription& joint) const {
    auto found = joints_.find(joint.name);
    if (found == joints_.end() && joint.type == kScapulothoracicSliding)
      found = joints_.find(std::string_view(joint.name).substr(0, joint.name.rfind("_sliding")));
    return found == joints_.end() ? pugi::xml_node() : found->second;
  }

  /// Coordinates and axes of a joint that moves in another way; its frames stay.
  Status replace_motion(pugi::xml_node node, const JointDescription& joint) {
    pugi::xml_document fresh;
    if (auto s = write_joint(fresh, after_, joint); !s) return s;
    const pugi::xml_node source = fresh.first_child();
    node.set_name(source.name());
    for (const char* part : {"coordinates", "SpatialTransform"}) {
      node.remove_child(part);
      if (source.child(part)) node.append_copy(source.child(part));
    }
    return {};
  }

  /// Translations of the file that are not zero, in the order in which they are read.
  [[nodiscard]] std::vector<pugi::xml_node> moving_translations(pugi::xml_node joint) {
    std::array<pugi::xml_node, 3> slots;
    std::size_t position = 0;
    for (const pugi::xml_node axis : joint.child("SpatialTransform").children("TransformAxis")) {
      std::size_t slot = position++;
      for (std::size_t i = 0; i < 3; ++i)
        if (name_of(axis) == fmt::format("rotation{}", i + 1))
          slot = i;
        else if (name_of(axis) == fmt::format("translation{}", i + 1))
          slot = i + 3;
      if (slot >= 3 && slot < 6) slots[slot - 3] = axis;
    }
    std::vector<pugi::xml_node> moving;
    for (const pugi::xml_node axis : slots) {
      const pugi::xml_node function = find_function(axis, "function");
      const bool driven = !words_of(text_of(axis, "coordinates")).empty();
      if (axis && (driven || (function && read_function(file_, function)(0.0).f != 0.0)))
        moving.push_back(axis);
    }
    return moving;
  }

  void scale_translations(pugi::xml_node node, const JointDescription& old, const JointDescription& joint) {
    if (old.axes.size() != joint.axes.size()) return;
    const auto nodes = moving_translations(node);
    std::size_t next = 0;
    for (std::size_t i = 0; i < joint.axes.size(); ++i) {
      if (joint.axes[i].is_rotation) continue;
      if (next >= nodes.size()) return;
      const pugi::xml_node axis = nodes[next++];
      const auto ratio = ratio_of(old.axes[i].function, joint.axes[i].function);
      if (!ratio || *ratio == 1.0) continue;
      if (const pugi::xml_node function = find_function(axis, "function")) {
        multiply_function(file_, function, *ratio);
      } else {  // OpenSim's default, the identity
        write_function(axis, "function", joint.axes[i].function);
      }
    }
  }

  void edit_parameters(pugi::xml_node node, const JointDescription& old, const JointDescription& joint) {
    const auto& p = joint.parameters;
    if (p == old.parameters) return;
    if (joint.type == "EllipsoidJoint") set_numbers(node, "radii_x_y_z", p);
    if (joint.type != kScapulothoracic || p.size() != 6) return;
    set_numbers(node, "thoracic_ellipsoid_radii_x_y_z", {p[0], p[1], p[2]});
    set_numbers(node, "scapula_winging_axis_origin", {p[3], p[4]});
    set_numbers(node, "scapula_winging_axis_direction", {p[5]});
  }

  /// Both sides of a joint; the halves of a scapulothoracic joint are put together first.
  void edit_frames(const JointDescription& half) {
    if (find(before_.joints, half.name) == nullptr || half.type == kScapulothoracicSliding) return;
    const pugi::xml_node node = node_of(half);
    if (!node) return;
    const int sliding = find_sliding_half(after_, half);
    const JointDescription joint =
        sliding < 0 ? half : join(after_.joints[static_cast<std::size_t>(sliding)], half);
    const auto parent = side_of(node, true);
    const bool reversed = parent && parent->body_idx == joint.child_body_idx;
    set_side(node, !reversed, joint.parent_body_idx, joint.parent_from_joint);
    set_side(node, reversed, joint.child_body_idx, joint.child_from_joint);
  }

  [[nodiscard]] std::optional<Attachment> side_of(pugi::xml_node node, bool parent) {
    auto side = frames_.socket(node, parent ? "parent_frame" : "child_frame");
    return side ? side : frames_.socket(node, parent ? "parent_body" : "child_body");
  }

  void set_side(pugi::xml_node node, bool parent, int body_idx, const math::SE3& wanted) {
    if (!sockets_) return set_old_side(node, parent, wanted);
    const auto side = side_of(node, parent);
    if (!side) return;
    if (side->body_idx == body_idx && same_place(side->body_from_frame, wanted)) return;
    const char* socket = parent ? "socket_parent_frame" : "socket_child_frame";
    const std::string last = last_name(text_of(node, socket));
    pugi::xml_node frame =
        child_of(node, "frames").find_child_by_attribute("PhysicalOffsetFrame", "name", last.c_str());
    if (!frame) {
      const std::string name = fmt::format("{}_{}_offset", name_of(node), parent ? "parent" : "child");
      frame = append_named(node.child("frames"), "PhysicalOffsetFrame", name);
      set_text(child_of(node, socket), name);
    }
    set_text(child_of(frame, "socket_parent"), body_path(after_, body_idx));
    set_vector3(frame, "translation", wanted.translation);
    if (!same_rotation(read_transform(file_, frame, "translation", "orientation"), wanted))
      set_vector3(frame, "orientation", math::to_body_xyz(wanted.rotation));
  }

  /// Before 4.0 the joint itself holds its place, on a body or, in files of between, on a frame.
  void set_old_side(pugi::xml_node node, bool parent, const math::SE3& wanted) {
    const bool old_names = !node.child("location_in_child") && !node.child("orientation_in_child");
    const char* place = parent ? "location_in_parent" : old_names ? "location" : "location_in_child";
    const char* rotation = parent      ? "orientation_in_parent"
                           : old_names ? "orientation"
                                       : "orientation_in_child";
    const auto side = side_of(node, parent);
    const math::SE3 in_frame = side ? side->body_from_frame.inverse() * wanted : wanted;
    const math::SE3 there = read_transform(file_, node, place, rotation);
    if ((there.translation - in_frame.translation).norm() > kSamePlace)
      set_vector3(node, place, in_frame.translation);
    if (!same_rotation(there, in_frame)) set_vector3(node, rotation, math::to_body_xyz(in_frame.rotation));
  }

  [[nodiscard]] static std::string last_name(const std::string& path) {
    return path.substr(path.rfind('/') + 1);
  }

  void add_marker(const data::MarkerDescription& marker) {
    const pugi::xml_node objects = child_of(child_of(model_, "MarkerSet"), "objects");
    data::MarkerDescription legal = marker;
    make_legal(legal.name);
    if (sockets_) return write_marker(objects, after_, legal);
    hang(append_named(objects, "Marker", legal.name), marker);
  }

  /// A marker on another body.
  void hang(pugi::xml_node node, const data::MarkerDescription& marker) {
    if (sockets_) {
      set_text(child_of(node, "socket_parent_frame"), body_path(after_, marker.body_idx));
    } else {
      const std::string path = body_path(after_, marker.body_idx);
      set_text(child_of(node, "body"), last_name(path));
    }
    set_vector3(node, "location", marker.x_in_body);
  }

  XmlFile& file_;
  pugi::xml_node model_;
  const ModelDescription& before_;
  const ModelDescription& after_;
  FrameTable frames_;
  Nodes bodies_, joints_;
  bool sockets_;
};

}  // namespace

Status edit_model(XmlFile& file, pugi::xml_node model, const ModelDescription& before,
                  const ModelDescription& after) {
  ModelEditor editor(file, model, before, after);
  editor.edit_bodies();
  if (auto s = editor.edit_joints(); !s) return s;
  ModelEditor(file, model, before, after).edit_points();  // frames of joints have moved
  return {};
}

}  // namespace kinemark::io::osim
