// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/clock_time.h"

#include <chrono>
#include <cmath>

#include "kinemark/core/number.h"

namespace kinemark::io {
namespace {

constexpr std::size_t kLongest = 48;  // characters

bool is_clock_digit(char c) { return c >= '0' && c <= '9'; }

/// Reads from the left, and forgets what it has read.
class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text) {}

  [[nodiscard]] bool done() const { return text_.empty(); }
  /// One of these characters.
  bool take(std::string_view any) {
    if (text_.empty() || any.find(text_.front()) == std::string_view::npos) return false;
    text_.remove_prefix(1);
    return true;
  }
  /// A whole number of so many digits.
  std::optional<int> take_number(std::size_t fewest, std::size_t most) {
    std::size_t digits = 0;
    int value = 0;
    for (; digits < text_.size() && digits < most && is_clock_digit(text_[digits]); ++digits)
      value = 10 * value + (text_[digits] - '0');
    if (digits < fewest) return std::nullopt;
    text_.remove_prefix(digits);
    return value;
  }
  /// Digits behind a point or comma, as a part of one; `resolution` is that of the last.
  double take_part(double& resolution) {
    resolution = 1.0;
    if (text_.size() < 2 || !is_clock_digit(text_[1]) || !take(".,")) return 0.0;
    double value = 0.0;
    for (; !text_.empty() && is_clock_digit(text_.front()); text_.remove_prefix(1)) {
      value = 10.0 * value + (text_.front() - '0');
      resolution /= 10.0;
    }
    return value * resolution;
  }

 private:
  std::string_view text_;
};

/// "2024-05-01T" or "2024/05/01 ", if it begins so.
std::optional<std::int64_t> take_date(Reader& reader) {
  Reader ahead = reader;
  const auto year = ahead.take_number(4, 4);
  if (!year || !ahead.take("-/")) return std::nullopt;
  const auto month = ahead.take_number(1, 2);
  if (!month || !ahead.take("-/")) return std::nullopt;
  const auto day = ahead.take_number(1, 2);
  if (!day || !ahead.take("Tt ")) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year{*year},
                                         std::chrono::month{static_cast<unsigned>(*month)},
                                         std::chrono::day{static_cast<unsigned>(*day)}};
  if (!date.ok()) return std::nullopt;
  reader = ahead;
  return std::chrono::sys_days{date}.time_since_epoch().count();
}

/// Seconds east of Greenwich of "Z", "+02:00", "-0530" or nothing; nothing at all of anything else.
std::optional<double> take_zone(Reader& reader) {
  if (reader.done()) return 0.0;
  if (reader.take("Zz")) return reader.done() ? std::optional(0.0) : std::nullopt;
  const bool east = reader.take("+");
  if (!east && !reader.take("-")) return std::nullopt;
  const auto hours = reader.take_number(2, 2);
  reader.take(":");
  const auto minutes = reader.done() ? std::optional(0) : reader.take_number(2, 2);
  if (!hours || !minutes || !reader.done()) return std::nullopt;
  return (east ? 60.0 : -60.0) * (60 * *hours + *minutes);
}

}  // namespace

std::optional<ClockTime> parse_clock_time(std::string_view text) {
  text = trim(text);
  if (text.size() > kLongest || text.find(':') == std::string_view::npos) return std::nullopt;
  Reader reader(text);
  ClockTime out;
  const auto date = take_date(reader);
  const auto first = reader.take_number(1, 2);
  if (!first || !reader.take(":")) return std::nullopt;
  const auto second = reader.take_number(2, 2);
  if (!second) return std::nullopt;
  const bool has_hours = reader.take(":");
  const auto third = has_hours ? reader.take_number(2, 2) : std::optional(0);
  if (!third) return std::nullopt;
  // Minutes and seconds alone have a part of a second.
  const int hours = has_hours ? *first : 0, minutes = has_hours ? *second : *first;
  const int seconds = has_hours ? *third : *second;
  if (hours > 24 || minutes > 59 || seconds > 60) return std::nullopt;
  const double part = reader.take_part(out.resolution_s);
  if (!has_hours && (date || out.resolution_s == 1.0)) return std::nullopt;
  const auto zone = take_zone(reader);
  if (!zone) return std::nullopt;
  out.day = date.value_or(0);
  out.second = 3600.0 * hours + 60.0 * minutes + seconds + part - *zone;
  return out;
}

}  // namespace kinemark::io
