// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kinemark/core/progress.h"
#include "kinemark/core/result.h"
#include "kinemark/data/model_description.h"
#include "kinemark/data/trajectories.h"
#include "studies/common/study_table.h"
#include "studies/taichi/control_runs.h"
#include "studies/taichi/geometry_fit.h"

namespace kinemark::studies {

/// What `kinemark study taichi` is asked to do.
struct TaiChiJob {
  data::ModelDescription human;                 ///< kinemark's own
  std::optional<data::Trajectories> recording;  ///< as read; absent: simulated subjects, one per seed
  std::vector<std::uint64_t> seeds{1};
  int threads = 1;
};

/// One set of landmarks tracked at 1 ms and at 1/60 s, on recorded goals and on goals computed from the
/// model.
struct SetOutcome {
  ControlComparison recorded_fine, recorded_coarse, reachable_fine;
  std::optional<ControlComparison> reachable_coarse;  ///< where it is asked for
};

/// Motions that the figures draw, on recorded goals at 1 ms.
struct TaiChiDrawing {
  data::Trajectories goals;
  motion::TrackResult whole, paper;
};

/// Results of one subject.
struct TaiChiSubject {
  std::uint64_t seed = 0;
  GeometryFit medians, centres, positions;                             ///< 40 coordinates
  GeometryFit clavicle_medians, clavicle_centres, clavicle_positions;  ///< 44
  GeometryFit held_out, clavicle_held_out;  ///< Freedom::centres from the first half of the frames
  SetOutcome whole, three, paper, pelvis_paper, upper;
  double forearm_min_m = 0.0, forearm_max_m = 0.0;  ///< recorded distance of left elbow and wrist
  std::optional<TaiChiDrawing> drawing;             ///< of the first subject
};

struct TaiChiStudy {
  bool recorded = false;
  std::vector<TaiChiSubject> subjects;
  StudyTable table;
};

/// Size the model, adapt it, track all sets, for the recording or for every seed. About a minute a subject.
/// `progress` counts steps of the work.
[[nodiscard]] Result<TaiChiStudy> study_taichi(const TaiChiJob& job, const Progress& progress = {});

/// One set on a compiled model and recorded goals; `made`: goals that the model made. `coarse`: at 1/60 s too
/// on goals that the model made. `truth`: the simulated subject's own motion, or null. Where `drawn` is not
/// null it gets the track on recorded goals at 1 ms, with bounds.
[[nodiscard]] Result<SetOutcome> study_set(const model::Model& model, const data::Trajectories& goals,
                                           const data::Trajectories& made, const LandmarkSet& set,
                                           bool coarse, const data::JointMotion* truth = nullptr,
                                           motion::TrackResult* drawn = nullptr);

/// The table: worst of all subjects in each line. Bounds on residuals belong to the recording alone.
[[nodiscard]] std::vector<StudyRow> taichi_rows(const std::vector<TaiChiSubject>& subjects, bool recorded);

}  // namespace kinemark::studies
