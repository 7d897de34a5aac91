// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinemark::io::testing {

/// The bytes of a number as they lie in memory.
template <class T>
std::string raw(T value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

/// A chunk with its length in `width` bytes (1, 4 or 8).
inline std::string chunk(std::uint16_t tag, const std::string& content, int width = 4) {
  const std::uint64_t size = content.size() + 2;
  return raw(static_cast<std::uint8_t>(width)) + raw(size).substr(0, static_cast<std::size_t>(width)) +
         raw(tag) + content;
}

/// Header of stream 1: markers with x, y, z in `unit`, and `more` channels.
inline std::string motion_header(const std::vector<std::string>& markers, double rate_hz,
                                 std::string_view format = "float32", const std::string& unit = "meters",
                                 const std::string& more = "", std::size_t more_channels = 0) {
  std::string channels;
  for (const auto& marker : markers)
    for (const char axis : {'X', 'Y', 'Z'})
      channels += "<channel><label>" + marker + "_" + axis + "</label><marker>" + marker +
                  "</marker><type>Position" + axis + "</type><unit>" + unit + "</unit></channel>";
  return chunk(2, raw(std::uint32_t{1}) +
                      "<?xml version=\"1.0\"?><info><name>OptiTrack</name><type>MoCap</type><channel_count>" +
                      std::to_string(3 * markers.size() + more_channels) + "</channel_count><nominal_srate>" +
                      std::to_string(rate_hz) + "</nominal_srate><channel_format>" + std::string(format) +
                      "</channel_format><desc><channels>" + channels + more + "</channels></desc></info>");
}

/// A sample with its time; a negative time is left out.
template <class T>
std::string sample(double time_s, const std::vector<T>& values) {
  std::string out = time_s < 0.0 ? raw(std::uint8_t{0}) : raw(std::uint8_t{8}) + raw(time_s);
  for (const T value : values) out += raw(value);
  return out;
}

/// A chunk of samples of a stream.
inline std::string samples(const std::vector<std::string>& all, std::uint32_t stream = 1) {
  std::string out = raw(stream) + raw(std::uint8_t{4}) + raw(static_cast<std::uint32_t>(all.size()));
  for (const auto& one : all) out += one;
  return chunk(3, out);
}

inline std::string offset(double when_s, double add_s, std::uint32_t stream = 1) {
  return chunk(4, raw(stream) + raw(when_s) + raw(add_s));
}

/// The beginning of a file.
inline std::string xdf_start() {
  return "XDF:" + chunk(1, "<?xml version=\"1.0\"?><info><version>1.0</version></info>", 1);
}

/// One marker "A" for `frames` frames of 100 Hz from 1000 s on, its x the number of the frame in mm.
inline std::string small_file(int frames = 5) {
  std::vector<std::string> all;
  for (int f = 0; f < frames; ++f)
    all.push_back(sample<float>(1000.0 + 0.01 * f, {0.001F * static_cast<float>(f), 0.5F, 1.0F}));
  return xdf_start() + motion_header({"A"}, 100.0) + samples(all) +
         chunk(6, raw(std::uint32_t{1}) + "<info/>");
}

}  // namespace kinemark::io::testing
