// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Any bytes as what a rig says: frames whose counts are counts and whose numbers go up, answers that agree
// with their check; never a crash, a hang or memory without bound. The first byte chooses the shape and in
// what portions the rest comes.
#include <cstdint>
#include <cstdlib>

#include "kinemark/stream/serial/frame_decoder.h"
#include "kinemark/stream/serial/rig_plan.h"

namespace {

using namespace kinemark::stream;

void decode(std::span<const std::uint8_t> bytes, FrameShape shape, std::size_t portion) {
  FrameDecoder decoder(shape);
  SerialFrame frame;
  std::int64_t last = -1, frames = 0;
  for (std::size_t at = 0; at < bytes.size(); at += portion) {
    decoder.push(bytes.subspan(at, std::min(portion, bytes.size() - at)));
    while (decoder.next(frame)) {
      if (frame.number <= last) std::abort();
      last = frame.number;
      ++frames;
      for (const auto count : frame.counts)
        if (count < 0 || count > 1023) std::abort();
    }
  }
  if (decoder.losses().lost != last + 1 - frames) std::abort();
}

void answer(std::string_view text) {
  const auto found = find_answer(text);
  if (!found) return;
  if (found->end > text.size()) std::abort();
  const ScanPlan plan{
      .leds = {"a", "b"}, .cameras = {"A", "B"}, .rate_hz = 0.0, .timing = {}, .intensity = {}};
  SerialRigFacts facts{.name = "rig", .version = "1", .leds = 8, .cameras = 2, .bits = 10, .clock_hz = 2e6};
  if (const auto said = serial_facts(*found)) facts = *said;
  (void)plan_command(plan, facts);
  const auto granted = granted_plan(plan, *found, facts);
  if (granted && !granted->layout.validate()) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::span bytes(data + 1, size - 1);
  decode(bytes, {.slots = 1 + (data[0] & 7), .cameras = 1 + (data[0] >> 3 & 1)}, 1U + (data[0] >> 4) * 7U);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  answer(text);
  answer(checked_line(text.substr(0, text.find('\n'))));
  return 0;
}
