// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/input/file_hash.h"

#include <fmt/core.h>
#include <xxhash.h>

#include <memory>
#include <vector>

#include "kinemark/io/file.h"

namespace kinemark::io {

Result<FileHash> hash_files(std::span<const std::filesystem::path> paths) {
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(), &XXH3_freeState);
  XXH3_64bits_reset(state.get());
  std::vector<std::byte> block(1 << 20);
  FileHash hash;
  for (const auto& path : paths) {
    const auto file = InputFile::open(path);
    if (!file) return std::unexpected(file.error());
    for (std::size_t at = 0;;) {
      const auto n = file->read_at(at, block);
      if (!n) return std::unexpected(n.error());
      if (*n == 0) break;
      XXH3_64bits_update(state.get(), block.data(), *n);
      at += *n;
      hash.bytes += static_cast<std::int64_t>(*n);
    }
  }
  hash.hex = fmt::format("{:016x}", XXH3_64bits_digest(state.get()));
  return hash;
}

Result<FileHash> hash_file(const std::filesystem::path& path) { return hash_files({&path, 1}); }

Result<data::InputFile> record_inputs(const std::string& role, const std::filesystem::path& path,
                                      std::span<const std::filesystem::path> files) {
  const auto hash = hash_files(files);
  if (!hash) return std::unexpected(hash.error());
  return data::InputFile{
      .role = role, .path = path.string(), .bytes = hash->bytes, .hash = hash->hex, .hash_kind = "XXH3-64"};
}

Result<data::InputFile> record_input(const std::string& role, const std::filesystem::path& path) {
  return record_inputs(role, path, {&path, 1});
}

}  // namespace kinemark::io
