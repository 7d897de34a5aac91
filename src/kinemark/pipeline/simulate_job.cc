// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/simulate_job.h"

#include <fmt/core.h>

#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/osim/osim_writer.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/model/model.h"
#include "kinemark/pipeline/human_model.h"
#include "kinemark/pipeline/motion_tables.h"
#include "kinemark/pipeline/staging.h"

namespace kinemark::pipeline {

namespace fs = std::filesystem;

Result<std::vector<fs::path>> simulate_subject(const SubjectJob& job) {
  auto description = job.model.empty() ? human_model() : io::read_osim(job.model);
  if (!description) return std::unexpected(description.error());
  const auto model = model::Model::compile(*description);
  if (!model) return std::unexpected(model.error());
  const auto subject = simulation::simulate_subject(*model, job.options);
  if (!subject) return std::unexpected(subject.error());

  std::error_code error;
  fs::create_directories(job.folder, error);
  if (error)
    return fail(Code::io, fmt::format("{}: cannot be made ({})", job.folder.string(), error.message()));
  auto staging =
      Staging::create({job.folder / "markers.c3d", job.folder / "markers.trc", job.folder / "model.osim",
                       job.folder / "truth.mot", job.folder / "truth.trc"},
                      job.force);
  if (!staging) return std::unexpected(staging.error());
  data::Trial trial;
  trial.source = "simulated";
  trial.markers = subject->markers;
  for (const std::size_t i : {0, 1})
    if (auto s = io::write_markers(staging->path(i), trial, false); !s) return std::unexpected(s.error());
  if (auto s = io::write_osim(staging->path(2), *description, {}); !s) return std::unexpected(s.error());
  if (auto s = io::write_table(staging->path(3), coordinates_table(subject->truth), {}); !s)
    return std::unexpected(s.error());
  trial.markers = subject->true_markers;
  if (auto s = io::write_markers(staging->path(4), trial, false); !s) return std::unexpected(s.error());
  if (auto s = staging->commit(); !s) return std::unexpected(s.error());
  return staging->targets();
}

}  // namespace kinemark::pipeline
