// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/utf8.h"
#include "kinemark/io/arrays/named_arrays.h"
#include "kinemark/io/file.h"
#include "kinemark/io/numpy/internal/npy_array.h"
#include "kinemark/io/numpy/internal/zip_members.h"
#include "kinemark/io/numpy/npz.h"

namespace kinemark::io {
namespace {

Result<std::vector<NamedArray>> read_arrays(std::span<const std::byte> bytes) {
  const auto members = internal::zip_members(bytes);
  if (!members) return std::unexpected(members.error());
  std::vector<NamedArray> out;
  for (const auto& member : *members) {
    std::string name = name_of_bytes(member.name);
    if (!name.ends_with(".npy")) continue;
    name.resize(name.size() - 4);
    const auto unpacked = internal::unpack(member);
    auto array = unpacked ? internal::parse_npy(*unpacked) : std::unexpected(unpacked.error());
    if (!array) return fail_at(fmt::format("array '{}'", printable(name, 63)), array.error());
    out.push_back({.name = std::move(name),
                   .shape = std::move(array->shape),
                   .numbers = std::move(array->numbers),
                   .texts = std::move(array->texts),
                   .is_text = array->is_text});
  }
  return out;
}

}  // namespace

bool is_npz(std::string_view begin) {
  using namespace std::string_view_literals;
  constexpr std::size_t kNameAt = 30;
  if (!begin.starts_with("PK\3\4"sv) || begin.size() < kNameAt) return false;
  const auto length = static_cast<std::size_t>(static_cast<unsigned char>(begin[26])) +
                      (static_cast<std::size_t>(static_cast<unsigned char>(begin[27])) << 8U);
  return begin.substr(kNameAt, length).ends_with(".npy");
}

Result<data::Trial> parse_npz(std::span<const std::byte> bytes, std::string_view name,
                              std::string_view unit) {
  auto arrays = read_arrays(bytes);
  if (!arrays) return fail_at(name, arrays.error());
  auto trial = trial_of_arrays(std::move(*arrays), unit);
  if (!trial) return fail_at(name, {trial.error().code, printable_sentence(trial.error().message)});
  trial->source = name;
  trial->format = "NPZ";
  if (auto s = trial->validate(); !s)
    return fail_at(name, {s.error().code, printable_sentence(s.error().message)});
  return trial;
}

Result<data::Trial> read_npz(const std::filesystem::path& path, std::string_view unit) {
  const auto bytes = read_text(path);
  if (!bytes) return std::unexpected(bytes.error());
  return parse_npz(std::as_bytes(std::span(*bytes)), path.string(), unit);
}

}  // namespace kinemark::io
