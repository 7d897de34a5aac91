// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/internal/joint_xml.h"

#include <fmt/core.h>

#include <array>
#include <cmath>

#include "kinemark/core/number.h"
#include "kinemark/io/osim/internal/function_xml.h"

namespace kinemark::io::osim {

using data::AxisDescription;
using data::CoordinateDescription;
using data::ModelDescription;
using Eigen::Vector3d;

namespace {

constexpr std::size_t kMaxCoordinates = 6;

CoordinateDescription read_coordinate(XmlFile& file, pugi::xml_node node) {
  CoordinateDescription c{.name = name_of(node),
                          .default_value = file.number(node, "default_value", 0.0),
                          .clamped = file.flag(node, "clamped", false),
                          .locked = file.flag(node, "locked", false)};
  if (c.name.empty()) file.note(node, "has no name");
  if (!node.child("default_value") && node.child("initial_value"))
    c.default_value = file.number(node, "initial_value", 0.0);  // before 2.0
  if (const std::string range = text_of(node, "range"); !range.empty()) {
    const auto words = words_of(range);
    const auto low = words.empty() ? std::nullopt : parse_number(words.front());
    const auto high = words.empty() ? std::nullopt : parse_number(words.back());
    if (words.size() != 2 || !low || !high || *low > *high)
      file.note(node.child("range"),
                fmt::format("{} is not a range; need two numbers, the lower first", in_quotes(range)));
    else
      c.range_min = *low, c.range_max = *high;
  } else if (c.clamped) {
    c.range_min = -10.0, c.range_max = 10.0;  // OpenSim's own default
  }
  // As in OpenSim: a prescribed coordinate without a function is free, and a locked one stays.
  if (const auto function = first_element(node.child("prescribed_function"));
      function && !c.locked && file.flag(node, "prescribed", false))
    c.prescribed = read_function(file, function);
  return c;
}

/// Elements with the coordinates of a joint.
std::vector<pugi::xml_node> coordinate_nodes(pugi::xml_node joint) {
  std::vector<pugi::xml_node> nodes = objects_of(joint, "CoordinateSet");
  for (const pugi::xml_node child : joint.child("coordinates").children())
    if (child.type() == pugi::node_element) nodes.push_back(child);
  return nodes;
}

/// The coordinates of one joint: reads them and creates those that the file only names.
class JointCoordinates {
 public:
  JointCoordinates(XmlFile& file, pugi::xml_node model, pugi::xml_node joint, ModelDescription& description)
      : file_(file), model_(model), joint_(joint), description_(description) {
    const auto nodes = coordinate_nodes(joint);
    if (nodes.size() > kMaxCoordinates) {
      file.note(joint, fmt::format("has {} coordinates; a joint has at most six", nodes.size()));
      return;
    }
    for (const pugi::xml_node node : nodes) add(read_coordinate(file, node), node);
    listed_ = !nodes.empty();
  }

  /// Index of the coordinate `name` of this joint.
  int find_or_make(const std::string& name) {
    for (const int idx : indices_)
      if (at(idx).name == name) return idx;
    // Before 2.0 one set holds the coordinates of all joints, and joints may share them.
    pugi::xml_node node;
    if (const pugi::xml_node set = model_.child("CoordinateSet")) {
      if (const int known = description_.find_coordinate(name); known >= 0) return known;
      node = set.child("objects").find_child_by_attribute("name", name.c_str());
    }
    if (listed_ && !node) {
      file_.note(joint_, fmt::format("moves by the coordinate {}, which it does not list", in_quotes(name)));
      return indices_.front();
    }
    return add(node ? read_coordinate(file_, node) : CoordinateDescription{.name = name}, node);
  }

  /// Exactly n coordinates, the missing ones named after the joint.
  void complete(std::size_t n) {
    const std::string joint = name_of(joint_);
    while (indices_.size() < n) add({.name = fmt::format("{}_coord_{}", joint, indices_.size())}, {});
    if (indices_.size() > n)
      file_.note(joint_, fmt::format("has {} coordinates; a {} has {}", indices_.size(), joint_.name(), n));
  }

  /// The file's word for the kind of motion, or `inferred`.
  void set_kind(int idx, bool inferred) {
    auto& c = description_.coordinates[static_cast<std::size_t>(idx)];
    const std::string word = motion_types_[static_cast<std::size_t>(idx - first_)];
    c.is_rotation = word == "rotational" || (word != "translational" && inferred);
  }

  [[nodiscard]] const std::vector<int>& indices() const { return indices_; }

 private:
  int add(CoordinateDescription coordinate, pugi::xml_node node) {
    if (indices_.empty()) first_ = static_cast<int>(description_.coordinates.size());
    indices_.push_back(static_cast<int>(description_.coordinates.size()));
    motion_types_.push_back(text_of(node, "motion_type"));
    description_.coordinates.push_back(std::move(coordinate));
    return indices_.back();
  }
  const CoordinateDescription& at(int idx) const {
    return description_.coordinates[static_cast<std::size_t>(idx)];
  }

  XmlFile& file_;
  pugi::xml_node model_, joint_;
  ModelDescription& description_;
  bool listed_ =
      false;  // the joint has a list of its own; only files that have none may name coordinates alone
  int first_ = 0;
  std::vector<int> indices_;
  std::vector<std::string> motion_types_;  // motion_type, one per index
};

/// Slot 0 to 2 for rotation1 to 3, 3 to 5 for translation1 to 3; by position where the name is not one of
/// these.
std::size_t slot_of(pugi::xml_node axis, std::size_t position) {
  constexpr std::array<std::string_view, 6> names = {"rotation1",    "rotation2",    "rotation3",
                                                     "translation1", "translation2", "translation3"};
  const std::string name = name_of(axis);
  for (std::size_t i = 0; i < names.size(); ++i)
    if (name == names[i]) return i;
  return position;
}

void read_spatial_transform(XmlFile& file, pugi::xml_node joint, JointCoordinates& coordinates,
                            data::JointDescription& description) {
  std::array<std::optional<AxisDescription>, 6> slots;
  std::size_t position = 0;
  for (const pugi::xml_node node : joint.child("SpatialTransform").children("TransformAxis")) {
    const std::size_t slot = slot_of(node, position++);
    if (slot >= slots.size() || slots[slot])
      return file.note(node, "is one axis too many; need at most three rotations and three translations");
    constexpr std::array<int, 6> kUnit = {0, 1, 2, 0, 1, 2};
    AxisDescription axis{.is_rotation = slot < 3,
                         .axis = file.vector3(node, "axis", Vector3d::Unit(kUnit[slot])),
                         .function = math::ScalarFunction::constant(0.0)};
    const auto names = words_of(text_of(node, "coordinates"));
    if (names.size() > 1)
      return file.note(
          node,
          fmt::format("depends on {} coordinates; functions of several are not supported", names.size()),
          Code::not_supported);
    const pugi::xml_node function = find_function(node, "function");
    if (function) axis.function = read_function(file, function);
    if (!names.empty()) axis.coordinate_idx = coordinates.find_or_make(names.front());
    slots[slot] = axis;
  }
  for (const auto& axis : slots) {
    // An axis that stays at zero is only there because OpenSim wants six.
    const bool moves = axis && (axis->coordinate_idx >= 0 || axis->function(0.0).f != 0.0);
    if (moves) description.axes.push_back(*axis);
  }
  for (const int idx : coordinates.indices()) {
    bool drives = false, rotates = false;
    for (const AxisDescription& axis : description.axes) {
      if (axis.coordinate_idx != idx) continue;
      drives = true;
      rotates = rotates || axis.is_rotation;
    }
    coordinates.set_kind(idx, rotates || !drives);
  }
}

Vector3d read_radii(XmlFile& file, pugi::xml_node node, const char* child) {
  const Vector3d radii = file.vector3(node, child, Vector3d::Constant(-1.0));
  if ((radii.array() <= 0.0).any())
    file.note(node, fmt::format("needs three positive numbers in <{}>", child));
  return radii;
}

void read_scapulothoracic(XmlFile& file, pugi::xml_node node, data::JointDescription& description) {
  const Vector3d radii = read_radii(file, node, "thoracic_ellipsoid_radii_x_y_z");
  auto origin = file.numbers(node, "scapula_winging_axis_origin");
  if (origin.size() != 2 && !origin.empty())
    file.note(node, "needs two numbers in <scapula_winging_axis_origin>");
  origin.resize(2, 0.0);
  const double direction = file.number(node, "scapula_winging_axis_direction", 0.0);
  if (!std::isfinite(direction)) file.note(node, "needs a finite number in <scapula_winging_axis_direction>");
  description.parameters = {radii.x(), radii.y(), radii.z(), origin[0], origin[1], direction};
}

/// Frame of the joint on one side: a socket or, before 4.0, a body and a position on it.
Attachment read_side(XmlFile& file, FrameTable& frames, pugi::xml_node node, bool parent, int owner_body) {
  std::optional<Attachment> side = frames.socket(node, parent ? "parent_frame" : "child_frame");
  if (!side) side = frames.socket(node, parent ? "parent_body" : "child_body");
  if (!side && !parent && owner_body >= 0) side = Attachment{.body_idx = owner_body};
  if (!side) {
    file.note(node, fmt::format("does not name its {} body", parent ? "parent" : "child"));
    side.emplace();
  }
  const bool old_names = !parent && !node.child("location_in_child") && !node.child("orientation_in_child");
  const char* location = parent ? "location_in_parent" : old_names ? "location" : "location_in_child";
  const char* orientation = parent      ? "orientation_in_parent"
                            : old_names ? "orientation"
                                        : "orientation_in_child";
  side->body_from_frame = side->body_from_frame * read_transform(file, node, location, orientation);
  return *side;
}

}  // namespace

FileJoint read_joint(XmlFile& file, FrameTable& frames, pugi::xml_node model, pugi::xml_node node,
                     int owner_body, ModelDescription& description) {
  FileJoint joint{.node = node, .description = {.name = name_of(node), .type = node.name()}};
  data::JointDescription& d = joint.description;
  Attachment parent = read_side(file, frames, node, true, owner_body);
  Attachment child = read_side(file, frames, node, false, owner_body);
  if (d.name.empty() && child.body_idx >= 0)
    d.name = description.bodies[static_cast<std::size_t>(child.body_idx)].name + "_joint";
  if (file.flag(node, "reverse", false)) std::swap(parent, child);  // as OpenSim 4 reads older documents
  d.parent_body_idx = parent.body_idx;
  d.child_body_idx = child.body_idx;
  d.parent_from_joint = parent.body_from_frame;
  d.child_from_joint = child.body_from_frame;

  JointCoordinates coordinates(file, model, node, description);
  if (d.type == "CustomJoint") {
    read_spatial_transform(file, node, coordinates, d);
  } else if (const auto freedoms = freedoms_of(d.type)) {
    coordinates.complete(freedoms->size());
    if (coordinates.indices().size() != freedoms->size()) return joint;
    d.axes = axes_of(*freedoms, coordinates.indices());
    for (std::size_t i = 0; i < freedoms->size(); ++i)
      coordinates.set_kind(coordinates.indices()[i], (*freedoms)[i].is_rotation);
    if (d.type == "EllipsoidJoint") {
      const Vector3d radii = read_radii(file, node, "radii_x_y_z");
      d.parameters = {radii.x(), radii.y(), radii.z()};
      for (auto& axis : ellipsoid_axes(radii, coordinates.indices()[0], coordinates.indices()[1]))
        d.axes.push_back(axis);
    }
  } else if (d.type == kScapulothoracic) {
    coordinates.complete(4);
    for (const int idx : coordinates.indices()) coordinates.set_kind(idx, true);
    read_scapulothoracic(file, node, d);
  } else {
    file.note(node, fmt::format("joints of the type {} are not supported", in_quotes(d.type)),
              Code::not_supported);
  }
  joint.coordinates = coordinates.indices();
  return joint;
}

}  // namespace kinemark::io::osim
