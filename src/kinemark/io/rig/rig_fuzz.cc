// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Any bytes: a valid rig, which reads back from what is written of it, or one sentence.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kinemark/io/rig/rig_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto rig = kinemark::io::parse_rig({reinterpret_cast<const char*>(data), size}, "fuzz.toml");
  if (!rig) {
    if (rig.error().message.find('\n') != std::string::npos) std::abort();
    return 0;
  }
  if (!rig->validate()) std::abort();
  const std::string text = kinemark::io::format_rig(*rig);
  const auto again = kinemark::io::parse_rig(text, "again.toml");
  if (!again || kinemark::io::format_rig(*again) != text) std::abort();
  return 0;
}
