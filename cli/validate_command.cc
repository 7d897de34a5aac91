// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <vector>

#include "cli/command.h"
#include "cli/console.h"
#include "kinemark/pipeline/files/file_facts.h"

namespace kinemark::cli {
namespace {

/// Exit status of one file: 0 no remarks, 1 readable with warnings, 3 or 4 not readable. Its entry for
/// --json goes to `answer`.
int validate(const Globals& globals, const std::string& path, nlohmann::ordered_json& answer) {
  const auto facts = pipeline::describe_file(path);
  if (!facts) {
    const int status = report_error(facts.error());
    answer.push_back({{"file", path}, {"exit_status", status}, {"error", facts.error().message}});
    return status;
  }
  const auto warnings = facts->at("warnings");
  answer.push_back({{"file", path}, {"exit_status", warnings.empty() ? 0 : 1}, {"warnings", warnings}});
  for (const auto& warning : warnings) say(globals, fmt::format("{}: {}", path, warning.get<std::string>()));
  if (warnings.empty()) say(globals, fmt::format("{}: good", path));
  return warnings.empty() ? 0 : 1;
}

}  // namespace

void add_validate(CLI::App& app, const Globals& globals, Run& run) {
  auto* command = app.add_subcommand(
      "validate", "Check files: exit status 0 good, 1 readable but odd, 3 or 4 not readable");
  const auto paths = std::make_shared<std::vector<std::string>>();
  command->add_option("FILE", *paths, ".c3d, .trc, .mot, .sto, .osim or .mcap")->required();
  command->callback([&globals, paths, &run] {
    run = [&globals, paths] {
      int worst = 0;
      auto answer = nlohmann::ordered_json::array();
      for (const auto& path : *paths) worst = std::max(worst, validate(globals, path, answer));
      if (globals.json) fmt::print("{}\n", answer.dump(2));
      return worst;
    };
  });
}

}  // namespace kinemark::cli
