// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/internal/json_parts.h"

#include <algorithm>
#include <cmath>

#include "kinemark/core/check.h"

namespace kinemark::report::internal {

using Json = nlohmann::ordered_json;

Json number(double value, int decimals) {
  if (!std::isfinite(value)) return nullptr;
  const double scale = std::pow(10.0, decimals);
  const double rounded = std::round(value * scale) / scale;
  if (!std::isfinite(rounded)) return value;
  return rounded == 0.0 ? 0.0 : rounded;  // no minus in front of zero
}

Json significant(double value, int digits) {
  check(digits >= 1 && digits <= 17, "a number has 1 to 17 significant digits");
  if (!std::isfinite(value)) return nullptr;
  if (value == 0.0) return 0.0;
  const int decimals = digits - 1 - static_cast<int>(std::floor(std::log10(std::abs(value))));
  // A power of ten that is itself a number; what is smaller still is written as it is.
  return std::abs(decimals) > 300 ? Json(value) : number(value, decimals);
}

Json millimetres(double metres) { return number(1e3 * metres, 4); }

Json gates_json(std::span<const Gate> gates) {
  Json out = Json::array();
  for (const Gate& g : gates)
    out.push_back({{"name", g.name},
                   {"passed", g.passed},
                   {"value", number(g.value, 6)},
                   {"bound", number(g.bound, 6)},
                   {"unit", g.unit},
                   {"sentence", g.sentence}});
  return out;
}

Json findings_json(std::span<const Notice> findings) {
  Json out = Json::array();
  for (const Notice& f : findings)
    out.push_back({{"level", f.level == Verdict::attention ? "attention" : "note"},
                   {"about", f.about},
                   {"subject", f.subject},
                   {"text", f.text},
                   {"time_s", number(f.time_s, 6)}});
  return out;
}

Json groups_json(std::span<const NoticeGroup> groups) {
  constexpr std::size_t kMostItems = 2000;
  Json out = Json::array();
  for (const auto& group : groups) {
    const std::span<const Notice> shown(group.items.data(), std::min(group.items.size(), kMostItems));
    out.push_back({{"level", group.level == Verdict::attention ? "attention" : "note"},
                   {"title", group.title},
                   {"items", findings_json(shown)}});
  }
  return out;
}

Json options_json(std::span<const std::pair<std::string, std::string>> options) {
  Json out = Json::object();
  for (const auto& [key, value] : options) out[key] = value;
  return out;
}

}  // namespace kinemark::report::internal

namespace kinemark::report {

nlohmann::ordered_json inputs_json(std::span<const data::InputFile> inputs) {
  auto out = nlohmann::ordered_json::array();
  for (const data::InputFile& i : inputs)
    out.push_back({{"role", i.role},
                   {"path", i.path},
                   {"bytes", i.bytes},
                   {"hash", i.hash},
                   {"hash_kind", i.hash_kind}});
  return out;
}

}  // namespace kinemark::report
