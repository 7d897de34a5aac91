// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <pugixml.hpp>
#include <string_view>
#include <vector>

namespace kinemark::io::osim {

// Children of an element with a value as text; numbers in the shortest form that reads back the same.
void append_text(pugi::xml_node node, const char* child, std::string_view text);
void append_flag(pugi::xml_node node, const char* child, bool value);
void append_number(pugi::xml_node node, const char* child, double value);
void append_numbers(pugi::xml_node node, const char* child, const std::vector<double>& values);
void append_vector3(pugi::xml_node node, const char* child, const Eigen::Vector3d& value);

/// `<tag name="name">` as the last child of `node`.
pugi::xml_node append_named(pugi::xml_node node, const char* tag, std::string_view name);

/// Replace the text of an element; comments in it stay.
void set_text(pugi::xml_node node, std::string_view text);
/// The same for a child element, which is made when there is none.
void set_numbers(pugi::xml_node node, const char* child, const std::vector<double>& values);
/// Three numbers.
void set_vector3(pugi::xml_node node, const char* child, const Eigen::Vector3d& value);

}  // namespace kinemark::io::osim
