// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/edit_service.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <exception>
#include <iterator>
#include <new>
#include <numeric>
#include <utility>

#include "kinemark/core/counted.h"
#include "kinemark/io/edits/edit_line.h"
#include "kinemark/pipeline/motion/edited_page.h"
#include "server/entrance.h"
#include "server/json_answer.h"

namespace kinemark::server {
namespace {

constexpr std::int64_t kMostOperations = 1'000'000'000;

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMostRequests = 64;  // that wait

}  // namespace

Result<EditRequest> parse_edit_request(std::string_view body) {
  const auto json = nlohmann::json::parse(body, nullptr, false);
  if (!json.is_object() || json.size() != 2 || !json.contains("expected") || !json.contains("edit"))
    return fail(Code::bad_input, R"(need {"expected": 12, "edit": {"do": "swap", ...}} as JSON)");
  const auto& expected = json["expected"];
  if (!expected.is_number_unsigned() || expected.get<std::uint64_t>() > kMostOperations)
    return fail(Code::bad_input, R"("expected" is the number of operations in the journal, 0 or more)");
  const auto& edit = json["edit"];
  // Also keeps what follows from being as deep as the body is long.
  if (!edit.is_object() || std::ranges::any_of(edit, [](const auto& value) { return value.is_structured(); }))
    return fail(Code::bad_input, R"("edit" is an object of texts and numbers, as a line of a journal)");
  auto parsed = io::parse_edit(edit.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  if (!parsed) return std::unexpected(parsed.error());
  return EditRequest{.expected = expected.get<std::size_t>(), .edit = std::move(*parsed)};
}

EditService::EditService(EditServiceOptions options) : options_(std::move(options)), worker_(kMostRequests) {}

bool EditService::handle(const Request& request, const TrialFile& trial, bool wants_data,
                         const Reply& reply) {
  return worker_.post([this, request, trial, wants_data, reply] {
    Response response;
    try {
      response = answer(request, trial, wants_data);
    } catch (const std::bad_alloc&) {
      open_.clear();
      response = refusal(503, fmt::format("{}: does not fit into memory", trial.path.filename().string()));
    } catch (const std::exception& error) {
      open_.clear();  // whatever state it was left in
      response = refusal(422, error.what());
    }
    add_safe_headers(response);
    reply(std::move(response));
  });
}

Result<pipeline::EditSession*> EditService::session_of(const fs::path& path) {
  auto stamp = stamps_of(path).front();
  const auto at = std::ranges::find(open_, path, &Open::path);
  if (at != open_.end()) {
    if (at->stamp == stamp) {
      open_.splice(open_.begin(), open_, at);
      if (auto s = at->session.refresh(); !s) return std::unexpected(s.error());
      return &at->session;
    }
    open_.erase(at);
  }
  auto session = pipeline::EditSession::open(path);
  if (!session) return std::unexpected(session.error());
  open_.push_front({path, stamp, std::move(*session)});
  return &open_.front().session;
}

Response EditService::answer(const Request& request, const TrialFile& trial, bool wants_data) {
  if (request.method == "POST" && !is_json(request.type))
    return refusal(415, "An edit is sent as application/json.");
  const auto session = session_of(trial.path);
  if (!session) return refusal(session.error());
  const auto bytes = [](std::size_t sum, const Open& one) { return sum + one.session.bytes(); };
  while (open_.size() > 1 && (open_.size() > options_.most_sessions ||
                              std::accumulate(std::next(open_.begin()), open_.end(), std::size_t{0}, bytes) >
                                  options_.most_bytes))
    open_.pop_back();
  if (request.method == "POST") return append(request, **session);
  return json_response(
      200, wants_data ? pipeline::edited_page_json(**session) : pipeline::editing_json(**session));
}

Response EditService::append(const Request& request, pipeline::EditSession& session) {
  auto asked = parse_edit_request(request.body);
  if (!asked) return refusal(400, asked.error().message);
  if (options_.time_now) asked->edit.made = options_.time_now();
  const auto asked_for = asked->expected;
  const auto made = session.append(std::move(asked->edit), asked_for);
  if (made && *made) return json_response(200, pipeline::editing_json(session));
  if (!made && made.error().code != Code::io) return refusal(made.error());
  // Another program may have come between.
  if (auto s = session.refresh(); !s) return refusal(s.error());
  const auto there = session.outcome().list.edits.size();
  if (!made && there == asked_for) return refusal(made.error());
  Json json{
      {"error",
       fmt::format("Somebody else has edited this recording: {} {} there and not {}. Look at what there is "
                   "now, and do it again.",
                   counted(static_cast<std::int64_t>(there), "operation"), there == 1 ? "is" : "are",
                   asked_for)}};
  json["editing"] = pipeline::editing_json(session);
  return json_response(409, json);
}

}  // namespace kinemark::server
