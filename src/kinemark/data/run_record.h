// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What the record of any run says: the files that its result depends on, and the bounds that it had to meet.
#pragma once

#include <cstdint>
#include <string>

namespace kinemark::data {

/// A file that a result depends on.
struct InputFile {
  std::string role;        ///< "model", "markers", "tasks", ...
  std::string path;        ///< as the user gave it
  std::int64_t bytes = 0;  ///< size
  std::string hash;        ///< hexadecimal digits, lower case
  std::string hash_kind;   ///< "XXH3-64"
};

/// A quality bound that a run had to meet.
struct Gate {
  std::string name;      ///< "marker_rms"
  bool passed = true;    ///< false: the run ends with exit status 1
  double value = 0.0;    ///< what was reached, in `unit`
  double bound = 0.0;    ///< what was asked, in `unit`
  std::string unit;      ///< "mm", "%", ...
  std::string sentence;  ///< for people: what was compared and what to do when it failed
};

}  // namespace kinemark::data
