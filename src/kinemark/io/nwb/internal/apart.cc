// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/nwb/internal/apart.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <system_error>
#include <utility>

#include "kinemark/io/file.h"

extern char** environ;  // NOLINT(readability-redundant-declaration): not every unistd.h has it

namespace kinemark::io::internal {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProgram = "kinemark-nwb";

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

/// Start the program with the end of a pipe as its output and nothing else of ours; its process, or -1.
pid_t start_program(const fs::path& program, const ApartJob& job, const ApartLimits& limits, int output) {
  std::vector<std::string> words{kProgram, job.file.string(), std::to_string(limits.seconds),
                                 std::to_string(limits.bytes)};
  words.insert(words.end(), job.what.begin(), job.what.end());
  std::vector<char*> arguments;
  for (auto& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
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
std::unexpected<Error> describe_end(const ApartJob& job, int status, const ApartLimits& limits) {
  const auto damaged = [&](const std::string& what) {
    return fail(Code::bad_input, fmt::format("{}: {}; the file is damaged. {}", job.name, what, job.undone));
  };
  // It came to its end, or was ended because of what it sent.
  if (status == 0 || (WIFSIGNALED(status) && WTERMSIG(status) == SIGTERM))
    return fail(
        Code::bad_input,
        fmt::format("{}: {} does not answer as expected: it is of another version, or the file misled "
                    "it. {}",
                    job.name, kProgram, job.undone));
  if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL))
    return damaged(fmt::format("HDF5 did not come to an end with it in {} s", limits.seconds));
  if (WIFSIGNALED(status)) return damaged(fmt::format("HDF5 crashed on it (signal {})", WTERMSIG(status)));
  return damaged("HDF5 could not read it");
}

}  // namespace

Apart::Apart(Apart&& other) noexcept
    : job_(std::move(other.job_)),
      limits_(other.limits_),
      child_(std::exchange(other.child_, -1)),
      input_(std::exchange(other.input_, -1)) {}

Apart::~Apart() {
  if (child_ > 0) (void)end(false);
}

Result<Apart> Apart::start(ApartJob job) {
  // HDF5 does not distinguish a missing file from a damaged one.
  const auto file = InputFile::open(job.file);
  if (!file) return std::unexpected(file.error());
  const fs::path program = find_program();
  if (program.empty())
    return fail(Code::not_supported, fmt::format("{}: the program that reads HDF5 (NWB, points in images), "
                                                 "{}, is not beside this one; install it, or say where "
                                                 "it is in KINEMARK_NWB_READER",
                                                 job.name, kProgram));
  const ApartLimits limits(file->size());
  std::array<int, 2> ends{-1, -1};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    return fail(Code::io,
                fmt::format("{}: cannot be read ({})", job.name, std::generic_category().message(errno)));
  const pid_t child = start_program(program, job, limits, ends[1]);
  const int error = errno;
  ::close(ends[1]);
  if (child < 0) {
    ::close(ends[0]);
    return fail(Code::io, fmt::format("{}: cannot be read: {} cannot be started ({})", job.name,
                                      program.string(), std::generic_category().message(error)));
  }
  return Apart(std::move(job), limits, child, ends[0]);
}

Status Apart::end(bool received) {
  ::close(std::exchange(input_, -1));
  // A process that sent nonsense would wait for a reader.
  if (!received) ::kill(child_, SIGTERM);
  const int status = wait_for(std::exchange(child_, -1));
  return received ? Status() : describe_end(job_, status, limits_);
}

}  // namespace kinemark::io::internal
