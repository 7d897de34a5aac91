// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The tai chi recording: what its reader finds, and least squares on a model scaled by medians.
#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "acceptance/taichi_recording.h"
#include "kinemark/stages/motion/scaling/clavicles.h"
#include "studies/taichi/least_squares.h"
#include "studies/taichi/subject.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using acceptance::kMillimetres;
using Eigen::Vector3d;
using testing_support::print_row;

using Pair = std::array<std::string_view, 2>;

double sd(const std::vector<double>& x) {
  double mean = 0.0, square = 0.0;
  for (const double v : x) mean += v / static_cast<double>(x.size());
  for (const double v : x) square += (v - mean) * (v - mean) / static_cast<double>(x.size());
  return std::sqrt(square);
}

double length_sd(const data::Trajectories& markers, const Pair& pair) {
  std::vector<double> length;
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    length.push_back((markers.x(f, markers.find(pair[0])) - markers.x(f, markers.find(pair[1]))).norm());
  return sd(length);
}

/// Scatter of the vector between two landmarks in the axes of the first one's segment; its angles are read in
/// the order that `rotation` makes of them.
template <class Rotation>
double vector_sd(const io::V3dFile& file, const Pair& pair, const Rotation& rotation) {
  const auto& markers = file.trial.markers;
  const auto from = markers.find(pair[0]), to = markers.find(pair[1]);
  std::array<std::vector<double>, 3> axis;
  for (std::int64_t f = 0; f < markers.frames(); ++f) {
    const Vector3d d =
        rotation(f, file.orientations.find(pair[0])).transpose() * (markers.x(f, to) - markers.x(f, from));
    for (std::size_t a = 0; a < 3; ++a) axis[a].push_back(d[static_cast<Eigen::Index>(a)]);
  }
  return std::sqrt(std::pow(sd(axis[0]), 2) + std::pow(sd(axis[1]), 2) + std::pow(sd(axis[2]), 2));
}

void check_reader(const io::V3dFile& file) {
  const auto& markers = file.trial.markers;
  const Vector3d first = markers.x(0, markers.find("FHead"));
  print_row(markers.frames() == 2990 && markers.markers() == 21 && file.orientations.names.size() == 21 &&
                markers.count_missing() == 0 && first == Vector3d(-0.216436, -0.185403, 1.739107),
            "taichi.v3d reader",
            "2,990 rows, 21 + 21 signals, first FHead (-0.216436, -0.185403, 1.739107), none missing",
            fmt::format("{} rows, {} + {} signals, ({:.6f}, {:.6f}, {:.6f}), {} missing", markers.frames(),
                        markers.markers(), file.orientations.names.size(), first.x(), first.y(), first.z(),
                        markers.count_missing()));
  constexpr std::array<Pair, 8> kRigid{{{"Neck", "Thorax"},
                                        {"Pelvis", "LHip"},
                                        {"Pelvis", "RHip"},
                                        {"LHip", "RHip"},
                                        {"LWrist", "LHand"},
                                        {"RWrist", "RHand"},
                                        {"LKnee", "LAnkle"},
                                        {"RKnee", "RAnkle"}}};
  double most = 0.0;
  for (const auto& pair : kRigid) most = std::max(most, length_sd(markers, pair));
  print_row(most <= 1e-5, "taichi.v3d, rigid pairs of landmarks", "SD of each length <= 0.01 mm",
            fmt::format("{:.4f} mm at most of {} pairs", kMillimetres * most, kRigid.size()));

  constexpr std::array<Pair, 6> kSegment{{{"Neck", "Thorax"},
                                          {"Pelvis", "LHip"},
                                          {"LWrist", "LHand"},
                                          {"RWrist", "RHand"},
                                          {"LKnee", "LAnkle"},
                                          {"RKnee", "RAnkle"}}};
  const auto as_read = [&](std::int64_t f, std::int64_t s) -> Eigen::Matrix3d {
    return file.orientations.world_from_segment(f, s);
  };
  // The same three rotations about fixed axes: Rz Ry Rx.
  const auto fixed = [&](std::int64_t f, std::int64_t s) -> Eigen::Matrix3d {
    const Vector3d a = file.orientations.angles(f, s);
    return (Eigen::AngleAxisd(a.z(), Vector3d::UnitZ()) * Eigen::AngleAxisd(a.y(), Vector3d::UnitY()) *
            Eigen::AngleAxisd(a.x(), Vector3d::UnitX()))
        .toRotationMatrix();
  };
  double ours = 0.0, other = 1.0;
  for (const auto& pair : kSegment) {
    ours = std::max(ours, vector_sd(file, pair, as_read));
    other = std::min(other, vector_sd(file, pair, fixed));
  }
  print_row(
      ours <= 2e-5 && other >= 100.0 * ours, "taichi.v3d, angles are orientations in the laboratory",
      "they turn each segment's own vector into a constant (<= 0.02 mm), read about fixed axes they do not",
      fmt::format("scatter {:.4f} mm at most; about fixed axes {:.1f} mm at least", kMillimetres * ours,
                  kMillimetres * other));
}

void check_medians(const data::Trajectories& landmarks, bool clavicles, double most_mm) {
  auto description = studies::scale_by_medians(acceptance::human(), landmarks).value();
  if (clavicles) motion::add_clavicles(description).value();
  const auto model = model::Model::compile(description).value();
  const auto ik = motion::solve_ik(model, landmarks, studies::landmark_ik_options(description)).value();
  print_row(kMillimetres * ik.fit.rms_error_m <= most_mm && landmarks.frames() == 1002,
            fmt::format("tai chi, least squares, 21 landmarks, scaled by medians, {} coordinates",
                        model.coordinate_count()),
            fmt::format("1002 rows at 60 Hz, RMS <= {} mm", most_mm),
            fmt::format("{} rows, {:.2f} mm, at most {:.1f} mm", landmarks.frames(),
                        kMillimetres * ik.fit.rms_error_m, kMillimetres * ik.fit.max_error_m));
}

int run_check(int /*argc*/, char** /*argv*/) {
  const auto data = testing_support::test_data_folder();
  if (!data) return testing_support::skip_all("the tai chi recording");
  const auto file = acceptance::read_tai_chi(*data);
  if (!file) {
    print_row(false, "taichi.v3d reader", "reads", file.error().message);
    return testing_support::exit_status();
  }
  check_reader(*file);
  const auto landmarks = studies::prepare_landmarks(file->trial.markers).value();
  check_medians(landmarks, false, 12.0);
  check_medians(landmarks, true, 7.5);
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("taichi", run_check);

}  // namespace
