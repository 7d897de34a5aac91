// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Any bytes as a skeleton of Vicon: one whose indices are in range, or one sentence.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kinemark/io/vsk/vsk.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinemark::io;
  const auto vsk = parse_vsk({reinterpret_cast<const char*>(data), size}, "fuzz");
  if (!vsk) {
    const auto& message = vsk.error().message;
    if (message.empty() || message.find('\n') != std::string::npos) std::abort();
    return 0;
  }
  const auto segments = static_cast<int>(vsk->segments.size());
  const auto markers = static_cast<int>(vsk->markers.size());
  for (int s = 0; s < segments; ++s)
    if (const int parent = vsk->segments[static_cast<std::size_t>(s)].parent; parent < -1 || parent >= s)
      std::abort();
  for (const auto& marker : vsk->markers) {
    if (marker.segment < 0 || marker.segment >= segments) std::abort();
    if (marker.x_in_segment && !marker.x_in_segment->allFinite()) std::abort();
  }
  for (const auto& [from, to] : vsk->sticks)
    if (from < 0 || from >= markers || to < 0 || to >= markers) std::abort();
  for (const auto& parameter : vsk->parameters)
    if (parameter.value && !std::isfinite(*parameter.value)) std::abort();
  return 0;
}
