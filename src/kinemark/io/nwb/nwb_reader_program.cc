// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// kinemark-nwb FILE SECONDS BYTES [neural | lanes | poses | carry FRESH NAME]: reads an NWB file for
// read_nwb() or read_neural(), or points in images for read_pose_table(), or puts the results of a file into
// another for carry(), which is at the other end of standard output. A process of its own, because HDF5
// crashes on some damaged files and never returns from others.
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "kinemark/io/nwb/internal/carry.h"
#include "kinemark/io/nwb/internal/neural_reader.h"
#include "kinemark/io/nwb/internal/pose_reader.h"
#include "kinemark/io/nwb/internal/reader.h"
#include "kinemark/io/nwb/internal/transfer.h"

namespace {

using namespace kinemark;

std::optional<rlim_t> number(const char* text) {
  rlim_t value = 0;
  const char* end = text + std::strlen(text);
  return std::from_chars(text, end, value).ptr == end && end != text ? std::optional(value) : std::nullopt;
}

/// At most `most`, or what is allowed already.
void limit(decltype(RLIMIT_CPU) what, rlim_t most) {
  struct rlimit now{};
  getrlimit(what, &now);
  now.rlim_cur = std::min(most, now.rlim_max);
  setrlimit(what, &now);
}

void set_limits(rlim_t seconds, rlim_t bytes) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // nobody reads what it would send
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, seconds);
#ifndef KINEMARK_SANITIZE_ADDRESS  // which needs terabytes of addresses
  limit(RLIMIT_AS, bytes);
#else
  static_cast<void>(bytes);
#endif
}

/// Send what `read` gives of a file.
template <class Read>
bool send_read(const Read& read, const char* path) {
  const auto content = [&]() -> decltype(read(path)) {
    try {
      return read(path);
    } catch (const std::bad_alloc&) {
      return fail(Code::bad_input,
                  std::string(path) + ": needs far more memory than its size explains. Nothing was read.");
    }
  };
  return io::internal::send(STDOUT_FILENO, content());
}

/// Do what the arguments behind the limits ask for; nothing where they ask for nothing known.
std::optional<bool> answer(const char* path, std::span<char* const> what) {
  const auto asks = [&](std::string_view word, std::size_t words) {
    return what.size() == words && what.front() == word;
  };
  if (what.empty()) return send_read(io::internal::read_nwb_here, path);
  if (asks("neural", 1)) return send_read(io::internal::read_neural_here, path);
  if (asks("lanes", 1)) return send_read(io::internal::read_lanes_here, path);
  if (asks("poses", 1)) return send_read(io::internal::read_pose_table_here, path);
  const auto carry = [&](const char* copy) -> Result<io::internal::Carried> {
    auto carried = io::internal::carry_here(copy, what[1]);
    if (!carried) return fail_at(what[2], carried.error());
    return carried;
  };
  if (asks("carry", 3)) return send_read(carry, path);
  return std::nullopt;
}

}  // namespace

int main(int argc, char** argv) {
  const auto seconds = argc >= 4 ? number(argv[2]) : std::nullopt;
  const auto bytes = argc >= 4 ? number(argv[3]) : std::nullopt;
  if (!seconds || !bytes) return 2;
  set_limits(*seconds, *bytes);
  const auto sent = answer(argv[1], std::span(argv, static_cast<std::size_t>(argc)).subspan(4));
  if (!sent) return 2;
  _exit(*sent ? 0 : 4);  // HDF5 has nothing left to do
}
