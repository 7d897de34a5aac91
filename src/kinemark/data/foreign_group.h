// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinemark::data {

/// A named array that a file holds and kinemark does not understand, in the bytes of the file.
struct ForeignParameter {
  std::string name;                ///< as the file spells it
  bool locked = false;             ///< the file asks that it is not changed
  std::int8_t type = -1;           ///< bytes of a number: 1, 2 or 4 (single precision); -1: text
  std::vector<std::uint8_t> dims;  ///< sizes, fastest first; empty: one value
  std::vector<std::byte> values;   ///< as stored, numbers in Intel order
  std::string description;         ///< as stored; at most 255 bytes
};

/// Parameters under one name, carried from a C3D file to the next.
struct ForeignGroup {
  std::string name;                          ///< as the file spells it
  bool locked = false;                       ///< the file asks that it is not changed
  std::string description;                   ///< as stored; at most 255 bytes
  std::vector<ForeignParameter> parameters;  ///< in the order of the file
};

/// A name as groups and parameters are found by it, files differ in the case of letters: upper case, fit to
/// show (name_of_bytes()).
[[nodiscard]] std::string foreign_name(std::string_view stored);

}  // namespace kinemark::data
