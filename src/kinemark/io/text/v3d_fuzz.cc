// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Any bytes: a valid trial or one sentence, never a crash, a hang or memory without bound.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kinemark/io/text/v3d.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file =
      kinemark::io::parse_v3d({reinterpret_cast<const char*>(data), size}, "fuzz.v3d", {.rate_hz = 179.0});
  if (!file) {
    if (file.error().message.find('\n') != std::string::npos) std::abort();
    return 0;
  }
  if (!file->trial.validate()) std::abort();
  const auto& orientations = file->orientations;
  if (orientations.angles_deg.size() !=
      3 * orientations.names.size() * static_cast<std::size_t>(orientations.frames))
    std::abort();
  if (orientations.frames != file->trial.markers.frames()) std::abort();
  if (file->trial.markers.x_in_world.size() + orientations.angles_deg.size() > 3 * (size / 2 + 1'000'000))
    std::abort();
  return 0;
}
