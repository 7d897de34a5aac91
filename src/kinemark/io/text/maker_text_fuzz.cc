// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Any bytes, read as each maker's export: a valid trial or one sentence, never a crash, a hang or memory
// without bound.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kinemark/io/text/camera_makers.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto which = kinemark::io::maker_text_of(text);
  if (!which) return 0;
  const auto trial = kinemark::io::parse_maker_text(text, "fuzz", *which);
  if (trial ? !trial->validate() : trial.error().message.find('\n') != std::string::npos) std::abort();
  if (trial && trial->markers.x_in_world.size() > 3 * (size / 2 + 1'000'000)) std::abort();
  return 0;
}
