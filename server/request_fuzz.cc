// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Any bytes as the headers, the target and the body of a request: nobody is let in who does not hold a
// secret, no target leads anywhere but to the few that there are, and an operation that is taken can stand in
// a journal.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kinemark/io/edits/edit_line.h"
#include "server/edit_service.h"
#include "server/entrance.h"
#include "server/live_push.h"
#include "server/live_viewer.h"
#include "server/routes.h"

namespace {

constexpr std::string_view kToken = "11111111111111111111111111111111";
constexpr std::string_view kSession = "33333333333333333333333333333333";

/// Lines: method, target, host, origin ("-": none), one that stands for nothing, authorization; the rest is
/// the body where it begins as an object, else it stands for asking for a WebSocket.
kinemark::server::Request parse(std::string_view text) {
  std::vector<std::string> lines;
  for (int i = 0; i < 6; ++i) {
    const auto end = std::min(text.find('\n'), text.size());
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  kinemark::server::Request request{.method = lines[0],
                                    .target = lines[1],
                                    .host = lines[2],
                                    .authorization = lines[5],
                                    .upgrade = !text.empty() && text.front() != '{',
                                    .body = std::string(text)};
  if (lines[3] != "-") request.origin = lines[3];
  return request;
}

bool holds(const std::string& text, std::string_view secret) {
  return text.find(secret) != std::string::npos;
}

/// A message of a page on a WebSocket: what is understood is a body that is there, and never more than is
/// allowed pushes it.
void check_push(std::string_view bytes) {
  using namespace kinemark::server;
  constexpr std::size_t kBodies = 3;
  LivePush push(kBodies);
  (void)drawn_count(bytes);
  for (std::size_t at = 0; at <= bytes.size(); at += kPushBytes) {
    const auto wish = push.read(bytes.substr(at, kPushBytes));
    if (!wish) continue;
    if (std::cmp_greater_equal(wish->body, kBodies) || !wish->point_in_body.allFinite()) std::abort();
    const bool refused = !push.take(&push, *wish, 0.0).empty();
    const auto now = push.now(0.0);
    if (now && !(now->force_in_world.norm() <= 500.0)) std::abort();
    if (refused != (wish->force_in_world.norm() > 500.0)) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinemark::server;
  check_push({reinterpret_cast<const char*>(data), size});
  Request request = parse({reinterpret_cast<const char*>(data), size});
  Entrance entrance({.hosts = {"127.0.0.1:8123", "localhost:8123"},
                     .token = std::string(kToken),
                     .session = std::string(kSession)});
  const std::string target = request.target;
  const auto response = entrance.ask(request);
  const bool has_secret =
      target.starts_with("/" + std::string(kSession) + "/") || holds(request.authorization, kToken);
  if (!response && !has_secret) std::abort();
  if (!response && request.method != "GET" && request.method != "HEAD" && request.method != "POST")
    std::abort();
  if (!response && request.method == "POST" && !request.origin) std::abort();
  if (!response && request.upgrade && request.method != "GET") std::abort();
  if (!response && request.upgrade && !request.origin) std::abort();
  if (response && response->status == 303 && request.target != "/?token=" + std::string(kToken)) std::abort();
  if (response && response->status != 303 && response->admitted) std::abort();
  if (response && response->body && response->body->find("<script") != std::string::npos) std::abort();
  const Route route = find_route(request.target);
  const auto number = std::to_string(route.number);
  if (route.target == Target::trial_page && request.target != "/trial/" + number) std::abort();
  if (route.target == Target::trial_edits && request.target != "/api/trial/" + number + "/edits")
    std::abort();
  if (route.target == Target::trial_data && request.target != "/api/trial/" + number + "/data") std::abort();
  if (route.target == Target::trial_angles && request.target != "/api/trial/" + number + "/angles")
    std::abort();
  for (const auto& [target, name] :
       {std::pair(Target::angles_now, "now"), std::pair(Target::angles_before, "before"),
        std::pair(Target::angles_recorded, "recorded")})
    if (route.target == target && request.target != "/trial/" + number + "/angles/" + name) std::abort();
  const bool of_trial = route.target == Target::trial_page || route.target == Target::trial_edits ||
                        route.target == Target::trial_data || route.target == Target::trial_angles ||
                        route.target == Target::angles_now || route.target == Target::angles_before ||
                        route.target == Target::angles_recorded;
  if (of_trial != (route.number != 0)) std::abort();
  if (route.target != Target::none && request.target.find("..") != std::string::npos) std::abort();
  if (const auto asked = parse_edit_request(request.body)) {
    const auto again = kinemark::io::parse_edit(kinemark::io::format_edit(asked->edit));
    if (!again || !again->same_as(asked->edit)) std::abort();
  }
  return 0;
}
