// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text_input.h"

#include <fmt/core.h>

#include <algorithm>
#include <span>
#include <string_view>
#include <utility>

#include "kinemark/io/blank_rows.h"
#include "kinemark/io/file.h"
#include "kinemark/io/text_dialect.h"

namespace kinemark::io {
namespace {

constexpr std::size_t kJudged = 1UL << 20;

/// What is no larger is for the reader of its format to judge, which knows what it expects.
Status judge(std::string_view begin, std::size_t size, const std::string& name) {
  if (size <= kJudged) return {};
  if (const auto zero = is_utf16(begin) ? std::string_view::npos : begin.find('\0');
      zero != std::string_view::npos)
    return fail(Code::bad_input,
                fmt::format("{}: is no text: byte {} is zero. Nothing more was read.", name, zero + 1));
  if (begin.find_first_of("\r\n") == std::string_view::npos)
    return fail(Code::bad_input,
                fmt::format("{}: its first line has more than {} bytes; expected lines of text. Nothing more "
                            "was read.",
                            name, kJudged));
  return {};
}

/// Without what fills up the last block of a disk: zeros, and the end mark of DOS.
std::string without_filling(std::string text) {
  if (is_utf16(text)) return text;
  while (!text.empty() && (text.back() == '\0' || text.back() == '\x1A')) text.pop_back();
  return text;
}

std::string plain_text(std::string text) {
  return without_blank_rows(in_plain_dialect(without_filling(std::move(text))));
}

}  // namespace

Result<std::string> read_lines_of_text(const std::filesystem::path& path, std::size_t max_bytes) {
  const auto file = InputFile::open(path);
  if (!file) return std::unexpected(file.error());
  std::string text(std::min(file->size(), kJudged), '\0');
  const auto begun = file->read_at(0, std::as_writable_bytes(std::span(text)));
  if (!begun) return std::unexpected(begun.error());
  text.resize(*begun);
  if (auto s = judge(text, file->size(), path.string()); !s) return std::unexpected(s.error());
  if (file->size() > max_bytes)
    return fail(Code::bad_input, fmt::format("{}: has {} bytes; at most {} are read as text", path.string(),
                                             file->size(), max_bytes));
  if (file->size() <= kJudged) return plain_text(std::move(text));
  text.resize(file->size());
  const auto n = file->read_at(kJudged, std::as_writable_bytes(std::span(text).subspan(kJudged)));
  if (!n) return std::unexpected(n.error());
  text.resize(kJudged + *n);
  return plain_text(std::move(text));
}

}  // namespace kinemark::io
