// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/served_page.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/core/html_text.h"
#include "kinemark/core/utf8.h"
#include "kinemark/core/version.h"
#include "kinemark/pipeline/files/info_json.h"
#include "kinemark/pipeline/files/json_text.h"
#include "server/embedded.h"

namespace kinemark::server {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kTextLetters = 300;

/// "rate_hz" as people read it: "rate, Hz".
std::string title_of(std::string key) {
  constexpr std::array<std::array<std::string_view, 2>, 3> kUnits = {
      {{"_hz", ", Hz"}, {"_s", ", s"}, {"_kg", ", kg"}}};
  for (const auto& [suffix, unit] : kUnits)
    if (key.ends_with(suffix)) key.replace(key.size() - suffix.size(), suffix.size(), unit);
  std::ranges::replace(key, '_', ' ');
  return key;
}

/// A name, a channel's properties, or a number, as text.
std::string value_text(const Json& value) {
  if (value.is_string()) return printable(value.get<std::string>(), kTextLetters);
  if (value.is_null()) return "not known";
  if (!value.is_object()) return value.dump();
  std::string text;
  for (const auto& [key, part] : value.items()) {
    const auto word = value_text(part);
    if (word.empty()) continue;
    const bool is_name = key == "name" || key == "kind" || key == "unit";
    text += (text.empty() ? "" : ", ") + (is_name ? word : title_of(key) + " " + word);
  }
  return text;
}

/// The page of viewer/ with `text` in each place of `mark`; it has one at least.
std::string filled(std::string_view page, std::string_view mark, std::string_view text) {
  std::string out;
  check(page.find(mark) != std::string_view::npos, "the page of viewer/ has no place for what is filled in");
  for (auto at = page.find(mark); at != std::string_view::npos; at = page.find(mark)) {
    out.append(page.substr(0, at)).append(text);
    page.remove_prefix(at + mark.size());
  }
  return out.append(page);
}

std::string fill(const Json& json, std::string_view root) {
  const auto page = filled(served_html(), "@root@", root);
  return filled(page, ">null<", ">" + json_in_html(pipeline::json_text(json)) + "<");
}

Json summary_of(const char* schema, std::string_view root) {
  return {{"schema", schema}, {"schema_version", 1}, {"version", kVersion}, {"root", root}};
}

Json printable_sentences(const std::vector<std::string>& sentences) {
  Json out = Json::array();
  for (const auto& sentence : sentences) out.push_back(printable_sentence(sentence));
  return out;
}

}  // namespace

std::optional<Response> served_file(std::string_view target) {
  const auto file = [](const char* type, std::string_view text) {
    return Response{.type = type, .body = std::make_shared<const std::string>(text)};
  };
  if (target == "/style.css") return file("text/css; charset=utf-8", style_css());
  if (target == "/list.css") return file("text/css; charset=utf-8", list_css());
  if (target == "/list.js") return file("text/javascript; charset=utf-8", list_js());
  return std::nullopt;
}

Json trials_json(const std::vector<TrialRow>& rows, const std::vector<std::string>& notes) {
  Json trials = Json::array();
  for (const auto& row : rows) trials.push_back(row_json(row));
  return {{"trials", std::move(trials)}, {"notes", printable_sentences(notes)}};
}

std::string trials_page(const std::vector<TrialRow>& rows, const std::vector<std::string>& notes,
                        std::string_view root) {
  return fill({{"summary", summary_of("kinemark.trials", root)}, {"list", trials_json(rows, notes)}}, root);
}

std::string facts_page(const pipeline::InfoOutcome& info, std::string_view root) {
  // Through text, so that what is no UTF-8 is none in the page either.
  const auto json = Json::parse(pipeline::json_text(pipeline::info_json(info)));
  auto summary = summary_of("kinemark.facts", root);
  summary["trial"] = printable(info.file.filename().string(), kTextLetters);
  summary["kind"] = value_text(json["kind"]);
  Json facts = Json::array(), lists = Json::array();
  for (const auto& [key, value] : json.items()) {
    if (key == "warnings" || key == "contradicted" || key == "kind" || key == "file") continue;
    if (!value.is_array()) {
      facts.push_back(
          {{"name", title_of(key)}, {"value", value_text(value.is_object() ? value["said"] : value)}});
      continue;
    }
    if (value.empty()) continue;
    Json values = Json::array();
    for (const auto& one : value) values.push_back(value_text(one));
    lists.push_back({{"name", title_of(key)}, {"values", std::move(values)}});
  }
  auto said = info.contradicted;
  said.insert(said.end(), info.warnings.begin(), info.warnings.end());
  return fill({{"summary", std::move(summary)},
               {"warnings", printable_sentences(said)},
               {"facts", std::move(facts)},
               {"lists", std::move(lists)}},
              root);
}

std::string notice_page(std::string_view title, std::string_view sentence, std::string_view root) {
  auto summary = summary_of("kinemark.notice", root);
  summary["trial"] = title;
  return fill({{"summary", std::move(summary)}, {"sentence", printable_sentence(sentence)}}, root);
}

}  // namespace kinemark::server
