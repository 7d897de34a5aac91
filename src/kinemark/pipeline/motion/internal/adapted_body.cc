// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/internal/adapted_body.h"

#include <Eigen/Core>
#include <algorithm>
#include <utility>

#include "kinemark/io/osim/osim_document.h"
#include "kinemark/stages/motion/scaling/geometry.h"
#include "kinemark/workflow/scale/scale.h"

namespace kinemark::pipeline::internal {
namespace {

workflow::ScaleOptions options_of(const TrackJob& job) {
  workflow::ScaleOptions options;
  options.adapt.ik.marker_weights = job.options.marker_weights;
  options.adapt.ik.first_time_s = job.options.first_time_s;
  options.adapt.ik.last_time_s = job.options.last_time_s;
  options.adapt.ik.seed = job.seed;
  options.adapt.marker_noise_sd_m = job.options.marker_noise_sd_m;
  options.adapt.threads = job.threads;
  options.max_rms_m = job.max_rms_m;
  options.drop_doubtful = job.options.judge_samples;
  return options;
}

/// The given model is where the user began, not the one that was brought to the subject's overall size.
void compare_with(const data::ModelDescription& given, motion::AdaptResult& adapted) {
  const auto before = motion::segment_lengths(given);
  double overall = 1.0;
  for (auto& length : adapted.lengths)
    if (const auto at = std::ranges::find(before, length.name, &motion::SegmentLength::name);
        at != before.end()) {
      overall = length.initial_m / at->length_m;
      length.initial_m = at->length_m;
    }
  for (auto& size : adapted.parameters)
    if (size.kind == motion::ParameterKind::body_scale)
      for (double* number : {&size.value, &size.sd, &size.data_sd}) *number *= overall;
}

}  // namespace

Result<AdaptedBody> adapt_body(const TrackJob& job, MotionInputs& inputs) {
  const auto document = io::OsimDocument::read(job.model);
  if (!document) return std::unexpected(document.error());
  workflow::ScaleInputs given{
      .motion = workflow::ScaleTrial{.recording = inputs.recording, .name = job.markers.filename().string()},
      .paths = document->paths(),
      .paths_fault = document->paths_error(),
      .names = {.model = job.model.string()}};
  auto found = workflow::scale(document->model(), std::move(given), options_of(job));
  if (!found) return std::unexpected(found.error());
  std::vector<Eigen::Vector3d> factors;
  for (const auto& factor : found->factors) factors.push_back(factor.factors);
  auto text =
      document->format({.model = found->model, .factors = std::move(factors), .paths = found->muscles});
  if (!text) return fail_at(job.output.string(), text.error());
  compare_with(document->model(), *found->from_motion);
  auto model = model::Model::compile(std::move(found->model));
  if (!model) return fail_at(job.model.string(), model.error());
  inputs.model = std::move(*model);
  return AdaptedBody{.result = std::move(*found->from_motion),
                     .text = std::move(text->text),
                     .lost = std::move(text->lost),
                     .remarks = std::move(found->remarks)};
}

}  // namespace kinemark::pipeline::internal
