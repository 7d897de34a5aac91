// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/internal/unpack_testing.h"

#include <zlib.h>

#include <bit>
#include <limits>
#include <stdexcept>

namespace kinemark::report::internal {
namespace {

std::vector<std::uint8_t> from_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> bytes;
  std::uint32_t held = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    held = held << 6 | static_cast<std::uint32_t>(digits.find(c));
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes.push_back(static_cast<std::uint8_t>(held >> bits & 0xFF));
  }
  return bytes;
}

}  // namespace

std::vector<std::uint8_t> inflate_base64(const std::string& text) {
  const auto packed = from_base64(text);
  for (std::size_t room = 64 + 4 * packed.size();; room *= 4) {
    std::vector<std::uint8_t> out(room);
    uLongf size = room;
    const int status = uncompress(out.data(), &size, packed.data(), static_cast<uLong>(packed.size()));
    if (status == Z_BUF_ERROR && room < (std::size_t{1} << 30)) continue;
    if (status != Z_OK) throw std::runtime_error("the zlib stream is damaged");
    out.resize(size);
    return out;
  }
}

std::vector<double> unpack_series(const nlohmann::ordered_json& packed) {
  const auto points = packed["points"].get<std::size_t>(), series = packed["series"].get<std::size_t>();
  const bool is_float = packed["kind"] == "float32";
  const auto bytes = inflate_base64(packed["data"].get<std::string>());
  const std::size_t n = points * series, width = is_float ? 4 : 2;
  if (bytes.size() != n * width) throw std::runtime_error("a packed block has another size");
  std::vector<double> out;
  for (std::size_t s = 0; s < series; ++s) {
    std::uint32_t word = 0;
    for (std::size_t i = s * points; i < (s + 1) * points; ++i) {
      std::uint32_t change = 0;
      for (std::size_t b = 0; b < width; ++b) change |= std::uint32_t{bytes[b * n + i]} << (8 * b);
      word += change;
      if (is_float)
        out.push_back(std::bit_cast<float>(word));
      else
        out.push_back(packed["offset"][s].get<double>() +
                      packed["step"][s].get<double>() * static_cast<double>(word & 0xFFFFU));
    }
  }
  return out;
}

std::vector<double> unpack_curve(const nlohmann::ordered_json& packed) {
  const auto bytes = inflate_base64(packed["data"].get<std::string>());
  const auto width = packed["bytes"].get<std::size_t>(), order = packed["order"].get<std::size_t>();
  const bool absent = packed["absent"].get<bool>();
  const std::size_t planes = width + (absent ? 1 : 0);
  const std::size_t points = planes == 0 ? 0 : bytes.size() / planes;
  if (points * planes != bytes.size()) throw std::runtime_error("a packed curve has another size");
  std::vector<std::int64_t> words(points);
  for (std::size_t i = 0; i < points; ++i) {
    std::uint32_t packed_word = 0;
    for (std::size_t b = 0; b < width; ++b) packed_word |= std::uint32_t{bytes[b * points + i]} << (8 * b);
    const std::int64_t half = packed_word / 2;
    words[i] = packed_word % 2 == 0 ? half : -half - 1;
  }
  // Sums undo differences; those of the second order begin at the second point.
  if (order == 2)
    for (std::size_t i = 2; i < points; ++i) words[i] += words[i - 1];
  if (order >= 1)
    for (std::size_t i = 1; i < points; ++i) words[i] += words[i - 1];
  std::vector<double> out(points);
  for (std::size_t i = 0; i < points; ++i)
    out[i] = absent && bytes[width * points + i] == 1
                 ? std::numeric_limits<double>::quiet_NaN()
                 : static_cast<double>(words[i]) * packed["step"].get<double>();
  return out;
}

std::vector<std::uint8_t> unpack_codes(const nlohmann::ordered_json& packed) {
  return inflate_base64(packed["data"].get<std::string>());
}

}  // namespace kinemark::report::internal
