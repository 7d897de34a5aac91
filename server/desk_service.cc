// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/desk_service.h"

#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

#include "server/desk_json.h"
#include "server/json_answer.h"
#include "server/served_page.h"

namespace kinemark::server {
namespace {

constexpr std::size_t kMostAsked = 64;  // that wait
constexpr std::chrono::milliseconds kLook{100};

}  // namespace

DeskService::DeskService(Keys keys, std::string page, std::string_view nonce, ServedDesk served)
    : root_(keys.root()),
      entrance_(std::move(keys)),
      page_(shielded(std::move(page), nonce, /*asks=*/true)),
      served_(std::move(served)),
      worker_(kMostAsked, {.every = kLook, .work = [this] { look(); }}) {}

void DeskService::handle(Request request, const Reply& reply) {
  auto refused = entrance_.ask(request);
  if (!refused && !request.upgrade && request.target == "/api/desk") {
    const bool taken = worker_.post([this, request, reply] {
      auto response = answer(request);
      add_safe_headers(response);
      reply(std::move(response));
    });
    if (taken) return;
    refused = refusal(503, "The device is busy; try again in a moment.");
  }
  auto response = refused ? std::move(*refused) : show(request);
  add_safe_headers(response);
  reply(std::move(response));
}

Response DeskService::show(const Request& request) const {
  if (request.method == "POST") {
    auto response = sentence_page(405, "This is only shown; /api/desk is what POST is for.");
    response.headers.emplace_back("Allow", "GET, HEAD");
    response.admitted = true;
    return response;
  }
  Response response;
  if (auto file = served_file(request.target); file && !request.upgrade) {
    response = std::move(*file);
  } else if (!request.upgrade && request.target == "/") {
    response = {.body = page_.html, .headers = {{"Content-Security-Policy", page_.policy}}};
  } else {
    const auto text = notice_page("Not found", "There is no such page; / shows the device.", root_);
    response = {.status = 404, .body = std::make_shared<const std::string>(text)};
    response.headers = {{"Content-Security-Policy", std::string(kOwnPolicy)}};
  }
  response.admitted = true;
  return response;
}

Response DeskService::answer(const Request& request) {
  auto& session = *served_.session;
  if (request.method == "POST") {
    if (!is_json(request.type)) return refusal(415, "What is asked of a device is sent as application/json.");
    const auto asked = parse_desk_request(request.body, session.state().wanted);
    if (!asked) return refusal(400, asked.error().message);
    ask_desk(*asked, session);
  } else {
    session.tick();
  }
  return json_response(200, desk_json(session.state()));
}

void DeskService::look() {
  if (left_) return;
  if (served_.session->state().step == pipeline::DeskStep::recording) served_.session->tick();
  if (!served_.stop || !served_.stop()) return;
  left_ = true;
  served_.session->leave();
  if (served_.ended) served_.ended(served_.session->state());
}

}  // namespace kinemark::server
