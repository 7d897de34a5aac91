// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Any bytes: a valid trial or one sentence, never a crash, a hang or memory without bound. Both files in one
// input, the skeleton first: a line "%%" stands between them; without it there is no skeleton.
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "kinemark/io/animation/amc.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto between = text.find("%%\n");
  const bool both = between != std::string_view::npos;
  const auto trial = kinemark::io::parse_amc(both ? text.substr(between + 3) : text, "fuzz.amc",
                                             both ? std::optional(text.substr(0, between)) : std::nullopt,
                                             "fuzz.asf", 120.0);
  if (!trial) {
    if (trial.error().message.find('\n') != std::string::npos) std::abort();
    return 0;
  }
  if (!trial->validate()) std::abort();
  if (trial->markers.state.size() > size + 1'000'000) std::abort();
  if (trial->channels.values.size() > 3 * (size + 1'000'000)) std::abort();
  return 0;
}
