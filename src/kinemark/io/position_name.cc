// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/position_name.h"

#include <algorithm>
#include <array>
#include <string>

namespace kinemark::io {

namespace {

template <std::size_t N>
bool is_one_of(const std::array<std::string_view, N>& words, std::string_view word) {
  return std::ranges::find(words, word) != words.end();
}

bool is_of_something_else(std::string_view word) {
  constexpr std::array<std::string_view, 15> kWords{"acc", "accel", "gyr",   "gyro", "mag",
                                                    "vel", "speed", "euler", "quat", "grf",
                                                    "rot", "eul",   "omega", "ori",  "grfs"};
  constexpr std::array<std::string_view, 8> kBegun{"accelerat", "gyroscop", "magnet",     "velocit",
                                                   "angular",   "rotat",    "quaternion", "orient"};
  // "LHipAngles", "RGroundReactionForce": the outputs of models.
  constexpr std::array<std::string_view, 12> kEnds{"angle",  "angles",   "force",        "forces",
                                                   "moment", "moments",  "torque",       "power",
                                                   "powers", "velocity", "acceleration", "torques"};
  if (word.ends_with("triangle")) return false;
  return is_one_of(kWords, word) ||
         std::ranges::any_of(kBegun, [&](std::string_view begun) { return word.starts_with(begun); }) ||
         std::ranges::any_of(kEnds, [&](std::string_view end) { return word.ends_with(end); });
}

}  // namespace

bool names_no_position(std::string_view name) {
  if (name == "F" || name == "f") return true;  // a force
  std::string word;
  for (std::size_t i = 0; i <= name.size(); ++i) {
    if (const char c = i < name.size() ? static_cast<char>(name[i] | 0x20) : ' '; c >= 'a' && c <= 'z') {
      word += c;
      continue;
    }
    if (is_of_something_else(word)) return true;
    word.clear();
  }
  return false;
}

}  // namespace kinemark::io
