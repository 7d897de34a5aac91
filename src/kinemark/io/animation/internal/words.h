// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::io::animation {

/// Lines of a text that hold something, without blanks at their ends. A line ends with \n, \r\n or \r; a
/// byte-order mark is passed over.
class TextLines {
 public:
  explicit TextLines(std::string_view text);

  /// The next line that is not blank; false at the end.
  bool next(std::string_view& line);
  /// The line that next() will give; empty at the end.
  [[nodiscard]] std::string_view peek() const;
  [[nodiscard]] std::int64_t number() const { return number_; }  ///< of the line given last, from 1
  [[nodiscard]] std::size_t bytes_left() const { return text_.size(); }

 private:
  std::string_view text_;
  std::int64_t number_ = 0;
};

/// Takes the first word, between blanks, from `line`; empty when there is none.
std::string_view take_word(std::string_view& line);

/// ASCII letters in lower case.
[[nodiscard]] std::string in_lower_case(std::string_view text);

/// For a message: in quotes, the first 40 characters.
[[nodiscard]] std::string in_quotes(std::string_view text);

/// "line N: what"; Code::bad_input.
[[nodiscard]] std::unexpected<Error> fail_in_line(std::int64_t number, const std::string& what);

/// Takes a word that must be a finite number. `what` it is, for the message: "x of the offset".
[[nodiscard]] Result<double> take_number(std::string_view& line, std::int64_t number, std::string_view what);

}  // namespace kinemark::io::animation
