// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Any bytes as an MCAP file of another program: a valid trial or one sentence, never a crash, a hang or
// memory without bound.
#include <cstdint>
#include <cstdlib>

#include "kinemark/io/recording/mcap_markers.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = std::as_bytes(std::span(data, size));
  (void)kinemark::io::is_mcap_of_others({reinterpret_cast<const char*>(data), size});
  const auto trial = kinemark::io::read_mcap_markers(kinemark::io::MemorySource(bytes, "fuzz.mcap"));
  if (trial ? !trial->validate() : trial.error().message.find('\n') != std::string::npos) std::abort();
  return 0;
}
