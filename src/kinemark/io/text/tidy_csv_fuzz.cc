// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Any bytes: a table whose arrays fit, or one sentence; never a crash, a hang or memory without bound.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kinemark/io/text/tidy_csv.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto table = kinemark::io::parse_tidy_csv({reinterpret_cast<const char*>(data), size}, "fuzz.csv");
  if (!table) {
    if (table.error().message.find('\n') != std::string::npos) std::abort();
    return 0;
  }
  if (table->cells.size() != static_cast<std::size_t>(table->rows() * table->width)) std::abort();
  if (!table->columns.empty() && std::ssize(table->columns) != table->width) std::abort();
  if (const auto value = table->number(table->rows() - 1, table->width - 1);
      !value && value.error().message.find('\n') != std::string::npos)
    std::abort();
  return 0;
}
