// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/markers/lost_parts.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "kinemark/core/counted.h"
#include "kinemark/data/filtering.h"

namespace kinemark::io {
namespace {

struct PartWords {
  Part part;
  std::string_view heading;  ///< of its column
  std::string_view in_part;  ///< what a format does with it that keeps it in part
};

constexpr std::array<PartWords, kParts> kWords = {{
    {Part::provenance, "provenance", "shortened"},
    {Part::covariance, "covariances", "kept as one standard deviation for each sample"},
    {Part::sample_times, "sample times", "rounded"},
    {Part::residuals, "residuals, cameras", "shortened"},
    {Part::channels, "channels", "shortened"},
    {Part::analog, "analog", "shortened"},
    {Part::events, "events", "shortened"},
    {Part::force_plates, "force plates", "shortened"},
    {Part::groups, "other groups", "shortened"},
    {Part::filters, "filters, unfiltered samples", "shortened"},
    {Part::calibration, "calibration's error", "shortened"},
}};

/// Samples whose state says more than whether they are there.
std::string made_or_rejected(const data::Trajectories& t) {
  const auto n = std::ranges::count_if(t.state, [](data::SampleState s) {
    return s != data::SampleState::measured && s != data::SampleState::missing;
  });
  return n == 0 ? "" : fmt::format("the provenance of {}", counted(n, "sample"));
}

std::string residuals(const data::Trial& trial) {
  const bool some = std::ranges::any_of(trial.residual_m, [](float r) { return std::isfinite(r); }) ||
                    std::ranges::any_of(trial.camera_mask, [](std::uint8_t m) { return m != 0; });
  return some ? "reconstruction residuals" : "";
}

/// Whether every covariance is one standard deviation, the same in all directions.
bool all_round(const Array<double>& covariance) {
  for (std::size_t i = 0; i + 5 < covariance.size(); i += 6) {
    const double* c = &covariance[i];
    const bool round = c[0] == c[3] && c[0] == c[5] && c[1] == 0.0 && c[2] == 0.0 && c[4] == 0.0;
    if (!round && !std::isnan(c[0])) return false;
  }
  return true;
}

std::string channels(const data::Channels& c) {
  if (c.count() == 0) return "";
  return c.count() == 1 ? fmt::format("1 channel that is no marker ({})", c.names.front())
                        : fmt::format("{} channels that are no markers ({} to {})", c.count(),
                                      c.names.front(), c.names.back());
}

std::string number_of(std::size_t n, std::string_view one, std::string_view many = "") {
  return n == 0 ? "" : counted(static_cast<std::int64_t>(n), one, many);
}

/// By what markers were smoothed, and what went in.
std::string filters(const data::Trajectories& t) {
  bool any = !t.unfiltered_in_world.empty();
  for (std::int64_t m = 0; m < t.markers(); ++m) any = any || data::was_filtered(t, m);
  return !any                            ? ""
         : t.unfiltered_in_world.empty() ? "the filters of markers"
                                         : "the filters of markers and their samples from before";
}

std::string_view cell(Kept kept) {
  switch (kept) {
    case Kept::whole:
      return "yes";
    case Kept::in_part:
      return "in part";
    case Kept::none:
      break;
  }
  return "";
}

std::string row(const MarkerFormat& f) {
  std::string out = fmt::format("| {} | `{}` | {} | {} |", f.name, f.extension,
                                f.read != nullptr ? "yes" : "", f.write != nullptr ? f.precision : "");
  for (const auto& words : kWords)
    out += fmt::format(" {}{}", f.write == nullptr ? "" : cell(f.keeps(words.part)), " |");
  return out + "\n";
}

}  // namespace

std::string held(const data::Trial& trial, Part part) {
  const data::Trajectories& t = trial.markers;
  switch (part) {
    case Part::provenance:
      return made_or_rejected(t);
    case Part::covariance:
      return t.covariance.empty() ? "" : "covariances of samples";
    case Part::sample_times:
      return t.sample_offset_s.empty() ? "" : "times of samples within their frame";
    case Part::residuals:
      return residuals(trial);
    case Part::channels:
      return channels(trial.channels);
    case Part::analog:
      return number_of(trial.analog.names.size(), "analog channel");
    case Part::events:
      return number_of(trial.events.size(), "event");
    case Part::force_plates:
      return number_of(trial.force_plates.size(), "force plate");
    case Part::groups:
      return number_of(trial.foreign.size(), "group of parameters", "groups of parameters");
    case Part::filters:
      return filters(t);
    case Part::calibration:
      return trial.calibration_error.known() ? "what the calibration leaves unknown of all positions" : "";
  }
  return "";
}

std::vector<std::string> lost_in(const MarkerFormat& format, const data::Trial& trial) {
  std::vector<std::string> out;
  for (const auto& words : kWords) {
    if (format.keeps(words.part) == Kept::whole) continue;
    const std::string what = held(trial, words.part);
    if (what.empty()) continue;
    // What a format in part keeps may be all that there is.
    const bool in_part = format.keeps(words.part) == Kept::in_part;
    if (in_part && words.part == Part::covariance && all_round(trial.markers.covariance)) continue;
    out.push_back(format.keeps(words.part) == Kept::none
                      ? fmt::format("{} cannot be stored in a {} file", what, format.extension)
                      : fmt::format("{} are {} in a {} file", what, words.in_part, format.extension));
  }
  for (const std::string& what : trial.unread) out.push_back(fmt::format("not carried on: {}", what));
  if (auto beside = lost_beside(format.extension, trial.beside); !beside.empty())
    out.push_back(std::move(beside));
  return out;
}

std::string lost_beside(std::string_view extension, const data::Beside& beside) {
  constexpr std::size_t kNamed = 40;
  if (beside.objects.empty()) return "";
  const bool kept = extension == ".nwb";
  std::vector<std::string> lost;
  for (const auto& object : beside.objects)
    if (!kept)
      lost.push_back(object.path);
    else if (!object.lost.empty())
      lost.push_back(fmt::format("{} ({}: {})", object.path, object.type, object.lost));
  if (lost.empty()) return "";
  std::string names;
  for (std::size_t i = 0; i < std::min(lost.size(), kNamed); ++i)
    names += fmt::format("{}{}", i == 0 ? "" : ", ", lost[i]);
  if (lost.size() > kNamed) names += fmt::format(" and {} more", lost.size() - kNamed);
  return kept ? fmt::format("not carried on: {}", names)
              : fmt::format(
                    "not carried on: what its file holds besides movement ({}); only an .nwb file keeps "
                    "it, and info lists it",
                    names);
}

std::string marker_format_table() {
  std::string out = "| format | ending | read | written, coordinates |";
  for (const auto& words : kWords) out += fmt::format(" {} |", words.heading);
  out += "\n|---|---|---|---|";
  for (std::size_t k = 0; k < kParts; ++k) out += "---|";
  out += "\n";
  for (const MarkerFormat& format : marker_formats()) out += row(format);
  return out;
}

}  // namespace kinemark::io
