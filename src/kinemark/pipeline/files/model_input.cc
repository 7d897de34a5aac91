// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/model_input.h"

#include <fmt/core.h>

#include <utility>

#include "kinemark/io/input/file_hash.h"
#include "kinemark/io/osim/osim_model.h"

namespace kinemark::pipeline {

Result<ModelInput> read_model_input(const std::filesystem::path& path) {
  auto description = io::read_osim(path);
  if (!description) return std::unexpected(description.error());
  if (description->markers.empty())
    return fail(Code::bad_input, fmt::format("{}: model '{}' has no markers; need at least one",
                                             path.string(), description->name));
  auto model = model::Model::compile(std::move(*description));
  if (!model) return fail_at(path.string(), model.error());
  auto file = io::record_input("model", path);
  if (!file) return std::unexpected(file.error());
  return ModelInput{.model = std::move(*model), .file = std::move(*file)};
}

}  // namespace kinemark::pipeline
