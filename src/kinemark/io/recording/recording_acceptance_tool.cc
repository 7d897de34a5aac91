// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What the acceptance script recording_kill.py drives.
//
//   recording_acceptance_tool record FILE SYNC    frames without end, each acknowledged one on stdout as a
//   line recording_acceptance_tool make FILE FRAMES    a closed recording recording_acceptance_tool check
//   FILE          "MESSAGES END FIRST_WRONG_FRAME|none" of what is there
#include <fmt/core.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <string>

#include "kinemark/io/recording/counts_recording.h"

namespace {

using namespace kinemark;

constexpr std::int64_t kLeds = 8, kCameras = 2;

/// Counts that identify a frame: each depends on the frame's number.
data::Counts one_frame(std::int64_t frame) {
  data::Counts counts = data::Counts::zeros({"1", "2", "3", "4", "5", "6", "7", "8"}, {"A", "B"},
                                            {.rate_hz = 100.0, .t0_s = 0.0, .frames = 1}, false);
  for (std::size_t i = 0; i < counts.counts.size(); ++i)
    counts.counts[i] = static_cast<std::int16_t>((31 * frame + 7 * static_cast<std::int64_t>(i)) % 4096);
  return counts;
}

int failed(const Error& error) {
  fmt::print(stderr, "{}\n", error.message);
  return exit_status(error.code);
}

int record(const char* path, std::string_view sync, std::int64_t frames) {
  const auto policy = sync == "always"  ? io::SyncPolicy::always
                      : sync == "never" ? io::SyncPolicy::never
                                        : io::SyncPolicy::background;
  auto writer = io::CountsWriter::create(path, one_frame(0), {}, {.sync = policy, .sync_interval_s = 0.05});
  if (!writer) return failed(writer.error());
  for (std::int64_t f = 0; frames < 0 || f < frames; ++f) {
    const data::Counts counts = one_frame(f);
    const auto status = writer->push({.frame = f,
                                      .time_s = 0.01 * static_cast<double>(f),
                                      .counts = counts.counts,
                                      .flags = counts.flags});
    if (!status) return failed(status.error());
    if (frames >= 0) continue;
    // Straight to the pipe: what the reader of the pipe has seen was acknowledged before.
    const std::string line = fmt::format("{}\n", f);
    if (::write(STDOUT_FILENO, line.data(), line.size()) != static_cast<ssize_t>(line.size())) return 4;
  }
  if (const auto closed = writer->close(); !closed) return failed(closed.error());
  return 0;
}

int check_file(const char* path) {
  const auto read = io::read_counts(path);
  if (!read) return failed(read.error());
  std::string wrong = "none";
  const std::size_t n = 4 * kLeds * kCameras;
  for (std::int64_t f = 0; f < read->counts.frames() && wrong == "none"; ++f) {
    const data::Counts expected = one_frame(f);
    if (std::memcmp(expected.counts.data(), read->counts.counts.data() + n * static_cast<std::size_t>(f),
                    sizeof(std::int16_t) * n) != 0)
      wrong = fmt::format("{}", f);
  }
  fmt::print("{} {} {}\n", read->counts.frames(), io::to_string(read->end), wrong);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view verb = argc > 2 ? argv[1] : "";
  if (verb == "record" && argc == 4) return record(argv[2], argv[3], -1);
  if (verb == "make" && argc == 4) return record(argv[2], "background", std::atoll(argv[3]));
  if (verb == "check" && argc == 3) return check_file(argv[2]);
  fmt::print(stderr, "usage: recording_acceptance_tool record FILE SYNC | make FILE FRAMES | check FILE\n");
  return 2;
}
