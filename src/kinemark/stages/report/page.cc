// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/internal/page.h"

#include "kinemark/core/check.h"
#include "kinemark/core/html_text.h"

namespace kinemark::report::internal {

std::string json_for_html(const nlohmann::ordered_json& json) {
  return json_in_html(json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

std::string fill_page(const nlohmann::ordered_json& json) {
  constexpr std::string_view kOpen = R"(<script type="application/json" id="kinemark-data">)";
  constexpr std::string_view kNothing = "null";
  const std::string_view page = page_template();
  const std::size_t at = page.find(kOpen);
  check(at != std::string_view::npos && page.substr(at + kOpen.size()).starts_with(kNothing),
        "the built page has no place for its data");
  const std::string data = json_for_html(json);
  std::string out;
  out.reserve(page.size() + data.size());
  out += page.substr(0, at + kOpen.size());
  out += data;
  out += page.substr(at + kOpen.size() + kNothing.size());
  return out;
}

}  // namespace kinemark::report::internal
