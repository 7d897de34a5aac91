// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/live_service.h"

#include <utility>

#include "kinemark/pipeline/files/json_text.h"
#include "server/served_page.h"
#include "server/trial_page.h"

namespace kinemark::server {
namespace {

using Json = nlohmann::ordered_json;

Response sentence(int status, std::string_view title, std::string_view what, std::string_view root) {
  Response response{.status = status,
                    .body = std::make_shared<const std::string>(notice_page(title, what, root))};
  response.headers = {{"Content-Security-Policy", std::string(kOwnPolicy)}};
  return response;
}

}  // namespace

std::string live_state_json(const LiveState& state) {
  Json viewers = Json::array();
  for (const auto& v : state.viewers)
    viewers.push_back(
        {{"sent", v.sent},
         {"dropped", v.dropped},
         {"dropped_angles", v.dropped_angles},
         {"to_socket_ms", {{"p50", v.half_ms}, {"p99", v.most_ms}, {"longest", v.longest_ms}}}});
  return pipeline::json_text({{"frames", state.frames},
                              {"of_frames", state.of_frames ? Json(*state.of_frames) : Json()},
                              {"ended", state.ended},
                              {"recorded", state.recorded},
                              {"unsolved", state.unsolved},
                              {"viewers", viewers}}) +
         "\n";
}

LiveService::LiveService(Keys keys, std::string page, std::string_view nonce, std::unique_ptr<LiveFeed> feed)
    : root_(keys.root()),
      entrance_(std::move(keys)),
      page_(shielded(std::move(page), nonce, /*asks=*/true)),
      feed_(std::move(feed)) {
  feed_->start();
}

void LiveService::handle(Request request, const Reply& reply) {
  auto response = entrance_.ask(request);
  if (!response) {
    response = answer(request);
    response->admitted = true;
  }
  add_safe_headers(*response);
  reply(std::move(*response));
}

Response LiveService::answer(const Request& request) {
  if (request.upgrade && request.target == "/live/socket") return open_socket();
  if (!request.upgrade && request.target == "/")
    return {.body = page_.html, .headers = {{"Content-Security-Policy", page_.policy}}};
  if (!request.upgrade && request.target == "/api/live")
    return {.type = "application/json",
            .body = std::make_shared<const std::string>(live_state_json(feed_->state()))};
  if (auto file = served_file(request.target); file && !request.upgrade) return std::move(*file);
  return sentence(404, "Not found", "There is no such page; / shows the live source.", root_);
}

Response LiveService::open_socket() {
  auto viewer = feed_->add_viewer();
  if (!viewer) {
    auto response = sentence(503, "Busy", "Too many view this source at once; close another page.", root_);
    response.headers.emplace_back("Retry-After", "1");
    return response;
  }
  return {.socket = std::move(viewer)};
}

}  // namespace kinemark::server
