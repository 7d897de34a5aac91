// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/trial_service.h"

#include <fmt/core.h>

#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "kinemark/core/utf8.h"
#include "kinemark/pipeline/files/json_text.h"
#include "server/routes.h"
#include "server/served_page.h"

namespace kinemark::server {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostRequests = 64;  // that wait for a thread
constexpr std::size_t kMostRows = 100'000;

void send(Response response, const Reply& reply) {
  response.admitted = true;
  add_safe_headers(response);
  reply(std::move(response));
}

void send_text(std::string_view text, const char* type, const Reply& reply) {
  send({.type = type, .body = std::make_shared<const std::string>(text)}, reply);
}

void send_page(const Page& page, const Reply& reply) {
  send({.body = page.html, .headers = {{"Content-Security-Policy", page.policy}}}, reply);
}

std::string name_of(const fs::path& path) { return printable(path.filename().string(), 200); }

bool is_gone(const Stamps& stamps) { return !stamps.front(); }

std::string gone_sentence(const fs::path& path) {
  return fmt::format("{}: the file is no longer there; the list shows what there is now.", name_of(path));
}

/// What a reader throws becomes its failure: one bad file must not end the server.
Result<Page> guarded(const std::function<Result<Page>(const fs::path&)>& make, const fs::path& path) {
  try {
    return make(path);
  } catch (const std::bad_alloc&) {
    return fail(Code::io, fmt::format("{}: does not fit into memory", name_of(path)));
  } catch (const std::exception& error) {
    return fail(Code::bad_input, fmt::format("{}: {}", name_of(path), error.what()));
  }
}

TrialRow guarded_row(const std::function<TrialRow(const fs::path&)>& describe, const fs::path& path) {
  auto row = unread_row(path);
  try {
    return describe(path);
  } catch (const std::bad_alloc&) {
    row.said = "does not fit into memory";
  } catch (const std::exception& error) {
    row.said = printable_sentence(error.what());
  }
  row.state = RowState::unreadable;
  return row;
}

}  // namespace

TrialService::TrialService(ServiceOptions options)
    : options_(std::move(options)),
      entrance_(options_.keys),
      files_(options_.given),
      shelf_(options_.most_page_bytes),
      edits_(options_.edits),
      angles_(options_.angles),
      list_worker_(kMostRequests),
      row_worker_(kMostRows),
      page_worker_(kMostRequests) {}

void TrialService::handle(Request request, const Reply& reply) {
  if (auto response = entrance_.ask(request)) {
    add_safe_headers(*response);
    reply(std::move(*response));
    return;
  }
  const Route route = request.upgrade ? Route{} : find_route(request.target);
  if (request.method == "POST" && route.target != Target::trial_edits &&
      route.target != Target::trial_angles && route.target != Target::none) {
    auto response = sentence_page(405, "This is only shown; edits and angles are what POST is for.");
    response.headers.emplace_back("Allow", "GET, HEAD");
    return send(std::move(response), reply);
  }
  switch (route.target) {
    case Target::list_page:
    case Target::list_json: {
      const bool as_json = route.target == Target::list_json;
      if (!list_worker_.post([this, as_json, reply] { send_list(as_json, reply); })) send_busy(reply);
      return;
    }
    case Target::trial_page:
      if (!list_worker_.post([this, n = route.number, reply] { send_trial(n, reply); })) send_busy(reply);
      return;
    case Target::trial_edits:
    case Target::trial_data:
      if (!list_worker_.post([this, request, route, reply] { send_edits(request, route, reply); }))
        send_busy(reply);
      return;
    case Target::trial_angles:
    case Target::angles_now:
    case Target::angles_before:
    case Target::angles_recorded:
      if (!list_worker_.post([this, request, route, reply] { send_angles(request, route, reply); }))
        send_busy(reply);
      return;
    case Target::style:
    case Target::list_style:
    case Target::list_script:
      return send(*served_file(request.target), reply);
    case Target::none:
      break;
  }
  send_sentence(404, "Not found", "There is no such page; the list shows every trial.", reply);
}

void TrialService::send_sentence(int status, std::string_view title, std::string_view sentence,
                                 const Reply& reply) const {
  Response response{.status = status};
  response.body = std::make_shared<const std::string>(notice_page(title, sentence, options_.keys.root()));
  response.headers = {{"Content-Security-Policy", std::string(kOwnPolicy)}};
  if (status == 503) response.headers.emplace_back("Retry-After", "1");
  send(std::move(response), reply);
}

void TrialService::send_busy(const Reply& reply) const {
  send_sentence(503, "Busy", "Too much is being asked at once; reload the page in a moment.", reply);
}

void TrialService::send_list(bool as_json, const Reply& reply) {
  const auto listing = files_.list();
  std::vector<TrialRow> rows;
  for (const auto& trial : listing.trials) rows.push_back(row_of(trial));
  if (!as_json)
    return send_page(
        {std::make_shared<const std::string>(trials_page(rows, listing.notes, options_.keys.root())),
         std::string(kOwnPolicy)},
        reply);
  send_text(pipeline::json_text(trials_json(rows, listing.notes)) + "\n", "application/json", reply);
}

TrialRow TrialService::row_of(const TrialFile& trial) {
  auto stamps = stamps_of(trial.path);
  auto row = unread_row(trial.path);
  row.number = trial.number;
  if (is_gone(stamps)) {
    row.state = RowState::unreadable;
    row.said = "the file is no longer there";
    return row;
  }
  const std::scoped_lock lock(mutex_);
  if (const auto at = rows_.find(trial.number); at != rows_.end() && at->second.stamps == stamps)
    return at->second.row;
  if (!being_read_.contains(trial.number) && row_worker_.post([this, trial] { read_row(trial); }))
    being_read_.insert(trial.number);
  return row;
}

void TrialService::read_row(const TrialFile& trial) {
  auto stamps = stamps_of(trial.path);
  auto row = guarded_row(options_.describe, trial.path);
  row.number = trial.number;
  const std::scoped_lock lock(mutex_);
  being_read_.erase(trial.number);
  // Of a file that changed meanwhile the stamps differ: the next list has it read again.
  rows_.insert_or_assign(trial.number, Described{std::move(stamps), std::move(row)});
}

std::optional<TrialFile> TrialService::find_trial(std::uint32_t number) {
  auto path = files_.path_of(number);
  if (!path) {
    (void)files_.list();  // a number from before the server was started again
    path = files_.path_of(number);
  }
  if (!path) return std::nullopt;
  return TrialFile{number, std::move(*path)};
}

void TrialService::send_trial(std::uint32_t number, const Reply& reply) {
  const auto trial = find_trial(number);
  if (!trial)
    return send_sentence(404, "Not found", "There is no trial of that number; see the list.", reply);
  const auto stamps = stamps_of(trial->path);
  if (is_gone(stamps)) return send_sentence(404, name_of(trial->path), gone_sentence(trial->path), reply);
  if (const auto page = shelf_.find(number, stamps)) return send_page(*page, reply);
  if (!page_worker_.post([this, trial = *trial, reply] { make_page(trial, reply); })) send_busy(reply);
}

void TrialService::send_edits(const Request& request, const Route& route, const Reply& reply) {
  const auto trial = find_trial(route.number);
  if (!trial || is_gone(stamps_of(trial->path)))
    return send_sentence(404, "Not found", "There is no trial of that number; see the list.", reply);
  if (!edits_.handle(request, *trial, route.target == Target::trial_data, reply)) send_busy(reply);
}

void TrialService::send_angles(const Request& request, const Route& route, const Reply& reply) {
  const auto trial = find_trial(route.number);
  if (!trial || is_gone(stamps_of(trial->path)))
    return send_sentence(404, "Not found", "There is no trial of that number; see the list.", reply);
  if (route.target == Target::trial_angles) return send(angles_.answer(request, *trial), reply);
  const auto which = route.target == Target::angles_now      ? AnglesOf::now
                     : route.target == Target::angles_before ? AnglesOf::before
                                                             : AnglesOf::recorded;
  if (const auto page = angles_.page(*trial, which)) return send_page(*page, reply);
  send_sentence(404, "Not found", "There are no such angles now; the page of the recording solves them.",
                reply);
}

void TrialService::make_page(const TrialFile& trial, const Reply& reply) {
  constexpr int kTries = 2;
  for (int i = 0; i < kTries; ++i) {
    const auto stamps = stamps_of(trial.path);
    // Several may have asked for it at once.
    if (const auto page = shelf_.find(trial.number, stamps)) return send_page(*page, reply);
    if (is_gone(stamps)) return send_sentence(404, name_of(trial.path), gone_sentence(trial.path), reply);
    auto page = guarded(options_.make_page, trial.path);
    if (stamps_of(trial.path) != stamps) continue;
    if (!page) return send_sentence(422, name_of(trial.path), page.error().message, reply);
    shelf_.keep(trial.number, stamps, *page);
    return send_page(*page, reply);
  }
  send_sentence(503, name_of(trial.path),
                fmt::format("{}: the file changes while it is read; reload the page when it is whole.",
                            name_of(trial.path)),
                reply);
}

}  // namespace kinemark::server
