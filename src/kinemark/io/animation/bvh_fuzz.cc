// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Any bytes: a valid trial or one sentence, never a crash, a hang or memory without bound.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kinemark/io/animation/bvh.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto trial = kinemark::io::parse_bvh({reinterpret_cast<const char*>(data), size}, "fuzz.bvh");
  if (!trial) {
    if (trial.error().message.find('\n') != std::string::npos) std::abort();
    return 0;
  }
  if (!trial->validate()) std::abort();
  if (trial->markers.state.size() > size + 1'000'000) std::abort();
  return 0;
}
