// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The same as the menus in plain lines: where there is no terminal, or one that is too small.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "cli/screens/menu.h"
#include "kinemark/pipeline/desk/desk.h"

namespace kinemark::screens {

/// What came of waiting for a line.
struct TypedLine {
  enum class Kind : std::uint8_t { line, nothing, closed };
  Kind kind = Kind::nothing;  ///< nothing: not within the time; closed: no more will come
  std::string text;           ///< of Kind::line, without its end
};

/// Where lines come from and go to.
struct LineTerminal {
  std::function<TypedLine(int milliseconds)> read;     ///< waits no longer than this; -1: as long as it takes
  std::function<void(const std::string& text)> write;  ///< at once, without a line feed of its own
};

/// Ask for source, set-up and trials, one line each, until `q` or the end of the input; a trial that is
/// recorded then is kept. Empty lines take what stands in brackets. Files of the trials that were kept.
[[nodiscard]] std::vector<std::string> ask_in_lines(pipeline::Desk& desk, const pipeline::Wanted& wanted,
                                                    const LineTerminal& terminal);

}  // namespace kinemark::screens
