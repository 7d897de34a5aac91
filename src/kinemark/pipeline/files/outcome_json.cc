// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/outcome_json.h"

namespace kinemark::pipeline {
namespace {

using Json = nlohmann::ordered_json;

Json paths(const std::vector<std::filesystem::path>& files) {
  Json list = Json::array();
  for (const auto& file : files) list.push_back(file.string());
  return list;
}

}  // namespace

Json outcome_json(const JobOutcome& outcome) {
  return Json{{"written", paths(outcome.written)}, {"warnings", outcome.warnings}};
}

Json validate_json(const ValidateOutcome& outcome) {
  Json list = Json::array();
  for (const auto& checked : outcome.files) {
    Json& entry =
        list.emplace_back(Json{{"file", checked.file.string()}, {"exit_status", checked.exit_status()}});
    if (checked.error)
      entry["error"] = checked.error->message;
    else
      entry["warnings"] = checked.warnings;
    if (!checked.notes.empty()) entry["notes"] = checked.notes;
  }
  return list;
}

Json recover_json(const RecoverOutcome& outcome) {
  Json damage = Json::array();
  for (const auto& one : outcome.damage)
    damage.push_back({{"offset", one.offset}, {"bytes", one.bytes}, {"what", one.what}});
  return Json{{"original", outcome.original.string()},
              {"written", paths(outcome.written)},
              {"messages", outcome.messages},
              {"end", io::to_string(outcome.end)},
              {"bytes_left_out", outcome.bytes_left_out},
              {"damage", std::move(damage)},
              {"warnings", outcome.warnings}};
}

}  // namespace kinemark::pipeline
