// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/serial/rig_answer.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <span>

#include "kinemark/stream/serial/check_sum.h"

namespace kinemark::stream {
namespace {

constexpr std::size_t kCheckDigits = 4;

/// "kind name=value name=value"
RigAnswer parse(std::string_view text) {
  RigAnswer out;
  while (!text.empty()) {
    const auto word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(text.size(), word.size() + 1));
    const auto equals = word.find('=');
    if (equals != std::string_view::npos)
      out.values.insert_or_assign(std::string(word.substr(0, equals)), std::string(word.substr(equals + 1)));
    else if (out.kind.empty())
      out.kind = word;
  }
  return out;
}

/// The text of a line "#text*1234" without its end, when its check is right.
std::optional<std::string_view> checked_text(std::string_view line) {
  if (line.size() < 2 + kCheckDigits || line[line.size() - kCheckDigits - 1] != '*') return std::nullopt;
  const auto text = line.substr(1, line.size() - kCheckDigits - 2);
  if (checked_line(text).substr(0, line.size()) != line) return std::nullopt;
  return text;
}

}  // namespace

std::optional<std::int64_t> RigAnswer::number(std::string_view name) const {
  const auto value = text(name);
  std::int64_t out = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), out);
  if (error != std::errc() || end != value.data() + value.size() || value.empty()) return std::nullopt;
  return out;
}

std::string_view RigAnswer::text(std::string_view name) const {
  const auto at = values.find(name);
  return at == values.end() ? std::string_view() : at->second;
}

std::string checked_line(std::string_view text) {
  const std::span bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  return fmt::format("#{}*{:04X}\n", text, crc16(bytes));
}

std::optional<RigAnswer> find_answer(std::string_view bytes) {
  for (auto end = bytes.find('\n'); end != std::string_view::npos; end = bytes.find('\n', end + 1)) {
    const auto begin = bytes.substr(0, end).rfind('#');
    if (begin == std::string_view::npos) continue;
    const auto text = checked_text(bytes.substr(begin, end - begin));
    if (!text) continue;
    auto out = parse(*text);
    out.end = end + 1;
    return out;
  }
  return std::nullopt;
}

}  // namespace kinemark::stream
