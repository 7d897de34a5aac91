// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/clean/clean.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "kinemark/data/filtering.h"
#include "kinemark/stages/trajectory/gaps/fill_gaps.h"
#include "kinemark/stages/trajectory/smoothing/smooth.h"
#include "kinemark/workflow/clean/internal/settled.h"
#include "kinemark/workflow/prepare/contradictions.h"

namespace kinemark::workflow {
namespace {

constexpr double kSure = 0.8;  ///< confidence from which a defect is rejected where that is asked for

Status screen(const RepairOptions& options, Repaired& repaired) {
  auto& recording = repaired.recording;
  auto screening = screen_markers(recording.trial, {.recorder_made = options.recorder_made,
                                                    .exchange_back = options.exchange_back,
                                                    .swapped = recording.edits.swapped,
                                                    .apart = repaired.apart.all(),
                                                    .reject_defects = options.reject_doubtful,
                                                    .sure = kSure});
  if (!screening) return std::unexpected(screening.error());
  auto& account = repaired.account;
  account.names = recording.trial.markers.names;
  account.defects =
      internal::settle_defects(std::move(screening->defects), screening->exchanged,
                               screening->rejected ? screening->sure : std::vector<data::Finding>{});
  account.upsampling = std::move(*screening->upsampling);
  internal::settle_upsampling(options.recorder_made, account.upsampling);
  std::ranges::move(screening->warnings, std::back_inserter(repaired.remarks.warnings));
  return {};
}

Status fill(const RepairOptions& options, Repaired& repaired) {
  if (options.gaps.method == trajectory::GapMethod::none) return {};
  auto gaps = options.gaps;
  gaps.seed = options.seed;
  gaps.threads = options.threads;
  gaps.leave = repaired.apart.all();
  auto& markers = repaired.recording.trial.markers;
  auto filled = trajectory::fill_gaps(markers, gaps);
  if (!filled) return std::unexpected(filled.error());
  repaired.account.gaps = std::move(filled->gaps);
  for (auto& swap : filled->swaps)
    repaired.account.defects.push_back({std::move(swap), "not relied on when filling; left as it is"});
  markers = std::move(filled->trajectories);
  return {};
}

}  // namespace

std::string begin_unfiltered(data::Trajectories& markers, bool smooths) {
  std::string filters = data::describe_filters(markers);
  if (filters.empty() || !smooths) return filters;
  const auto covariances = !markers.covariance.empty();
  if (data::restore_unfiltered(markers))
    return fmt::format("{}: smoothed anew from those{}", filters,
                       covariances ? ", whose own covariances are not known" : "");
  return filters +
         ", so that it is smoothed twice: noise found here is what the first filter left, and less "
         "than that of the measurement";
}

Result<Repaired> repair(data::Recording recording, const RepairOptions& options) {
  if (auto s = options.gaps.check(); !s) return std::unexpected(s.error());
  Repaired repaired;
  repaired.recording = std::move(recording);
  add_contradictions(repaired.recording.contradicted, repaired.remarks.gates);
  const auto& markers = repaired.recording.trial.markers;
  repaired.apart = find_points_apart(markers);
  if (const auto points = repaired.apart.describe(markers.names); !points.empty())
    repaired.remarks.warnings.push_back(
        fmt::format("No markers, and left as they are unless they are selected alone: {}", points));
  if (auto s = screen(options, repaired); !s) return std::unexpected(s.error());
  repaired.before = repaired.recording.trial.markers;
  if (auto s = fill(options, repaired); !s) return std::unexpected(s.error());
  return repaired;
}

Result<Cleaned> clean(data::Recording recording, const CleanOptions& options) {
  const bool smooths = options.filter.method != trajectory::FilterMethod::none;
  auto filters = begin_unfiltered(recording.trial.markers, smooths);
  auto repaired = repair(std::move(recording), options.repair);
  if (!repaired) return std::unexpected(repaired.error());
  auto filter = options.filter;
  filter.leave = repaired->apart.all();
  auto smooth = trajectory::smooth(repaired->recording.trial.markers, filter);
  if (!smooth) return std::unexpected(smooth.error());
  Cleaned cleaned{.recording = std::move(repaired->recording),
                  .derivatives = std::move(smooth->derivatives),
                  .account = std::move(repaired->account),
                  .remarks = std::move(repaired->remarks)};
  cleaned.recording.trial.markers = std::move(smooth->trajectories);
  cleaned.account.markers = std::move(smooth->markers);
  auto& warnings = cleaned.remarks.warnings;
  if (!filters.empty()) warnings.insert(warnings.begin(), std::move(filters));
  return cleaned;
}

}  // namespace kinemark::workflow
