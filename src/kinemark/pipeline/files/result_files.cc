// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/result_files.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "kinemark/io/file.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/osim/osim_writer.h"
#include "kinemark/io/seal.h"
#include "kinemark/io/set_mark.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/pipeline/files/json_text.h"

namespace kinemark::pipeline {

namespace fs = std::filesystem;

ResultFile text_file(fs::path target, std::function<std::string()> make) {
  return {std::move(target), [make = std::move(make)](const fs::path& staged, const std::string&) {
            return io::write_text(staged, make(), false);
          }};
}

ResultFile toml_file(fs::path target, std::function<std::string()> make) {
  return {std::move(target), [make = std::move(make)](const fs::path& staged, const std::string& set) {
            const std::string head = set.empty() ? "" : fmt::format("# {}\n", io::set_mark(set));
            return io::write_text(staged, head + make(), false);
          }};
}

ResultFile json_file(fs::path target, std::function<nlohmann::ordered_json()> make) {
  return {std::move(target), [make = std::move(make)](const fs::path& staged, const std::string& set) {
            auto json = make();
            if (!set.empty()) {
              // First, so that they are found at the beginning of a long file.
              auto named = nlohmann::ordered_json{{std::string(io::kSetKey), set},
                                                  {std::string(io::kSumKey), std::string(io::kNoSum)}};
              named.update(json);
              json = std::move(named);
            }
            const auto text = json_text(json) + "\n";
            return set.empty() ? io::write_text(staged, text, false)
                               : io::write_sealed_text(staged, text, false);
          }};
}

ResultFile table_file(fs::path target, std::function<data::Table()> make) {
  return {std::move(target), [make = std::move(make)](const fs::path& staged, const std::string& set) {
            return io::write_table(staged, make(), {.set = set});
          }};
}

ResultFile marker_file(fs::path target, const data::Trial& trial) {
  return {std::move(target), [&trial](const fs::path& staged, const std::string& set) {
            return io::write_markers(staged, trial, false, set);
          }};
}

ResultFile model_file(fs::path target, const std::string& text) {
  return {std::move(target), [&text](const fs::path& staged, const std::string& set) {
            return io::write_osim_text(staged, text, {.set = set});
          }};
}

Result<std::vector<fs::path>> write_results(Staging& staging, const std::vector<ResultFile>& files,
                                            const Progress& progress, std::string_view what,
                                            const std::string& set) {
  const auto total = static_cast<std::int64_t>(files.size());
  std::int64_t done = 0;
  for (const auto& file : files) {
    if (auto s = file.write(staging.path_of(file.target), set); !s) return staging.failure(s.error());
    if (progress && !progress(++done, total))
      return fail(Code::cancelled, fmt::format("{} was stopped", what));
  }
  auto written = staging.written();
  if (auto s = staging.commit(); !s) return std::unexpected(s.error());
  return written;
}

}  // namespace kinemark::pipeline
