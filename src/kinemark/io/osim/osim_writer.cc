// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/osim_writer.h"

#include <fmt/core.h>

#include <pugixml.hpp>
#include <set>
#include <sstream>
#include <vector>

#include "kinemark/io/file.h"
#include "kinemark/io/osim/internal/format_xml.h"
#include "kinemark/io/osim/internal/function_xml.h"
#include "kinemark/io/osim/internal/joint_writer.h"
#include "kinemark/io/osim/internal/part_writer.h"
#include "kinemark/io/set_mark.h"

namespace kinemark::io {
namespace {

using data::ModelDescription;

pugi::xml_node append_set(pugi::xml_node model, const char* tag, const char* name) {
  return osim::append_named(model, tag, name).append_child("objects");
}

Status write_coupling(pugi::xml_node objects, const ModelDescription& description,
                      const data::CouplingDescription& coupling) {
  const auto name_of = [&](int idx) { return description.coordinates[static_cast<std::size_t>(idx)].name; };
  if (coupling.function.kind() == math::ScalarFunction::Kind::natural_spline)
    return fail(
        Code::not_supported,
        fmt::format("coupling '{}' is a natural spline, which OpenSim cannot represent", coupling.name));
  const pugi::xml_node node = osim::append_named(objects, "CoordinateCouplerConstraint", coupling.name);
  osim::append_flag(node, "isEnforced", true);
  osim::write_function(node, "coupled_coordinates_function", coupling.function);
  osim::append_text(node, "independent_coordinate_names", name_of(coupling.independent_idx));
  osim::append_text(node, "dependent_coordinate_name", name_of(coupling.dependent_idx));
  return {};
}

void write_point_constraint(pugi::xml_node objects, const ModelDescription& description,
                            const data::PointConstraintDescription& constraint) {
  const pugi::xml_node node = osim::append_named(objects, "PointConstraint", constraint.name);
  osim::append_flag(node, "isEnforced", true);
  osim::append_text(node, "socket_body_1", osim::body_path(description, constraint.body_a_idx));
  osim::append_text(node, "socket_body_2", osim::body_path(description, constraint.body_b_idx));
  osim::append_vector3(node, "location_body_1", constraint.point_in_a);
  osim::append_vector3(node, "location_body_2", constraint.point_in_b);
}

/// OpenSim's coordinates belong to exactly one joint, and names are parts of paths and of lists.
Status check_coordinates(const ModelDescription& description) {
  std::vector<int> owner(description.coordinates.size(), -1);
  for (std::size_t j = 0; j < description.joints.size(); ++j)
    for (const auto& axis : description.joints[j].axes)
      for (const int idx : {axis.coordinate_idx, axis.second_coordinate_idx}) {
        if (idx < 0) continue;
        int& first = owner[static_cast<std::size_t>(idx)];
        if (first >= 0 && first != static_cast<int>(j))
          return fail(Code::not_supported,
                      fmt::format("coordinate '{}' drives the joints '{}' and '{}'; OpenSim allows one",
                                  description.coordinates[static_cast<std::size_t>(idx)].name,
                                  description.joints[static_cast<std::size_t>(first)].name,
                                  description.joints[j].name));
        first = static_cast<int>(j);
      }
  for (std::size_t i = 0; i < owner.size(); ++i)
    if (owner[i] < 0)
      return fail(Code::not_supported, fmt::format("coordinate '{}' drives no joint; OpenSim needs one",
                                                   description.coordinates[i].name));
  return {};
}

}  // namespace

Result<std::string> format_osim(const ModelDescription& original) {
  const ModelDescription description = osim::with_legal_names(original);
  if (const Status valid = description.validate(); !valid) return std::unexpected(valid.error());
  if (const Status alone = check_coordinates(description); !alone) return std::unexpected(alone.error());
  pugi::xml_document document;
  pugi::xml_node declaration = document.append_child(pugi::node_declaration);
  declaration.append_attribute("version") = "1.0";
  declaration.append_attribute("encoding") = "UTF-8";
  pugi::xml_node root = document.append_child("OpenSimDocument");
  root.append_attribute("Version") = "40000";
  pugi::xml_node model = osim::append_named(root, "Model", description.name);
  osim::append_vector3(model, "gravity", description.gravity);
  osim::append_text(model, "credits", description.credits);
  osim::append_text(model, "length_units", "meters");
  osim::append_text(model, "force_units", "N");

  // Halves of scapulothoracic joints and the bodies between them are written as one joint.
  std::set<int> hidden_bodies, hidden_joints;
  for (const auto& joint : description.joints)
    if (const int sliding = osim::find_sliding_half(description, joint); sliding >= 0) {
      hidden_joints.insert(sliding);
      hidden_bodies.insert(joint.parent_body_idx);
    }
  const pugi::xml_node bodies = append_set(model, "BodySet", "bodyset");
  for (std::size_t b = 0; b < description.bodies.size(); ++b)
    if (!hidden_bodies.contains(static_cast<int>(b))) osim::write_body(bodies, description.bodies[b]);
  const pugi::xml_node joints = append_set(model, "JointSet", "jointset");
  for (std::size_t j = 0; j < description.joints.size(); ++j)
    if (!hidden_joints.contains(static_cast<int>(j)))
      if (const Status s = osim::write_joint(joints, description, description.joints[j]); !s)
        return std::unexpected(s.error());
  const pugi::xml_node constraints = append_set(model, "ConstraintSet", "constraintset");
  for (const auto& coupling : description.couplings)
    if (const Status s = write_coupling(constraints, description, coupling); !s)
      return std::unexpected(s.error());
  for (const auto& constraint : description.point_constraints)
    write_point_constraint(constraints, description, constraint);
  const pugi::xml_node markers = append_set(model, "MarkerSet", "markerset");
  for (const auto& marker : description.markers) osim::write_marker(markers, description, marker);
  std::ostringstream text;
  document.save(text, "\t", pugi::format_default, pugi::encoding_utf8);
  return std::move(text).str();
}

Status write_osim(const std::filesystem::path& path, const ModelDescription& description,
                  const WriteOsimOptions& options) {
  const auto text = format_osim(description);
  if (!text) return fail_at(path.string(), text.error());
  return write_osim_text(path, *text, options);
}

Status write_osim_text(const std::filesystem::path& path, const std::string& text,
                       const WriteOsimOptions& options) {
  if (options.set.empty()) return write_text(path, text, options.force);
  const std::size_t declaration = text.find("?>") + 2;
  return write_text(path,
                    fmt::format("{}\n<!-- {} -->{}", text.substr(0, declaration), set_mark(options.set),
                                text.substr(declaration)),
                    options.force);
}

}  // namespace kinemark::io
