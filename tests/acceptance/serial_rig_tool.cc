// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Records a rig on a serial line, as serial_rig.py asks.
//
//   serial_rig_tool record PATH OUT.mcap LEDS FRAMES RATE DARK TRIGGER LEVEL [STALL_S]   plan, counts, losses
//   as JSON serial_rig_tool refuse PATH LEDS RATE                                              the refusal
//   serial_rig_tool open PATH TIMES                                                    opened and closed;
//   handles serial_rig_tool hold PATH                                                          opened until
//   stdin ends
//
// What a refusal says goes to stdout too; the exit status is 5 then.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "kinemark/io/recording/counts_recording.h"
#include "kinemark/stream/serial/serial_device.h"

namespace {

using namespace kinemark;
using namespace kinemark::stream;
using std::chrono::milliseconds;

[[noreturn]] void give_up(const Error& error) {
  fmt::print("{}\n", error.message);
  std::exit(exit_status(error.code));
}

template <class T>
T or_give_up(Result<T> result) {
  if (!result) give_up(result.error());
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

ScanPlan plan(int leds, double rate_hz, bool dark, double level) {
  ScanPlan out;
  for (int l = 0; l < leds; ++l) out.leds.push_back(leds == 1 ? "rim" : fmt::format("rim {}", l + 1));
  out.cameras = {"A", "B"};
  out.rate_hz = rate_hz;
  out.timing.dark_slot = dark;
  for (int l = 0; l < leds; ++l) out.intensity.push_back(level * (1.0 - 0.05 * l));
  return out;
}

/// The frames of a block behind those that are there.
void append(const Block& block, data::Counts& counts, std::vector<std::int64_t>& numbers) {
  counts.counts.insert(counts.counts.end(), block.counts.begin(), block.counts.end());
  counts.dark.insert(counts.dark.end(), block.dark.begin(), block.dark.end());
  counts.flags.insert(counts.flags.end(), block.flags.begin(), block.flags.end());
  for (std::int64_t i = 0; i < block.frames; ++i) numbers.push_back(block.first_frame + i);
}

void record(char** words) {
  const auto leds = std::stoi(words[4]);
  const std::int64_t wanted = std::stoll(words[5]);
  auto device = or_give_up(open_serial(words[2]));
  auto asked = plan(leds, std::stod(words[6]), words[7][0] == '1', std::stod(words[9]));
  if (words[8][0] == '1') asked.trigger = Trigger::digital_line;
  const auto granted = or_give_up(device->configure(asked));
  or_give_up(device->start());
  fmt::print(stderr, "started\n");
  data::Counts counts = granted.layout;
  std::vector<std::int64_t> numbers;
  std::vector<std::pair<std::int64_t, std::int64_t>> gaps;
  Block block;
  int failures = 0;
  bool overflow = false;
  while (numbers.empty() || numbers.back() + 1 < wanted) {
    const auto found = device->read(block, milliseconds(2000));
    if (!found) {
      ++failures;
      fmt::print(stderr, "{}\n", found.error().message);
      while (!device->reopen()) std::this_thread::sleep_for(milliseconds(20));
      continue;
    }
    if (*found != ReadResult::block) {
      if (asked.trigger == Trigger::at_once) give_up({Code::device, "no frame within 2 s"});
      continue;
    }
    const auto next = numbers.empty() ? 0 : numbers.back() + 1;
    if (block.gap != (block.first_frame != next))
      give_up({Code::bad_input, "a gap that is none, or none that is one"});
    if (block.gap) gaps.emplace_back(next, block.first_frame - next);
    overflow |= block.overflow;
    append(block, counts, numbers);
  }
  or_give_up(device->stop());
  counts.time.frames = static_cast<std::int64_t>(numbers.size());
  or_give_up(io::write_counts(words[3], counts, {}, true));
  std::int64_t lost = 0;
  for (const auto& [from, frames] : gaps) lost += frames;
  fmt::print(
      "{{\"rate_hz\": {:.9f}, \"frames\": {}, \"last\": {}, \"lost\": {}, \"gaps\": {}, \"failures\": {}, "
      "\"overflow\": {}, \"intensity\": [{}], \"times_s\": [{:.9f}], \"dark_s\": [{:.9f}], \"numbers\": "
      "[{}]}}\n",
      granted.plan.rate_hz, numbers.size(), numbers.back(), lost, gaps.size(), failures, overflow,
      fmt::join(granted.plan.intensity, ", "), fmt::join(counts.conversion_time_s, ", "),
      fmt::join(counts.dark_time_s, ", "), fmt::join(numbers, ", "));
}

/// Counts of each frame, a line each.
void print(const char* path) {
  const auto counts = or_give_up(io::read_counts(path)).counts;
  const std::span all(counts.counts), dark(counts.dark);
  const auto frames = static_cast<std::size_t>(counts.frames());
  const auto lit = all.size() / frames, unlit = dark.size() / frames;
  for (std::size_t f = 0; f < frames; ++f)
    fmt::print("{};{}\n", fmt::join(all.subspan(f * lit, lit), ","),
               fmt::join(dark.subspan(f * unlit, unlit), ","));
}

std::size_t handles() {
  std::size_t out = 0;
  for ([[maybe_unused]] const auto& one : std::filesystem::directory_iterator("/proc/self/fd")) ++out;
  return out;
}

void open_and_close(const char* path, int times) {
  const auto before = handles();
  for (int i = 0; i < times; ++i) {
    auto device = or_give_up(open_serial(path));
    if (i % 10 == 0) {
      or_give_up(device->configure(plan(1, 100.0, false, 1.0)));
      or_give_up(device->start());
    }
  }
  fmt::print("{}\n", static_cast<long>(handles()) - static_cast<long>(before));
}

}  // namespace

int main(int count, char** words) {
  const std::string verb = count > 2 ? words[1] : "";
  if (verb == "record" && count == 10) record(words);
  if (verb == "refuse" && count == 5) {
    auto device = or_give_up(open_serial(words[2]));
    (void)or_give_up(device->configure(plan(std::stoi(words[3]), std::stod(words[4]), false, 1.0)));
  }
  if (verb == "open" && count == 4) open_and_close(words[2], std::stoi(words[3]));
  if (verb == "print") print(words[2]);
  if (verb == "hold") {
    const auto device = or_give_up(open_serial(words[2]));
    fmt::print("held\n");
    std::fflush(stdout);
    while (std::getchar() != EOF) {
    }
  }
  return 0;
}
