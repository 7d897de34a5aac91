// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/internal/format_xml.h"

#include <string>

#include "kinemark/core/number.h"

namespace kinemark::io::osim {
namespace {

std::string join_numbers(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : " ") + format_number(value);
  return text;
}

bool is_text(pugi::xml_node node) {
  return node.type() == pugi::node_pcdata || node.type() == pugi::node_cdata;
}

}  // namespace

void append_text(pugi::xml_node node, const char* child, std::string_view text) {
  node.append_child(child).text().set(std::string(text).c_str());
}

void append_flag(pugi::xml_node node, const char* child, bool value) {
  append_text(node, child, value ? "true" : "false");
}

void append_number(pugi::xml_node node, const char* child, double value) {
  append_text(node, child, format_number(value));
}

void append_numbers(pugi::xml_node node, const char* child, const std::vector<double>& values) {
  append_text(node, child, join_numbers(values));
}

void append_vector3(pugi::xml_node node, const char* child, const Eigen::Vector3d& value) {
  append_numbers(node, child, {value.x(), value.y(), value.z()});
}

pugi::xml_node append_named(pugi::xml_node node, const char* tag, std::string_view name) {
  pugi::xml_node child = node.append_child(tag);
  child.append_attribute("name").set_value(std::string(name).c_str());
  return child;
}

void set_text(pugi::xml_node node, std::string_view text) {
  for (pugi::xml_node child = node.first_child(); child;) {
    const pugi::xml_node next = child.next_sibling();
    if (is_text(child)) node.remove_child(child);
    child = next;
  }
  node.append_child(pugi::node_pcdata).set_value(std::string(text).c_str());
}

void set_numbers(pugi::xml_node node, const char* child, const std::vector<double>& values) {
  if (!node.child(child)) node.append_child(child);
  set_text(node.child(child), join_numbers(values));
}

void set_vector3(pugi::xml_node node, const char* child, const Eigen::Vector3d& value) {
  set_numbers(node, child, {value.x(), value.y(), value.z()});
}

}  // namespace kinemark::io::osim
