// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/internal/path_xml.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <utility>

#include "kinemark/io/osim/internal/function_xml.h"

namespace kinemark::io::osim {
namespace {

/// The coordinate that a socket names: "/jointset/knee_r/knee_angle_r", or the name alone before 4.0.
int coordinate_of(pugi::xml_node node, const std::string& socket, const data::ModelDescription& description) {
  std::string path = text_of(node, ("socket_" + socket).c_str());
  if (path.empty()) path = text_of(node, socket.c_str());
  return description.find_coordinate(path.substr(path.rfind('/') + 1));
}

void read_moving(XmlFile& file, pugi::xml_node node, const data::ModelDescription& description,
                 data::PathPoint& point) {
  constexpr std::array<const char*, 3> kCoordinates = {"x_coordinate", "y_coordinate", "z_coordinate"};
  point.moves = true;
  for (std::size_t i = 0; i < kPositions.size(); ++i) {
    const pugi::xml_node function = first_element(node.child(kPositions[i]));
    point.place[i].coordinate_idx = coordinate_of(node, kCoordinates[i], description);
    point.place[i].function = function ? read_function(file, function) : math::ScalarFunction::constant(0.0);
  }
}

void read_condition(XmlFile& file, pugi::xml_node node, const data::ModelDescription& description,
                    data::PathPoint& point) {
  const auto range = file.numbers(node, "range");
  if (range.size() != 2) return file.note(node, "needs two numbers in <range>");
  point.condition_idx = coordinate_of(node, "coordinate", description);
  if (point.condition_idx < 0) return file.note(node, "does not name a coordinate of the model");
  point.range_min = range[0];
  point.range_max = range[1];
}

data::PathPoint read_point(XmlFile& file, FrameTable& frames, pugi::xml_node node,
                           const data::ModelDescription& description) {
  data::PathPoint point{.name = name_of(node), .x_in_frame = file.vector3(node, "location")};
  if (const auto frame = frame_of_point(frames, node)) {
    point.body_idx = frame->body_idx;
    point.body_from_frame = frame->body_from_frame;
  } else {
    file.note(node, "does not name its body");
  }
  if (node.child(kPositions[0])) read_moving(file, node, description, point);
  if (node.child("range")) read_condition(file, node, description, point);
  return point;
}

/// The side that a surface keeps paths on: "x", "-y", "+z", or any other word for all around.
void read_side(std::string side, data::WrapSurface& surface) {
  surface.side_sign = side.starts_with('-') ? -1 : 1;
  if (side.starts_with('-') || side.starts_with('+')) side.erase(0, 1);
  const std::size_t axis = side.size() == 1 ? std::string_view("xyzXYZ").find(side) : std::string_view::npos;
  if (axis != std::string_view::npos) surface.side_axis = static_cast<int>(axis % 3);
}

data::WrapSurface read_surface(XmlFile& file, const Attachment& owner, pugi::xml_node node) {
  data::WrapSurface surface{
      .name = name_of(node),
      .is_cylinder = std::string_view(node.name()) == "WrapCylinder",
      .active = text_of(node, "active") != "false",
      .body_idx = owner.body_idx,
      .body_from_frame = owner.body_from_frame,
      .frame_from_surface = read_transform(file, node, "translation", "xyz_body_rotation")};
  read_side(text_of(node, "quadrant"), surface);
  if (!surface.is_cylinder) return surface;
  surface.radius = file.number(node, "radius", 1.0);
  surface.length = file.number(node, "length", 1.0);
  return surface;
}

/// Surfaces by name; of two with one name the first.
std::map<std::string, data::WrapSurface, std::less<>> read_surfaces(
    XmlFile& file, FrameTable& frames, pugi::xml_node model, const data::ModelDescription& description) {
  std::map<std::string, data::WrapSurface, std::less<>> surfaces;
  for (const pugi::xml_node set : descendants(model, "WrapObjectSet")) {
    Attachment owner;
    if (std::string_view(set.parent().name()) == "Body")
      owner.body_idx = description.find_body(name_of(set.parent()));
    else if (const auto parent = frames.socket(set.parent(), "parent"))
      owner = {parent->body_idx,
               parent->body_from_frame * read_transform(file, set.parent(), "translation", "orientation")};
    for (const pugi::xml_node node : set.child("objects").children())
      if (node.type() == pugi::node_element) surfaces.emplace(name_of(node), read_surface(file, owner, node));
  }
  return surfaces;
}

data::PathWrap read_wrap(XmlFile& file, pugi::xml_node node,
                         const std::map<std::string, data::WrapSurface, std::less<>>& surfaces) {
  data::PathWrap wrap;
  const std::string name = text_of(node, "wrap_object");
  const auto found = surfaces.find(name);
  if (found != surfaces.end()) wrap.surface = found->second;
  wrap.surface.name = name;
  const auto range = file.numbers(node, "range");  // from 1; less: the path's first or last point
  if (range.size() == 2) {
    wrap.first_point = range[0] < 1.0 ? -1 : static_cast<int>(std::min(range[0], 1e6)) - 1;
    wrap.last_point = range[1] < 1.0 ? -1 : static_cast<int>(std::min(range[1], 1e6)) - 1;
  }
  return wrap;
}

}  // namespace

std::vector<pugi::xml_node> descendants(pugi::xml_node node, std::string_view tag) {
  struct Finder : pugi::xml_tree_walker {
    std::string_view tag;
    std::vector<pugi::xml_node> found;
    bool for_each(pugi::xml_node& each) override {
      if (tag == each.name()) found.push_back(each);
      return true;
    }
  } finder;
  finder.tag = tag;
  node.traverse(finder);
  return std::move(finder.found);
}

pugi::xml_node owner_of_path(pugi::xml_node geometry_path) {
  const pugi::xml_node parent = geometry_path.parent();
  return name_of(parent).empty() && parent.parent() ? parent.parent() : parent;
}

std::optional<Attachment> frame_of_point(FrameTable& frames, pugi::xml_node point) {
  for (const char* socket : {"parent_frame", "reference_frame", "body"})
    if (const auto frame = frames.socket(point, socket)) return frame;
  return std::nullopt;
}

std::vector<data::MusclePath> read_paths(XmlFile& file, FrameTable& frames, pugi::xml_node model,
                                         const data::ModelDescription& description) {
  const auto surfaces = read_surfaces(file, frames, model, description);
  std::vector<data::MusclePath> paths;
  for (const pugi::xml_node node : descendants(model, "GeometryPath")) {
    const pugi::xml_node owner = owner_of_path(node);
    data::MusclePath path{.name = name_of(owner), .kind = owner.name()};
    for (const pugi::xml_node point : objects_of(node, "PathPointSet"))
      path.points.push_back(read_point(file, frames, point, description));
    for (const pugi::xml_node wrap : objects_of(node, "PathWrapSet"))
      path.wraps.push_back(read_wrap(file, wrap, surfaces));
    paths.push_back(std::move(path));
  }
  return paths;
}

}  // namespace kinemark::io::osim
