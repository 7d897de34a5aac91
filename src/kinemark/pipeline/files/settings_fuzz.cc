// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Any bytes: options of a command, which read back the same from what is written of them, or what is wrong.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kinemark/pipeline/files/settings_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinemark;
  const auto settings = pipeline::parse_settings({reinterpret_cast<const char*>(data), size}, "fuzz.toml");
  if (!settings) return settings.error().message.empty() ? std::abort(), 0 : 0;
  const std::string text = pipeline::settings_text(*settings);
  const auto again = pipeline::parse_settings(text, "again.toml");
  if (!again || again->command != settings->command || again->list.size() != settings->list.size())
    std::abort();
  for (std::size_t i = 0; i < settings->list.size(); ++i) {
    const auto &a = settings->list[i], &b = again->list[i];
    if (a.name != b.name || a.values != b.values || a.is_switch != b.is_switch || a.on != b.on) std::abort();
  }
  return 0;
}
