// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/osim_model.h"

#include <fmt/core.h>

#include <cmath>
#include <vector>

#include "kinemark/io/osim/internal/constraint_xml.h"
#include "kinemark/io/osim/internal/frame_table.h"
#include "kinemark/io/osim/internal/joint_xml.h"
#include "kinemark/io/osim/internal/legacy.h"
#include "kinemark/io/osim/internal/xml_file.h"

namespace kinemark::io {
namespace {

using data::ModelDescription;
using osim::XmlFile;

constexpr std::size_t kMaxObjects = 5000;  // of one kind; the largest public model has some hundreds

/// Objects of a set, and those of the same kind that were added to the model itself (4.x <components>).
std::vector<pugi::xml_node> all_objects(XmlFile& file, pugi::xml_node model, const char* set,
                                        std::string_view ending) {
  auto objects = osim::objects_of(model, set);
  for (const pugi::xml_node child : model.child("components").children())
    if (std::string_view(child.name()).ends_with(ending)) objects.push_back(child);
  if (objects.size() > kMaxObjects) {
    file.note(model.child(set),
              fmt::format("<{}> has {} objects; at most {} are read", set, objects.size(), kMaxObjects));
    objects.clear();
  }
  return objects;
}

/// Moments and products about the mass centre: six numbers (xx yy zz xy xz yz), nine (before 2.0), or one
/// element each.
Eigen::Matrix3d read_inertia(XmlFile& file, pugi::xml_node node) {
  auto v = file.numbers(node, "inertia");
  if (v.size() == 9) return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(v.data());
  if (v.empty())
    for (const char* child :
         {"inertia_xx", "inertia_yy", "inertia_zz", "inertia_xy", "inertia_xz", "inertia_yz"})
      v.push_back(file.number(node, child, 0.0));
  if (v.size() != 6) {
    file.note(node.child("inertia"), fmt::format("has {} numbers; need six", v.size()));
    v.resize(6, 0.0);
  }
  Eigen::Matrix3d inertia;
  inertia << v[0], v[3], v[4], v[3], v[1], v[5], v[4], v[5], v[2];
  return inertia;
}

/// Bodies without the ground, each with the element that it came from.
std::vector<pugi::xml_node> read_bodies(XmlFile& file, pugi::xml_node model, ModelDescription& description) {
  std::vector<pugi::xml_node> nodes;
  for (const pugi::xml_node node : all_objects(file, model, "BodySet", "Body")) {
    const std::string name = osim::name_of(node);
    if (name == "ground") continue;
    if (name.empty()) file.note(node, "has no name");
    description.bodies.push_back({.name = name,
                                  .mass = file.number(node, "mass", 0.0),
                                  .com_in_body = file.vector3(node, "mass_center"),
                                  .inertia_about_com = read_inertia(file, node)});
    nodes.push_back(node);
  }
  return nodes;
}

void read_joints(XmlFile& file, osim::FrameTable& frames, pugi::xml_node model,
                 const std::vector<pugi::xml_node>& body_nodes, ModelDescription& description) {
  std::vector<osim::FileJoint> joints;
  for (std::size_t b = 0; b < body_nodes.size(); ++b)  // before 4.0 joints stand in their child bodies
    if (const pugi::xml_node node = osim::first_element(body_nodes[b].child("Joint")))
      joints.push_back(osim::read_joint(file, frames, model, node, static_cast<int>(b), description));
  for (const pugi::xml_node node : all_objects(file, model, "JointSet", "Joint"))
    joints.push_back(osim::read_joint(file, frames, model, node, -2, description));
  if (!file.error()) osim::hang_from_ground(file, std::move(joints), description);
}

void read_markers(XmlFile& file, osim::FrameTable& frames, pugi::xml_node model,
                  ModelDescription& description) {
  for (const pugi::xml_node node : all_objects(file, model, "MarkerSet", "Marker")) {
    if (std::string_view(node.name()) != "Marker") continue;
    std::optional<osim::Attachment> frame;
    for (const char* socket : {"parent_frame", "reference_frame", "body"})
      if (!frame) frame = frames.socket(node, socket);
    if (!frame) return file.note(node, "does not name its body");
    description.markers.push_back({.name = osim::name_of(node),
                                   .body_idx = frame->body_idx,
                                   .x_in_body = frame->body_from_frame * file.vector3(node, "location")});
  }
}

Result<ModelDescription> read_model(XmlFile file, const std::filesystem::path* folder) {
  file.inline_files(folder);
  const pugi::xml_node model = file.find_object({"Model"});
  if (!model && !file.error())
    return fail(Code::bad_input,
                fmt::format("{}: not an OpenSim model: its first element is <{}>; need <OpenSimDocument> "
                            "with a <Model>",
                            file.name(), file.document().name()));
  ModelDescription description{.name = osim::name_of(model), .credits = osim::text_of(model, "credits")};
  if (!file.error()) {
    osim::modernise(model);
    description.gravity = file.vector3(model, "gravity", description.gravity);
    const auto body_nodes = read_bodies(file, model, description);
    osim::FrameTable frames(file, model, description);
    read_joints(file, frames, model, body_nodes, description);
    for (const pugi::xml_node node : all_objects(file, model, "ConstraintSet", "Constraint"))
      osim::read_constraint(file, frames, node, description);
    read_markers(file, frames, model, description);
  }
  if (file.error()) return std::unexpected(*file.error());
  if (const Status valid = description.validate(); !valid) return fail_at(file.name(), valid.error());
  return description;
}

}  // namespace

Result<ModelDescription> read_osim(const std::filesystem::path& path) {
  auto file = XmlFile::read(path);
  if (!file) return std::unexpected(file.error());
  const std::filesystem::path folder = path.parent_path();
  return read_model(std::move(*file), &folder);
}

Result<ModelDescription> parse_osim(std::string_view xml, std::string_view name) {
  auto file = XmlFile::parse(xml, std::string(name));
  if (!file) return std::unexpected(file.error());
  return read_model(std::move(*file), nullptr);
}

}  // namespace kinemark::io
