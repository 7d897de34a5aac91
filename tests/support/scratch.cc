// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "support/scratch.h"

#include <cstdlib>
#include <stdexcept>

namespace kinemark::testing_support {

ScratchFolder::ScratchFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "kinemark-test-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("cannot make a scratch folder");
  path_ = pattern;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

int ScratchFolder::count_files() const {
  int n = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(path_)) n += entry.is_regular_file();
  return n;
}

}  // namespace kinemark::testing_support
