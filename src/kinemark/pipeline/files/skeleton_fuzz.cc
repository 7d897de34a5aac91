// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Any bytes: a valid skeleton, or what is wrong with them.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kinemark/pipeline/files/skeleton_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinemark;
  const auto file = pipeline::parse_skeleton({reinterpret_cast<const char*>(data), size}, "fuzz.json");
  if (!file) return file.error().message.starts_with("fuzz.json") ? 0 : (std::abort(), 0);
  if (!file->skeleton.validate()) std::abort();
  return 0;
}
