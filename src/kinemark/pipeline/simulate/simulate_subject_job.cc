// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/simulate/simulate_subject_job.h"

#include <utility>

#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/osim/osim_writer.h"
#include "kinemark/model/model.h"
#include "kinemark/pipeline/files/file_set.h"
#include "kinemark/pipeline/files/motion_tables.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/simulate/human_model.h"

namespace kinemark::pipeline {

Result<SimulateSubjectOutcome> run_simulate_subject(const SimulateSubjectJob& job) {
  auto description = job.model.empty() ? human_model() : io::read_osim(job.model);
  if (!description) return std::unexpected(description.error());
  const auto model = model::Model::compile(*description);
  if (!model) return fail_at(job.model.string(), model.error());
  auto options = job.options;
  options.seed = job.seed;
  const auto subject = simulation::simulate_subject(*model, options);
  if (!subject) return std::unexpected(subject.error());

  auto staging = Staging::create_in(
      job.folder, {"markers.c3d", "markers.trc", "model.osim", "truth.mot", "truth.trc"}, job, {job.model});
  if (!staging) return std::unexpected(staging.error());
  data::Trial recorded, truth;
  recorded.source = truth.source = "simulated";
  recorded.markers = subject->markers;
  truth.markers = subject->true_markers;
  const auto& targets = staging->targets();
  const auto model_text = io::format_osim(*description);
  if (!model_text) return fail_at(targets[2].string(), model_text.error());
  const std::string set = SetDigest()
                              .add("simulate subject")
                              .add(*model_text)
                              .add(recorded.markers)
                              .add(coordinates_table(subject->truth))
                              .add(truth.markers)
                              .hex();
  auto written = write_results(*staging,
                               {marker_file(targets[0], recorded), marker_file(targets[1], recorded),
                                model_file(targets[2], *model_text),
                                table_file(targets[3], [&] { return coordinates_table(subject->truth); }),
                                marker_file(targets[4], truth)},
                               job.progress, "the simulation", set);
  if (!written) return std::unexpected(written.error());
  SimulateSubjectOutcome out;
  out.written = std::move(*written);
  return out;
}

}  // namespace kinemark::pipeline
