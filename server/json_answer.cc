// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/json_answer.h"

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "kinemark/core/utf8.h"
#include "kinemark/pipeline/files/json_text.h"

namespace kinemark::server {

Response json_response(int status, const nlohmann::ordered_json& json) {
  Response response{.status = status, .type = "application/json", .admitted = true};
  response.body = std::make_shared<const std::string>(pipeline::json_text(json) + "\n");
  if (status == 503) response.headers.emplace_back("Retry-After", "1");
  return response;
}

Response refusal(int status, std::string_view sentence) {
  return json_response(status, {{"error", printable_sentence(sentence)}});
}

Response refusal(const Error& error) { return refusal(error.code == Code::io ? 503 : 422, error.message); }

bool is_json(std::string_view type) {
  constexpr std::string_view kJson = "application/json";
  return type == kJson || (type.starts_with(kJson) && type[kJson.size()] == ';');
}

}  // namespace kinemark::server
