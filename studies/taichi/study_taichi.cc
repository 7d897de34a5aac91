// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/taichi/study_taichi.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "kinemark/stages/motion/scaling/clavicles.h"
#include "studies/taichi/landmarks.h"
#include "studies/taichi/least_squares.h"
#include "studies/taichi/subject.h"

namespace kinemark::studies {
namespace {

using data::ModelDescription;
using data::Trajectories;

constexpr std::int64_t kParts = 13;  // of one subject's work, for the progress

/// Counts parts of the work; false from next() when the caller wants to stop.
class Parts {
 public:
  Parts(const Progress& progress, std::size_t subjects)
      : progress_(progress), total_(kParts * static_cast<std::int64_t>(subjects)) {}
  bool next() { return !progress_ || progress_(done_++, total_); }

 private:
  const Progress& progress_;
  std::int64_t done_ = 0, total_;
};

std::unexpected<Error> stopped() { return fail(Code::cancelled, "the study was stopped"); }

Status adapt(const ModelDescription& medians, const Trajectories& landmarks, int threads, Parts& parts,
             GeometryFit& plain, GeometryFit& centres, GeometryFit& positions, GeometryFit& held_out) {
  const auto frames = landmarks.frames();
  struct Task {
    GeometryFit* out;
    Freedom freedom;
    std::int64_t last;
  };
  for (const auto& [out, freedom, last] : {Task{&plain, Freedom::none, frames},
                                           {&centres, Freedom::centres, frames},
                                           {&positions, Freedom::positions, frames},
                                           {&held_out, Freedom::centres, frames / 2}}) {
    if (!parts.next()) return stopped();
    auto fit = fit_geometry(medians, landmarks, freedom, 0, last, threads);
    if (!fit) return std::unexpected(fit.error());
    *out = std::move(*fit);
  }
  return {};
}

Status track(const ModelDescription& description, const Trajectories& landmarks,
             const data::JointMotion* truth, Parts& parts, bool draw, TaiChiSubject& out) {
  const auto model = model::Model::compile(description);
  if (!model) return std::unexpected(model.error());
  const auto all = reference_ik(*model, landmarks, reference_ik_options(description));
  if (!all) return std::unexpected(all.error());
  const auto made = carried_landmarks(*model, all->motion);
  if (draw) out.drawing.emplace();
  TaiChiDrawing* drawing = draw ? &*out.drawing : nullptr;
  struct Task {
    SetOutcome* out;
    LandmarkSet set;
    bool coarse;
    motion::TrackResult* drawn;
  };
  const Task tasks[] = {{&out.whole, whole_body_set(), true, draw ? &drawing->whole : nullptr},
                        {&out.three, three_level_set(), true, nullptr},
                        {&out.paper, paper_set(), false, draw ? &drawing->paper : nullptr},
                        {&out.pelvis_paper, pelvis_paper_set(), false, nullptr},
                        {&out.upper, upper_body_set(), true, nullptr}};
  for (const auto& task : tasks) {
    if (!parts.next()) return stopped();
    auto outcome = study_set(*model, landmarks, made, task.set, task.coarse, truth, task.drawn);
    if (!outcome) return fail_at(task.set.name, outcome.error());
    *task.out = std::move(*outcome);
  }
  if (draw) drawing->goals = landmarks;
  return {};
}

Result<TaiChiSubject> study_subject(const ModelDescription& human, const Trajectories& landmarks,
                                    const data::JointMotion* truth, std::uint64_t seed, int threads,
                                    bool draw, Parts& parts) {
  TaiChiSubject out{.seed = seed};
  const auto medians = scale_by_medians(human, landmarks);
  if (!medians) return std::unexpected(medians.error());
  if (auto s =
          adapt(*medians, landmarks, threads, parts, out.medians, out.centres, out.positions, out.held_out);
      !s)
    return std::unexpected(s.error());
  auto clavicles = *medians;
  if (const auto added = motion::add_clavicles(clavicles); !added) return std::unexpected(added.error());
  if (auto s = adapt(clavicles, landmarks, threads, parts, out.clavicle_medians, out.clavicle_centres,
                     out.clavicle_positions, out.clavicle_held_out);
      !s)
    return std::unexpected(s.error());
  const auto tracked = scale_by_medians(human, landmarks, {.lock_unseen = true});
  if (!tracked) return std::unexpected(tracked.error());
  if (auto s = track(*tracked, landmarks, truth, parts, draw, out); !s) return std::unexpected(s.error());
  const auto elbow = landmarks.find("LElbow"), wrist = landmarks.find("LWrist");
  out.forearm_min_m = std::numeric_limits<double>::infinity();
  for (std::int64_t f = 0; f < landmarks.frames(); ++f) {
    if (!landmarks.present(f, elbow) || !landmarks.present(f, wrist)) continue;
    const double length = (landmarks.x(f, elbow) - landmarks.x(f, wrist)).norm();
    out.forearm_min_m = std::min(out.forearm_min_m, length);
    out.forearm_max_m = std::max(out.forearm_max_m, length);
  }
  return out;
}

}  // namespace

Result<SetOutcome> study_set(const model::Model& model, const Trajectories& goals, const Trajectories& made,
                             const LandmarkSet& set, bool coarse, const data::JointMotion* truth,
                             motion::TrackResult* drawn) {
  constexpr double kFine_s = 0.001, kCoarse_s = 1.0 / 60.0;
  const auto ik = reference_ik_options(model.description(), set.all());
  const auto of_goals = reference_ik(model, goals, ik);
  if (!of_goals) return std::unexpected(of_goals.error());
  const auto of_made = reference_ik(model, made, ik);
  if (!of_made) return std::unexpected(of_made.error());
  const auto run = [&](const Trajectories& to, const motion::IkResult& fitted, double step_s,
                       motion::TrackResult* keep) -> Result<ControlComparison> {
    auto tracked = run_control(model, to, set, {.step_s = step_s, .error_bars = true, .limits = true},
                               first_pose(fitted.motion));
    if (!tracked) return std::unexpected(tracked.error());
    auto compared = compare(model, *tracked, fitted, set.name, &to == &goals ? truth : nullptr);
    if (keep != nullptr) *keep = std::move(*tracked);
    return compared;
  };
  SetOutcome out;
  auto fine = run(goals, *of_goals, kFine_s, drawn);
  if (!fine) return std::unexpected(fine.error());
  out.recorded_fine = std::move(*fine);
  auto rough = run(goals, *of_goals, kCoarse_s, nullptr);
  if (!rough) return std::unexpected(rough.error());
  out.recorded_coarse = std::move(*rough);
  auto reached = run(made, *of_made, kFine_s, nullptr);
  if (!reached) return std::unexpected(reached.error());
  out.reachable_fine = std::move(*reached);
  if (!coarse) return out;
  auto reached_roughly = run(made, *of_made, kCoarse_s, nullptr);
  if (!reached_roughly) return std::unexpected(reached_roughly.error());
  out.reachable_coarse = std::move(*reached_roughly);
  return out;
}

Result<TaiChiStudy> study_taichi(const TaiChiJob& job, const Progress& progress) {
  TaiChiStudy out{.recorded = job.recording.has_value()};
  if (!out.recorded && job.seeds.empty()) return fail(Code::usage, "the study needs one seed or more");
  Parts parts(progress, out.recorded ? 1 : job.seeds.size());
  if (out.recorded) {
    const auto landmarks = prepare_landmarks(*job.recording);
    if (!landmarks) return std::unexpected(landmarks.error());
    auto subject = study_subject(job.human, *landmarks, nullptr, 0, job.threads, true, parts);
    if (!subject) return std::unexpected(subject.error());
    out.subjects.push_back(std::move(*subject));
  } else {
    for (const auto seed : job.seeds) {
      const auto simulated = simulate_tai_chi(job.human, seed);
      if (!simulated) return fail_at(fmt::format("seed {}", seed), simulated.error());
      auto subject = study_subject(job.human, simulated->landmarks, &simulated->truth, seed, job.threads,
                                   out.subjects.empty(), parts);
      if (!subject) return fail_at(fmt::format("seed {}", seed), subject.error());
      out.subjects.push_back(std::move(*subject));
    }
    out.table.seeds = job.seeds;
  }
  out.table.rows = taichi_rows(out.subjects, out.recorded);
  return out;
}

}  // namespace kinemark::studies
