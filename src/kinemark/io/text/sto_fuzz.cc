// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Any bytes: a valid table or one sentence, never a crash, a hang or memory without bound.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kinemark/io/text/table_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto table = kinemark::io::parse_table({reinterpret_cast<const char*>(data), size}, "fuzz.sto");
  if (table ? !table->validate() : table.error().message.find('\n') != std::string::npos) std::abort();
  if (table && table->values.size() > size) std::abort();
  return 0;
}
