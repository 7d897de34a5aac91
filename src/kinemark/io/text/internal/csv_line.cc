// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/internal/csv_line.h"

#include <algorithm>

#include "kinemark/core/number.h"

namespace kinemark::io::internal {

bool split_csv(std::string_view line, std::vector<std::string>& cells) {
  cells.clear();
  std::size_t i = 0;
  while (true) {
    std::string& cell = cells.emplace_back();
    if (i < line.size() && line[i] == '"') {
      for (++i; i < line.size(); ++i) {
        if (line[i] != '"') {
          cell += line[i];
        } else if (i + 1 < line.size() && line[i + 1] == '"') {
          cell += line[++i];
        } else {
          break;
        }
      }
      if (i >= line.size()) return false;
      ++i;
      while (i < line.size() && line[i] != ',') ++i;
    } else {
      const std::size_t end = std::min(line.find(',', i), line.size());
      cell = trim(line.substr(i, end - i));
      i = end;
    }
    if (i >= line.size()) return true;
    ++i;
  }
}

}  // namespace kinemark::io::internal
