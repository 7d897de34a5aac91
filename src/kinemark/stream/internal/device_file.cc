// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/internal/device_file.h"

#include <fmt/core.h>
#include <grp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace kinemark::stream {
namespace {

namespace fs = std::filesystem;

bool is_number(const std::string& text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

/// Whether a process has the file open; false also where that may not be seen.
bool has_open(const fs::path& process, const fs::path& file) {
  std::error_code ignored;
  for (fs::directory_iterator at(process / "fd", ignored), end; at != end; at.increment(ignored)) {
    if (ignored) return false;
    if (fs::read_symlink(at->path(), ignored) == file) return true;
  }
  return false;
}

std::string group_of(const std::string& path) {
  struct stat about{};
  if (stat(path.c_str(), &about) != 0) return "";
  // Read for this one word; other threads may ask for theirs.
  group entry{};
  group* found = nullptr;
  std::string room(16'384, '\0');
  getgrgid_r(about.st_gid, &entry, room.data(), room.size(), &found);
  return found == nullptr ? std::to_string(about.st_gid) : std::string(found->gr_name);
}

}  // namespace

std::string who_has(const std::string& path) {
  std::error_code ignored;
  const fs::path file = fs::canonical(path, ignored);
  for (fs::directory_iterator at("/proc", ignored), end; at != end; at.increment(ignored)) {
    if (ignored) break;
    const auto number = at->path().filename().string();
    if (!is_number(number) || number == std::to_string(getpid()) || !has_open(at->path(), file)) continue;
    std::string name;
    std::getline(std::ifstream(at->path() / "comm"), name);
    return fmt::format("{} (process {})", name.empty() ? "a program" : name, number);
  }
  return has_open("/proc/self", file) ? "this program itself" : "another program";
}

std::string cannot_open(const std::string& path, int error) {
  switch (error) {
    case ENOENT:
    case ENODEV:
    case ENXIO:
      return fmt::format("{}: there is no such device; is it plugged in?", path);
    case EACCES:
    case EPERM: {
      const auto group = group_of(path);
      return fmt::format(
          "{}: no permission; it is of the group {}: sudo usermod -aG {} $USER, then log in again", path,
          group, group);
    }
    case EBUSY:
    case EWOULDBLOCK:
      return fmt::format("{}: {} has it; end that first", path, who_has(path));
    default:
      return fmt::format("{}: cannot be opened: {}", path, std::strerror(error));
  }
}

}  // namespace kinemark::stream
