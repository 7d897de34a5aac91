// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What setups of inverse kinematics and of scaling have in common.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/io/osim/ik_setup.h"
#include "kinemark/io/osim/internal/xml_file.h"

namespace kinemark::io::osim {

/// The tasks of <set> below owner; anything wrong is noted in the file.
[[nodiscard]] IkTasks read_ik_tasks(XmlFile& file, pugi::xml_node owner, const char* set);

/// A path as written in the file, of any operating system, relative to `folder`; empty when it is absent or
/// "Unassigned".
[[nodiscard]] std::filesystem::path path_of(pugi::xml_node node, const char* child,
                                            const std::filesystem::path& folder);

/// The same for a file to read. Where it is not there, but a file of its name stands beside the setup, it is
/// that one, and `notes` gets a sentence.
[[nodiscard]] std::filesystem::path input_path_of(const XmlFile& file, pugi::xml_node node, const char* child,
                                                  const std::filesystem::path& folder,
                                                  std::vector<std::string>& notes);

/// <time_range> as two times, the earlier first; nothing when it is absent or wrong (then noted).
[[nodiscard]] std::optional<std::pair<double, double>> read_time_range(XmlFile& file, pugi::xml_node owner);

}  // namespace kinemark::io::osim
