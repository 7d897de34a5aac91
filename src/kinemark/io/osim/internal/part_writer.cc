// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/internal/part_writer.h"

#include <array>
#include <string_view>

#include "kinemark/io/osim/internal/format_xml.h"
#include "kinemark/io/osim/internal/joint_writer.h"

namespace kinemark::io::osim {

void set_mass(pugi::xml_node node, const data::BodyDescription& body) {
  constexpr std::array<const char*, 6> kApart = {"inertia_xx", "inertia_yy", "inertia_zz",
                                                 "inertia_xy", "inertia_xz", "inertia_yz"};
  const Eigen::Matrix3d& i = body.inertia_about_com;
  const std::array<double, 6> numbers = {i(0, 0), i(1, 1), i(2, 2), i(0, 1), i(0, 2), i(1, 2)};
  set_numbers(node, "mass", {body.mass});
  set_vector3(node, "mass_center", body.com_in_body);
  if (!node.child("inertia") && node.child(kApart[0])) {  // before 4.0
    for (std::size_t k = 0; k < numbers.size(); ++k) set_numbers(node, kApart[k], {numbers[k]});
    return;
  }
  set_numbers(node, "inertia", {numbers.begin(), numbers.end()});
}

void write_body(pugi::xml_node objects, const data::BodyDescription& body) {
  set_mass(append_named(objects, "Body", body.name), body);
}

void write_marker(pugi::xml_node objects, const data::ModelDescription& description,
                  const data::MarkerDescription& marker) {
  const pugi::xml_node node = append_named(objects, "Marker", marker.name);
  append_text(node, "socket_parent_frame", body_path(description, marker.body_idx));
  append_vector3(node, "location", marker.x_in_body);
}

void make_legal(std::string& name) {
  for (char& c : name)
    if (std::string_view(" \\*+/\t\r\n").find(c) != std::string_view::npos) c = '_';
}

data::ModelDescription with_legal_names(data::ModelDescription description) {
  const auto rename = [](auto& items) {
    for (auto& item : items) make_legal(item.name);
  };
  if (description.name.empty()) description.name = "model";
  make_legal(description.name);
  rename(description.bodies);
  rename(description.joints);
  rename(description.coordinates);
  rename(description.couplings);
  rename(description.point_constraints);
  rename(description.markers);
  return description;
}

}  // namespace kinemark::io::osim
