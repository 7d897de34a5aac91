// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/c3d/unfiltered.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <set>
#include <utility>

#include "kinemark/core/counted.h"
#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/number.h"
#include "kinemark/data/filtering.h"
#include "kinemark/io/c3d/provenance.h"

namespace kinemark::io {
namespace {

constexpr const char* kFilters = "FILTERS";
constexpr const char* kPrefix = "UNFILTERED_PREFIX";
constexpr std::size_t kTextsPerParameter = 200;
constexpr std::size_t kLongestMethod = 100;

std::string text_of(const data::FilterUsed& used) {
  if (!data::is_filter(used)) return "";
  return fmt::format("{} {} {} {}", used.method.substr(0, kLongestMethod), used.order, used.cutoff_hz,
                     used.noise_sd_m);
}

/// The last word of a text, which loses it.
std::string take_word(std::string& text) {
  const auto at = text.rfind(' ');
  if (at == std::string::npos) return "";
  std::string word = text.substr(at + 1);
  text.resize(at);
  return word;
}

/// The filter that a text tells; nothing where it is none of ours.
std::optional<data::FilterUsed> filter_of(std::string text) {
  if (text.empty()) return data::FilterUsed{"none", 0, kNaN, kNaN};
  const auto noise = parse_number(take_word(text)), cutoff = parse_number(take_word(text)),
             order = parse_number(take_word(text));
  if (!noise || !cutoff || !order || !(std::abs(*order) <= 1000.0) || text.empty()) return std::nullopt;
  return data::FilterUsed{.method = std::move(text),
                          .order = static_cast<int>(*order),
                          .cutoff_hz = *cutoff,
                          .noise_sd_m = *noise};
}

void read_filters(const C3dParameters& parameters, data::Trial& trial) {
  const std::vector<std::string> texts = parameters.texts(kProvenanceGroup, kFilters);
  if (texts.empty()) return;
  std::vector<data::FilterUsed> filters;
  for (const std::string& text : texts)
    if (auto filter = filter_of(text)) filters.push_back(std::move(*filter));
  if (texts.size() != trial.markers.names.size() || filters.size() != texts.size()) {
    trial.warnings.emplace_back(
        "KINEMARK:FILTERS does not fit the markers; that some were smoothed is known, by what is not");
    return;
  }
  trial.markers.filters = std::move(filters);
}

/// Channels without those of some indices, which rise.
void remove(data::Channels& all, const std::vector<std::int64_t>& gone) {
  const auto before = all.count();
  std::vector<std::size_t> kept;
  for (std::int64_t c = 0; c < before; ++c)
    if (!std::ranges::binary_search(gone, c)) kept.push_back(at(c));
  data::Channels out{.rate_hz = kept.empty() ? 0.0 : all.rate_hz, .frames = kept.empty() ? 0 : all.frames};
  for (const std::size_t c : kept) {
    out.names.push_back(std::move(all.names[c]));
    out.kinds.push_back(all.kinds[c]);
    out.units.push_back(std::move(all.units[c]));
  }
  out.values.reserve(at(3 * out.frames) * kept.size());
  for (std::int64_t f = 0; f < out.frames; ++f)
    for (const std::size_t c : kept) {
      const auto from = all.values.begin() + 3 * (f * before + static_cast<std::int64_t>(c));
      out.values.insert(out.values.end(), from, from + 3);
    }
  all = std::move(out);
}

}  // namespace

std::vector<std::int64_t> unfiltered_markers(const data::Trajectories& markers) {
  std::vector<std::int64_t> out;
  for (std::int64_t m = 0; m < markers.markers(); ++m)
    if (data::keeps_unfiltered(markers, m)) out.push_back(m);
  return out;
}

std::string unfiltered_prefix(const data::Trial& trial) {
  const std::set<std::string> taken = [&] {
    std::set<std::string> names(trial.markers.names.begin(), trial.markers.names.end());
    names.insert(trial.channels.names.begin(), trial.channels.names.end());
    return names;
  }();
  std::string prefix = "unfiltered_";
  const auto meets = [&](const std::string& name) { return taken.contains(prefix + name); };
  while (std::ranges::any_of(trial.markers.names, meets)) prefix += '_';
  return prefix;
}

void add_filters(const data::Trial& trial, bool with_points, C3dParameters& parameters) {
  const auto& filters = trial.markers.filters;
  if (std::ranges::none_of(filters, data::is_filter) && !with_points) return;
  C3dGroup& group = parameters.group(kProvenanceGroup);
  int part = 1;
  for (std::size_t begin = 0; begin < filters.size(); begin += kTextsPerParameter) {
    std::vector<std::string> texts;
    for (std::size_t m = begin; m < std::min(filters.size(), begin + kTextsPerParameter); ++m)
      texts.push_back(text_of(filters[m]));
    const auto width = std::max<std::size_t>(1, std::ranges::max(texts, {}, &std::string::size).size());
    group.parameters.push_back({.name = part == 1 ? kFilters : fmt::format("{}{}", kFilters, part),
                                .type = C3dType::text,
                                .dims = {static_cast<int>(width), static_cast<int>(texts.size())},
                                .texts = std::move(texts)});
    if (part++ == 1)
      group.parameters.back().description =
          "of each marker: filter, order, -3 dB in Hz, noise before it in m";
  }
  if (!with_points) return;
  const std::string prefix = unfiltered_prefix(trial);
  group.parameters.push_back({.name = kPrefix,
                              .type = C3dType::text,
                              .dims = {static_cast<int>(prefix.size())},
                              .texts = {prefix},
                              .description = "points of this name are samples before the filter"});
}

void take_filters(const C3dParameters& parameters, const C3dLayout& layout, data::Trial& trial) {
  read_filters(parameters, trial);
  const std::string prefix = parameters.text(kProvenanceGroup, kPrefix);
  if (prefix.empty()) return;
  const std::vector<std::string> listed = parameters.texts("POINT", kC3dUnfilteredList);
  data::Trajectories& t = trial.markers;
  data::Channels& channels = trial.channels;
  std::vector<std::int64_t> taken;
  std::int64_t strangers = 0;
  for (std::int64_t c = 0; c < channels.count(); ++c) {
    const std::string& name = channels.names[at(c)];
    if (std::ranges::find(listed, name) == listed.end() || !name.starts_with(prefix)) continue;
    const std::int64_t m = t.find(name.substr(prefix.size()));
    strangers += m < 0 ? 1 : 0;
    if (m < 0) continue;
    if (t.unfiltered_in_world.empty()) t.unfiltered_in_world.assign(t.x_in_world.size(), kNaN);
    for (std::int64_t f = 0; f < t.frames(); ++f)
      for (std::size_t axis = 0; axis < 3; ++axis)
        t.unfiltered_in_world[3 * t.index(f, m) + axis] =
            channels.values[at(3 * (f * channels.count() + c)) + axis] * layout.metres_per_unit;
    taken.push_back(c);
  }
  if (!taken.empty()) remove(channels, taken);
  if (strangers > 0)
    trial.warnings.push_back(fmt::format("{} of samples before the filter {} to no marker and {} read as {}",
                                         counted(strangers, "point"), strangers == 1 ? "belongs" : "belong",
                                         strangers == 1 ? "is" : "are",
                                         strangers == 1 ? "a channel" : "channels"));
}

}  // namespace kinemark::io
