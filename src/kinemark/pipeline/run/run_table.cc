// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/run/run_table.h"

#include <fmt/core.h>

#include <map>
#include <string_view>
#include <vector>

#include "kinemark/core/counted.h"
#include "kinemark/core/text.h"
#include "kinemark/core/utf8.h"
#include "kinemark/data/likely_pairs.h"
#include "kinemark/pipeline/files/file_table.h"

namespace kinemark::pipeline {
namespace {

std::string command_of(const RunStep& step) {
  std::string out = "kinemark";
  for (const auto& word : step.words) out += " " + data::for_shell(word);
  return out;
}

}  // namespace

std::string run_table(const RunOutcome& outcome) {
  std::vector<std::vector<std::string>> rows{{"subject", "recording", "step", "status", "s", "findings"}};
  std::map<TrialStatus, std::int64_t> counts;
  for (const auto& each : outcome.steps) {
    rows.push_back({printable(each.step.subject), printable(each.step.trial), each.step.name,
                    std::string(to_string(each.status)),
                    each.seconds > 0.0 ? fmt::format("{:.1f}", each.seconds) : "",
                    printable_sentence(each.said)});
    ++counts[each.status];
  }
  std::vector<std::string> parts;
  for (const auto& [status, n] : counts) parts.push_back(fmt::format("{} {}", n, to_string(status)));
  return aligned(rows) + fmt::format("{}: {}\n", counted(std::ssize(outcome.steps), "step"), join(parts));
}

nlohmann::ordered_json run_json(const RunOutcome& outcome) {
  nlohmann::ordered_json json;
  json["exit_status"] = outcome.exit_status();
  json["steps"] = nlohmann::ordered_json::array();
  for (const auto& each : outcome.steps) {
    nlohmann::ordered_json step;
    step["subject"] = each.step.subject;
    step["trial"] =
        each.step.trial.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(each.step.trial);
    step["step"] = each.step.name;
    step["command"] = command_of(each.step);
    step["outputs"] = nlohmann::ordered_json::array();
    for (const auto& file : each.step.outputs) step["outputs"].push_back(file.string());
    step["status"] = to_string(each.status);
    step["exit_status"] = each.exit_status;
    step["seconds"] = each.seconds;
    step["said"] = each.said;
    json["steps"].push_back(std::move(step));
  }
  return json;
}

std::string commands_text(const RunOutcome& outcome) {
  std::string out;
  for (const auto& each : outcome.steps) out += command_of(each.step) + "\n";
  return out;
}

}  // namespace kinemark::pipeline
