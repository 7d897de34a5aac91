// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Which objects of a file are ours: what the digest covers, what another result replaces, and what is left
// for others.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/io/nwb/internal/input.h"

namespace kinemark::io::internal {

/// Attribute of the root: paths of what we wrote. "/processing/behavior/" with a slash at its end is the
/// group alone, its attributes without what is in it. Files of older versions have none: all in them is ours.
inline constexpr const char* kContentAttribute = "kinemark_content";
/// Attribute of the root: the processing module with our positions, where it is not kModule.
inline constexpr const char* kModuleAttribute = "kinemark_module";

/// The processing module that holds, or would hold, our positions.
[[nodiscard]] std::string module_of(const Input& in);

/// Every object of a file that we wrote alone, as the content list names it; without units, intervals of
/// trials, electrodes and potentials, which lie beside a movement and go along as those of others do.
[[nodiscard]] std::vector<std::string> all_content(const Input& in);

/// The list of a file; nothing where it has none.
[[nodiscard]] std::optional<std::vector<std::string>> listed_content(const Input& in);

/// Ours by the list; of a file of ours without one, what we write under names that we give; of a file of
/// others nothing.
[[nodiscard]] std::vector<std::string> our_content(Input& in);

/// True for a path of the list, and for what lies below one.
[[nodiscard]] bool covers(const std::vector<std::string>& content, std::string_view path);

/// The first of some processing modules in which the names that the writer of positions gives are free, or
/// ours: `behavior`, else `kinemark`, `kinemark_2`, ...
[[nodiscard]] std::string room_for_positions(Input& in);

}  // namespace kinemark::io::internal
