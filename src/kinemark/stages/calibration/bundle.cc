// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/calibration/bundle.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinemark/camera/parameters.h"
#include "kinemark/math/rotation_fit.h"
#include "kinemark/math/statistics.h"
#include "kinemark/stages/calibration/internal/bundle_problem.h"
#include "kinemark/stages/calibration/internal/gauge.h"
#include "kinemark/stages/calibration/internal/rays.h"
#include "kinemark/stages/calibration/light.h"

namespace kinemark::calibration {
namespace {

using internal::BundleProblem;
using internal::BundleState;

constexpr int kManyLeds = 12;  // with so many points one pose of the object determines the cameras
// Largest error of a side with the nominal cameras, whose detectors warp what they see, of that side. One
// pose shows each side at one place only, where the warp may be large: then all sides are judged together.
constexpr double kLargestSideError = 0.06;
constexpr std::size_t kFewSightings = 4;

/// Positions of the LEDs of one pose by intersection of rays; NaN where fewer than two cameras see one.
std::vector<Eigen::Vector3d> positions(const data::Rig& rig, const StillPoses& tree, int pose) {
  std::vector<Eigen::Vector3d> out;
  for (int led = 0; led < tree.leds(); ++led) {
    std::vector<camera::Ray> rays;
    for (int c = 0; c < tree.cameras; ++c)
      if (const auto& seen = tree.at(pose, led, c); seen.seen())
        if (const auto ray = internal::line_of_sight(rig.cameras[static_cast<std::size_t>(c)], seen.counts))
          rays.push_back(*ray);
    const auto at = internal::meet(rays);
    out.push_back(at ? *at : Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  }
  return out;
}

/// Poses that served; NaN for all others.
std::vector<math::SE3> only_used(const std::vector<math::SE3>& all, const std::vector<int>& used) {
  std::vector<math::SE3> out(all.size());
  for (auto& pose : out) pose.translation.setConstant(std::numeric_limits<double>::quiet_NaN());
  for (const int pose : used) out[static_cast<std::size_t>(pose)] = all[static_cast<std::size_t>(pose)];
  return out;
}

bool located(const Eigen::Vector3d& position) { return position.allFinite(); }

/// Rigid motion that maps the tree onto the located points.
math::SE3 fit_tree(const StillPoses& tree, const std::vector<Eigen::Vector3d>& at) {
  const auto count = std::ranges::count_if(at, located);
  Eigen::Matrix3Xd from(3, count), to(3, count);
  Eigen::Index column = 0;
  for (std::size_t led = 0; led < at.size(); ++led) {
    if (!located(at[led])) continue;
    from.col(column) = tree.tree[led];
    to.col(column++) = at[led];
  }
  return math::fit_rigid(from, to).target_from_source;
}

struct Start {
  std::vector<math::SE3> poses;
  std::vector<int> usable;
};

Start start_poses(const data::Rig& rig, const StillPoses& tree) {
  Start start;
  for (int pose = 0; pose < tree.poses(); ++pose) {
    const auto at = positions(rig, tree, pose);
    const bool enough = std::ranges::count_if(at, located) >= 3;
    start.poses.push_back(enough ? fit_tree(tree, at) : math::SE3{});
    if (enough) start.usable.push_back(pose);
  }
  return start;
}

/// Triangulated sides beside those of the tree, for sides of half the longest or more.
struct Sides {
  double rms_m = 0.0;
  double worst_share = 0.0;  // median error of the worst side that was seen often, of that side
  double scale = 1.0;        // median of found over given, of all
  std::string sentence;      // on the worst side, or where none was seen often on the scale

  [[nodiscard]] bool match() const {
    return worst_share <= kLargestSideError && std::abs(scale - 1.0) <= kLargestSideError;
  }
};

Sides compare_sides(const data::Rig& rig, const StillPoses& tree, const std::vector<int>& poses) {
  Sides out;
  std::vector<std::vector<double>> found(static_cast<std::size_t>(tree.leds() * tree.leds()));
  std::vector<double> ratios;
  double squares = 0.0, longest = 0.0;
  for (const auto& a : tree.tree)
    for (const auto& b : tree.tree) longest = std::max(longest, (a - b).norm());
  for (const int pose : poses) {
    const auto at = positions(rig, tree, pose);
    for (int a = 0; a < tree.leds(); ++a)
      for (int b = a + 1; b < tree.leds(); ++b) {
        const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
        const double side = (at[i] - at[j]).norm(), given = (tree.tree[i] - tree.tree[j]).norm();
        if (!std::isfinite(side) || given < 0.5 * longest) continue;
        found[static_cast<std::size_t>(a * tree.leds() + b)].push_back(side);
        squares += (side - given) * (side - given);
        ratios.push_back(side / given);
      }
  }
  if (ratios.empty()) return out;
  out.rms_m = std::sqrt(squares / static_cast<double>(ratios.size()));
  out.scale = math::upper_median(ratios);
  out.sentence = fmt::format("its distances are {:.0f} % of those given", 100.0 * out.scale);
  for (int a = 0; a < tree.leds(); ++a)
    for (int b = a + 1; b < tree.leds(); ++b) {
      const auto& sides = found[static_cast<std::size_t>(a * tree.leds() + b)];
      if (sides.size() < kFewSightings) continue;
      const double side = math::upper_median(sides);
      const double given =
          (tree.tree[static_cast<std::size_t>(a)] - tree.tree[static_cast<std::size_t>(b)]).norm();
      const double share = std::abs(side - given) / given;
      if (share <= out.worst_share) continue;
      out.worst_share = share;
      out.sentence =
          fmt::format("LEDs {} and {} are {:.1f} mm apart on the tree and {:.1f} mm in the recording", a + 1,
                      b + 1, 1e3 * given, 1e3 * side);
    }
  return out;
}

Status check_input(const data::Rig& nominal, const StillPoses& tree,
                   const std::vector<GridObservations>& grids) {
  if (nominal.camera_count() < 2) return fail(Code::bad_input, "a bundle needs two cameras or more");
  if (tree.cameras != nominal.camera_count() || tree.leds() < 2 ||
      tree.observations.size() != static_cast<std::size_t>(tree.poses() * tree.leds() * tree.cameras))
    return fail(Code::bad_input,
                fmt::format("tree sightings of {} cameras and {} LEDs do not fit a rig of {} cameras",
                            tree.cameras, tree.leds(), nominal.camera_count()));
  for (const auto& camera : nominal.cameras)
    if (camera.kind != data::CameraKind::lateral_effect)
      return fail(Code::not_supported, fmt::format("camera '{}' is no lateral-effect camera", camera.name));
  for (int c = 0; c < tree.cameras; ++c) {
    bool sees = false;
    for (int pose = 0; pose < tree.poses() && !sees; ++pose)
      for (int led = 0; led < tree.leds(); ++led) sees = sees || tree.at(pose, led, c).seen();
    if (!sees)
      return fail(Code::bad_input,
                  fmt::format("camera '{}' saw the tree in none of {} poses",
                              nominal.cameras[static_cast<std::size_t>(c)].name, tree.poses()));
  }
  if (!grids.empty() && grids.size() != nominal.cameras.size())
    return fail(Code::bad_input, fmt::format("{} grids for {} cameras; one each was expected, or none",
                                             grids.size(), nominal.camera_count()));
  for (const auto& grid : grids)
    if (grid.nodes != grids.front().nodes ||
        grid.observations.size() != static_cast<std::size_t>(grid.nodes * grid.nodes))
      return fail(Code::bad_input, "the grids before the cameras have different numbers of LEDs");
  return {};
}

struct Progressing {
  const Progress& progress;
  int done = 0, most = 0;
  bool next() {
    done = std::min(done + 1, most);
    return !progress || progress(done, most);
  }
};

/// Gauss-Newton with step halving until the predicted gain of a step is negligible.
Status converge(BundleProblem& problem, BundleState& state, const BundleOptions& options,
                Progressing& progress) {
  constexpr double kDone = 0.05;  // of chi2: a quarter of one standard deviation along the worst direction
  constexpr int kHalvings = 12;
  for (int i = 0; i < options.max_iterations; ++i) {
    if (!progress.next()) return fail(Code::cancelled, "the calibration was stopped");
    const auto step = problem.solve(state);
    if (!step.solved)
      return fail(Code::bad_input,
                  "the bundle has no solution: some pose or parameter is not determined by what was seen");
    const double before = problem.cost(state);
    double share = 1.0;
    BundleState next = problem.moved(state, step, share);
    for (int h = 0; h < kHalvings && problem.cost(next) > before; ++h)
      next = problem.moved(state, step, share *= 0.5);
    state = std::move(next);
    const bool done = share == 1.0 && step.decrement < kDone;
    if (i >= 2 || done) problem.reweigh(state);
    if (done) return {};
  }
  return {};
}

}  // namespace

Status BundleOptions::check() const {
  if (warp_degree < 2 || highest_warp_degree > data::kHighestDegree || warp_degree > data::kHighestDegree)
    return fail(Code::usage, fmt::format("a warp degree of {} (up to {}); 2 to {} was expected", warp_degree,
                                         highest_warp_degree, data::kHighestDegree));
  if (!(enough > 0.0) || !(refuse_above > 0.0) || max_iterations < 1)
    return fail(Code::usage, "the limits on chi2/dof and the number of iterations must be positive");
  if (!(largest_outlier_share >= 0.0) || largest_outlier_share > 0.5)
    return fail(Code::usage,
                fmt::format("an outlier share of {}; 0 to 0.5 was expected", largest_outlier_share));
  return {};
}

Result<BundleResult> calibrate_bundle(const data::Rig& nominal, const StillPoses& tree,
                                      const std::vector<GridObservations>& grids,
                                      const BundleOptions& options, const Progress& progress) {
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  if (auto s = check_input(nominal, tree, grids); !s) return std::unexpected(s.error());
  data::Rig flat = nominal;
  for (auto& camera : flat.cameras) camera = camera::with_warp_degree(camera, options.warp_degree);

  const Start first = start_poses(flat, tree);
  const std::size_t fewest = tree.leds() >= kManyLeds ? 1 : 4;
  if (first.usable.size() < fewest)
    return fail(
        Code::bad_input,
        fmt::format("{} of {} poses were seen by two cameras with three LEDs; {} or more were expected",
                    first.usable.size(), tree.poses(), fewest));
  if (const auto sides = compare_sides(flat, tree, first.usable); !sides.match())
    return fail(Code::bad_input, "the tree's sides do not match the recording: " + sides.sentence);

  BundleProblem problem(flat, tree, grids, options);
  BundleState state{.rig = flat, .world_from_tree = first.poses, .cam_from_grid = {}, .grid_shift = {}};
  for (const auto& grid : grids)
    state.cam_from_grid.push_back({Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.0, 0.0, grid.distance_m)});
  if (!grids.empty()) state.grid_shift.assign(grids.front().observations.size(), Eigen::Vector2d::Zero());

  Progressing steps{progress, 0, 2 * options.max_iterations};
  // A fifth of a long recording gives a starting point for the adjustment of all of it.
  constexpr std::size_t kFew = 60;
  if (first.usable.size() > 2 * kFew) {
    std::vector<int> few;
    for (std::size_t i = 0; i < kFew; ++i) few.push_back(first.usable[i * first.usable.size() / kFew]);
    problem.use_poses(few);
    if (auto s = converge(problem, state, options, steps); !s) return std::unexpected(s.error());
    const Start again = start_poses(state.rig, tree);
    for (const int pose : again.usable)
      if (!std::ranges::binary_search(few, pose))
        state.world_from_tree[static_cast<std::size_t>(pose)] = again.poses[static_cast<std::size_t>(pose)];
    problem.use_poses(again.usable);
  } else {
    problem.use_poses(first.usable);
  }
  if (auto s = converge(problem, state, options, steps); !s) return std::unexpected(s.error());
  int degree = options.warp_degree;
  auto misfit = problem.misfit(state);
  while (options.escalate && misfit.chi2_per_dof > options.enough &&
         degree + 2 <= options.highest_warp_degree) {
    state = problem.enrich(state, degree += 2);
    if (auto s = converge(problem, state, options, steps); !s) return std::unexpected(s.error());
    misfit = problem.misfit(state);
  }
  if (misfit.chi2_per_dof > options.refuse_above)
    return fail(
        Code::bad_input,
        fmt::format(
            "calibration refused: chi2 per degree of freedom is {:.2f} with a warp of degree {}{}, {:.2f} or "
            "less was expected; the model of the detector does not fit these cameras, or something moved",
            misfit.chi2_per_dof, degree, options.crosstalk ? " and crosstalk" : "", options.refuse_above));
  BundleResult result;
  result.report = {.chi2_per_dof = misfit.chi2_per_dof,
                   .warp_degree = degree,
                   .crosstalk = options.crosstalk,
                   .iterations = steps.done,
                   .poses = static_cast<int>(problem.poses().size()),
                   .observations = misfit.observations,
                   .outliers = misfit.outliers,
                   .world_from_tree = state.world_from_tree,
                   .side_rms_m = compare_sides(state.rig, tree, problem.poses()).rms_m};
  result.rig = std::move(state.rig);
  result.rig.method = "bundle";
  result.rig.chi2_per_dof = misfit.chi2_per_dof;
  find_light_counts(tree, only_used(result.report.world_from_tree, problem.poses()), result.rig);
  result.rig.covariance =
      internal::hold_the_cloud(result.rig, problem, result.report.world_from_tree, tree.tree);
  return result;
}

}  // namespace kinemark::calibration
