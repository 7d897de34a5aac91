// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/trial_model.h"

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <system_error>
#include <vector>

#include "kinemark/core/utf8.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "server/trial_files.h"

namespace kinemark::server {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> models_in(const fs::path& folder) {
  std::vector<fs::path> models;
  std::error_code error;
  for (fs::directory_iterator at(folder.empty() ? "." : folder, error), end; !error && at != end;
       at.increment(error))
    if (pipeline::ending_of(at->path()) == ".osim" && at->is_regular_file(error) &&
        !leads_out(folder.empty() ? "." : folder, at->path()))
      models.push_back(folder / at->path().filename());
  std::ranges::sort(models);
  return models;
}

}  // namespace

Result<fs::path> find_model(const fs::path& recording, const fs::path& given) {
  if (!given.empty()) return given;
  const auto models = models_in(recording.parent_path());
  const auto own = std::ranges::find(models, recording.stem(), [](const auto& m) { return m.stem(); });
  if (own != models.end()) return *own;
  if (models.size() == 1) return models.front();
  const auto name = printable(recording.filename().string(), 200);
  if (models.empty())
    return fail(
        Code::not_supported,
        fmt::format("No body model is known for {}: start 'kinemark serve' with --model FILE.osim, or "
                    "put an .osim beside the recording",
                    name));
  return fail(Code::not_supported,
              fmt::format("{} body models lie beside {} and none has its name: start 'kinemark serve' with "
                          "--model FILE.osim, or call one {}.osim",
                          models.size(), name, printable(recording.stem().string(), 200)));
}

}  // namespace kinemark::server
