// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/motion_bids_files.h"

#include <utility>

#include "kinemark/io/bids/motion_bids.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/files/staging.h"

namespace kinemark::pipeline {

namespace fs = std::filesystem;

Result<std::vector<fs::path>> write_motion_bids(const fs::path& path, const data::Trial& trial,
                                                const JobSettings& job, const std::vector<fs::path>& inputs) {
  const auto name = io::parse_motion_name(path);
  if (!name) return std::unexpected(name.error());
  const auto files = io::motion_files(*name, trial);
  if (!files) return std::unexpected(files.error());
  std::vector<fs::path> targets;
  std::vector<ResultFile> results;
  for (const io::MotionFile& file : *files) {
    targets.push_back(file.path);
    results.push_back({.target = file.path, .write = [&file](const fs::path& staged, const std::string&) {
                         return file.write(staged);
                       }});
  }
  auto staging = Staging::create_in(name->folder, {}, job, inputs);
  if (!staging) return std::unexpected(staging.error());
  if (auto s = staging->add(targets); !s) return std::unexpected(s.error());
  return write_results(*staging, results, {}, "convert");
}

}  // namespace kinemark::pipeline
