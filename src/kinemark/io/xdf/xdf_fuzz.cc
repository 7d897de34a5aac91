// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Any bytes as an XDF file: a valid trial or one sentence, never a crash, a hang or memory without bound.
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>

#include "kinemark/io/xdf/xdf.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto trial = kinemark::io::parse_xdf(std::as_bytes(std::span(data, size)), "fuzz");
  if (trial ? !trial->validate() : trial.error().message.find('\n') != std::string::npos) std::abort();
  if (trial && trial->markers.x_in_world.size() > 11 * size) std::abort();
  return 0;
}
