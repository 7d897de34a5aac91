// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/matlab/internal/mat_file.h"

#include <fmt/core.h>

#include <span>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/core/version.h"
#include "kinemark/io/file.h"
#include "kinemark/io/matlab/internal/inflate.h"
#include "kinemark/io/matlab/internal/mat_parse.h"
#include "kinemark/io/set_mark.h"

namespace kinemark::io::internal {
namespace {

/// Text, two bytes of the version and two of the byte order. No date: the same content gives the same bytes.
std::string header(const std::string& set) {
  std::string out = fmt::format("MATLAB 5.0 MAT-file, written by kinemark {} {}", kVersion, set_mark(set));
  out.resize(kMatHeaderBytes - 12, ' ');
  out.append(8, '\0');
  return out + std::string("\0\1IM", 4);
}

}  // namespace

Status write_mat_file(const std::filesystem::path& path, const std::string& bytes,
                      const MatWriteOptions& options) {
  check(bytes.size() <= kMostVariableBytes, "a variable of a MAT file has 2 GB at most");
  auto file = OutputFile::create(path, options.force);
  if (!file) return std::unexpected(file.error());
  const auto packed = deflate_all(std::as_bytes(std::span(bytes)));
  const std::uint32_t tag[] = {std::to_underlying(MatType::compressed),
                               static_cast<std::uint32_t>(packed.size())};
  if (auto s = file->write(header(options.set)); !s) return s;
  if (auto s = file->write(std::as_bytes(std::span(tag))); !s) return s;
  if (auto s = file->write(packed); !s) return s;
  return file->commit();
}

}  // namespace kinemark::io::internal
