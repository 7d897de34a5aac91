// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/path_measures.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "kinemark/core/enum_names.h"
#include "kinemark/core/index.h"
#include "kinemark/core/nearest_name.h"
#include "kinemark/core/parallel.h"
#include "kinemark/core/text.h"
#include "kinemark/data/interval_refits.h"
#include "kinemark/stages/analysis/path/definitions.h"
#include "kinemark/stages/analysis/path/measured_path.h"
#include "kinemark/stages/analysis/path/noise_sentences.h"

namespace kinemark::analysis {
namespace {

const PathDefinition* find_definition(std::string_view id) {
  for (const auto& definition : path_definitions())
    if (definition.what.id == id) return &definition;
  return nullptr;
}

// What one marker gives: its measures, and why it gives none.
struct MarkerMeasures : PathMeasures {
  std::optional<NotMeasured> not_measured;
};

MarkerMeasures measure_marker(const data::Trajectories& markers, std::int64_t marker,
                              const PathMeasureOptions& options) {
  MarkerMeasures out;
  auto path = MeasuredPath::create(markers, marker, options);
  if (!path) {
    out.not_measured = path.error();
    return out;
  }
  out.noises.push_back(path->noise());
  const std::vector<data::Region> whole{
      {.first_frame = markers.time.number(0), .last_frame = markers.time.number(markers.frames() - 1)}};
  const bool paths =
      options.curves || options.measures.empty() || std::ranges::any_of(options.measures, find_definition);
  const bool rhythms = options.rhythms || std::ranges::any_of(options.measures, find_rhythm_definition);
  for (const auto& region : options.regions.empty() ? whole : options.regions) {
    const auto say = [&](const std::string& what) {
      out.warnings.push_back(
          fmt::format("{}{}: {}", path->name(),
                      region.name.empty() ? "" : fmt::format(" in region '{}'", region.name), what));
    };
    if (paths) {
      PathCurves curves;
      auto measures = path->measure(region, options.curves ? &curves : nullptr);
      if (!measures) {
        say(measures.error());
        continue;
      }
      std::ranges::move(*measures, std::back_inserter(out.measures));
      if (options.curves) out.curves.push_back(std::move(curves));
    }
    if (!rhythms) continue;
    auto rhythm = path->rhythm(region);
    if (!rhythm) {
      say(rhythm.error());
      continue;
    }
    std::ranges::copy(rhythm->measures, std::back_inserter(out.measures));
    out.rhythms.push_back(std::move(*rhythm));
  }
  return out;
}

}  // namespace

Status check_regions(const TimeBase& time, const std::vector<data::Region>& regions) {
  const std::int64_t first = time.number(0), last = time.number(time.frames - 1);
  for (const auto& region : regions) {
    if (region.first_frame > region.last_frame)
      return fail(Code::bad_input, fmt::format("region '{}' ends in frame {}, before it begins in frame {}",
                                               region.name, region.last_frame, region.first_frame));
    if (region.first_frame > last || region.last_frame < first)
      return fail(
          Code::bad_input,
          fmt::format("region '{}', frames {} to {}, lies outside the recording, whose frames are {} to {}",
                      region.name, region.first_frame, region.last_frame, first, last));
  }
  return {};
}

std::vector<std::string> not_measured_sentences(std::span<const NotMeasured> markers) {
  std::vector<std::string> out;
  const auto named = [&](NotMeasuredWhy why) {
    std::vector<std::string> names;
    for (const auto& marker : markers)
      if (marker.why == why) names.push_back(marker.subject);
    return names;
  };
  if (const auto names = named(NotMeasuredWhy::made_samples); !names.empty())
    out.push_back(
        fmt::format("most samples of {} were made by the recorder: 'kinemark clean IN OUT --upsampled "
                    "decimate' leaves those that it measured",
                    listed(names)));
  if (const auto names = named(NotMeasuredWhy::too_few_samples); !names.empty()) {
    std::int64_t least = kLeastSamples, most = 0;
    for (const auto& marker : markers)
      if (marker.why == NotMeasuredWhy::too_few_samples)
        least = std::min(least, marker.samples), most = std::max(most, marker.samples);
    out.push_back(fmt::format(
        "{} {} measured in {} frames; need {} at least", listed(names), names.size() == 1 ? "was" : "were",
        least == most ? fmt::format("{}", most) : fmt::format("{} to {}", least, most), kLeastSamples));
  }
  if (const auto names = named(NotMeasuredWhy::unknown_noise); !names.empty())
    out.push_back(fmt::format("the noise of {} is not known: no seven frames in a row differ; state it",
                              listed(names)));
  if (const auto names = named(NotMeasuredWhy::too_slow); !names.empty())
    out.push_back(
        fmt::format("{:g} frames a second are too few to measure movement", markers.front().rate_hz));
  if (const auto names = named(NotMeasuredWhy::no_smoother); !names.empty())
    out.push_back(fmt::format("no smoother fits the samples of {}", listed(names)));
  return out;
}

Status PathMeasureOptions::check() const {
  if (auto s = data::check_interval_refits(refits, level); !s) return s;
  if (!(noise_sd_m >= 0.0) || !std::isfinite(noise_sd_m))
    return fail(Code::usage,
                fmt::format("a noise of {} m; need 0 (found from the data) or more", noise_sd_m));
  for (const auto& id : measures)
    if (find_definition(id) == nullptr && find_rhythm_definition(id) == nullptr) {
      std::vector<std::string> known;
      for (const auto& definition : path_definitions()) known.emplace_back(definition.what.id);
      for (const auto& definition : rhythm_definitions()) known.emplace_back(definition.id);
      const auto nearest = nearest_names(id, known);
      return fail(Code::usage,
                  fmt::format("there is no measure '{}'{}; --list shows them all", id,
                              nearest.empty() ? "" : fmt::format(" (nearest: {})", join(nearest))));
    }
  return {};
}

Result<PathMeasures> measure_paths(const data::Trajectories& markers, const PathMeasureOptions& options) {
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  if (markers.markers() == 0 || markers.frames() == 0)
    return fail(Code::bad_input, "there are no markers to measure; need at least one with samples");
  if (!(markers.time.rate_hz > 0.0))
    return fail(Code::bad_input, "the recording has no frame rate; measures of movement need one");
  if (auto s = check_regions(markers.time, options.regions); !s) return std::unexpected(s.error());
  std::vector<MarkerMeasures> each(at(markers.markers()));
  const auto measure_some = [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t m = begin; m < end; ++m) each[at(m)] = measure_marker(markers, m, options);
  };
  parallel_for(markers.markers(), 1, options.threads, measure_some);
  PathMeasures out;
  for (auto& one : each) std::ranges::move(one.noises, std::back_inserter(out.noises));
  out.warnings = noise_sentences(out.noises);
  std::vector<NotMeasured> not_measured;
  for (const auto& one : each)
    if (one.not_measured) not_measured.push_back(*one.not_measured);
  std::ranges::move(not_measured_sentences(not_measured), std::back_inserter(out.warnings));
  for (auto& one : each) {
    std::ranges::move(one.measures, std::back_inserter(out.measures));
    std::ranges::move(one.curves, std::back_inserter(out.curves));
    std::ranges::move(one.rhythms, std::back_inserter(out.rhythms));
    std::ranges::move(one.warnings, std::back_inserter(out.warnings));
  }
  return out;
}

}  // namespace kinemark::analysis
