// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/robot/robot_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "kinemark/io/file.h"

namespace kinemark::io {

Result<std::vector<std::string>> write_robot(const std::filesystem::path& path,
                                             const data::ModelDescription& model, bool force) {
  std::string ending = path.extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  if (ending != ".urdf" && ending != ".xml" && ending != ".mjcf")
    return fail(Code::usage, fmt::format("{}: a model is written as .urdf, or for MuJoCo as .xml or .mjcf",
                                         path.string()));
  auto text = ending == ".urdf" ? urdf_of(model) : mjcf_of(model);
  if (auto s = write_text(path, text.text, force); !s) return std::unexpected(s.error());
  return std::move(text.lost);
}

}  // namespace kinemark::io
