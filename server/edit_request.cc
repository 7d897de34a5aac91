// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/edit_request.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "kinemark/io/edits/edit_line.h"

namespace kinemark::server {
namespace {

constexpr std::int64_t kMostOperations = 1'000'000'000;

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

}  // namespace kinemark::server
