// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Any bytes: a valid trial or one sentence, never a crash, a hang or memory without bound.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kinemark/io/text/trajectories_csv.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  for (const std::string_view unit : {"", "mm"}) {  // with one, columns are other people's
    const auto trial =
        kinemark::io::parse_trajectories_csv({reinterpret_cast<const char*>(data), size}, "fuzz.csv", unit);
    if (trial ? !trial->validate() : trial.error().message.find('\n') != std::string::npos) std::abort();
    if (trial && trial->markers.state.size() > 4 * size + 1'000'000) std::abort();
  }
  return 0;
}
