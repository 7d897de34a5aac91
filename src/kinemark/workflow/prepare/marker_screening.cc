// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/prepare/marker_screening.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/counted.h"
#include "kinemark/core/enum_names.h"
#include "kinemark/stages/trajectory/screening/real_samples.h"
#include "kinemark/stages/trajectory/screening/screen.h"
#include "kinemark/stages/trajectory/screening/upsampling.h"
#include "kinemark/workflow/foundations/foundation_gate.h"
#include "kinemark/workflow/prepare/exchanged_labels.h"

namespace kinemark::workflow {
namespace {

constexpr EnumNames<RecorderMade::decimate> kRecorderMade{"keep", "mark", "missing", "decimate"};

/// Whether one of the pairs is that of a label swap; the prefix of a subject may be left out.
bool by_hand(const data::Finding& swap, const std::vector<std::pair<std::string, std::string>>& pairs) {
  const auto same = [](const std::string& full, const std::string& name) {
    return full == name || full.ends_with(":" + name);
  };
  return std::ranges::any_of(pairs, [&](const auto& pair) {
    return (same(swap.subject, pair.first) && same(swap.partner, pair.second)) ||
           (same(swap.subject, pair.second) && same(swap.partner, pair.first));
  });
}

/// Whether a finding is of one of some markers.
bool is_of(const std::vector<std::int64_t>& which, const std::vector<std::string>& names,
           const data::Finding& finding) {
  return std::ranges::any_of(which, [&](std::int64_t m) {
    const auto& name = names[static_cast<std::size_t>(m)];
    return name == finding.subject || name == finding.partner;
  });
}

Status find_defects(data::Trial& trial, const ScreeningRules& rules, Screening& out) {
  if (!rules.find_defects) return {};
  const auto& markers = trial.markers;
  auto defects = trajectory::screen(markers, {.side = side_by_body});
  if (!defects) return std::unexpected(defects.error());
  out.defects = std::move(*defects);
  std::erase_if(out.defects, [&](const auto& defect) { return is_of(rules.apart, markers.names, defect); });
  if (rules.exchange_back) {
    out.exchanged = sure_swaps(out.defects, rules.sure);
    std::erase_if(out.exchanged, [&](const auto& swap) { return by_hand(swap, rules.swapped); });
    if (auto s = exchange_back(trial, out.exchanged); !s) return s;
  }
  for (const auto& swap : sure_swaps(out.defects, rules.sure))
    if (by_hand(swap, rules.swapped)) out.edited.push_back(swap);
  double samples = 0.0;
  for (const data::Finding& defect : out.defects) {
    if (defect.confidence < rules.sure || defect.kind == data::FindingKind::clock_jump) continue;
    if (defect.kind == data::FindingKind::label_swap &&
        (rules.exchange_back || by_hand(defect, rules.swapped)))
      continue;
    out.sure.push_back(defect);
    samples += static_cast<double>(defect.frame_count());
  }
  if (!out.sure.empty()) out.sure_share = samples / static_cast<double>(markers.state.size());
  return {};
}

Status reject_defects(data::Trial& trial, const ScreeningRules& rules, Screening& out) {
  if (!rules.reject_defects || out.sure.empty() || out.sure_share > rules.most_rejected) return {};
  auto rest = trajectory::reject_defects(trial.markers, out.sure, rules.sure);
  if (!rest) return std::unexpected(rest.error());
  trial.markers = std::move(*rest);
  out.rejected = true;
  return {};
}

Status find_upsampling(data::Trial& trial, const ScreeningRules& rules, Screening& out) {
  if (!rules.find_upsampling) return {};
  auto found = trajectory::detect_upsampling(trial.markers);
  if (!found) return std::unexpected(found.error());
  out.upsampling = std::move(*found);
  return {};
}

/// Analog samples and residuals belong to the old frames.
void change_frames(data::Trial& trial, data::Trajectories markers, Screening& out) {
  trial.residual_m.clear();
  trial.camera_mask.clear();
  trial.first_frame = 1;
  if (!trial.analog.names.empty()) {
    out.warnings.push_back(fmt::format(
        "{} left out: samples belong to the frames as they were recorded, not to those of {:g} Hz",
        counted(std::ssize(trial.analog.names), "analog channel"), markers.time.rate_hz));
    trial.analog = {};
    trial.force_plates.clear();
  }
  trial.markers = std::move(markers);
}

Status treat_made(data::Trial& trial, const ScreeningRules& rules, Screening& out) {
  if (!out.upsampling) return {};
  const RecorderMade choice = rules.recorder_made;
  const auto& found = *out.upsampling;
  if (choice == RecorderMade::keep || found.factor() == 1) return {};
  const auto made = choice == RecorderMade::mark      ? trajectory::MadeSamples::mark
                    : choice == RecorderMade::missing ? trajectory::MadeSamples::missing
                                                      : trajectory::MadeSamples::decimate;
  auto real = trajectory::keep_real_samples(trial.markers, found, made);
  if (!real) return std::unexpected(real.error());
  if (real->frames() != trial.markers.frames()) {
    change_frames(trial, std::move(*real), out);
    return {};
  }
  out.made_left_out = real->count_missing() - trial.markers.count_missing();
  trial.markers = std::move(*real);
  return {};
}

/// Which frames were measured; empty: all.
std::string upsampling_sentence(int factor, double rate_hz) {
  if (factor == 1) return {};
  return fmt::format(
      "the recorder measured at {:g} Hz and made {} of every {} frames: these are no "
      "measurements of their own ('kinemark clean --upsampled decimate' leaves the others)",
      rate_hz / factor, factor - 1, factor);
}

/// A part of a recording that shows what the recorder did: frames in its middle, of markers that are seen in
/// them, at even distances in their order.
data::Trajectories glimpse_of(const data::Trajectories& markers) {
  constexpr std::int64_t kFrames = 2048, kMarkers = 12;
  const auto count = std::min(kFrames, markers.frames()), first = (markers.frames() - count) / 2;
  std::vector<std::int64_t> seen;
  for (std::int64_t m = 0; m < markers.markers(); ++m) {
    std::int64_t present = 0;
    for (std::int64_t f = first; f < first + count; ++f) present += markers.present(f, m);
    if (2 * present > count) seen.push_back(m);
  }
  const auto taken = std::min(kMarkers, std::ssize(seen));
  std::vector<std::int64_t> chosen;
  for (std::int64_t k = 0; k < taken; ++k)
    chosen.push_back(seen[static_cast<std::size_t>(k * std::ssize(seen) / taken)]);
  std::vector<std::string> names;
  for (const auto m : chosen) names.push_back(markers.names[static_cast<std::size_t>(m)]);
  auto time = markers.time;
  time.t0_s = markers.time.time_s(first);
  time.frames = count;
  auto out = data::Trajectories::all_missing(std::move(names), time);
  for (std::int64_t f = 0; f < count; ++f)
    for (std::int64_t k = 0; k < taken; ++k) {
      const auto m = chosen[static_cast<std::size_t>(k)];
      out.x(f, k) = markers.x(first + f, m);
      out.state[out.index(f, k)] = markers.state[markers.index(first + f, m)];
    }
  return out;
}

}  // namespace

std::string_view to_string(RecorderMade made) { return kRecorderMade[made]; }

Result<RecorderMade> parse_recorder_made(std::string_view name) {
  return kRecorderMade.parse(name, "choice for samples that the recorder made");
}

Result<Screening> screen_markers(data::Trial& trial, const ScreeningRules& rules) {
  using Step = Status (*)(data::Trial&, const ScreeningRules&, Screening&);
  constexpr std::array<Step, 4> kAsRecorded = {find_defects, find_upsampling, reject_defects, treat_made};
  constexpr std::array<Step, 4> kMadeFirst = {find_upsampling, treat_made, find_defects, reject_defects};
  Screening out;
  for (const Step step : rules.made_first ? kMadeFirst : kAsRecorded)
    if (auto s = step(trial, rules, out); !s) return std::unexpected(s.error());
  return out;
}

std::vector<std::string> swap_sentences(const Screening& screening, const TimeBase& time) {
  std::vector<std::string> out;
  for (const auto& swap : screening.exchanged) out.push_back("Exchanged back: " + sentence_of(swap, time));
  for (const auto& swap : screening.edited)
    out.push_back("Left as edits have it: " + sentence_of(swap, time));
  return out;
}

Result<int> made_factor(const data::Trajectories& markers) {
  const auto glimpse = glimpse_of(markers);
  if (glimpse.markers() == 0) return 1;
  const auto found = trajectory::detect_upsampling(glimpse);
  if (!found) return std::unexpected(found.error());
  return found->factor();
}

Result<std::string> note_on_upsampling(const data::Trajectories& markers) {
  const auto factor = made_factor(markers);
  if (!factor) return std::unexpected(factor.error());
  return upsampling_sentence(*factor, markers.time.rate_hz);
}

Status leave_out_defects(data::Trial& trial, bool keep_defects,
                         const std::vector<std::pair<std::string, std::string>>& swapped,
                         std::vector<std::string>& warnings) {
  constexpr std::size_t kListed = 5;
  const auto screening = screen_markers(trial, {.recorder_made = RecorderMade::mark,
                                                .find_defects = !keep_defects,
                                                .exchange_back = true,
                                                .swapped = swapped,
                                                .reject_defects = true});
  if (!screening) return std::unexpected(screening.error());
  if (auto note = upsampling_sentence(screening->upsampling->factor(), trial.markers.time.rate_hz);
      !note.empty())
    warnings.push_back(std::move(note));
  std::ranges::move(swap_sentences(*screening, trial.markers.time), std::back_inserter(warnings));
  const auto& sure = screening->sure;
  for (std::size_t i = 0; i < std::min(sure.size(), kListed); ++i)
    warnings.push_back("Left out: " + sentence_of(sure[i], trial.markers.time));
  if (sure.size() > kListed)
    warnings.push_back(fmt::format("Left out: {} more defects like these.", sure.size() - kListed));
  return {};
}

}  // namespace kinemark::workflow
