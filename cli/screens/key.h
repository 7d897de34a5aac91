// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace kinemark::screens {

/// What was pressed.
struct Key {
  /// `character` has its own; the others are keys of their name, `interrupt` is Ctrl-C.
  enum class Kind : std::uint8_t {
    none,
    character,
    enter,
    escape,
    up,
    down,
    left,
    right,
    backspace,
    interrupt
  };
  Kind kind = Kind::none;  ///< none: nothing in the time waited for, or another size of the terminal
  char32_t character = 0;  ///< of Kind::character
  /// A character's key.
  static Key of(char32_t c) { return {Kind::character, c}; }
  /// Whether it is this character's.
  [[nodiscard]] bool is(char32_t c) const { return kind == Kind::character && character == c; }
};

}  // namespace kinemark::screens
