// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The methods of the field: Ehrig's comparison on a simulated ball joint, a functional hip with a
// laboratory's own centre beside it, a functional knee with its epicondyles.
#include <fmt/core.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/random.h"
#include "kinemark/core/units.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/stages/skeleton/articulated/articulated.h"
#include "kinemark/stages/skeleton/functional/carry.h"
#include "kinemark/stages/skeleton/functional/functional.h"
#include "kinemark/stages/skeleton/functional/score.h"
#include "support/acceptance.h"
#include "support/test_data.h"

namespace {

using namespace kinemark;
using testing_support::print_row;
namespace fs = std::filesystem;

constexpr double kMm = 1e3;

data::SegmentLayout two_segments(const data::Trajectories& markers, const std::vector<std::string>& parent,
                                 const std::vector<std::string>& child) {
  data::SegmentLayout layout;
  layout.segments = {{"parent", {}}, {"child", {}}};
  for (const auto& name : parent) layout.segments[0].markers.push_back(static_cast<int>(markers.find(name)));
  for (const auto& name : child) layout.segments[1].markers.push_back(static_cast<int>(markers.find(name)));
  layout.joints = {{"joint", 0, 1}};
  return layout;
}

// A ball joint as Ehrig et al. (2006) moved it: four markers on each segment, 1 mm of noise per axis on all
// of them, the moving segment anywhere in a cone about its mean pose, 200 frames; both segments move in the
// room.
struct Ball {
  data::Trajectories markers;
  Eigen::Matrix3Xd centre;
  std::vector<Eigen::Matrix3d> world_from_parent, world_from_child;
};

Ball make_ball(double range_rad, std::uint64_t seed) {
  constexpr std::int64_t kFrames = 200;
  constexpr double kNoise_m = 1e-3;
  Random motion(seed, 1), noise(seed, 2);
  const std::vector<Eigen::Vector3d> parent = {
      {0.12, 0.05, 0.08}, {-0.12, 0.05, 0.08}, {0.07, -0.15, 0.10}, {-0.07, -0.15, 0.10}};
  const std::vector<Eigen::Vector3d> child = {
      {0.06, 0.02, -0.15}, {-0.06, 0.03, -0.20}, {0.02, 0.07, -0.28}, {0.03, -0.06, -0.32}};
  Ball ball;
  std::vector<std::string> names;
  for (int k = 0; k < 8; ++k) names.push_back((k < 4 ? "P" : "C") + std::to_string(k % 4));
  ball.markers = data::Trajectories::all_missing(names, {.rate_hz = 100.0, .t0_s = 0.0, .frames = kFrames});
  ball.centre.resize(3, kFrames);
  for (std::int64_t f = 0; f < kFrames; ++f) {
    const double sway = motion.uniform(-0.1, 0.1), tilt = motion.uniform(-0.1, 0.1);
    const Eigen::Matrix3d pelvis = (Eigen::AngleAxisd(sway, Eigen::Vector3d::UnitX()) *
                                    Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitY()))
                                       .toRotationMatrix();
    Eigen::Vector3d at;
    for (double& c : at) c = motion.uniform(-0.1, 0.1);
    const double azimuth = motion.uniform(0.0, 2.0 * std::numbers::pi);
    // Even over the cap of half the range; rotations about the long axis over half the range as well.
    const double height = motion.uniform(std::cos(0.5 * range_rad), 1.0);
    const double roll = motion.uniform(-0.25, 0.25) * range_rad;
    const Eigen::Vector3d axis(std::cos(azimuth), std::sin(azimuth), 0.0);
    const Eigen::Matrix3d thigh = pelvis * (Eigen::AngleAxisd(std::acos(height), axis) *
                                            Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()))
                                               .toRotationMatrix();
    ball.centre.col(f) = at;
    ball.world_from_parent.push_back(pelvis);
    ball.world_from_child.push_back(thigh);
    for (std::int64_t m = 0; m < 8; ++m) {
      const auto k = static_cast<std::size_t>(m % 4);
      Eigen::Vector3d x = at + (m < 4 ? pelvis * parent[k] : thigh * child[k]);
      for (double& c : x) c += kNoise_m * noise.gaussian();
      ball.markers.x(f, m) = x;
      ball.markers.state[ball.markers.index(f, m)] = data::SampleState::measured;
    }
  }
  return ball;
}

/// Squared errors of one method, pooled.
struct Pool {
  std::string name;
  double frame = 0.0;                ///< of every frame by itself
  double parent = 0.0, child = 0.0;  ///< of the mean position in each segment's true axes
  void add(const data::Skeleton& skeleton, const Ball& ball) {
    Eigen::Vector3d in_parent = Eigen::Vector3d::Zero(), in_child = Eigen::Vector3d::Zero();
    double squares = 0.0;
    for (std::int64_t f = 0; f < skeleton.frames(); ++f) {
      const Eigen::Vector3d d = skeleton.centre(f, 0) - ball.centre.col(f);
      squares += d.squaredNorm();
      in_parent += ball.world_from_parent[static_cast<std::size_t>(f)].transpose() * d;
      in_child += ball.world_from_child[static_cast<std::size_t>(f)].transpose() * d;
    }
    const auto n = static_cast<double>(skeleton.frames());
    frame += squares / n;
    parent += (in_parent / n).squaredNorm();
    child += (in_child / n).squaredNorm();
  }
};

void ehrig(int seeds) {
  const std::vector<double> ranges_deg = {10.0, 20.0, 30.0, 45.0, 60.0, 90.0};
  for (const double range : ranges_deg) {
    Pool ours{"articulated"}, score{"SCoRE"}, gamage{"Gamage-Lasenby"}, plain{"uncorrected"};
    for (int seed = 1; seed <= seeds; ++seed) {
      const Ball ball = make_ball(range * kRadPerDeg, static_cast<std::uint64_t>(seed));
      const auto layout = two_segments(ball.markers, {"P0", "P1", "P2", "P3"}, {"C0", "C1", "C2", "C3"});
      const auto find = [&](skeleton::FunctionalMethod method) {
        return skeleton::find_joints(ball.markers, layout,
                                     {.method = method, .kind = data::JointChoice::ball})
            .value();
      };
      score.add(find(skeleton::FunctionalMethod::score), ball);
      gamage.add(find(skeleton::FunctionalMethod::gamage), ball);
      plain.add(find(skeleton::FunctionalMethod::gamage_plain), ball);
      const skeleton::ArticulatedOptions options{.joint = data::JointChoice::ball, .continuity = false};
      ours.add(skeleton::fit_articulated(ball.markers, layout, options).value().skeleton, ball);
    }
    const auto rms = [&](double squares) { return kMm * std::sqrt(squares / seeds); };
    const double best = std::min({rms(score.frame), rms(gamage.frame), rms(plain.frame)});
    print_row(rms(ours.frame) < best,
              fmt::format("ball joint, {:.0f} deg of motion, centre in every frame, {} seeds", range, seeds),
              "ours lowest",
              fmt::format("RMS ours {:.2f}, SCoRE {:.2f}, Gamage-Lasenby {:.2f} (uncorrected {:.2f}) mm",
                          rms(ours.frame), rms(score.frame), rms(gamage.frame), rms(plain.frame)));
    if (range != 45.0) continue;
    const double worst = std::max({rms(ours.frame), rms(score.frame), rms(gamage.frame)});
    print_row(
        worst <= 3.0, "ball joint, 45 deg, centre in every frame (Ehrig et al. 2006)", "<= 3 mm, all three",
        fmt::format("ours {:.2f}, SCoRE {:.2f}, Gamage-Lasenby {:.2f} mm; of the mean place in parent and "
                    "child {:.2f} and {:.2f}, {:.2f} and {:.2f}, {:.2f} and {:.2f} mm",
                    rms(ours.frame), rms(score.frame), rms(gamage.frame), rms(ours.parent), rms(ours.child),
                    rms(score.parent), rms(score.child), rms(gamage.parent), rms(gamage.child)));
  }
}

// The functional hip

/// Position of a carried centre relative to the laboratory's own in the walk.
struct Comparison {
  double mean_distance_m = 0.0, within = 0.0;
  double sd_m = 0.0;        ///< root of the trace of the mean covariance
  double largest_z2 = 0.0;  ///< squared Mahalanobis length of the mean difference, in the parent's axes
};

Comparison compare(const data::Skeleton& carried, const data::Trajectories& walk, const std::string& point,
                   const skeleton::SegmentPoses& pelvis) {
  const auto m = walk.find(point);
  Comparison c;
  double n = 0.0, inside = 0.0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (std::int64_t f = 0; f < walk.frames(); ++f) {
    if (!walk.present(f, m) || carried.state[carried.index(f, 0)] == data::CentreState::undetermined ||
        !pelvis.known[static_cast<std::size_t>(f)])
      continue;
    const Eigen::Vector3d d = walk.x(f, m) - carried.centre(f, 0);
    const Eigen::Matrix3d C = carried.centre_covariance(f, 0);
    const Eigen::Matrix3d& R = pelvis.world_from_segment[static_cast<std::size_t>(f)];
    mean += R.transpose() * d;
    covariance += R.transpose() * C * R;
    c.mean_distance_m += d.norm();
    inside += d.dot(C.inverse() * d) < 7.815;
    n += 1.0;
  }
  mean /= n;
  covariance /= n;
  c.mean_distance_m /= n;
  c.within = inside / n;
  c.sd_m = std::sqrt(covariance.trace());
  c.largest_z2 = mean.dot(covariance.inverse() * mean);
  return c;
}

void hip(const fs::path& data) {
  const auto trial = io::read_markers(data / "btk-others/FunctionalLHip.c3d").value();
  const auto walk = io::read_markers(data / "btk-others/FunctionalWalk.c3d").value();
  const std::vector<std::string> pelvis = {"LASI", "RASI", "LPSI", "RPSI"},
                                 thigh = {"LF01", "LF02", "LF03", "LF04", "LF05"};
  const auto layout = two_segments(trial.markers, pelvis, thigh);
  const skeleton::Samples samples{trial.markers, {}};
  const auto a = skeleton::find_segment_poses(samples, "pelvis", layout.segments[0].markers);
  const auto b = skeleton::find_segment_poses(samples, "thigh", layout.segments[1].markers);
  const auto motion = skeleton::measure_motion(a, b);
  const auto fit = skeleton::fit_score(samples, a, b, motion, data::JointKind::ball);
  print_row(std::abs(kMm * fit.residual_rms_m - 5.7) <= 0.2, "functional left hip, SCoRE residual",
            "5.7 mm +-0.2",
            fmt::format("{:.2f} mm over {} frames, {:.0f} deg of motion", kMm * fit.residual_rms_m,
                        fit.frames, motion.range_rad * kDegPerRad));

  const auto score = skeleton::find_joints(trial.markers, layout, {.kind = data::JointChoice::ball}).value();
  const auto carried = skeleton::carry_joints(score, walk.markers).value();
  const auto walk_layout = two_segments(walk.markers, pelvis, thigh);
  const auto walk_pelvis =
      skeleton::find_segment_poses({walk.markers, {}}, "pelvis", walk_layout.segments[0].markers);
  const auto theirs = compare(carried, walk.markers, "LeftHipCenterScore", walk_pelvis);
  print_row(theirs.mean_distance_m <= 6.5e-3, "functional left hip carried to the walk, SCoRE",
            "within 6.5 mm of LeftHipCenterScore",
            fmt::format("{:.2f} mm on average", kMm * theirs.mean_distance_m));

  const skeleton::ArticulatedOptions options{.joint = data::JointChoice::ball, .continuity = false};
  const auto ours = skeleton::fit_articulated(trial.markers, layout, options);
  if (!ours) {
    print_row(false, "functional left hip carried to the walk, articulated", "an interval that covers it",
              ours.error().message);
    return;
  }
  const auto placed = skeleton::carry_joints(ours->skeleton, walk.markers).value();
  const auto covered = compare(placed, walk.markers, "LeftHipCenterScore", walk_pelvis);
  // An interval wide enough covers anything: it must also be one of use.
  print_row(covered.largest_z2 < 7.815 && covered.sd_m < 15e-3,
            "functional left hip carried to the walk, articulated",
            "LeftHipCenterScore within the 95 % interval of the mean, SD < 15 mm",
            fmt::format("{:.2f} mm away on average, SD {:.2f} mm, chi-square {:.2f} of 7.81; in {:.0f} % of "
                        "frames one by one; {}",
                        kMm * covered.mean_distance_m, kMm * covered.sd_m, covered.largest_z2,
                        100.0 * covered.within, ours->skeleton.joints[0].description));
}

// The functional knee

data::Trajectories cut(const data::Trajectories& from, std::int64_t first, std::int64_t last) {
  auto out = data::Trajectories::all_missing(
      from.names, {.rate_hz = from.time.rate_hz, .t0_s = 0.0, .frames = last - first + 1});
  for (std::int64_t f = first; f <= last; ++f)
    for (std::int64_t m = 0; m < from.markers(); ++m) {
      out.x(f - first, m) = from.x(f, m);
      out.state[out.index(f - first, m)] = from.state[from.index(f, m)];
    }
  return out;
}

void knee(const fs::path& data) {
  const auto trial = io::read_markers(data / "biobuddy/right_knee.c3d").value();
  const auto markers = cut(trial.markers, 300, 821);
  const auto layout = two_segments(markers, {"RGT", "RTHI1", "RTHI2", "RTHI3"},
                                   {"RATT", "RLM", "RSPH", "RLEG1", "RLEG2", "RLEG3"});
  const auto found =
      skeleton::find_joints(markers, layout, {.method = skeleton::FunctionalMethod::sara}).value();
  const auto& joint = found.joints[0];
  const auto automatic = skeleton::find_joints(markers, layout).value();
  const skeleton::Samples samples{markers, {}};
  const auto femur = skeleton::find_segment_poses(samples, "femur", layout.segments[0].markers);
  const auto lateral = markers.find("RLFE"), medial = markers.find("RMFE");
  double angle = 0.0, distance = 0.0, middle_distance = 0.0, n = 0.0, sd = 0.0;
  for (std::int64_t f = 0; f < markers.frames(); ++f) {
    if (!femur.known[static_cast<std::size_t>(f)] ||
        found.state[found.index(f, 0)] == data::CentreState::undetermined)
      continue;
    const Eigen::Vector3d line = (markers.x(f, lateral) - markers.x(f, medial)).normalized();
    const Eigen::Vector3d middle = 0.5 * (markers.x(f, lateral) + markers.x(f, medial));
    const Eigen::Vector3d axis = femur.world_from_segment[static_cast<std::size_t>(f)] * joint.axis_in_parent;
    const Eigen::Vector3d off = middle - found.centre(f, 0);
    angle += std::acos(std::min(1.0, std::abs(axis.dot(line)))) * kDegPerRad;
    middle_distance += (off - axis * axis.dot(off)).norm();
    const Eigen::Vector3d across = axis.cross(line).normalized();
    distance += std::abs(off.dot(across));
    sd += std::sqrt(across.dot(found.centre_covariance(f, 0) * across));
    n += 1.0;
  }
  angle /= n;
  distance /= n;
  middle_distance /= n;
  sd /= n;
  print_row(angle <= 6.0, "functional right knee, axis against the epicondyles", "within 6 deg",
            fmt::format("{:.2f} deg; SD of each tilt {:.2f} deg; {}", angle, joint.axis_sd_rad * kDegPerRad,
                        joint.description));
  print_row(
      distance <= 10e-3, "functional right knee, axis past the epicondyle line", "within 10 mm",
      fmt::format(
          "{:.2f} mm between the lines, SD of a frame {:.2f} mm; {:.2f} mm from the epicondyles' middle",
          kMm * distance, kMm * sd, kMm * middle_distance));
  // 95 % of two tilts lie within 2.45 SD, 95 % of one distance within 1.96 SD.
  print_row(
      angle <= 2.45 * joint.axis_sd_rad * kDegPerRad,
      "functional right knee, interval of the axis' direction", "covers the epicondyles",
      fmt::format("{:.2f} deg away, 95 % within {:.2f} deg", angle, 2.45 * joint.axis_sd_rad * kDegPerRad));
  print_row(distance <= 1.96 * sd, "functional right knee, interval of the axis' place",
            "covers the epicondyle line",
            fmt::format("{:.2f} mm away, 95 % within {:.2f} mm", kMm * distance, kMm * 1.96 * sd));
  print_row(
      automatic.joints[0].kind == data::JointKind::hinge, "functional right knee, kind chosen by the data",
      "hinge",
      fmt::format("{}; {}", data::to_string(automatic.joints[0].kind), automatic.joints[0].description));
}

int run_check(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "all";
  const auto asked = [&](const char* name) { return what == name || what == "all"; };
  if (asked("ehrig")) ehrig(argc > 2 ? std::atoi(argv[2]) : 10);
  if (what == "ehrig") return testing_support::exit_status();
  const auto data = testing_support::test_data_folder();
  if (!data) return testing_support::skip_all("functional hip and knee");
  if (asked("hip")) hip(*data);
  if (asked("knee")) knee(*data);
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("joint_methods", run_check);

}  // namespace
