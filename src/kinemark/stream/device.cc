// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/device.h"

#include <fmt/core.h>

namespace kinemark::stream {

std::vector<std::string> own_names(const std::vector<std::string>& given, int count, bool cameras) {
  std::vector<std::string> out;
  for (int i = 0; i < count; ++i) {
    if (i < static_cast<int>(given.size()))
      out.push_back(given[static_cast<std::size_t>(i)]);
    else
      out.push_back(cameras && i < 26 ? std::string(1, static_cast<char>('A' + i))
                                      : fmt::format("{}", i + 1));
  }
  return out;
}

}  // namespace kinemark::stream
