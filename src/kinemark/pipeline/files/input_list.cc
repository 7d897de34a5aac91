// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/input_list.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <system_error>

#include "kinemark/io/markers/marker_format.h"
#include "kinemark/pipeline/files/job_settings.h"

namespace kinemark::pipeline {

namespace fs = std::filesystem;

namespace {

Status append_folder(const fs::path& folder, const std::vector<std::string>& endings, InputList& list) {
  std::vector<fs::path> found;
  std::int64_t others = 0;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error); !error && entry != fs::directory_iterator();
       entry.increment(error)) {
    std::error_code ignored;
    if (entry->path().filename().native().starts_with('.') || !entry->is_regular_file(ignored)) continue;
    if (std::ranges::find(endings, ending_of(entry->path())) != endings.end())
      found.push_back(entry->path());
    else
      ++others;
  }
  if (error)
    return fail(Code::io,
                fmt::format("{}: the folder cannot be read ({})", folder.string(), error.message()));
  if (found.empty())
    return fail(Code::bad_input, fmt::format("{}: the folder holds no file that can be read here; need {}",
                                             folder.string(), fmt::join(endings, ", ")));
  if (others > 0)
    list.notes.push_back(fmt::format("{}: {} {} another ending passed over", folder.string(), others,
                                     others == 1 ? "file with" : "files with"));
  std::ranges::sort(found);
  list.files.insert(list.files.end(), found.begin(), found.end());
  return {};
}

}  // namespace

std::vector<std::string> marker_endings() {
  auto endings = io::read_extensions();
  std::erase(endings, ".mcap");  // in a folder these are counts
  return endings;
}

std::vector<std::string> known_endings() {
  auto known = io::read_extensions();
  for (const char* other : {".mot", ".sto", ".osim", ".vsk", ".vst"}) known.emplace_back(other);
  return known;
}

Result<InputList> list_inputs(const std::vector<fs::path>& given, const std::vector<std::string>& endings) {
  InputList list;
  for (const auto& path : given) {
    std::error_code ignored;
    if (!fs::is_directory(path, ignored))
      list.files.push_back(path);
    else if (auto s = append_folder(path, endings, list); !s)
      return std::unexpected(s.error());
  }
  return list;
}

}  // namespace kinemark::pipeline
