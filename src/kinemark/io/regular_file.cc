// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/regular_file.h"

#include <fmt/core.h>

#include <string_view>
#include <system_error>

namespace kinemark::io {
namespace {

/// What stands in the way, in words; empty for a regular file and where nothing is known.
std::string_view other_kind(std::filesystem::file_type type) {
  switch (type) {
    case std::filesystem::file_type::directory:
      return "a folder";
    case std::filesystem::file_type::fifo:
      return "a pipe (FIFO)";
    case std::filesystem::file_type::socket:
      return "a socket";
    case std::filesystem::file_type::character:
    case std::filesystem::file_type::block:
      return "a device";
    default:
      return "";
  }
}

}  // namespace

Status check_regular(const std::filesystem::path& path) {
  std::error_code unknown;
  const std::string_view kind = other_kind(std::filesystem::status(path, unknown).type());
  if (kind.empty()) return {};
  return fail(Code::bad_input, fmt::format("{}: is {}, not a regular file", path.string(), kind));
}

}  // namespace kinemark::io
