// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/place.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <stdio.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

namespace kinemark::io {
namespace {

namespace fs = std::filesystem;

constexpr int kMostLinks = 40;  // as the kernel follows

std::string system_words() { return std::generic_category().message(errno); }

std::unexpected<Error> exists_already(const fs::path& path) {
  return fail(Code::io, fmt::format("{}: exists already; use --force to replace it", path.string()));
}

std::unexpected<Error> cannot_be_written(const fs::path& path) {
  return fail(Code::io, fmt::format("{}: cannot be written ({})", path.string(), system_words()));
}

bool rename_with(const fs::path& from, const fs::path& to, unsigned flags) {
  return ::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), flags) == 0;
}

/// The kernel or the file system does not know that kind of renaming.
bool unknown_to_system() { return errno == EINVAL || errno == ENOSYS || errno == EOPNOTSUPP; }

}  // namespace

Result<fs::path> find_target(const fs::path& path, bool force) {
  fs::path target = path;
  std::error_code ignored;
  for (int links = 0;; ++links) {
    const auto kind = fs::symlink_status(target, ignored).type();
    if (kind == fs::file_type::directory)
      return fail(Code::io, fmt::format("{}: is a folder; need a file name", path.string()));
    if (kind == fs::file_type::not_found || kind == fs::file_type::none) return target;
    if (kind != fs::file_type::regular && kind != fs::file_type::symlink)
      return fail(Code::io, fmt::format("{}: is not a regular file and is not replaced", path.string()));
    if (!force && (kind == fs::file_type::regular || !fs::is_directory(target, ignored)))
      return exists_already(path);
    if (kind == fs::file_type::regular) return target;
    if (links == kMostLinks)
      return fail(Code::io, fmt::format("{}: is a link that leads to itself", path.string()));
    target = target.parent_path() / fs::read_symlink(target, ignored);
  }
}

Status check_below(const fs::path& setup, const fs::path& output, std::string_view element) {
  std::error_code ignored;
  const auto folder = fs::weakly_canonical(fs::absolute(setup, ignored).parent_path(), ignored);
  // With force a link as output is followed; it may not lead elsewhere either.
  const auto target = find_target(output, true).value_or(output);
  const auto file = fs::weakly_canonical(fs::absolute(target, ignored), ignored);
  if (std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end()) return {};
  return fail(Code::usage,
              fmt::format("{}: <{}> is {}, which lies outside the setup's own folder; give --output",
                          setup.string(), element, output.string()));
}

Result<Replaced> place_file(const fs::path& from, const fs::path& target, bool force, bool exchange) {
  if (!force) {
    if (rename_with(from, target, RENAME_NOREPLACE)) return Replaced::nothing;
    if (errno == EEXIST) return exists_already(target);
    if (!unknown_to_system()) return cannot_be_written(target);
    // A second name never replaces either.
    if (::link(from.c_str(), target.c_str()) != 0)
      return errno == EEXIST ? exists_already(target) : cannot_be_written(target);
    ::unlink(from.c_str());
    return Replaced::nothing;
  }
  if (exchange) {
    if (rename_with(from, target, RENAME_EXCHANGE)) {
      std::error_code ignored;
      if (!fs::is_directory(fs::symlink_status(from, ignored))) return Replaced::exchanged;
      rename_with(from, target, RENAME_EXCHANGE);  // a folder came there, and is not ours to take away
      return fail(Code::io, fmt::format("{}: is a folder; need a file name", target.string()));
    }
    if (errno != ENOENT && !unknown_to_system()) return cannot_be_written(target);
  }
  std::error_code ignored;
  const bool there = fs::exists(target, ignored);
  if (::rename(from.c_str(), target.c_str()) != 0) return cannot_be_written(target);
  return there ? Replaced::gone : Replaced::nothing;
}

void unplace_file(const fs::path& from, const fs::path& target, Replaced replaced) {
  if (replaced == Replaced::nothing)
    ::rename(target.c_str(), from.c_str());
  else if (replaced == Replaced::exchanged)
    rename_with(from, target, RENAME_EXCHANGE);
}

Status sync_folder(const fs::path& folder) {
  const int fd = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return {};  // a folder that may be written in but not read
  const bool synced = ::fsync(fd) == 0 || errno == EINVAL || errno == EROFS || errno == EBADF;
  const std::string why = system_words();
  ::close(fd);
  if (!synced)
    return fail(Code::io, fmt::format("{}: cannot be forced to the disk ({})", folder.string(), why));
  return {};
}

}  // namespace kinemark::io
