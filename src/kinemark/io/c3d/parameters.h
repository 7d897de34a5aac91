// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/foreign_group.h"
#include "kinemark/io/c3d/number_format.h"

namespace kinemark::io {

/// How a parameter's values are stored; the value is the byte in the file.
enum class C3dType : std::int8_t { text = -1, byte = 1, int16 = 2, float32 = 4 };

/// One named array of a C3D file.
///
/// `dims` runs fastest first, as the file stores it; no dims: a single number. For text dims[0] is the width
/// of each text and `texts` holds the others' product of them, trimmed. 16-bit integers are signed in
/// `numbers`.
struct C3dParameter {
  std::string name;                ///< upper case
  C3dType type = C3dType::int16;   ///< how the file stores it
  std::vector<int> dims;           ///< sizes, fastest first; empty: one number
  std::vector<double> numbers;     ///< empty for text
  std::vector<std::string> texts;  ///< UTF-8; empty for numbers
  std::string description;         ///< the file's own words; may be empty
  bool locked = false;             ///< the file asks that it is not changed
  data::ForeignParameter stored;   ///< the same as read; empty in what is to be written
};

/// Parameters under one name.
struct C3dGroup {
  std::string name;                      ///< upper case; "GROUP n" when the file names none
  std::string description;               ///< the file's own words; may be empty
  std::vector<C3dParameter> parameters;  ///< in the order of the file
  data::ForeignGroup stored;             ///< the same as read, without its parameters
};

/// The parameter section of a C3D file, in file order.
struct C3dParameters {
  std::vector<C3dGroup> groups;  ///< in the order of the file

  /// The first parameter of that name (any case), or null.
  [[nodiscard]] const C3dParameter* find(std::string_view group, std::string_view name) const;
  /// Whether there is a group of that name, in any case of letters.
  [[nodiscard]] bool has_group(std::string_view group) const;
  /// First number of a parameter, or nothing when it is absent, text or empty.
  [[nodiscard]] std::optional<double> number(std::string_view group, std::string_view name) const;
  /// First text of a parameter, or empty.
  [[nodiscard]] std::string text(std::string_view group, std::string_view name) const;
  /// All numbers or texts of NAME, NAME2, NAME3, ... in a row: a C3D dimension ends at 255, so longer lists
  /// go on in numbered parameters.
  [[nodiscard]] std::vector<double> numbers(std::string_view group, std::string_view name) const;
  /// All texts of NAME, NAME2, NAME3, ... in a row.
  [[nodiscard]] std::vector<std::string> texts(std::string_view group, std::string_view name) const;

  /// The group of that name, made when absent.
  C3dGroup& group(std::string_view name);
};

/// Read a parameter section, from its four-byte head to its end. Never fails: what cannot be read is left out
/// and reported in `warnings`. Entries are found by their pointers, which real files get right more often
/// than lengths; each holds at most the bytes up to the next one, so time and memory are bounded by the
/// section.
[[nodiscard]] C3dParameters parse_parameters(std::span<const std::byte> section, Processor processor,
                                             std::vector<std::string>& warnings);

/// The section's bytes, a whole number of 512-byte blocks. Values are taken from `numbers` or `texts` and
/// must fit `dims`; `foreign` groups follow as they are, 120 at most, those of a name that is written with
/// the parameters that are not. More than 255 blocks is
/// Code::not_supported.
[[nodiscard]] Result<std::vector<std::byte>> encode_parameters(
    const C3dParameters& parameters, Processor processor, std::span<const data::ForeignGroup> foreign = {});

/// Text as a file holds it, made fit to show: control characters become blanks, blanks at both ends go, and
/// bytes that are not UTF-8 are taken as Latin-1.
[[nodiscard]] std::string clean_text(std::string_view raw);

}  // namespace kinemark::io
