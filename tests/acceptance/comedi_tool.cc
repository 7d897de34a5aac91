// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Acquires from a comedi board by stream::Device, as comedi_qemu.py asks, inside its machine.
//
//   comedi_tool SECONDS TIMES STALL_HZ
//
// Sets analog outputs 2 to 7, which the driver comedi_test gives back on its inputs of the same numbers;
// records 8 inputs at 1 kHz for SECONDS, TIMES times; then at STALL_HZ with a reader that stalls for 5 s.
// Prints a line of JSON for each.
#include <comedilib.h>
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "kinemark/stream/comedi/comedi_device.h"

namespace {

using namespace kinemark;
using namespace kinemark::stream;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr const char* kBoard = "/dev/comedi0";
// The driver's wave: 0.1 s, from -1 to 1 V in a range from -10 to 10 V of 15 bits.
constexpr double kWave_s = 0.1, kMiddle = 16383.75, kHeight = 1638.375;

[[noreturn]] void give_up(const Error& error) {
  fmt::print("{{\"error\": \"{}\"}}\n", error.message);
  std::exit(exit_status(error.code));
}

template <class T>
T or_give_up(Result<T> result) {
  if (!result) give_up(result.error());
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

double volts_of(int channel) { return -9.0 + 2.25 * channel; }

/// Largest departure of what the inputs 2 to 7 read, one by one, from what was written to the outputs, V.
double read_back() {
  comedi_t* board = comedi_open(kBoard);
  double worst = 1e9;
  for (unsigned k = 2; k < 8; ++k) {
    lsampl_t code = 0;
    if (comedi_data_read(board, 0, k, 0, AREF_GROUND, &code) < 0) return 1e9;
    const double off = std::abs(code / 65535.0 * 20.0 - 10.0 - volts_of(static_cast<int>(k)));
    worst = k == 2 ? off : std::max(worst, off);
  }
  comedi_close(board);
  return worst;
}

/// What frames showed.
struct Seen {
  std::int64_t frames = 0, lost = 0, misplaced = 0, uneven = 0, gaps = 0;
  bool overflow = false;
  double saw = -1.0;         // of the last frame
  std::int64_t number = -1;  // of the last frame

  /// One frame of 8 inputs: 0 is a saw tooth, 1 a square wave of its height, the others stand in the middle.
  void look(std::int64_t next, const std::int16_t* counts, double rate_hz) {
    misplaced +=
        std::min(std::abs(counts[1] - kMiddle - kHeight), std::abs(counts[1] - kMiddle + kHeight)) > 1.5;
    for (int k = 2; k < 8; ++k) misplaced += std::abs(counts[k] - kMiddle) > 1.5;
    // The tooth climbs by the same step each frame, and by as many steps as frames are missing.
    const double step = 1.0 / (rate_hz * kWave_s);
    if (number >= 0) {
      const double climbed = (counts[0] - saw) / (2.0 * kHeight) - static_cast<double>(next - number) * step;
      uneven += std::abs(climbed - std::round(climbed)) > 0.6 * step + 2.0 / kHeight;
    }
    saw = counts[0];
    number = next;
    ++frames;
  }
};

Seen record(Device& device, double rate_hz, double seconds, double stall_s) {
  ScanPlan plan{.leds = {"rim"},
                .cameras = {"A", "B"},
                .rate_hz = rate_hz,
                .timing = {.conversion_s = 1e-6},
                .intensity = {}};
  const auto granted = or_give_up(device.configure(plan));
  or_give_up(device.start());
  Seen out;
  Block block;
  std::int64_t next = 0;
  const auto frames = static_cast<std::int64_t>(std::llround(seconds * granted.plan.rate_hz));
  while (next < frames) {
    if (or_give_up(device.read(block, milliseconds(5000))) != ReadResult::block)
      give_up({Code::device, "nothing came in 5 s"});
    out.lost += block.first_frame - next;
    out.gaps += block.gap;
    out.overflow |= block.overflow;
    for (std::int64_t f = 0; f < block.frames; ++f)
      out.look(block.first_frame + f, block.counts.data() + 8 * f, granted.plan.rate_hz);
    next = block.first_frame + block.frames;
    if (stall_s > 0.0 && next > frames / 8)
      std::this_thread::sleep_for(std::chrono::duration<double>(std::exchange(stall_s, 0.0)));
  }
  or_give_up(device.stop());
  return out;
}

void print(const char* what, const Seen& seen, double wall_s) {
  fmt::print(
      "{{\"what\": \"{}\", \"frames\": {}, \"last\": {}, \"lost\": {}, \"gaps\": {}, \"overflow\": {}, "
      "\"misplaced\": {}, "
      "\"uneven\": {}, \"wall_s\": {:.3f}}}\n",
      what, seen.frames, seen.number, seen.lost, seen.gaps, seen.overflow, seen.misplaced, seen.uneven,
      wall_s);
}

}  // namespace

int main(int count, char** words) {
  if (count != 4) return 2;
  const double seconds = std::stod(words[1]), stall_hz = std::stod(words[3]);
  const int times = std::stoi(words[2]);
  auto device = or_give_up(open_comedi(kBoard));
  const auto& can = device->capabilities();
  fmt::print(
      "{{\"what\": \"board\", \"name\": \"{}\", \"cameras\": {}, \"outputs\": {}, \"listed\": {}, "
      "\"second\": \"{}\"}}\n",
      can.name, can.cameras, can.analog_outputs, list_comedi().size(), open_comedi(kBoard).error().message);
  for (int k = 2; k < 8; ++k) or_give_up(device->write_analog(k, volts_of(k)));
  const auto refused = device->write_analog(2, 11.0);
  device.reset();
  fmt::print("{{\"what\": \"outputs\", \"worst_v\": {:.6f}, \"beyond\": \"{}\"}}\n", read_back(),
             refused.error().message);
  device = or_give_up(open_comedi(kBoard));
  const auto timed = [&](const char* what, double rate_hz, double for_s, double stall_s) {
    const auto began = steady_clock::now();
    const auto seen = record(*device, rate_hz, for_s, stall_s);
    print(what, seen, std::chrono::duration<double>(steady_clock::now() - began).count());
  };
  for (int i = 0; i < times; ++i) timed("steady", 1000.0, seconds, 0.0);
  timed("stalled", 1000.0, 7.0, 5.0);
  if (stall_hz > 0.0) timed("overrun", stall_hz, 8.0, 5.0);
  return 0;
}
