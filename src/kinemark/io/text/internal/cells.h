// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Lines and cells of a text in memory, without a copy and without an allocation per cell.
#pragma once

#include <fast_float/fast_float.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "kinemark/core/result.h"

namespace kinemark::io::internal {

inline bool is_space(char c) { return c == ' ' || c == '\r' || c == '\v' || c == '\f'; }

/// True when the line holds nothing but blanks and tabs.
inline bool is_blank(std::string_view line) {
  for (const char c : line)
    if (!is_space(c) && c != '\t' && c != '\n') return false;
  return true;
}

/// Walks over the lines of a text. A line ends with \n or \r\n, or with \r where the text holds no \n at all.
/// A byte-order mark of UTF-8 at the start is skipped.
class Lines {
 public:
  explicit Lines(std::string_view text);

  /// The next line without its end; false at the end of the text.
  bool next(std::string_view& line) {
    if (p_ == end_) return false;
    const auto* stop =
        static_cast<const char*>(std::memchr(p_, line_end_, static_cast<std::size_t>(end_ - p_)));
    const char* last = stop == nullptr ? end_ : stop;
    line = std::string_view(p_, static_cast<std::size_t>(last - p_));
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    p_ = stop == nullptr ? end_ : stop + 1;
    ++number_;
    return true;
  }
  /// Number of the line that next() gave last, from 1; 0 before the first.
  [[nodiscard]] std::int64_t number() const { return number_; }
  /// How many lines follow before a blank one or the end of the text.
  [[nodiscard]] std::int64_t count_until_blank() const;
  /// Go on to the next line that is not blank; its number, or 0 where there is none.
  std::int64_t skip_blank();

 private:
  const char* p_;
  const char* end_;
  char line_end_ = '\n';
  std::int64_t number_ = 0;
};

/// Refuses lines over 1 MiB (about 100,000 names): cells of a header are kept one by one, which takes many
/// times the memory of their text.
[[nodiscard]] Status check_header_line(std::string_view line, std::int64_t number);

/// How cells are separated: by single tabs (cells may be blank), or by runs of blanks.
enum class Separator : std::uint8_t { tab, blanks };

enum class Cell : std::uint8_t {
  number,  ///< a number, NaN and infinity included
  blank,   ///< nothing between two tabs
  text,    ///< anything else
  none,    ///< the line holds no further cell
};

/// The numbers that fast_float does not read: a leading +, what old C libraries print for NaN and
/// infinity ("1.#QNAN", "-1.#IND00", "1.#INF"), and words for a number that is not there ("NA", "#N/A",
/// "None", "null", "-"), which are NaN.
[[nodiscard]] bool parse_odd_number(std::string_view cell, double& value);

/// ASCII letters in lower case.
[[nodiscard]] std::string lower(std::string_view text);

/// The first 40 characters of a cell for a message, whatever is not printable ASCII shown as '?'.
[[nodiscard]] std::string excerpt(std::string_view cell);

/// How one row is separated whose file usually separates cells as `usual`: people and programs mix both. In
/// blanks where it holds no tab, or a blank between two cells that are no blanks.
[[nodiscard]] Separator separator_of_row(std::string_view row, Separator usual);

/// Walks over the cells of one line.
class Cells {
 public:
  Cells(std::string_view line, Separator separator)
      : p_(line.data()), end_(line.data() + line.size()), tabs_(separator == Separator::tab) {}

  /// Read the next cell as a number into `value`, which is written only when Cell::number comes back.
  Cell next(double& value) {
    if (!begin_cell()) return Cell::none;
    if (p_ == end_ || *p_ == '\t') return finish_blank();
    const auto [stop, error] = fast_float::from_chars(p_, end_, value);
    const char* after = stop;
    while (after != end_ && is_space(*after)) ++after;
    const bool whole = after == end_ || *after == '\t' || (!tabs_ && after != stop);
    if (!whole || (error != std::errc() && error != std::errc::result_out_of_range)) return next_odd(value);
    text_ = std::string_view(p_, static_cast<std::size_t>(stop - p_));
    p_ = after;
    finish_cell();
    return Cell::number;
  }
  /// Take the next cell as it is, without blanks at its ends; false when the line holds no further cell.
  bool next_text(std::string_view& text);
  /// Text of the cell read last, without blanks at its ends.
  [[nodiscard]] std::string_view text() const { return text_; }

 private:
  bool begin_cell() {
    if (done_) return false;
    while (p_ != end_ && (is_space(*p_) || (!tabs_ && *p_ == '\t'))) ++p_;
    // Runs of blanks end with the last cell; after a tab follows one more.
    return tabs_ || p_ != end_;
  }
  Cell finish_blank() {
    text_ = {};
    finish_cell();
    return Cell::blank;
  }
  void finish_cell() {
    if (p_ == end_)
      done_ = true;
    else if (tabs_)
      ++p_;
  }
  Cell next_odd(double& value);

  const char* p_;
  const char* end_;
  bool tabs_;
  bool done_ = false;
  std::string_view text_;
};

}  // namespace kinemark::io::internal
