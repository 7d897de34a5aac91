// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/poizner/study_poizner_job.h"

#include <fmt/core.h>

#include <array>

#include "studies/common/each_seed.h"
#include "studies/poizner/study_rows.h"

namespace kinemark::studies {
namespace {

Result<PoiznerSeed> study_seed(std::uint64_t seed) {
  auto rig = calibrate_rig(seed);
  if (!rig) return fail_at(fmt::format("seed {}", seed), rig.error());
  PoiznerSeed out{
      .seed = seed, .chi2_per_dof = rig->bundle.report.chi2_per_dof, .tree = {}, .wheels = {}, .arm = {}};
  auto tree = study_still_tree(*rig);
  if (!tree) return fail_at(fmt::format("seed {}", seed), tree.error());
  out.tree = std::move(*tree);
  for (int wheel = 0; wheel < kWheels; ++wheel) {
    auto study = study_wheel(*rig, study_wheel_options(wheel));
    if (!study) return fail_at(fmt::format("seed {}", seed), study.error());
    out.wheels.push_back(std::move(*study));
  }
  auto arm = study_arm(*rig);
  if (!arm) return fail_at(fmt::format("seed {}", seed), arm.error());
  out.arm = std::move(*arm);
  return out;
}

// What `make` makes of every seed, or the first error.
template <class Outcome, class Make>
Result<std::vector<Outcome>> of_each_seed(const PoiznerJob& job, const Progress& progress, const Make& make) {
  std::vector<Result<Outcome>> outcomes(job.seeds.size());
  auto status = run_each(static_cast<std::int64_t>(job.seeds.size()), job.threads, progress,
                         [&](std::size_t i) { outcomes[i] = make(job.seeds[i]); });
  if (!status) return std::unexpected(status.error());
  std::vector<Outcome> out;
  for (auto& outcome : outcomes) {
    if (!outcome) return std::unexpected(outcome.error());
    out.push_back(std::move(*outcome));
  }
  return out;
}

}  // namespace

simulation::WheelOptions study_wheel_options(int wheel) {
  simulation::WheelOptions out;
  out.rotation_deg = wheel % 2 == 0 ? 8.0 : 35.0;
  out.glint_share = wheel < 2 ? 0.0 : 0.04;
  return out;
}

std::string_view wheel_name(int wheel) {
  constexpr std::array<std::string_view, kWheels> kNames{"wheel at 8 deg", "wheel at 35 deg",
                                                         "wheel at 8 deg, glint", "wheel at 35 deg, glint"};
  return kNames[static_cast<std::size_t>(wheel)];
}

Result<PoiznerStudy> study_poizner(const PoiznerJob& job, const Progress& progress) {
  if (job.seeds.empty()) return fail(Code::usage, "the study needs one seed or more");
  PoiznerStudy out;
  if (job.as_built) {
    auto rigs =
        of_each_seed<AsBuiltOutcome>(job, progress, [](std::uint64_t seed) { return study_as_built(seed); });
    if (!rigs) return std::unexpected(rigs.error());
    out.as_built = std::move(*rigs);
    out.table = {job.seeds, as_built_rows(out.as_built)};
    return out;
  }
  auto seeds = of_each_seed<PoiznerSeed>(job, progress, study_seed);
  if (!seeds) return std::unexpected(seeds.error());
  out.seeds = std::move(*seeds);
  out.table = {job.seeds, study_rows(out.seeds)};
  return out;
}

}  // namespace kinemark::studies
