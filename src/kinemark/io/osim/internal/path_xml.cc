// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/internal/path_xml.h"

#include <fmt/core.h>

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
  std::vector<data::MusclePath> paths;
  for (const pugi::xml_node node : descendants(model, "GeometryPath")) {
    const pugi::xml_node owner = owner_of_path(node);
    data::MusclePath path{.name = name_of(owner), .kind = owner.name()};
    for (const pugi::xml_node point : objects_of(node, "PathPointSet"))
      path.points.push_back(read_point(file, frames, point, description));
    for (const pugi::xml_node wrap : objects_of(node, "PathWrapSet"))
      path.wraps.push_back(text_of(wrap, "wrap_object"));
    paths.push_back(std::move(path));
  }
  return paths;
}

}  // namespace kinemark::io::osim
