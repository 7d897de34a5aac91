// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/segments/internal/segment_trials.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <set>
#include <utility>

namespace kinemark::workflow {
namespace {

/// Takes markers of one trial after the other.
class PointTaker {
 public:
  PointTaker(const analysis::SegmentDefinition& definition, std::list<MarkersAndModelled>& modelled,
             analysis::SegmentInput& input, std::vector<std::string>& warnings)
      : wanted_(names_of_points(definition)), modelled_(modelled), input_(input), warnings_(warnings) {}

  const data::Trajectories* take(const data::Trial& trial, const std::string& name) {
    const auto* markers = with_modelled(trial, name);
    for (auto& [wanted, theirs] : suffixed_names(trial.markers.names, wanted_))
      input_.aliases.try_emplace(wanted, theirs);
    return markers;
  }

 private:
  const data::Trajectories* with_modelled(const data::Trial& trial, const std::string& name) {
    auto found = with_modelled_points(trial, wanted_);
    if (!found) return &trial.markers;
    warnings_.push_back(fmt::format("{}: not measured, taken as a model of the file has them: {}", name,
                                    fmt::join(found->points, ", ")));
    modelled_.push_back(std::move(*found));
    return &modelled_.back().markers;
  }

  std::set<std::string> wanted_;
  std::list<MarkersAndModelled>& modelled_;
  analysis::SegmentInput& input_;
  std::vector<std::string>& warnings_;
};

}  // namespace

analysis::SegmentInput points_of(const analysis::SegmentDefinition& definition,
                                 const SegmentsOptions& options, bool own_static,
                                 const data::Trial& recording, SegmentTrials& trials,
                                 std::vector<std::string>& warnings) {
  analysis::SegmentInput input;
  PointTaker taker(definition, trials.modelled, input, warnings);
  input.markers = taker.take(recording, options.name);
  if (own_static) input.static_trial = input.markers;
  if (trials.still) input.static_trial = taker.take(*trials.still, options.static_name);
  for (const auto& [name, trial] : trials.shown) input.trials[name] = taker.take(trial, name);
  return input;
}

}  // namespace kinemark::workflow
