// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Any bytes as channels.tsv, motion.json and motion.tsv, one after the other with zero bytes between: a valid
// trial or one sentence, never a crash, a hang or memory without bound.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kinemark/io/bids/motion_bids.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto take = [&] {
    const auto end = text.find('\0');
    const auto part = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    return part;
  };
  const auto channels = take(), json = take();
  const auto trial = kinemark::io::parse_motion_bids({.motion = text, .channels = channels, .json = json});
  if (trial ? !trial->validate() : trial.error().message.find('\n') != std::string::npos) std::abort();
  if (trial && trial->markers.x_in_world.size() > size) std::abort();
  return 0;
}
