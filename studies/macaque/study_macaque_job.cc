// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/macaque/study_macaque_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "studies/common/each_seed.h"
#include "studies/macaque/macaque_rows.h"

namespace kinemark::studies {
namespace {

constexpr double kMm = 1e-3, kStagger_m = 0.020;

std::vector<ElbowCell> elbow_cells(const MacaqueJob& job) {
  std::vector<ElbowCell> out;
  for (const double stagger : {0.0, kStagger_m})
    for (const bool pose : {false, true})
      for (const double missing : job.missing) {
        if (pose && missing == 0.0) continue;  // nothing to correlate
        if (!pose) out.push_back({0.0, missing, stagger, pose, job.frames});
        for (const double noise : job.noise_mm)
          out.push_back({kMm * noise, missing, stagger, pose, job.frames});
      }
  return out;
}

std::vector<SleeveCell> sleeve_cells(const MacaqueJob& job) {
  std::vector<SleeveCell> out;
  for (const bool hard : {false, true})
    for (const double noise : job.sleeve_noise_mm) out.push_back({kMm * noise, hard, job.sleeve_s});
  return out;
}

/// Outcomes of all cells and seeds; cell c, seed s at c seeds + s.
struct Outcomes {
  std::vector<Result<ElbowErrors>> elbow;
  std::vector<Result<SleeveErrors>> sleeve;
};

template <class Cells, class Errors, class Add>
Status collect(const Cells& cells, const std::vector<std::uint64_t>& seeds,
               const std::vector<Result<Errors>>& outcomes, const Add& add) {
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const auto seed = seeds[i % seeds.size()];
    if (!outcomes[i]) return fail_at(fmt::format("seed {}", seed), outcomes[i].error());
    add(cells[i / seeds.size()], *outcomes[i], i % seeds.size() == 0);
  }
  return {};
}

}  // namespace

void ElbowResult::add(const ElbowErrors& of_seed) {
  errors += of_seed;
  // Not std::max: what is no number stays none, whichever seed it comes from.
  const double ratio = of_seed.ours.over_bound();
  if (!std::isnan(worst_over_bound) && !(ratio <= worst_over_bound)) worst_over_bound = ratio;
}

const ElbowResult* MacaqueStudy::find(double noise_mm, double missing, bool staggered,
                                      bool pose_correlated) const {
  const auto at = std::ranges::find_if(elbow, [&](const ElbowResult& r) {
    return std::abs(r.cell.noise_m - kMm * noise_mm) < 1e-9 && std::abs(r.cell.missing - missing) < 1e-9 &&
           (r.cell.stagger_m > 0.0) == staggered && r.cell.pose_correlated == pose_correlated;
  });
  return at == elbow.end() ? nullptr : &*at;
}

Result<MacaqueStudy> study_macaque(const MacaqueJob& job, const Progress& progress) {
  if (job.seeds.empty()) return fail(Code::usage, "the study needs one seed or more");
  if (job.as_published) {
    auto published = study_published(job.seeds, job.threads, progress);
    if (!published) return std::unexpected(published.error());
    MacaqueStudy out{.published = std::move(*published)};
    out.table = {job.seeds, published_rows(out.published)};
    return out;
  }
  const auto elbow = elbow_cells(job);
  const auto sleeve = sleeve_cells(job);
  const std::size_t seeds = job.seeds.size(), elbows = elbow.size() * seeds;
  Outcomes outcomes{std::vector<Result<ElbowErrors>>(elbows),
                    std::vector<Result<SleeveErrors>>(sleeve.size() * seeds)};
  const auto count = static_cast<std::int64_t>(elbows + outcomes.sleeve.size());
  auto status = run_each(count, job.threads, progress, [&](std::size_t i) {
    // Long recordings first, so that no thread is left alone with one at the end.
    if (i < outcomes.sleeve.size())
      outcomes.sleeve[i] = study_sleeve(sleeve[i / seeds], job.seeds[i % seeds]);
    else
      outcomes.elbow[i - outcomes.sleeve.size()] = study_elbow(
          elbow[(i - outcomes.sleeve.size()) / seeds], job.seeds[(i - outcomes.sleeve.size()) % seeds]);
  });
  if (!status) return std::unexpected(status.error());
  MacaqueStudy out;
  status = collect(elbow, job.seeds, outcomes.elbow,
                   [&](const ElbowCell& cell, const ElbowErrors& errors, bool is_new) {
                     if (is_new) out.elbow.push_back({cell, {}, 0.0});
                     out.elbow.back().add(errors);
                   });
  if (!status) return std::unexpected(status.error());
  status = collect(sleeve, job.seeds, outcomes.sleeve,
                   [&](const SleeveCell& cell, const SleeveErrors& errors, bool is_new) {
                     if (is_new) out.sleeve.push_back({cell, {}});
                     out.sleeve.back().errors += errors;
                   });
  if (!status) return std::unexpected(status.error());
  out.table = {job.seeds, macaque_rows(out, job.seeds.size())};
  return out;
}

}  // namespace kinemark::studies
