// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/nwb/internal/names.h"

#include <fmt/core.h>

#include <set>

namespace kinemark::io::internal {

std::vector<std::string> series_names(const std::vector<std::string>& markers) {
  std::vector<std::string> out;
  std::set<std::string> used;
  for (const std::string& marker : markers) {
    std::string name;
    for (const char c : marker) {
      const bool control = static_cast<unsigned char>(c) < ' ' || c == '\x7f';
      name += control || c == '/' || c == ':' || c == '\\' ? '_' : c;
    }
    // "." means the group itself.
    if (name == "." || name == "..") name = "_" + name;
    std::string unique = name;
    for (int suffix = 2; !used.insert(unique).second; ++suffix) unique = fmt::format("{}_{}", name, suffix);
    out.push_back(std::move(unique));
  }
  return out;
}

}  // namespace kinemark::io::internal
