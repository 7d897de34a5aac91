// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// read_nwb(), read_neural() and read_pose_table(): start the program that reads, waits for what it sends, and
// says how it ended where it sends nothing.
#include <fcntl.h>
#include <fmt/core.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <system_error>
#include <utility>

#include "kinemark/io/file.h"
#include "kinemark/io/nwb/internal/transfer.h"
#include "kinemark/io/nwb/neural_file.h"
#include "kinemark/io/nwb/nwb.h"
#include "kinemark/io/nwb/pose_table.h"

extern char** environ;  // NOLINT(readability-redundant-declaration): not every unistd.h has it

namespace kinemark::io {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProgram = "kinemark-nwb";

/// A descriptor that is closed at the end of the scope.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(); }
  void close() {
    if (fd_ >= 0) ::close(std::exchange(fd_, -1));
  }
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_;
};

/// The program that reads NWB files, or an empty path.
fs::path find_program() {
  if (const char* named = std::getenv("KINEMARK_NWB_READER"); named != nullptr && *named != '\0')
    return named;
  std::error_code absent;
  const fs::path own = fs::read_symlink("/proc/self/exe", absent).parent_path();
  // Beside the program that runs, where both were installed, or where ours are installed and another program
  // runs.
  for (const fs::path& path : {own / kProgram, own.parent_path() / "libexec/kinemark" / kProgram,
                               fs::path(KINEMARK_LIBEXEC) / kProgram})
    if (fs::is_regular_file(path, absent)) return path;
  return {};
}

/// What the process may use: docs/formats/nwb.md.
struct Limits {
  std::size_t seconds, bytes;

  explicit Limits(std::size_t file_bytes)
      : seconds(5 + 2 * (file_bytes >> 20)), bytes((1UL << 30) + 256 * file_bytes) {}
};

/// Start the program with the end of a pipe as its output and nothing else of ours; its process, or -1.
/// `what` is one more argument for it, or null.
pid_t start(const fs::path& program, const fs::path& file, const Limits& limits, const char* what,
            int output) {
  const std::string seconds = std::to_string(limits.seconds), bytes = std::to_string(limits.bytes);
  std::array<char*, 6> arguments{
      const_cast<char*>(kProgram),      const_cast<char*>(file.c_str()), const_cast<char*>(seconds.c_str()),
      const_cast<char*>(bytes.c_str()), const_cast<char*>(what),         nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  // Signals as a new program expects them, whatever this one blocks or ignores.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  pid_t child = -1;
  const int error = posix_spawn(&child, program.c_str(), &actions, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  errno = error;
  return error == 0 ? child : -1;
}

int wait_for(pid_t child) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  return status;
}

/// One sentence on a process that ended without a result.
std::unexpected<Error> describe_end(const std::string& name, int status, const Limits& limits) {
  const auto damaged = [&](const std::string& what) {
    return fail(Code::bad_input, fmt::format("{}: {}; the file is damaged. Nothing was read.", name, what));
  };
  // It came to its end, or was ended because of what it sent.
  if (status == 0 || (WIFSIGNALED(status) && WTERMSIG(status) == SIGTERM))
    return fail(
        Code::bad_input,
        fmt::format("{}: {} does not answer as expected: it is of another version, or the file misled "
                    "it. Nothing was read.",
                    name, kProgram));
  if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL))
    return damaged(fmt::format("HDF5 did not come to an end with it in {} s", limits.seconds));
  if (WIFSIGNALED(status)) return damaged(fmt::format("HDF5 crashed on it (signal {})", WTERMSIG(status)));
  return damaged("HDF5 could not read it");
}

template <class T>
using Receive = std::optional<Result<T>> (*)(int, std::size_t);

/// What the program reads of a file, told by `what`, as `receive` takes it.
template <class T>
Result<T> read_apart(const fs::path& path, const char* what, Receive<T> receive) {
  // HDF5 does not distinguish a missing file from a damaged one.
  const auto file = InputFile::open(path);
  if (!file) return std::unexpected(file.error());
  const fs::path program = find_program();
  if (program.empty())
    return fail(Code::not_supported, fmt::format("{}: the program that reads HDF5 (NWB, points in images), "
                                                 "{}, is not beside this one; install it, or say where "
                                                 "it is in KINEMARK_NWB_READER",
                                                 path.string(), kProgram));
  const Limits limits(file->size());
  std::array<int, 2> ends{-1, -1};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    return fail(Code::io, fmt::format("{}: cannot be read ({})", path.string(),
                                      std::generic_category().message(errno)));
  const Descriptor input(ends[0]);
  Descriptor output(ends[1]);
  const pid_t child = start(program, path, limits, what, output.get());
  if (child < 0)
    return fail(Code::io, fmt::format("{}: cannot be read: {} cannot be started ({})", path.string(),
                                      program.string(), std::generic_category().message(errno)));
  output.close();
  auto received = receive(input.get(), limits.bytes);
  // A process that sent nonsense would wait for a reader.
  if (!received) ::kill(child, SIGTERM);
  const int status = wait_for(child);
  if (!received) return describe_end(path.string(), status, limits);
  return std::move(*received);
}

}  // namespace

Result<NwbFile> read_nwb(const fs::path& path) {
  return read_apart<NwbFile>(path, nullptr, internal::receive);
}

Result<data::Neural> read_neural(const fs::path& path) {
  return read_apart<data::Neural>(path, "neural", internal::receive_neural);
}

Result<data::Neural> read_neural_lanes(const fs::path& path) {
  return read_apart<data::Neural>(path, "lanes", internal::receive_neural);
}

Result<PoseTable> read_pose_table(const fs::path& path) {
  return read_apart<PoseTable>(path, "poses", internal::receive_poses);
}

}  // namespace kinemark::io
