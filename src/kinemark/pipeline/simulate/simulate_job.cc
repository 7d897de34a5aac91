// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/simulate/simulate_job.h"

#include <fmt/core.h>

#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/osim/osim_writer.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/model/model.h"
#include "kinemark/pipeline/files/motion_tables.h"
#include "kinemark/pipeline/files/staging.h"
#include "kinemark/pipeline/internal/new_folder.h"
#include "kinemark/pipeline/simulate/human_model.h"

namespace kinemark::pipeline {

namespace fs = std::filesystem;

Result<std::vector<fs::path>> simulate_subject(const SubjectJob& job, const Progress& progress) {
  auto description = job.model.empty() ? human_model() : io::read_osim(job.model);
  if (!description) return std::unexpected(description.error());
  const auto model = model::Model::compile(*description);
  if (!model) return fail_at(job.model.string(), model.error());
  const auto subject = simulation::simulate_subject(*model, job.options);
  if (!subject) return std::unexpected(subject.error());

  const internal::NewFolder folder(job.folder);
  if (folder.error())
    return fail(Code::io,
                fmt::format("{}: cannot be made ({})", job.folder.string(), folder.error().message()));
  auto staging =
      Staging::create({job.folder / "markers.c3d", job.folder / "markers.trc", job.folder / "model.osim",
                       job.folder / "truth.mot", job.folder / "truth.trc"},
                      job.force);
  if (!staging) return std::unexpected(staging.error());
  data::Trial recorded, truth;
  recorded.source = truth.source = "simulated";
  recorded.markers = subject->markers;
  truth.markers = subject->true_markers;
  const auto write = [&](std::size_t i) -> Status {
    const auto path = staging->path(i);
    if (i == 2) return io::write_osim(path, *description, {});
    if (i == 3) return io::write_table(path, coordinates_table(subject->truth), {});
    return io::write_markers(path, i < 2 ? recorded : truth, false);
  };
  const auto files = static_cast<std::int64_t>(staging->targets().size());
  for (std::int64_t i = 0; i < files; ++i) {
    if (auto s = write(static_cast<std::size_t>(i)); !s) return staging->failure(s.error());
    if (progress && !progress(i + 1, files)) return fail(Code::cancelled, "the simulation was stopped");
  }
  if (auto s = staging->commit(); !s) return std::unexpected(s.error());
  return staging->targets();
}

}  // namespace kinemark::pipeline
