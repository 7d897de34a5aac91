// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/json_text.h"

#include <fmt/core.h>

#include <string_view>

namespace kinemark::pipeline {

std::string json_text(const nlohmann::ordered_json& json) {
  const std::string raw = json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  // JSON allows DEL and the controls from U+0080 to U+009F as they are; a terminal obeys them.
  const auto is_c1 = [&](std::size_t i) {
    return raw[i] == '\xC2' && i + 1 < raw.size() && static_cast<unsigned char>(raw[i + 1]) < 0xA0;
  };
  std::string out;
  out.reserve(raw.size());
  for (std::size_t i = 0; i < raw.size(); ++i) {
    if (raw[i] == '\x7F')
      out += "\\u007f";
    else if (is_c1(i))
      out += fmt::format("\\u00{:02x}", static_cast<int>(static_cast<unsigned char>(raw[++i])));
    else
      out += raw[i];
  }
  return out;
}

}  // namespace kinemark::pipeline
