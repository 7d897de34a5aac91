// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Members of a ZIP archive, as NumPy writes it: stored or deflated, in one file, not encrypted.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::io::internal {

/// One member.
struct ZipMember {
  std::string name;                   ///< with its folders
  bool deflated = false;              ///< else stored as it is
  std::size_t bytes = 0;              ///< unpacked, as the archive says
  std::span<const std::byte> packed;  ///< of the archive
};

/// The members that the directory at the end of an archive lists. Code::bad_input where it is damaged or cut
/// short; Code::not_supported for encrypted members and other ways of packing.
[[nodiscard]] Result<std::vector<ZipMember>> zip_members(std::span<const std::byte> archive);

/// What a member holds. Code::bad_input where it is damaged, or holds another number of bytes than the
/// archive says; nothing is allocated that its packed bytes cannot fill.
[[nodiscard]] Result<std::vector<std::byte>> unpack(const ZipMember& member);

}  // namespace kinemark::io::internal
