// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/file_hash.h"

#include <fmt/core.h>
#include <xxhash.h>

#include <memory>
#include <vector>

#include "kinemark/io/file.h"

namespace kinemark::pipeline {

Result<FileHash> hash_file(const std::filesystem::path& path) {
  const auto file = io::InputFile::open(path);
  if (!file) return std::unexpected(file.error());
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(), &XXH3_freeState);
  XXH3_64bits_reset(state.get());
  std::vector<std::byte> block(1 << 20);
  FileHash hash;
  while (true) {
    const auto n = file->read_at(static_cast<std::size_t>(hash.bytes), block);
    if (!n) return std::unexpected(n.error());
    if (*n == 0) break;
    XXH3_64bits_update(state.get(), block.data(), *n);
    hash.bytes += static_cast<std::int64_t>(*n);
  }
  hash.hex = fmt::format("{:016x}", XXH3_64bits_digest(state.get()));
  return hash;
}

Result<data::InputFile> record_input(const std::string& role, const std::filesystem::path& path) {
  const auto hash = hash_file(path);
  if (!hash) return std::unexpected(hash.error());
  return data::InputFile{
      .role = role, .path = path.string(), .bytes = hash->bytes, .hash = hash->hex, .hash_kind = "XXH3-64"};
}

}  // namespace kinemark::pipeline
