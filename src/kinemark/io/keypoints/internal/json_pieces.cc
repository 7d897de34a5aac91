// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/keypoints/internal/json_pieces.h"

#include <fmt/core.h>

#include <algorithm>
#include <string>

namespace kinemark::io::internal {
namespace {

using Json = nlohmann::json;
using Event = Json::parse_event_t;

constexpr int kMostLevels = 32;

/// The text with null in place of each NaN outside strings; empty where there is none.
std::string with_null_for_nan(std::string_view text) {
  std::string out;
  if (text.find("NaN") == std::string_view::npos) return out;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (!quoted && text.substr(i).starts_with("NaN")) {
      out += "null";
      i += 2;
      continue;
    }
    out += text[i];
    if (quoted && text[i] == '\\' && i + 1 < text.size())
      out += text[++i];
    else if (text[i] == '"')
      quoted = !quoted;
  }
  return out;
}

/// Finds the pieces while the text is parsed, hands each over and lets it go.
class Pieces {
 public:
  explicit Pieces(const TakePiece& take) : take_(take) {}

  /// Called by the parser; false lets the value go.
  bool event(int depth, Event event, const Json& value) {
    if (!status_) return false;
    switch (event) {
      case Event::key:
        if (depth != 1) return true;
        key_ = value.get_ref<const std::string&>();
        below_is_array_ = false;
        return true;
      case Event::array_start:
      case Event::object_start:
        if (depth > kMostLevels)
          status_ = fail(Code::bad_input, fmt::format("has more than {} levels", kMostLevels));
        else if (depth == 0)
          outermost_is_array_ = event == Event::array_start;
        else if (depth == 1)
          below_is_array_ = event == Event::array_start && !outermost_is_array_;
        return status_.has_value();
      case Event::array_end:
      case Event::object_end:
      case Event::value:
        // What is less deep has given its pieces away.
        return depth != piece_depth() ? depth > piece_depth() : give(value);
    }
    return true;
  }
  [[nodiscard]] const Status& status() const { return status_; }

 private:
  [[nodiscard]] int piece_depth() const { return below_is_array_ ? 2 : 1; }
  bool give(const Json& piece) {
    status_ = take_(key_, piece);
    return false;
  }

  const TakePiece& take_;
  Status status_;
  std::string key_;
  bool outermost_is_array_ = false, below_is_array_ = false;
};

}  // namespace

Status read_pieces(std::string_view text, const TakePiece& take) {
  const std::string without_nan = with_null_for_nan(text);
  if (!without_nan.empty()) text = without_nan;
  Pieces pieces(take);
  try {
    // What the parser keeps is empty: every piece has gone.
    [[maybe_unused]] const Json empty = Json::parse(
        text, [&](int depth, Event event, Json& value) { return pieces.event(depth, event, value); });
  } catch (const Json::parse_error& e) {
    const auto before = text.substr(0, std::min<std::size_t>(e.byte, text.size()));
    if (pieces.status())
      return fail(Code::bad_input, fmt::format("line {}: is no JSON", 1 + std::ranges::count(before, '\n')));
  } catch (const Json::exception&) {
    if (pieces.status()) return fail(Code::bad_input, "holds a number that is too large");
  }
  return pieces.status();
}

}  // namespace kinemark::io::internal
