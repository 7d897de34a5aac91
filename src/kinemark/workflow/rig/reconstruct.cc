// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/rig/reconstruct.h"

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/camera/light.h"
#include "kinemark/camera/usable.h"
#include "kinemark/core/enum_names.h"
#include "kinemark/core/index.h"
#include "kinemark/core/utf8.h"

namespace kinemark::workflow {

std::string_view to_string(ReconstructMethod method) {
  constexpr EnumNames<ReconstructMethod::classic> kNames{"smoother", "frames", "classic"};
  return kNames[method];
}

namespace {

constexpr double kDim = 0.3, kDimmer = 0.8, kBrighter = 1.25;  // of the light of the calibration
constexpr double kSure = 2.0;                                  // SD

bool knows_dark(const data::Rig& rig) {
  return std::ranges::all_of(rig.cameras, [](const auto& c) { return c.detector.knows_dark(); });
}

/// What there is to say of an LED's light.
std::string light_sentence(const std::string& led, const reconstruction::LedLight& found, bool dark_known) {
  const double off = found.light < 1.0 ? kDimmer - found.light : found.light - kBrighter;
  if (found.source == reconstruction::LightSource::unknown ||
      !(off > kSure * found.light_sd || (dark_known && off > 0.0)))
    return {};
  return fmt::format("LED '{}' shines with {:.3f} +- {:.1g} of the light of the calibration's LEDs{}; {}",
                     printable(led, 60), found.light, found.light_sd, found.light < kDim ? ": it is dim" : "",
                     dark_known
                         ? "the offsets are those of its light"
                         : "how much of the offsets goes with it is not known, and its positions' deviations "
                           "say so; calibrate with a dark slot");
}

/// Observations of an LED that stand at the converter's highest code, in one channel and in more.
std::string saturation_sentence(const data::Counts& counts, std::int64_t led) {
  std::int64_t one = 0, more = 0;
  for (std::int64_t f = 0; f < counts.frames(); ++f)
    for (std::int64_t c = 0; c < counts.camera_count(); ++c) {
      const auto full = 4.0 - camera::kept_channels(counts.at(f, led, c), counts.highest_code).sum();
      one += full == 1.0, more += full > 1.0;
    }
  if (one + more == 0) return {};
  return fmt::format(
      "LED '{}' is brighter than the detector: of {} observations {} have one channel at the highest "
      "code, which is left out, and {} have more and are not used",
      printable(counts.leds[at(led)], 60), counts.frames() * counts.camera_count(), one, more);
}

/// What there is to say of a camera whose offsets are not those of its calibration; nothing of one that has
/// them.
std::string drift_sentence(const std::string& camera, double drifted_counts) {
  if (drifted_counts == 0.0) return {};
  return fmt::format(
      "camera '{}' reads up to {:.1f} counts other in the dark than at its calibration; its offsets are "
      "those of the "
      "recording's dark slots",
      printable(camera, 60), drifted_counts);
}

Remarks remarks_on(const data::Counts& counts, const data::Rig& rig, const std::vector<double>& drifted,
                   const std::vector<reconstruction::LedLight>& lights) {
  Remarks out;
  const bool dark_known = knows_dark(rig);
  const auto add = [&](std::string sentence) {
    if (!sentence.empty()) out.warnings.push_back(std::move(sentence));
  };
  for (std::size_t c = 0; c < drifted.size(); ++c) add(drift_sentence(rig.cameras[c].name, drifted[c]));
  for (std::int64_t led = 0; led < counts.led_count(); ++led) {
    if (at(led) < lights.size()) add(light_sentence(counts.leds[at(led)], lights[at(led)], dark_known));
    add(saturation_sentence(counts, led));
  }
  return out;
}

/// The rig with dark counts of the recording's own dark slots, where its calibration had none or they have
/// drifted.
struct InTheDark {
  data::Rig rig;
  std::vector<double> drifted_counts;  ///< per camera
};
InTheDark with_dark(const data::Counts& counts, const data::Rig& rig, bool as_calibrated) {
  InTheDark out{.rig = rig, .drifted_counts = {}};
  if (as_calibrated) return out;
  if (knows_dark(rig))
    out.drifted_counts = camera::follow_dark_counts(counts, out.rig);
  else
    camera::find_dark_counts(counts, out.rig);
  return out;
}

}  // namespace

Result<Reconstructed> reconstruct(const data::Counts& counts, const data::Rig& rig,
                                  const ReconstructOptions& options) {
  auto frames = options.frames;
  frames.threads = options.threads;
  const bool classic = options.method == ReconstructMethod::classic;
  const auto [known, drifted] = with_dark(counts, rig, !frames.light);
  auto found = classic ? reconstruction::reconstruct_classic(counts, rig, frames)
                       : reconstruction::reconstruct(counts, known, frames);
  if (!found) return std::unexpected(found.error());
  Reconstructed out{.markers = {},
                    .calibration_error = {},
                    .leds = std::move(found->leds),
                    .lights = {},
                    .fits = {},
                    .remarks = {}};
  if (!classic) out.remarks = remarks_on(counts, known, drifted, found->lights);
  if (options.method == ReconstructMethod::smoother) {
    auto smoother = options.smoother;
    smoother.threads = options.threads;
    auto smooth = trajectory::smooth_counts(counts, found->rigs, found->points, smoother);
    if (!smooth) return std::unexpected(smooth.error());
    if (frames.calibration_error)
      reconstruction::add_calibration_error(counts, *found, smooth->points, options.threads);
    found->points = std::move(smooth->points);
    out.fits = std::move(smooth->leds);
  }
  if (frames.calibration_error && !classic)
    out.calibration_error = reconstruction::calibration_error(counts, known, *found, found->points);
  if (frames.calibration_error && classic)
    if (const auto better = reconstruction::reconstruct(counts, known, frames))
      out.calibration_error =
          reconstruction::calibration_error(counts, known, *better, better->points, &found->points);
  out.lights = std::move(found->lights);
  out.markers = std::move(found->points);
  return out;
}

}  // namespace kinemark::workflow
