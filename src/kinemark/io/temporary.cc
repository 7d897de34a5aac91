// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/temporary.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <ranges>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "kinemark/io/placement.h"

namespace kinemark::io {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPrefix = ".kinemark-";
constexpr int kMostAttempts = 10'000;

/// All temporary files and folders of the process, oldest first. Signals come to a process, and so must this
/// list.
struct OfProcess {
  std::mutex mutex;
  std::list<fs::path> paths;
  int made = 0;
};

OfProcess& of_process() {
  static auto* const all = new OfProcess;  // outlives every other object
  return *all;
}

fs::path folder_of(const fs::path& target) {
  return target.has_parent_path() ? target.parent_path() : fs::path(".");
}

fs::path whole_path(const fs::path& path) {
  std::error_code ignored;
  return fs::absolute(path, ignored).lexically_normal();
}

/// ".kinemark-PID-NUMBER".
bool is_temporary_name(std::string_view name) {
  if (!name.starts_with(kPrefix)) return false;
  name.remove_prefix(kPrefix.size());
  const auto dash = name.find('-');
  const auto whole = [](std::string_view part) {
    return !part.empty() && part.find_first_not_of("0123456789") == std::string_view::npos;
  };
  return dash != std::string_view::npos && whole(name.substr(0, dash)) && whole(name.substr(dash + 1));
}

bool lock(int fd, int how) {
  int result = ::flock(fd, LOCK_EX | how);
  while (result != 0 && errno == EINTR) result = ::flock(fd, LOCK_EX | how);
  return result == 0;
}

bool same_file(int fd, const fs::path& path) {
  struct stat open{}, named{};
  return ::fstat(fd, &open) == 0 && ::lstat(path.c_str(), &named) == 0 && open.st_dev == named.st_dev &&
         open.st_ino == named.st_ino;
}

/// A file, an empty folder, or a folder of files.
void remove_path(const fs::path& path) {
  std::error_code ignored;
  if (is_temporary(path))
    fs::remove_all(path, ignored);
  else
    fs::remove(path, ignored);
}

int open_new_file(const fs::path& path) {
  return ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666);
}

int open_new_folder(const fs::path& path) {
  if (::mkdir(path.c_str(), 0700) != 0) return -1;
  return ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC | O_NOFOLLOW);
}

/// Make the file or folder under a name of its own and lock it. Another program may take it for a leftover
/// before it is opened or locked: then it is made anew.
int open_locked(const fs::path& folder, int (*open_new)(const fs::path&), fs::path& path) {
  auto& all = of_process();
  for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
    path = folder / fmt::format("{}{}-{}", kPrefix, ::getpid(), ++all.made);
    const int fd = open_new(path);
    if (fd < 0) {
      const int why = errno;
      std::error_code ignored;
      if (why == EEXIST || (why == ENOENT && fs::is_directory(folder, ignored))) continue;
      errno = why;
      return -1;
    }
    lock(fd, 0);
    if (same_file(fd, path)) return fd;
    ::close(fd);
  }
  errno = EEXIST;
  return -1;
}

}  // namespace

Temporary::Temporary(fs::path path, int fd) : path_(std::move(path)), fd_(fd), listed_(true) {
  auto& paths = of_process().paths;
  entry_ = paths.insert(paths.end(), whole_path(path_));
}

Result<Temporary> Temporary::file_for(const fs::path& target) {
  const auto folder = folder_of(target);
  if (!is_temporary(folder)) remove_leftovers(folder);
  const std::lock_guard guard(of_process().mutex);
  fs::path path;
  const int fd = open_locked(folder, open_new_file, path);
  if (fd < 0)
    return fail(Code::io, fmt::format("{}: cannot be written ({})", target.string(),
                                      std::generic_category().message(errno)));
  return Temporary(std::move(path), fd);
}

Result<Temporary> Temporary::folder_for(const fs::path& target) {
  const auto folder = folder_of(target);
  remove_leftovers(folder);
  const std::lock_guard guard(of_process().mutex);
  fs::path path;
  const int fd = open_locked(folder, open_new_folder, path);
  if (fd < 0)
    return fail(Code::io, fmt::format("{}: cannot be written ({})", target.string(),
                                      std::generic_category().message(errno)));
  return Temporary(std::move(path), fd);
}

Temporary Temporary::watch_folder(const fs::path& folder) {
  const std::lock_guard guard(of_process().mutex);
  return {folder, -1};
}

Temporary::Temporary(Temporary&& other) noexcept
    : path_(std::move(other.path_)),
      fd_(std::exchange(other.fd_, -1)),
      entry_(other.entry_),
      listed_(std::exchange(other.listed_, false)) {}

Temporary& Temporary::operator=(Temporary&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(fd_, other.fd_);
  std::swap(entry_, other.entry_);
  std::swap(listed_, other.listed_);
  other.remove();
  return *this;
}

Temporary::~Temporary() { remove(); }

void Temporary::remove() {
  if (!listed_) return;
  const std::lock_guard guard(of_process().mutex);
  remove_path(*entry_);
  of_process().paths.erase(entry_);
  listed_ = false;
  if (fd_ >= 0) ::close(std::exchange(fd_, -1));
}

void Temporary::release() {
  if (std::exchange(listed_, false)) of_process().paths.erase(entry_);
  if (fd_ >= 0) ::close(std::exchange(fd_, -1));
}

bool is_temporary(const fs::path& path) { return is_temporary_name(path.filename().native()); }

std::unique_lock<std::mutex> hold_end() { return std::unique_lock(of_process().mutex); }

void end_process(int status) {
  auto& all = of_process();
  all.mutex.lock();  // for good: nothing is made any more
  for (const auto& path : std::views::reverse(all.paths)) remove_path(path);
  ::_exit(status);
}

void remove_leftovers(const fs::path& folder) {
  std::error_code end;
  std::vector<fs::path> found;
  for (fs::directory_iterator entry(folder, end); !end && entry != fs::directory_iterator();
       entry.increment(end))
    if (is_temporary(entry->path())) found.push_back(entry->path());
  if (found.empty()) return;
  const std::lock_guard guard(of_process().mutex);
  for (const auto& path : found) {
    // Where a lock belongs to the process and not to the descriptor, our own would seem to be free.
    if (std::ranges::find(of_process().paths, whole_path(path)) != of_process().paths.end()) continue;
    const int fd = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0) continue;
    struct stat info{};
    const bool ours = ::fstat(fd, &info) == 0 && info.st_uid == ::geteuid() &&
                      (S_ISREG(info.st_mode) || S_ISDIR(info.st_mode));
    if (ours && lock(fd, LOCK_NB) && same_file(fd, path) &&
        (S_ISREG(info.st_mode) || take_back_placement(path, folder)))
      remove_path(path);
    ::close(fd);
  }
}

}  // namespace kinemark::io
