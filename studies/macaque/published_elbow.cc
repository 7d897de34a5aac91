// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/macaque/published_elbow.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "kinemark/core/missing.h"
#include "kinemark/stages/simulation/limb.h"
#include "kinemark/stages/skeleton/articulated/articulated.h"
#include "kinemark/stages/skeleton/functional/functional.h"
#include "studies/common/each_seed.h"

namespace kinemark::studies {
namespace {

constexpr double kInMm = 1e3, kInPercent = 100.0;
constexpr double kThreshold_m = 0.030;  // of the report

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return values.empty() ? kNaN : sum / static_cast<double>(values.size());
}

double sd_of(const std::vector<double>& values) {
  if (values.size() < 2) return kNaN;
  const double mean = mean_of(values);
  double squares = 0.0;
  for (const double v : values) squares += (v - mean) * (v - mean);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

// Over frames that have a centre, of those that are determined where asked.
double mean_error(const data::Skeleton& found, const simulation::LimbRecording& limb, bool determined) {
  std::vector<double> errors;
  for (std::int64_t f = 0; f < found.frames(); ++f) {
    const auto state = found.state[found.index(f, 0)];
    if (state == data::CentreState::undetermined || (determined && state != data::CentreState::determined))
      continue;
    errors.push_back(
        (found.centre(f, 0) - Eigen::Map<const Eigen::Vector3d>(limb.centre_in_world.data() + 3 * f)).norm());
  }
  return mean_of(errors);
}

std::int64_t complete_frames(const data::Trajectories& markers) {
  std::int64_t out = 0;
  for (std::int64_t f = 0; f < markers.frames(); ++f) {
    std::int64_t seen = 0;
    for (std::int64_t m = 0; m < markers.markers(); ++m) seen += markers.present(f, m);
    out += seen == markers.markers();
  }
  return out;
}

// Deviations need two recordings; one has none.
std::optional<double> in_mm(double value) {
  return std::isfinite(value) ? std::optional(kInMm * value) : std::nullopt;
}

std::string name_of(const PublishedCell& cell) {
  return fmt::format("{:g} mm noise, {:.0f} % missing", kInMm * cell.noise_m, kInPercent * cell.missing);
}

}  // namespace

std::vector<PublishedCell> published_cells(const PublishedReading& reading) {
  const double low = reading.low_noise_m;
  return {{.noise_m = 2e-3, .missing = 0.0, .paper_m = 30e-3},
          {.noise_m = low, .missing = 0.2, .paper_m = 10.16e-3},
          {.noise_m = low, .missing = 0.3, .paper_m = {}},
          {.noise_m = low, .missing = 0.4, .paper_m = 30e-3},
          {.noise_m = low, .missing = 0.5, .paper_m = {}}};
}

Result<PublishedErrors> study_published_elbow(const PublishedCell& cell, std::uint64_t seed,
                                              const PublishedReading& reading) {
  const auto limb = simulation::simulate_chain({.frames = reading.frames,
                                                .last_at_end = true,
                                                .noise_sd_m = cell.noise_m,
                                                .missing = cell.missing,
                                                .seed = seed});
  if (!limb) return std::unexpected(limb.error());
  PublishedErrors out{.classic_m = kNaN, .ours_m = kNaN};
  skeleton::FunctionalOptions theirs;
  theirs.method = skeleton::FunctionalMethod::constant_distance;
  theirs.kind = data::JointChoice::ball;
  theirs.constant_distance = {.complete_frames = static_cast<int>(reading.frames),
                              .penalty_m = reading.penalty_m};
  const auto classic = skeleton::find_joints(limb->markers, limb->layout, theirs);
  // Of fewer markers than all the report says nothing.
  if (classic && complete_frames(limb->markers) >= 2) out.classic_m = mean_error(*classic, *limb, false);
  skeleton::ArticulatedOptions own;
  own.joint = data::JointChoice::ball;
  own.continuity = false;  // frames are poses without order
  const auto ours = skeleton::fit_articulated(limb->markers, limb->layout, own);
  if (ours) out.ours_m = mean_error(ours->skeleton, *limb, true);
  return out;
}

std::optional<double> share_at(const std::vector<PublishedResult>& cells, double error_m) {
  const PublishedResult* before = nullptr;
  for (const auto& cell : cells) {
    if (cell.cell.missing == 0.0 || cell.classic_m.empty()) continue;
    const double behind = mean_of(cell.classic_m);
    if (before != nullptr) {
      const double from = mean_of(before->classic_m);
      if (from < error_m && behind >= error_m)
        return before->cell.missing +
               (cell.cell.missing - before->cell.missing) * (error_m - from) / (behind - from);
    }
    before = &cell;
  }
  return {};
}

std::vector<StudyRow> published_rows(const std::vector<PublishedResult>& cells) {
  std::vector<StudyRow> rows;
  for (const auto& cell : cells) {
    const auto name = name_of(cell.cell);
    rows.push_back({.quantity = name + ": mean error of the elbow, mean of recordings",
                    .unit = "mm",
                    .paper = cell.cell.paper_m ? std::optional(kInMm * *cell.cell.paper_m) : std::nullopt,
                    .classic = in_mm(mean_of(cell.classic_m)),
                    .ours = kInMm * mean_of(cell.ours_m)});
    if (cell.classic_m.size() > 1 && cell.ours_m.size() > 1)
      rows.push_back({.quantity = name + ": mean error of the elbow, SD of recordings",
                      .unit = "mm",
                      .classic = in_mm(sd_of(cell.classic_m)),
                      .ours = kInMm * sd_of(cell.ours_m)});
    rows.push_back({.quantity = name + ": recordings with an answer",
                    .unit = "1",
                    .classic = static_cast<double>(cell.classic_m.size()),
                    .ours = static_cast<double>(cell.ours_m.size())});
  }
  double below = 0.0;
  for (const auto& cell : cells)
    if (mean_of(cell.ours_m) < kThreshold_m) below = std::max(below, kInPercent * cell.cell.missing);
  const auto reached = share_at(cells, kThreshold_m);
  rows.push_back(
      {.quantity = "share missing at which the mean error reaches 30 mm (ours: most that was tried below it)",
       .unit = "%",
       .paper = 40.0,
       .classic = reached ? std::optional(kInPercent * *reached) : std::nullopt,
       .ours = below});
  return rows;
}

Result<std::vector<PublishedResult>> study_published(const std::vector<std::uint64_t>& seeds, int threads,
                                                     const Progress& progress) {
  if (seeds.empty()) return fail(Code::usage, "the study needs one seed or more");
  std::vector<PublishedResult> out;
  for (const auto& cell : published_cells()) out.push_back({.cell = cell, .classic_m = {}, .ours_m = {}});
  std::vector<Result<PublishedErrors>> errors(out.size() * seeds.size());
  auto status = run_each(static_cast<std::int64_t>(errors.size()), threads, progress, [&](std::size_t i) {
    errors[i] = study_published_elbow(out[i / seeds.size()].cell, seeds[i % seeds.size()]);
  });
  if (!status) return std::unexpected(status.error());
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (!errors[i]) return fail_at(fmt::format("seed {}", seeds[i % seeds.size()]), errors[i].error());
    auto& cell = out[i / seeds.size()];
    if (std::isfinite(errors[i]->classic_m)) cell.classic_m.push_back(errors[i]->classic_m);
    if (std::isfinite(errors[i]->ours_m)) cell.ours_m.push_back(errors[i]->ours_m);
  }
  return out;
}

}  // namespace kinemark::studies
