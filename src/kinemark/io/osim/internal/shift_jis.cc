// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/internal/shift_jis.h"

#include <iconv.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace kinemark::io::osim {
namespace {

bool declares_shift_jis(std::string_view xml) {
  std::string line(xml.substr(0, std::min(xml.find('>'), std::size_t{200})));
  std::ranges::transform(line, line.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  constexpr std::array<std::string_view, 5> kNames{"shift_jis", "shift-jis", "sjis", "cp932", "windows-31j"};
  const std::size_t at = line.find("encoding=");
  if (!line.starts_with("<?xml") || at == std::string::npos) return false;
  return std::ranges::any_of(
      kNames, [&](std::string_view name) { return line.compare(at + 10, name.size(), name) == 0; });
}

}  // namespace

std::optional<std::string> from_shift_jis(std::string_view xml) {
  if (!declares_shift_jis(xml)) return std::nullopt;
  iconv_t converter = ::iconv_open("UTF-8", "CP932");
  if (converter == reinterpret_cast<iconv_t>(-1)) return std::nullopt;
  std::string in(xml);
  std::string out(3 * in.size(), '\0');  // a byte becomes three at most
  char *from = in.data(), *to = out.data();
  std::size_t left = in.size(), room = out.size();
  const bool whole =
      ::iconv(converter, &from, &left, &to, &room) != static_cast<std::size_t>(-1) && left == 0;
  ::iconv_close(converter);
  if (!whole) return std::nullopt;
  out.resize(out.size() - room);
  return out;
}

}  // namespace kinemark::io::osim
