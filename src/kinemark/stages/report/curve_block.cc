// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/internal/curve_block.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

#include "kinemark/core/check.h"
#include "kinemark/stages/report/internal/track_block.h"

namespace kinemark::report::internal {
namespace {

using Json = nlohmann::ordered_json;
using Words = std::vector<std::uint32_t>;
constexpr double kMostWord = 2147483647.0;
constexpr double kSdPerStep = 16.0, kStepsPerReach = 2000.0;
constexpr double kStepsPerSmallest = 20.0, kStepsPerMedian = 1000.0;

std::vector<float> finite(std::span<const float> values) {
  std::vector<float> out;
  std::ranges::copy_if(values, std::back_inserter(out), [](float v) { return std::isfinite(v); });
  return out;
}

/// The largest of 1, 2, 5 times a power of ten that is at most x > 0.
double round_down(double x) {
  const int exponent = static_cast<int>(std::floor(std::log10(x)));
  // Divided by a whole power, a small step is the number nearest to its decimals.
  const auto times_power = [](double digit, int e) {
    return e < 0 ? digit / std::pow(10.0, -e) : digit * std::pow(10.0, e);
  };
  double best = times_power(5.0, exponent - 1);
  for (const double digit : {1.0, 2.0, 5.0})
    if (times_power(digit, exponent) <= x) best = times_power(digit, exponent);
  return best;
}

/// At most `wanted`, but such that the largest value has a word.
double within_words(double wanted, std::span<const float> finite_values) {
  double largest = 0.0;
  for (const float v : finite_values) largest = std::max(largest, std::abs(double{v}));
  const double step = round_down(wanted);
  return largest / step < kMostWord - 1.0 ? step : round_down(10.0 * largest / kMostWord);
}

double median(std::vector<float> values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::ranges::nth_element(values, middle);
  return *middle;
}

std::uint32_t zigzag(std::uint32_t difference) {
  return difference << 1U ^ (difference >> 31U == 0 ? 0U : 0xFFFFFFFFU);
}

/// Words as they are (order 0), their differences (1), or the differences of those (2), small ones as small
/// numbers.
Words differences(const Words& words, int order) {
  Words out(words.size());
  std::uint32_t before = 0, slope = 0;
  for (std::size_t i = 0; i < words.size(); ++i) {
    std::uint32_t d = words[i];
    if (order > 0) d -= before;
    const std::uint32_t change = d;
    if (order == 2 && i > 1) d -= slope;
    slope = change;
    before = words[i];
    out[i] = zigzag(d);
  }
  return out;
}

std::int64_t bits_of(const Words& words) {
  std::int64_t bits = 0;
  for (const std::uint32_t word : words) bits += std::bit_width(word);
  return bits;
}

}  // namespace

double curve_step(std::span<const float> values, std::span<const float> sd, double usual) {
  check(usual > 0.0, "curve_step() needs a usual step above 0");
  const auto known = finite(values);
  if (known.empty()) return round_down(usual);
  double step = usual;
  const auto deviations = finite(sd);
  if (!deviations.empty() && median(deviations) > 0.0F)
    step = std::min(step, median(deviations) / kSdPerStep);
  const auto [low, high] = std::ranges::minmax(known);
  if (high > low) step = std::min(step, (double{high} - double{low}) / kStepsPerReach);
  return within_words(step, known);
}

double deviation_step(std::span<const float> sd) {
  auto known = finite(sd);
  std::erase_if(known, [](float v) { return v <= 0.0F; });
  if (known.empty()) return 1.0;
  const double smallest = *std::ranges::min_element(known);
  return within_words(std::max(smallest / kStepsPerSmallest, median(known) / kStepsPerMedian), known);
}

Json pack_curve(std::span<const float> values, double step) {
  check(step > 0.0, "pack_curve() needs a step above 0");
  Words words(values.size());
  std::vector<std::uint8_t> absent(values.size(), 0);
  const auto first = std::ranges::find_if(values, [](float v) { return std::isfinite(v); });
  std::uint32_t held = 0;
  const auto to_word = [&](float v) {
    const double word = std::round(double{v} / step);
    check(std::abs(word) <= kMostWord, "pack_curve() needs a step that is not too fine");
    return static_cast<std::uint32_t>(static_cast<std::int64_t>(word));
  };
  if (first != values.end()) held = to_word(*first);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool here = std::isfinite(values[i]);
    if (here) held = to_word(values[i]);
    absent[i] = here ? 0 : 1;
    words[i] = held;
  }
  int order = 0;
  Words best = differences(words, 0);
  for (const int other : {1, 2}) {
    Words d = differences(words, other);
    if (bits_of(d) >= bits_of(best)) continue;
    best = std::move(d);
    order = other;
  }
  std::uint32_t all = 0;
  for (const std::uint32_t word : best) all |= word;
  const std::size_t width = (static_cast<std::size_t>(std::bit_width(all)) + 7) / 8;
  const bool any_absent = std::ranges::find(absent, 1) != absent.end();
  std::vector<std::uint8_t> bytes;
  bytes.reserve((width + 1) * values.size());
  for (std::size_t b = 0; b < width; ++b)
    for (const std::uint32_t word : best) bytes.push_back(static_cast<std::uint8_t>(word >> (8 * b)));
  if (any_absent) bytes.insert(bytes.end(), absent.begin(), absent.end());
  return {{"kind", "rounded"}, {"step", step},         {"order", order},
          {"bytes", width},    {"absent", any_absent}, {"data", deflated(bytes)}};
}

Json pack_codes(std::span<const std::uint8_t> codes) {
  return {{"kind", "codes"}, {"data", deflated(codes)}};
}

std::int64_t room(const Json& json) {
  if (json.is_string()) return std::ssize(json.get_ref<const std::string&>()) + 2;
  std::int64_t sum = 8;
  if (json.is_structured())
    for (const auto& part : json) sum += 8 + room(part);
  return sum;
}

Json pack_within(std::int64_t points, std::int64_t most, const std::function<Json(const PlotPoints&)>& pack) {
  std::int64_t wanted = std::max<std::int64_t>(2, points);
  for (;;) {
    const PlotPoints thinned(points, wanted);
    Json out = pack(thinned);
    const std::int64_t taken = room(out);
    if (taken <= most || thinned.size() <= 2) return out;
    const double share = static_cast<double>(most) / static_cast<double>(taken);
    wanted = std::clamp(static_cast<std::int64_t>(share * static_cast<double>(thinned.size())),
                        std::int64_t{2}, thinned.size() - 1);
  }
}

}  // namespace kinemark::report::internal
