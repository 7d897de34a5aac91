// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Any bytes: points of whole frames or one sentence, never a crash, a hang or memory without bound.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kinemark/io/text/keypoints_csv.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto read =
      kinemark::io::parse_keypoints_csv({reinterpret_cast<const char*>(data), size}, "fuzz.csv");
  if (!read) {
    if (read.error().message.find('\n') != std::string::npos) std::abort();
    return 0;
  }
  if (read->frames() < 1 || read->image.size() > 20 * size + 100'000) std::abort();
  for (std::size_t i = 0; i < read->image.size(); i += 2)
    if (std::isnan(read->image[i]) != std::isnan(read->image[i + 1])) std::abort();
  return 0;
}
