// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Any bytes: a valid table or one sentence, never a crash, a hang or memory without bound.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kinemark/io/text/marker_table.h"
#include "kinemark/io/text/orientation_table.h"
#include "kinemark/io/text/table_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto table = kinemark::io::parse_table({reinterpret_cast<const char*>(data), size}, "fuzz.sto");
  if (table ? !table->validate() : table.error().message.find('\n') != std::string::npos) std::abort();
  if (table && table->values.size() > size) std::abort();
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  (void)kinemark::io::begins_marker_table(text);
  const auto markers = kinemark::io::parse_marker_table(text, "fuzz.sto");
  if (markers ? !markers->validate() : markers.error().message.find('\n') != std::string::npos) std::abort();
  const auto sensors = kinemark::io::parse_orientations(text, "fuzz.sto");
  if (sensors ? !sensors->validate() : sensors.error().message.find('\n') != std::string::npos) std::abort();
  return 0;
}
