// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The files of the folder that `segments` writes.
#pragma once

#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/segments/segment_tables.h"
#include "kinemark/pipeline/segments/segments_job.h"

namespace kinemark::pipeline::internal {

/// What they are made from, until they are written.
struct SegmentTables {
  SeriesList angles, loads;
  data::Trial points, whole;
  std::string set;  ///< its name
};

/// The outcome must outlive them.
[[nodiscard]] SegmentTables tables_of(const SegmentsOutcome& outcome, const data::Trial& recording);

/// All of them; those of loads are added to `staging`, which has the others. They need tables and outcome
/// until they are written.
[[nodiscard]] Result<std::vector<ResultFile>> list_files(const SegmentsJob& job, const SegmentTables& tables,
                                                         const SegmentsOutcome& outcome, Staging& staging);

}  // namespace kinemark::pipeline::internal
