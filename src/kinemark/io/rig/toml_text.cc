// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/rig/toml_text.h"

#include <fmt/core.h>

#include <algorithm>

#include "kinemark/core/utf8.h"
#include "kinemark/io/file.h"

namespace kinemark::io {
namespace {

constexpr std::size_t kReasonCharacters = 200;

/// Walks over a text and measures how deep its keys and brackets go; strings and comments do not count.
class DepthMeter {
 public:
  DepthMeter(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  Status measure() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '#')
        skip_to_line_end();
      else if (c == '"' || c == '\'')
        skip_string(c);
      else
        take(c);
      if (dots_ >= kMostKeyParts) return refuse(fmt::format("a key has more than {} parts", kMostKeyParts));
      if (brackets_ > kMostBrackets)
        return refuse(fmt::format("arrays and tables are nested deeper than {}", kMostBrackets));
    }
    return {};
  }

 private:
  void take(char c) {
    ++at_;
    if (c == '.') ++dots_;
    if (c == '\n') ++line_;
    if (c == '[' || c == '{') ++brackets_;
    if (c == ']' || c == '}') brackets_ = std::max(0, brackets_ - 1);
    // What ends a key or a value.
    if (std::string_view("\n=,[]{}").find(c) != std::string_view::npos) dots_ = 0;
  }

  void skip_to_line_end() { at_ = std::min(text_.find('\n', at_), text_.size()); }

  void skip_string(char quote) {
    const std::string three(3, quote);
    const bool many_lines = text_.substr(at_).starts_with(three);
    at_ += many_lines ? 3 : 1;
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '\n') {
        if (!many_lines) return;  // not closed; the parser says so
        ++line_;
      } else if (c == '\\' && quote == '"') {
        ++at_;
      } else if (c == quote && (!many_lines || text_.substr(at_).starts_with(three))) {
        at_ += many_lines ? 3 : 1;
        return;
      }
    }
    at_ = std::min(at_, text_.size());
  }

  [[nodiscard]] Status refuse(const std::string& what) const {
    return fail(Code::bad_input, fmt::format("{}: line {}: {}; no file of ours does", name_, line_, what));
  }

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
  std::int64_t line_ = 1;
  int dots_ = 0, brackets_ = 0;
};

}  // namespace

Result<toml::table> parse_toml(std::string_view text, const std::string& name) {
  if (text.size() > kMostTomlBytes)
    return fail(Code::bad_input, fmt::format("{}: has {} bytes; at most {} are read as TOML", name,
                                             text.size(), kMostTomlBytes));
  if (auto s = DepthMeter(text, name).measure(); !s) return std::unexpected(s.error());
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    const auto& where = error.source().begin;
    return fail(Code::bad_input, fmt::format("{}: line {}, column {}: {}", name, where.line, where.column,
                                             printable(error.description(), kReasonCharacters)));
  }
}

Result<toml::table> read_toml(const std::filesystem::path& path) {
  const auto text = read_text(path, kMostTomlBytes);
  if (!text) return std::unexpected(text.error());
  return parse_toml(*text, path.string());
}

}  // namespace kinemark::io
