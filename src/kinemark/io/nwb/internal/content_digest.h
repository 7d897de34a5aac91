// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "kinemark/io/nwb/internal/input.h"
#include "kinemark/io/nwb/internal/output.h"

namespace kinemark::io::internal {

/// Attribute of the root of our own files: the digest of everything else in them.
inline constexpr const char* kDigestAttribute = "kinemark_digest";

/// XXH3 over names, links, attributes, shapes and values of what the file's content list names, or, where it
/// has none, of all objects in the order of their names: "xxh3:" and 16 digits. Samples that were read
/// already are not read again (Input::digest_of). Nothing where a part of the file cannot be read.
[[nodiscard]] std::optional<std::string> content_digest(Input& in);

/// Write the set that a file belongs to (empty: none), the list of its content and, last of all, the digest
/// of that.
void seal(Output& out, const std::string& set, const std::vector<std::string>& content);
/// The same of a file that is all ours.
void seal_whole(Output& out, const std::string& set);

}  // namespace kinemark::io::internal
