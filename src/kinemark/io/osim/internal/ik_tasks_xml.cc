// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/internal/ik_tasks_xml.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>
#include <string>

#include "kinemark/core/number.h"

namespace kinemark::io::osim {
namespace {

double read_weight(XmlFile& file, pugi::xml_node node) {
  const double weight = file.number(node, "weight", 0.0);
  if (!std::isfinite(weight) || weight < 0.0)
    file.note(node.child("weight"), fmt::format("is {}; need a finite number, 0 or more", weight));
  return weight;
}

IkCoordinateTask::Target read_target(XmlFile& file, pugi::xml_node node) {
  using enum IkCoordinateTask::Target;
  std::string word = text_of(node, "value_type");
  for (char& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (word == "manual_value") return manual_value;
  if (word == "from_file") return from_file;
  if (!word.empty() && word != "default_value")
    file.note(node.child("value_type"),
              fmt::format("is {}; need default_value, manual_value or from_file", in_quotes(word)));
  return default_value;
}

}  // namespace

IkTasks read_ik_tasks(XmlFile& file, pugi::xml_node owner, const char* set) {
  IkTasks tasks;
  std::set<std::string> seen;
  for (const pugi::xml_node node : objects_of(owner, set)) {
    const std::string_view tag = node.name();
    const std::string name = name_of(node);
    if (tag != "IKMarkerTask" && tag != "IKCoordinateTask") continue;
    if (name.empty()) file.note(node, fmt::format("a {} has no name", tag));
    if (!seen.insert(std::string(tag) + name).second) file.note(node, "occurs twice");
    if (tag == "IKMarkerTask") {
      tasks.markers.push_back(
          {.name = name, .weight = read_weight(file, node), .apply = file.flag(node, "apply", true)});
      continue;
    }
    const double value = file.number(node, "value", 0.0);
    if (!std::isfinite(value)) file.note(node.child("value"), "must be finite");
    tasks.coordinates.push_back({.name = name,
                                 .weight = read_weight(file, node),
                                 .apply = file.flag(node, "apply", true),
                                 .target = read_target(file, node),
                                 .value = value});
  }
  return tasks;
}

std::filesystem::path path_of(pugi::xml_node node, const char* child, const std::filesystem::path& folder) {
  std::string text = text_of(node, child);
  if (text.empty() || text == "Unassigned") return {};
  std::ranges::replace(text, '\\', '/');
  return (folder / text).lexically_normal();
}

std::filesystem::path input_path_of(const XmlFile& file, pugi::xml_node node, const char* child,
                                    const std::filesystem::path& folder, std::vector<std::string>& notes) {
  std::filesystem::path path = path_of(node, child, folder);
  std::error_code unreadable;
  if (path.empty() || std::filesystem::exists(path, unreadable)) return path;
  std::filesystem::path beside = folder / path.filename();
  if (path.filename().empty() || !std::filesystem::is_regular_file(beside, unreadable)) return path;
  notes.push_back(fmt::format("{}: <{}> names {}, which is not there; {} beside the setup is read instead",
                              file.name(), child, in_quotes(text_of(node, child)),
                              in_quotes(path.filename().string())));
  return beside;
}

std::optional<std::pair<double, double>> read_time_range(XmlFile& file, pugi::xml_node owner) {
  const auto words = words_of(text_of(owner, "time_range"));
  if (words.empty()) return std::nullopt;
  const auto begin = parse_number(words.front()), end = parse_number(words.back());
  if (words.size() == 2 && begin == -1.0 && end == -1.0) return std::nullopt;  // OpenSim's "not set"
  if (words.size() == 2 && begin && end && *begin <= *end) return std::pair(*begin, *end);
  file.note(owner.child("time_range"), fmt::format("{} is not a range; need two times, the earlier first",
                                                   in_quotes(text_of(owner, "time_range"))));
  return std::nullopt;
}

}  // namespace kinemark::io::osim
