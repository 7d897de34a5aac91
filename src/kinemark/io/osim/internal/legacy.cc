// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/internal/legacy.h"

#include <fmt/core.h>

#include <string>
#include <string_view>
#include <vector>

#include "kinemark/io/osim/internal/format_xml.h"
#include "kinemark/io/osim/internal/xml_file.h"

namespace kinemark::io::osim {
namespace {

std::vector<pugi::xml_node> elements_of(pugi::xml_node node) {
  std::vector<pugi::xml_node> elements;
  for (const pugi::xml_node child : node.children())
    if (child.type() == pugi::node_element) elements.push_back(child);
  return elements;
}

/// SimbodyBody -> Body, SimbodyCoordinate -> Coordinate, SimbodyJoint -> CustomJoint.
void rename_objects(pugi::xml_node model, const char* set, const char* tag) {
  for (pugi::xml_node object : objects_of(model, set))
    if (std::string_view(object.name()).starts_with("Simbody")) object.set_name(tag);
}

/// SimbodyTranslationDof "tx" has no axis of its own; a dof without motion_type has is_rotation.
bool is_rotation(pugi::xml_node dof) {
  if (std::string_view(dof.name()).find("Rotation") != std::string_view::npos) return true;
  return text_of(dof, "is_rotation") == "true";
}

void convert_dofs(pugi::xml_node joint) {
  const char* set = joint.child("DofSet") ? "DofSet" : "TransformAxisSet";
  if (!joint.child(set) || joint.child("SpatialTransform")) return;
  pugi::xml_node transform = joint.append_child("SpatialTransform");
  int rotations = 0, translations = 0;
  for (const pugi::xml_node dof : objects_of(joint, set)) {
    const bool rotation = is_rotation(dof);
    const std::string name =
        rotation ? fmt::format("rotation{}", ++rotations) : fmt::format("translation{}", ++translations);
    pugi::xml_node axis = append_named(transform, "TransformAxis", name);
    std::string coordinate = text_of(dof, "coordinate");
    if (coordinate.empty()) coordinate = text_of(dof, "coordinates");
    append_text(axis, "coordinates", coordinate == "Unassigned" ? "" : coordinate);
    std::string direction = text_of(dof, "axis");
    const std::string which = name_of(dof);
    if (direction.empty() && !which.empty())
      direction = which.back() == 'z' ? "0 0 1" : which.back() == 'y' ? "0 1 0" : "1 0 0";
    append_text(axis, "axis", direction);
    const char* function = dof.child("Value") ? "Value" : dof.child("value") ? "value" : "function";
    pugi::xml_node holder = axis.append_child("function");
    for (const pugi::xml_node f : elements_of(dof.child(function))) holder.append_copy(f);
  }
}

void convert_joint(pugi::xml_node joint) {
  if (const auto bodies = words_of(text_of(joint, "bodies")); bodies.size() == 2) {
    append_text(joint, "parent_body", bodies[0]);
    append_text(joint, "child_body", bodies[1]);
  }
  convert_dofs(joint);
}

}  // namespace

void modernise(pugi::xml_node model) {
  if (const pugi::xml_node engine = first_element(model.child("DynamicsEngine"))) {
    for (const pugi::xml_node element : elements_of(engine)) model.append_copy(element);
    model.remove_child("DynamicsEngine");
  }
  rename_objects(model, "BodySet", "Body");
  rename_objects(model, "CoordinateSet", "Coordinate");
  rename_objects(model, "JointSet", "CustomJoint");
  for (const pugi::xml_node joint : objects_of(model, "JointSet")) convert_joint(joint);
  for (const pugi::xml_node body : objects_of(model, "BodySet"))
    if (const pugi::xml_node joint = first_element(body.child("Joint"))) convert_joint(joint);
}

}  // namespace kinemark::io::osim
