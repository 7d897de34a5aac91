// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Lines in which a rig on a serial line answers: "#plan leds=2 period=20000*1A2B".
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace kinemark::stream {

/// One answer whose check is right.
struct RigAnswer {
  std::string kind;                                        ///< "rig", "plan", "start", "stop", "out", "no"
  std::map<std::string, std::string, std::less<>> values;  ///< as written
  std::size_t end = 0;                                     ///< bytes up to and with its line's end

  /// The value as a whole number; nothing when it is absent or none.
  [[nodiscard]] std::optional<std::int64_t> number(std::string_view name) const;
  /// The value; empty when absent.
  [[nodiscard]] std::string_view text(std::string_view name) const;
};

/// The first answer among bytes of which others may be frames, or damaged; nothing when there is no whole
/// one.
[[nodiscard]] std::optional<RigAnswer> find_answer(std::string_view bytes);

/// Text with the check of an answer behind it, as a rig writes it.
[[nodiscard]] std::string checked_line(std::string_view text);

}  // namespace kinemark::stream
