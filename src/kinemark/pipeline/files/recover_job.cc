// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/recover_job.h"

#include "kinemark/io/recording/recover.h"

namespace kinemark::pipeline {

Result<nlohmann::ordered_json> recover_file(const std::filesystem::path& in, const std::filesystem::path& out,
                                            bool force) {
  const auto report = io::recover_recording(in, out, force);
  if (!report) return std::unexpected(report.error());
  auto damage = nlohmann::ordered_json::array();
  for (const auto& one : report->damage)
    damage.push_back({{"offset", one.offset}, {"bytes", one.bytes}, {"what", one.what}});
  return nlohmann::ordered_json{{"original", in.string()},
                                {"written", {out.string()}},
                                {"messages", report->messages},
                                {"end", io::to_string(report->end)},
                                {"bytes_left_out", report->bytes_left_out},
                                {"damage", damage},
                                {"warnings", report->warnings}};
}

}  // namespace kinemark::pipeline
