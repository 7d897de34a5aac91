// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Any bytes: a valid layout of segments, which reads back from what is written of it, or what is wrong.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kinemark/pipeline/joints/segments_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinemark;
  const std::vector<std::string> markers{"Ann:S1", "Ann:S2", "Ann:S3", "Ann:F1", "Ann:F2", "Bob:F2", "a\"b"};
  const auto layout =
      pipeline::parse_segments({reinterpret_cast<const char*>(data), size}, "fuzz.toml", markers);
  if (!layout) return layout.error().message.empty() ? std::abort(), 0 : 0;
  if (!layout->validate(static_cast<std::int64_t>(markers.size()))) std::abort();
  const std::string text = pipeline::segments_text(*layout, markers);
  const auto again = pipeline::parse_segments(text, "again.toml", markers);
  if (!again || pipeline::segments_text(*again, markers) != text) std::abort();
  return 0;
}
