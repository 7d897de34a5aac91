// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// What the enumerators of an enum are called in files, options and messages.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "kinemark/core/result.h"

namespace kinemark {

/// The error of a name that is none: "there is no `what` 'name'; there are a, b and c".
[[nodiscard]] std::unexpected<Error> unknown_name(Code code, std::string_view what, std::string_view name,
                                                  std::span<const std::string_view> known);

/// Names of the enumerators from 0 to `kLast`, in their order; another number of names does not compile.
///
///   constexpr EnumNames<JointKind::hinge> kJointKinds{"ball", "hinge"};
template <auto kLast>
class EnumNames {
 public:
  using Enum = decltype(kLast);                                               ///< the enumeration
  static constexpr std::size_t kCount = static_cast<std::size_t>(kLast) + 1;  ///< number of enumerators

  /// Names as they are written, one for each enumerator.
  template <class... Names>
    requires(sizeof...(Names) == kCount)
  consteval explicit EnumNames(Names... names) : names_{names...} {}

  /// "unknown" of a number that is no enumerator.
  [[nodiscard]] constexpr std::string_view operator[](Enum value) const {
    const auto i = static_cast<std::size_t>(value);
    return i < kCount ? names_[i] : "unknown";
  }
  /// Letter by letter.
  [[nodiscard]] constexpr std::optional<Enum> find(std::string_view name) const {
    const auto found = std::ranges::find(names_, name);
    if (found == names_.end()) return std::nullopt;
    return static_cast<Enum>(found - names_.begin());
  }
  /// find(), or the error of unknown_name().
  /// @param what  what the enum is, for the message: "filter"
  [[nodiscard]] Result<Enum> parse(std::string_view name, std::string_view what,
                                   Code code = Code::usage) const {
    if (const auto found = find(name)) return *found;
    return unknown_name(code, what, name, names_);
  }

 private:
  std::array<std::string_view, kCount> names_;
};

}  // namespace kinemark
