// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/internal/track_block.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include "kinemark/core/check.h"
#include "kinemark/stages/report/internal/base64.h"

namespace kinemark::report::internal {
namespace {

using Json = nlohmann::ordered_json;
constexpr double kMostSteps = 65'535.0;

struct Reach {
  double low = 0.0, high = 0.0;
  bool any = false;
};

Reach reach_of(std::span<const double> series) {
  Reach reach;
  for (const double v : series) {
    if (!std::isfinite(v)) continue;
    reach.low = reach.any ? std::min(reach.low, v) : v;
    reach.high = reach.any ? std::max(reach.high, v) : v;
    reach.any = true;
  }
  return reach;
}

/// Words of a series, each less the one before it: the lowest bytes of all, then the next ones. A word that
/// is absent repeats the one before it.
template <class Word, class ToWord>
void put_planes(std::span<const double> series, const ToWord& to_word, std::span<std::uint8_t> bytes,
                std::size_t at, std::size_t plane) {
  const auto first = std::ranges::find_if(series, [](double v) { return std::isfinite(v); });
  Word held = first == series.end() ? Word{0} : to_word(*first);
  Word before = 0;
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (std::isfinite(series[i])) held = to_word(series[i]);
    const auto change = static_cast<Word>(held - before);
    before = held;
    for (std::size_t b = 0; b < sizeof(Word); ++b)
      bytes[b * plane + at + i] = static_cast<std::uint8_t>(change >> (8 * b));
  }
}

}  // namespace

std::string deflated(std::span<const std::uint8_t> bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::vector<std::uint8_t> out(size);
  const int status = compress2(out.data(), &size, bytes.data(), static_cast<uLong>(bytes.size()), 6);
  check(status == Z_OK, "zlib cannot deflate");
  return base64(std::span<const std::uint8_t>(out.data(), size));
}

Json pack_series(std::span<const double> values, std::int64_t points, double finest, double coarsest) {
  check(points >= 0 && finest > 0.0 && coarsest >= finest, "pack_series() needs steps above 0");
  const auto length = static_cast<std::size_t>(points);
  check(length == 0 ? values.empty() : values.size() % length == 0, "pack_series() needs whole series");
  const std::size_t count = length == 0 ? 0 : values.size() / length;
  Json offsets = Json::array(), steps = Json::array();
  bool fits = true;
  for (std::size_t s = 0; s < count; ++s) {
    const Reach reach = reach_of(values.subspan(s * length, length));
    const double step = std::max(finest, (reach.high - reach.low) / kMostSteps);
    fits = fits && step <= coarsest;
    offsets.push_back(reach.low);
    steps.push_back(step);
  }
  std::vector<std::uint8_t> bytes(values.size() * (fits ? 2 : 4));
  for (std::size_t s = 0; s < count; ++s) {
    const auto series = values.subspan(s * length, length);
    const double low = offsets[s].get<double>(), step = steps[s].get<double>();
    if (fits)
      put_planes<std::uint16_t>(
          series, [&](double v) { return static_cast<std::uint16_t>(std::llround((v - low) / step)); }, bytes,
          s * length, values.size());
    else
      put_planes<std::uint32_t>(
          series, [](double v) { return std::bit_cast<std::uint32_t>(static_cast<float>(v)); }, bytes,
          s * length, values.size());
  }
  Json out = {{"kind", fits ? "int16" : "float32"}, {"series", count}, {"points", points}};
  if (fits) {
    out["offset"] = std::move(offsets);
    out["step"] = std::move(steps);
  }
  out["data"] = deflated(bytes);
  return out;
}

}  // namespace kinemark::report::internal
