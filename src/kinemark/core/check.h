// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <source_location>
#include <stdexcept>
#include <string>

namespace kinemark {

/// Thrown when the caller violates a precondition (a shape, an index); never for bad files.
class ContractError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

/// Checks a precondition of a public function; active in every build.
inline void check(bool condition, const char* message,
                  const std::source_location& where = std::source_location::current()) {
  if (!condition) [[unlikely]] {
    throw ContractError(std::string(where.file_name()) + ":" + std::to_string(where.line()) + ": " + message);
  }
}

}  // namespace kinemark
