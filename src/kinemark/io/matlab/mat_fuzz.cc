// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Any bytes after the first 128 of a MAT file, and the same as if they had been compressed: a valid trial or
// one sentence, never a crash, a hang or memory without bound.
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>
#include <vector>

#include "kinemark/io/matlab/internal/inflate.h"
#include "kinemark/io/matlab/mat.h"

namespace {

using namespace kinemark;

void try_file(std::span<const std::byte> bytes, std::size_t most) {
  const auto trial = io::parse_mat(bytes, "fuzz");
  if (trial ? !trial->validate() : trial.error().message.find('\n') != std::string::npos) std::abort();
  if (trial && trial->markers.x_in_world.size() > 4 * most) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = std::as_bytes(std::span(data, size));
  try_file(bytes, size * 1032 + 64);
  constexpr std::size_t kHeader = 128;
  if (size < kHeader) return 0;
  const auto packed = io::internal::deflate_all(bytes.subspan(kHeader));
  std::vector<std::byte> file(bytes.begin(), bytes.begin() + kHeader);
  std::uint32_t tag[] = {15, static_cast<std::uint32_t>(packed.size())};
  if (file[126] == std::byte{'M'})
    for (std::uint32_t& word : tag) word = __builtin_bswap32(word);
  const auto tag_bytes = std::as_bytes(std::span(tag));
  file.insert(file.end(), tag_bytes.begin(), tag_bytes.end());
  file.insert(file.end(), packed.begin(), packed.end());
  try_file(file, size + 64);
  return 0;
}
