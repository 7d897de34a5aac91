// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Any bytes: a valid trial or one sentence, never a crash, a hang or memory without bound.
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "kinemark/io/blank_rows.h"
#include "kinemark/io/text/trc.h"
#include "kinemark/io/text_dialect.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text = kinemark::io::without_blank_rows(
      kinemark::io::in_plain_dialect(std::string(reinterpret_cast<const char*>(data), size)));
  const auto trial = kinemark::io::parse_trc(text, "fuzz.trc");
  if (trial ? !trial->validate() : trial.error().message.find('\n') != std::string::npos) std::abort();
  if (trial && trial->markers.x_in_world.size() > 3 * (text.size() / 2 + 1'000'000)) std::abort();
  return 0;
}
