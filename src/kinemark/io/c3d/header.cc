// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/c3d/header.h"

#include <algorithm>

#include "kinemark/io/c3d/parameters.h"

namespace kinemark::io {
namespace {

// Byte offsets. Words in c3d.org's tables count from 1: word w begins at byte 2 (w - 1).
constexpr std::size_t kEventKey = 298;  // 12345: labels have four letters
constexpr std::size_t kEventCount = 300;
constexpr std::size_t kEventTimes = 304;
constexpr std::size_t kEventFlags = 376;
constexpr std::size_t kEventLabels = 396;
constexpr int kMaxEvents = 18;
constexpr std::uint16_t kKey = 12345;

}  // namespace

bool is_c3d_header(std::span<const std::byte, kC3dBlock> block) { return block[1] == std::byte{0x50}; }

C3dHeader parse_header(std::span<const std::byte, kC3dBlock> block, Processor processor) {
  const auto u16 = [&](std::size_t at) { return static_cast<int>(load_u16(block.data() + at, processor)); };
  const auto f32 = [&](std::size_t at) { return load_f32(block.data() + at, processor); };
  C3dHeader h;
  h.parameter_block = std::to_integer<int>(block[0]);
  h.points = u16(2);
  h.analog_per_frame = u16(4);
  h.first_frame = u16(6);
  h.last_frame = u16(8);
  h.max_gap_frames = u16(10);
  h.scale = f32(12);
  h.data_block = u16(16);
  h.samples_per_frame = u16(18);
  h.rate_hz = f32(20);
  if (u16(kEventKey) != kKey) return h;
  const int events = u16(kEventCount) <= kMaxEvents ? u16(kEventCount) : 0;
  for (int i = 0; i < events; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const auto* label = reinterpret_cast<const char*>(block.data()) + kEventLabels + 4 * k;
    const float time_s = f32(kEventTimes + 4 * k);
    if (!std::isfinite(time_s)) continue;
    h.events.push_back(
        {.label = clean_text({label, 4}), .time_s = time_s, .shown = block[kEventFlags + k] != std::byte{0}});
  }
  return h;
}

std::array<std::byte, kC3dBlock> encode_header(const C3dHeader& header, Processor processor) {
  std::array<std::byte, kC3dBlock> block{};
  const auto u16 = [&](std::size_t at, int value) {
    store_u16(block.data() + at, static_cast<std::uint16_t>(value), processor);
  };
  const auto f32 = [&](std::size_t at, float value) { store_f32(block.data() + at, value, processor); };
  block[0] = static_cast<std::byte>(header.parameter_block);
  block[1] = std::byte{0x50};
  u16(2, header.points);
  u16(4, header.analog_per_frame);
  u16(6, header.first_frame);
  u16(8, header.last_frame);
  u16(10, header.max_gap_frames);
  f32(12, header.scale);
  u16(16, header.data_block);
  u16(18, header.samples_per_frame);
  f32(20, header.rate_hz);
  u16(kEventKey, kKey);
  const std::size_t events = std::min<std::size_t>(header.events.size(), kMaxEvents);
  u16(kEventCount, static_cast<int>(events));
  for (std::size_t i = 0; i < events; ++i) {
    const C3dHeaderEvent& event = header.events[i];
    std::string label = event.label;
    label.resize(4, ' ');
    f32(kEventTimes + 4 * i, static_cast<float>(event.time_s));
    block[kEventFlags + i] = std::byte{event.shown};
    std::memcpy(block.data() + kEventLabels + 4 * i, label.data(), 4);
  }
  return block;
}

}  // namespace kinemark::io
