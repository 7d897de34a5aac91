// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/child_command.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <deque>
#include <system_error>
#include <utility>

namespace kinemark::cli {
namespace {

constexpr std::size_t kMostLines = 1000;
constexpr std::size_t kLongestLine = 10'000;
constexpr int kNotStarted = 127;

/// Collects lines from pieces of text.
class Lines {
 public:
  void add(std::string_view text) {
    for (const char c : text) {
      if (c == '\n')
        end();
      else if (line_.size() < kLongestLine)
        line_ += c;
    }
  }
  void end() {
    if (!line_.empty()) lines_.push_back(std::exchange(line_, {}));
    if (lines_.size() > kMostLines) lines_.pop_front();
  }
  [[nodiscard]] std::vector<std::string> take() {
    end();
    return {lines_.begin(), lines_.end()};
  }

 private:
  std::string line_;
  std::deque<std::string> lines_;
};

/// In the new process: only what a signal handler may do.
[[noreturn]] void become(char* const* words, const char* folder, int output, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  const int nothing = ::open("/dev/null", O_RDWR);
  const bool ready = ::getppid() == parent && nothing >= 0 && ::dup2(nothing, STDIN_FILENO) >= 0 &&
                     ::dup2(nothing, STDOUT_FILENO) >= 0 && ::dup2(output, STDERR_FILENO) >= 0 &&
                     ::chdir(folder) == 0;
  if (ready) ::execv("/proc/self/exe", words);
  ::_exit(kNotStarted);
}

int wait_for(pid_t child) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  return status;
}

std::unexpected<Error> not_started(const std::string& command) {
  return fail(Code::io, fmt::format("'kinemark {}' cannot be started ({})", command,
                                    std::generic_category().message(errno)));
}

}  // namespace

Result<pipeline::CommandEnd> run_child(const std::vector<std::string>& words,
                                       const std::filesystem::path& folder) {
  std::vector<std::string> all{"kinemark"};
  all.insert(all.end(), words.begin(), words.end());
  std::vector<char*> pointers;
  for (auto& word : all) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const std::string command = words.empty() ? "" : words.front();
  std::array<int, 2> ends{-1, -1};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return not_started(command);
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child == 0) become(pointers.data(), folder.c_str(), ends[1], parent);
  ::close(ends[1]);
  if (child < 0) {
    ::close(ends[0]);
    return not_started(command);
  }
  Lines lines;
  std::array<char, 4096> buffer{};
  while (true) {
    const auto n = ::read(ends[0], buffer.data(), buffer.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    lines.add({buffer.data(), static_cast<std::size_t>(n)});
  }
  ::close(ends[0]);
  const int status = wait_for(child);
  if (WIFSIGNALED(status))
    return fail(Code::io, fmt::format("'kinemark {}' was ended by signal {}", command, WTERMSIG(status)));
  if (WEXITSTATUS(status) == kNotStarted)
    return fail(Code::io, fmt::format("'kinemark {}' cannot be started in {}", command, folder.string()));
  return pipeline::CommandEnd{.exit_status = WEXITSTATUS(status), .said = lines.take()};
}

}  // namespace kinemark::cli
