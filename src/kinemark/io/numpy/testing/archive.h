// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Archives for tests, put together byte by byte as NumPy does.
#pragma once

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace kinemark::io::testing_npz {

inline std::string little(std::uint64_t value, int bytes) {
  std::string out;
  for (int i = 0; i < bytes; ++i) out += i < 8 ? static_cast<char>(value >> (8 * i) & 0xffU) : '\0';
  return out;
}

/// An .npy of a type ("<f8"), a shape ("(2, 3)") and its bytes.
inline std::string npy(const std::string& type, const std::string& shape, const std::string& data,
                       const std::string& columns_first = "False") {
  std::string header =
      "{'descr': '" + type + "', 'fortran_order': " + columns_first + ", 'shape': " + shape + ", }";
  header.resize((header.size() + 10 + 63) / 64 * 64 - 11, ' ');
  header += '\n';
  return std::string("\x93NUMPY\x01", 7) + '\0' + little(header.size(), 2) + header + data;
}

/// Doubles as bytes.
inline std::string doubles(const std::vector<double>& values) {
  std::string out(8 * values.size(), '\0');
  std::memcpy(out.data(), values.data(), out.size());
  return out;
}

/// Texts as an .npy of unicode.
inline std::string texts(const std::vector<std::string>& values, const std::string& shape) {
  std::size_t longest = 1;
  for (const auto& value : values) longest = std::max(longest, value.size());
  std::string data;
  for (const auto& value : values)
    for (std::size_t i = 0; i < longest; ++i)
      data += little(i < value.size() ? static_cast<unsigned char>(value[i]) : 0U, 4);
  return npy("<U" + std::to_string(longest), shape, data);
}

inline std::string deflated(const std::string& plain) {
  std::string out(plain.size() + 100, '\0');
  z_stream stream{};
  deflateInit2(&stream, 6, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(plain.data()));
  stream.avail_in = static_cast<uInt>(plain.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

/// A ZIP of members by their names.
inline std::string zip(const std::vector<std::pair<std::string, std::string>>& members,
                       bool compressed = false) {
  std::string out, directory;
  for (const auto& [name, plain] : members) {
    const std::string packed = compressed ? deflated(plain) : plain;
    const std::string sizes = little(packed.size(), 4) + little(plain.size(), 4);
    const std::string how = little(20, 2) + little(0, 2) + little(compressed ? 8 : 0, 2) + little(0, 8) +
                            sizes + little(name.size(), 2) + little(0, 2);
    directory += "PK\x01\x02" + little(20, 2) + how + little(0, 2 + 2 + 2 + 4) + little(out.size(), 4) + name;
    out += "PK\x03\x04" + how + name + packed;
  }
  const std::size_t begin = out.size();
  return out + directory + "PK\x05\x06" + little(0, 4) + little(members.size(), 2) +
         little(members.size(), 2) + little(directory.size(), 4) + little(begin, 4) + little(0, 2);
}

inline std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

}  // namespace kinemark::io::testing_npz
