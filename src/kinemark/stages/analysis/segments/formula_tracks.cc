// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/segments/formula_tracks.h"

#include <algorithm>
#include <utility>

#include "kinemark/stages/analysis/segments/internal/lacks.h"
#include "kinemark/stages/analysis/segments/internal/subject.h"

namespace kinemark::analysis {

struct FormulaTracks::Steps {
  const SegmentDefinition* definition = nullptr;
  const data::Trajectories* recording = nullptr;
  internal::Subject subject;
  SegmentGraph graph;
  std::vector<std::int64_t> marker_idx;
};

FormulaTracks::FormulaTracks(std::unique_ptr<Steps> steps) : steps_(std::move(steps)) {}
FormulaTracks::FormulaTracks(FormulaTracks&&) noexcept = default;
FormulaTracks& FormulaTracks::operator=(FormulaTracks&&) noexcept = default;
FormulaTracks::~FormulaTracks() = default;

Result<FormulaTracks> FormulaTracks::create(const SegmentDefinition& definition, const SegmentInput& input,
                                            const SegmentOptions& options,
                                            std::span<const GraphOutput> outputs) {
  auto subject = internal::find_subject(definition, input, options);
  if (!subject) return std::unexpected(subject.error());
  const internal::TrialMarkers trial(*input.markers, input.aliases);
  auto graph = build_graph(definition, subject->names(trial, input.static_trial == input.markers), outputs);
  if (!graph) return std::unexpected(graph.error());
  auto marker_idx = internal::indices_of(*graph, trial);
  return FormulaTracks(std::make_unique<Steps>(Steps{.definition = &definition,
                                                     .recording = input.markers,
                                                     .subject = std::move(*subject),
                                                     .graph = std::move(*graph),
                                                     .marker_idx = std::move(marker_idx)}));
}

const std::set<std::string>& FormulaTracks::lacks(std::size_t output) const {
  return steps_->graph.lacks[output];
}

std::vector<std::int64_t> FormulaTracks::markers_of(std::size_t output) const {
  std::vector<std::int64_t> out;
  const int step = steps_->graph.outputs[output];
  if (step < 0) return out;
  for (const int input : steps_->graph.steps[static_cast<std::size_t>(step)].inputs)
    if (static_cast<std::size_t>(input) < steps_->marker_idx.size())
      out.push_back(steps_->marker_idx[static_cast<std::size_t>(input)]);
  std::ranges::sort(out);
  return out;
}

std::vector<std::string> FormulaTracks::lack_sentences(std::span<const std::string> names) const {
  return internal::lack_sentences(*steps_->definition, names, steps_->graph, steps_->recording->names);
}

std::vector<UsedParameter> FormulaTracks::constant_parameters() const {
  std::vector<UsedParameter> out;
  for (const auto& [name, used] : steps_->subject.parameters)
    if (used.constant) out.push_back(used);
  return out;
}

void FormulaTracks::evaluate(const data::Trajectories& markers, std::int64_t frame,
                             std::vector<StepValue>& work, std::span<StepValue> out) const {
  work.resize(steps_->graph.steps.size());
  internal::set_inputs(steps_->graph, steps_->marker_idx, markers, frame, steps_->subject, work);
  steps_->graph.evaluate(work);
  for (std::size_t i = 0; i < out.size(); ++i)
    if (const int step = steps_->graph.outputs[i]; step >= 0) out[i] = work[static_cast<std::size_t>(step)];
}

}  // namespace kinemark::analysis
