// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/internal/constraint_xml.h"

#include <fmt/core.h>

#include <cmath>
#include <optional>
#include <string>

#include "kinemark/io/osim/internal/function_xml.h"

namespace kinemark::io::osim {
namespace {

int find_coordinate(XmlFile& file, pugi::xml_node node, const std::string& name,
                    const data::ModelDescription& description) {
  const int idx = description.find_coordinate(name);
  if (idx < 0)
    file.note(node, fmt::format("names the coordinate {}, which the model does not have", in_quotes(name)));
  return std::max(idx, 0);
}

void read_coupler(XmlFile& file, pugi::xml_node node, data::ModelDescription& description) {
  const auto independent = words_of(text_of(node, "independent_coordinate_names"));
  if (independent.size() != 1)
    return file.note(node, fmt::format("couples to {} coordinates; one is supported", independent.size()),
                     Code::not_supported);
  const pugi::xml_node function = find_function(node, "coupled_coordinates_function");
  if (!function) return file.note(node, "has no function");
  data::CouplingDescription coupling{
      .name = name_of(node),
      .dependent_idx = find_coordinate(file, node, text_of(node, "dependent_coordinate_name"), description),
      .independent_idx = find_coordinate(file, node, independent.front(), description),
      .function = read_function(file, function)};
  const double scale = file.number(node, "scale_factor", 1.0);
  if (!std::isfinite(scale)) file.note(node.child("scale_factor"), "must be finite");
  if (scale != 1.0) coupling.function = coupling.function.scaled(scale);
  description.couplings.push_back(std::move(coupling));
}

void read_point_constraint(XmlFile& file, FrameTable& frames, pugi::xml_node node,
                           data::ModelDescription& description) {
  const auto a = frames.socket(node, "body_1"), b = frames.socket(node, "body_2");
  if (!a || !b) return file.note(node, "does not name its two bodies");
  description.point_constraints.push_back(
      {.name = name_of(node),
       .body_a_idx = a->body_idx,
       .body_b_idx = b->body_idx,
       .point_in_a = a->body_from_frame * file.vector3(node, "location_body_1"),
       .point_in_b = b->body_from_frame * file.vector3(node, "location_body_2")});
}

constexpr double kLever_m = 0.1;  // of the points that hold a welded frame, from its origin

/// A frame of a weld: a socket, or in files of before 4.0 a body with a place and an orientation.
std::optional<Attachment> welded_frame(XmlFile& file, FrameTable& frames, pugi::xml_node node,
                                       const std::string& number) {
  if (const auto frame = frames.socket(node, "frame" + number)) return frame;
  auto body = frames.socket(node, "body_" + number);
  if (body)
    body->body_from_frame =
        body->body_from_frame * read_transform(file, node, ("location_body_" + number).c_str(),
                                               ("orientation_body_" + number).c_str());
  return body;
}

/// Two frames that are one: three points of the one lie on those of the other.
void read_weld(XmlFile& file, FrameTable& frames, pugi::xml_node node, data::ModelDescription& description) {
  const auto a = welded_frame(file, frames, node, "1"), b = welded_frame(file, frames, node, "2");
  if (!a || !b) return file.note(node, "does not name its two frames");
  const Eigen::Vector3d points[] = {Eigen::Vector3d::Zero(), kLever_m * Eigen::Vector3d::UnitX(),
                                    kLever_m * Eigen::Vector3d::UnitY()};
  constexpr const char* kOf[] = {"origin", "x", "y"};
  for (int k = 0; k < 3; ++k)
    description.point_constraints.push_back({.name = fmt::format("{}_{}", name_of(node), kOf[k]),
                                             .body_a_idx = a->body_idx,
                                             .body_b_idx = b->body_idx,
                                             .point_in_a = a->body_from_frame * points[k],
                                             .point_in_b = b->body_from_frame * points[k]});
}

}  // namespace

void read_constraint(XmlFile& file, FrameTable& frames, pugi::xml_node node,
                     data::ModelDescription& description) {
  if (file.flag(node, "isDisabled", false) || !file.flag(node, "isEnforced", true)) return;
  const std::string_view tag = node.name();
  if (tag == "CoordinateCouplerConstraint") {
    read_coupler(file, node, description);
  } else if (tag == "PointConstraint") {
    read_point_constraint(file, frames, node, description);
  } else if (tag == "WeldConstraint") {
    read_weld(file, frames, node, description);
  } else {
    description.warnings.push_back(fmt::format("{} {} is not enforced", tag, in_quotes(name_of(node))));
  }
}

}  // namespace kinemark::io::osim
