// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/macaque/elbow_study.h"

#include <vector>

#include "kinemark/stages/skeleton/articulated/articulated.h"
#include "kinemark/stages/skeleton/functional/functional.h"

namespace kinemark::studies {
namespace {

using data::SegmentKind;
using simulation::LimbRecording;

/// Nothing answered in any frame.
CentreErrors refused(const LimbRecording& limb) {
  CentreErrors out;
  out.frames = limb.markers.frames() * static_cast<std::int64_t>(limb.layout.joints.size());
  return out;
}

CentreErrors by_the_field(const LimbRecording& limb, skeleton::FunctionalMethod method) {
  skeleton::FunctionalOptions options;
  options.method = method;
  options.kind = data::JointChoice::ball;
  const auto found = skeleton::find_joints(limb.markers, limb.layout, options);
  // Where SCoRE cannot be used another method replaces it, which does not count here.
  const bool stood_in =
      found && method == skeleton::FunctionalMethod::score && found->joints.front().method != "SCoRE";
  return found && !stood_in ? judge_centres(*found, limb, nullptr) : refused(limb);
}

CentreErrors by_us(const LimbRecording& limb, bool continuity, const skeleton::CentreBound* bound) {
  skeleton::ArticulatedOptions options;
  options.joint = data::JointChoice::ball;
  options.continuity = continuity;
  const auto found = skeleton::fit_articulated(limb.markers, limb.layout, options);
  return found ? judge_centres(found->skeleton, limb, bound) : refused(limb);
}

Result<skeleton::CentreBound> bound_of(const LimbRecording& limb, SegmentKind kind, double noise_m) {
  const std::vector<SegmentKind> kinds(limb.layout.segments.size(), kind);
  return skeleton::calc_centre_bound(limb.markers, limb.layout, kinds, {limb.x_true, limb.centre_in_world},
                                     noise_m);
}

}  // namespace

ElbowErrors& ElbowErrors::operator+=(const ElbowErrors& other) {
  report += other.report;
  score += other.score;
  ours += other.ours;
  return *this;
}

SleeveErrors& SleeveErrors::operator+=(const SleeveErrors& other) {
  report += other.report;
  score += other.score;
  alone += other.alone;
  smoothed += other.smoothed;
  return *this;
}

simulation::ChainOptions chain_options(const ElbowCell& cell, std::uint64_t seed) {
  simulation::ChainOptions out;
  out.frames = cell.frames;
  out.stagger_m = cell.stagger_m;
  out.noise_sd_m = cell.noise_m;
  out.missing = cell.missing;
  out.pose_correlated = cell.pose_correlated;
  out.seed = seed;
  return out;
}

Result<ElbowErrors> study_elbow(const ElbowCell& cell, std::uint64_t seed) {
  const auto limb = simulation::simulate_chain(chain_options(cell, seed));
  if (!limb) return std::unexpected(limb.error());
  ElbowErrors out;
  out.report = by_the_field(*limb, skeleton::FunctionalMethod::constant_distance);
  if (cell.stagger_m > 0.0) out.score = by_the_field(*limb, skeleton::FunctionalMethod::score);
  if (!(cell.noise_m > 0.0)) return out;
  const auto bound =
      bound_of(*limb, cell.stagger_m > 0.0 ? SegmentKind::solid : SegmentKind::line, cell.noise_m);
  if (!bound) return std::unexpected(bound.error());
  out.ours = by_us(*limb, false, &*bound);
  return out;
}

simulation::SleeveOptions sleeve_options(const SleeveCell& cell, std::uint64_t seed) {
  auto out = cell.hard ? simulation::SleeveOptions::hard() : simulation::SleeveOptions{};
  out.noise_sd_m = cell.noise_m;
  out.duration_s = cell.duration_s;
  out.seed = seed;
  return out;
}

Result<SleeveErrors> study_sleeve(const SleeveCell& cell, std::uint64_t seed) {
  const auto limb = simulation::simulate_sleeve(sleeve_options(cell, seed));
  if (!limb) return std::unexpected(limb.error());
  const auto bound = bound_of(*limb, SegmentKind::solid, cell.noise_m);
  if (!bound) return std::unexpected(bound.error());
  SleeveErrors out;
  out.report = by_the_field(*limb, skeleton::FunctionalMethod::constant_distance);
  out.score = by_the_field(*limb, skeleton::FunctionalMethod::score);
  out.alone = by_us(*limb, false, &*bound);
  out.smoothed = by_us(*limb, true, nullptr);
  return out;
}

}  // namespace kinemark::studies
