// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/session/trial_name.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <system_error>

#include "kinemark/core/utf8.h"

namespace kinemark::pipeline {
namespace {

constexpr int kMostNames = 10000;             // that are tried for a free one
constexpr std::size_t kLongestTrial = 200;    // bytes; a file's name has 255 with its ending
constexpr std::size_t kMostNumberDigits = 9;  // of the number at a name's end

bool is_control(unsigned char c) { return c < 0x20 || c == 0x7F; }

}  // namespace

std::string next_trial(const std::string& name) {
  std::size_t digits = 0;
  while (digits < name.size() && digits < kMostNumberDigits &&
         std::isdigit(static_cast<unsigned char>(name[name.size() - 1 - digits])) != 0)
    ++digits;
  if (digits == 0) return name + "_02";
  const std::string number = name.substr(name.size() - digits);
  return name.substr(0, name.size() - digits) + fmt::format("{:0{}}", std::stol(number) + 1, digits);
}

std::filesystem::path trial_file(const std::filesystem::path& folder, const std::string& name) {
  return (folder / (name + ".mcap")).lexically_normal();
}

std::string free_trial(const std::filesystem::path& folder, const std::string& name) {
  std::string out = name;
  std::error_code none;
  for (int tries = 0; tries < kMostNames &&
                      std::filesystem::exists(std::filesystem::symlink_status(trial_file(folder, out), none));
       ++tries)
    out = next_trial(out);
  return out;
}

Status check_trial_name(const std::string& name) {
  if (name.empty()) return fail(Code::usage, "Trial: a name is missing");
  if (name.find_first_of("/\\") == std::string::npos && name.front() != '.' && name.size() <= kLongestTrial &&
      is_utf8(name) && std::ranges::none_of(name, is_control))
    return {};
  return fail(Code::usage,
              fmt::format("Trial: '{}' cannot name a file; need up to {} bytes without '/', '\\' and control "
                          "characters, and no '.' at the beginning",
                          printable(name, 60), kLongestTrial));
}

}  // namespace kinemark::pipeline
