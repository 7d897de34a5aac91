// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/page_file.h"

#include <fmt/core.h>

#include <utility>

#include "kinemark/pipeline/files/output_check.h"

namespace kinemark::pipeline {

Result<PageFile> PageFile::begin(const std::filesystem::path& path, const JobSettings& job,
                                 const std::vector<std::filesystem::path>& others) {
  PageFile out;
  if (path.empty()) return out;
  if (ending_of(path) != ".html")
    return fail(Code::usage, fmt::format("{}: a page ends in .html; '{}' is another ending", path.string(),
                                         ending_of(path)));
  // check_apart() compares files that are there; a target that is not yet there is compared by name.
  if (auto s = check_apart(job, {path}, others); !s) return std::unexpected(s.error());
  for (const auto& other : others)
    if (!other.empty() && other.lexically_normal() == path.lexically_normal())
      return fail(Code::usage, fmt::format("{}: is the page and another file as well", path.string()));
  auto file = io::OutputFile::create(path, job.force);
  if (!file) return std::unexpected(file.error());
  out.path_ = path;
  out.file_.emplace(std::move(*file));
  return out;
}

void PageFile::add_inputs(const std::vector<data::InputFile>& inputs) {
  for (const auto& input : inputs) inputs_.emplace_back(input.path);
}

Status PageFile::write(std::string_view html, JobOutcome& outcome) {
  if (!file_) return {};
  if (auto s = check_apart({path_}, inputs_); !s) return s;
  if (auto s = file_->write(html); !s) return s;
  if (auto s = file_->commit(); !s) return s;
  file_.reset();
  outcome.written.push_back(path_);
  return {};
}

}  // namespace kinemark::pipeline
