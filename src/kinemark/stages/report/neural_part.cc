// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/neural_part.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kinemark/stages/report/internal/json_parts.h"
#include "kinemark/stages/report/internal/track_block.h"

namespace kinemark::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::int64_t kSpikeBins = 3000;
constexpr double kFinestBin_s = 0.001;
constexpr std::size_t kMostUnits = 500, kMostTrials = 2000;
constexpr int kLevels = 254;  // of a value's byte
constexpr std::uint8_t kNoSample = 255;

Json codes(std::span<const std::uint8_t> bytes) {
  return {{"kind", "codes"}, {"data", internal::deflated(bytes)}};
}

Json unit_json(const data::SpikeTrain& unit, double start_s, double bin_s, std::int64_t bins) {
  std::vector<std::uint8_t> counts(static_cast<std::size_t>(bins), 0);
  std::int64_t inside = 0;
  for (const double time_s : unit.times_s) {
    const double at = std::floor((time_s - start_s) / bin_s);
    if (!(at >= 0.0 && at < static_cast<double>(bins))) continue;
    ++inside;
    auto& count = counts[static_cast<std::size_t>(at)];
    if (count < 255) ++count;
  }
  return {{"id", unit.id}, {"spikes", inside}, {"counts", codes(counts)}};
}

Json trials_json(const data::Neural& neural, double start_s, double end_s) {
  Json out = Json::array();
  const auto* trials = neural.find_intervals("trials");
  if (trials == nullptr) return out;
  for (const auto& row : trials->rows) {
    if (!(row.stop_s >= start_s && row.start_s <= end_s) || out.size() == kMostTrials) continue;
    std::string label;
    for (const auto& one : row.labels) label += (label.empty() ? "" : ", ") + one.column + " " + one.value;
    out.push_back({{"label", label},
                   {"start_s", internal::number(row.start_s, 6)},
                   {"stop_s", internal::number(row.stop_s, 6)}});
  }
  return out;
}

/// One channel: bytes of its lower and upper bounds between its least and its largest value.
Json channel_json(const data::FieldEnvelope& field, std::size_t channel) {
  const std::size_t width = field.channels.size(), bins = static_cast<std::size_t>(field.bins);
  double least = 0.0, most = 0.0;
  bool any = false;
  for (std::size_t b = 0; b < bins; ++b) {
    const double low = field.low[b * width + channel], high = field.high[b * width + channel];
    if (std::isnan(low)) continue;
    least = any ? std::min(least, low) : low;
    most = any ? std::max(most, high) : high;
    any = true;
  }
  const double step = most > least ? (most - least) / kLevels : 1.0;
  std::vector<std::uint8_t> low(bins, kNoSample), high(bins, kNoSample);
  for (std::size_t b = 0; b < bins; ++b) {
    const double from = field.low[b * width + channel], to = field.high[b * width + channel];
    if (std::isnan(from)) continue;
    low[b] = static_cast<std::uint8_t>(std::clamp(std::floor((from - least) / step), 0.0, 1.0 * kLevels));
    high[b] = static_cast<std::uint8_t>(std::clamp(std::ceil((to - least) / step), 0.0, 1.0 * kLevels));
  }
  return {{"name", field.channels[channel]},
          {"least", least},
          {"step", step},
          {"low", codes(low)},
          {"high", codes(high)}};
}

Json fields_json(const data::Neural& neural, double start_s, double end_s) {
  Json out = Json::array();
  for (const auto& field : neural.fields) {
    const double stop_s = field.start_s + field.bin_s * static_cast<double>(field.bins);
    if (stop_s < start_s || field.start_s > end_s) continue;
    Json channels = Json::array();
    for (std::size_t k = 0; k < field.channels.size(); ++k) channels.push_back(channel_json(field, k));
    out.push_back({{"name", field.name},
                   {"unit", field.unit},
                   {"start_s", field.start_s},
                   {"bin_s", field.bin_s},
                   {"bins", field.bins},
                   {"channels", std::move(channels)}});
  }
  return out;
}

}  // namespace

nlohmann::ordered_json neural_json(const data::Neural& neural, double start_s, double end_s) {
  if (!(end_s > start_s)) return nullptr;
  const double bin_s = std::max(kFinestBin_s, (end_s - start_s) / static_cast<double>(kSpikeBins));
  const auto bins = static_cast<std::int64_t>(std::floor((end_s - start_s) / bin_s)) + 1;
  Json units = Json::array();
  for (const auto& unit : neural.units)
    if (units.size() < kMostUnits) units.push_back(unit_json(unit, start_s, bin_s, bins));
  Json trials = trials_json(neural, start_s, end_s), fields = fields_json(neural, start_s, end_s);
  if (units.empty() && trials.empty() && fields.empty()) return nullptr;
  return {{"start_s", start_s},
          {"bin_s", bin_s},
          {"bins", bins},
          {"unit_count", neural.units.size()},
          {"units", std::move(units)},
          {"trials", std::move(trials)},
          {"fields", std::move(fields)}};
}

}  // namespace kinemark::report
