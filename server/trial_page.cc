// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/trial_page.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "kinemark/core/html_text.h"
#include "kinemark/core/utf8.h"
#include "kinemark/pipeline/files/info_json.h"
#include "kinemark/pipeline/files/json_text.h"
#include "kinemark/pipeline/motion/edited_page.h"
#include "kinemark/pipeline/motion/report_job.h"
#include "server/list_page.h"
#include "server/secret.h"
#include "server/trial_row.h"

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

std::string list_section(const std::string& key, const Json& values) {
  std::string text = fmt::format("<section>\n<h2>{} <small>{}</small></h2>\n<ul class=\"names\">\n",
                                 html_text(title_of(key)), values.size());
  for (const auto& value : values) text += fmt::format("<li>{}</li>\n", html_text(value_text(value)));
  return text + "</ul>\n</section>\n";
}

std::string warnings_section(const std::vector<std::string>& warnings) {
  if (warnings.empty()) return {};
  std::string text = "<section>\n<h2>What is odd</h2>\n<ul class=\"findings\">\n";
  for (const auto& warning : warnings)
    text += fmt::format(
        "<li class=\"note\"><span class=\"level\">note</span><span class=\"text\">{}</span></li>\n",
        html_text(printable_sentence(warning)));
  return text + "</ul>\n</section>\n";
}

/// A page of viewer/, behind a policy of its own.
Result<Page> report_page(Result<std::string> html, bool asks) {
  if (!html) return std::unexpected(html.error());
  const auto nonce = new_secret();
  if (!nonce) return std::unexpected(nonce.error());
  return shielded(std::move(*html), *nonce, asks);
}

}  // namespace

std::string facts_page(const pipeline::InfoOutcome& info, std::string_view root) {
  // Through text, so that what is no UTF-8 is none in the page either.
  const auto json = Json::parse(pipeline::json_text(pipeline::info_json(info)));
  const auto name = printable(info.file.filename().string(), kTextLetters);
  std::string text = page_head(name, false, root);
  text += fmt::format(
      "<header><p class=\"brand\"><b>kinemark</b> {}</p><h1>{}</h1>"
      "<p class=\"model\"><a href=\"{}\">All trials</a></p></header>\n<main>\n",
      html_text(value_text(json["kind"])), html_text(name), root);
  text += warnings_section(info.warnings);
  text +=
      "<section>\n<h2>What it holds</h2>\n<div class=\"table\" role=\"region\" aria-label=\"What it holds\" "
      "tabindex=\"0\">\n<table class=\"held\">\n<tbody>\n";
  std::string lists;
  for (const auto& [key, value] : json.items()) {
    if (key == "warnings" || key == "kind" || key == "file") continue;
    if (value.is_array()) {
      if (!value.empty()) lists += list_section(key, value);
    } else {
      text += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", html_text(title_of(key)),
                          html_text(value_text(value)));
    }
  }
  text += "</tbody>\n</table>\n</div>\n</section>\n";
  return text + lists + "</main>\n" + page_foot();
}

Page shielded(std::string html, std::string_view nonce, bool asks) {
  constexpr std::string_view kStyle = "<style", kScript = "<script type=\"module\"";
  constexpr std::string_view kNothing = "content=\"default-src 'none'; ", kAsks = "connect-src 'self'; ";
  const std::string attribute = fmt::format(" nonce=\"{}\"", nonce);
  if (const auto at = html.rfind(kScript); at != std::string::npos)
    html.insert(at + std::string_view("<script").size(), attribute);
  if (const auto at = html.find(kStyle); at != std::string::npos) html.insert(at + kStyle.size(), attribute);
  // A file by itself may ask nobody: its own policy is the first thing in it.
  if (const auto at = html.find(kNothing); asks && at != std::string::npos)
    html.insert(at + kNothing.size(), kAsks);
  return {.html = std::make_shared<const std::string>(std::move(html)),
          .policy = fmt::format("default-src 'none'; {1}script-src 'nonce-{0}'; style-src 'nonce-{0}'; "
                                "img-src data: blob:; media-src blob:; worker-src blob:; base-uri 'none'; "
                                "form-action 'none'; frame-ancestors 'none'",
                                nonce, asks ? kAsks : "")};
}

Result<Page> make_trial_page(const std::filesystem::path& path, std::string_view root,
                             const std::vector<std::filesystem::path>& geometry) {
  if (is_solved(path)) {
    pipeline::MarkersPageOptions options;
    options.geometry = geometry;
    return report_page(pipeline::page_of(path, options), false);
  }
  pipeline::InfoJob job;
  job.file = path;
  job.edits = io::kEditsNone;
  const auto info = pipeline::run_info(job);
  if (!info) return std::unexpected(info.error());
  if (std::holds_alternative<pipeline::MarkerFileFacts>(info->facts))
    return report_page(pipeline::edited_page(path), true);
  return Page{std::make_shared<const std::string>(facts_page(*info, root)), std::string(kOwnPolicy)};
}

}  // namespace kinemark::server
