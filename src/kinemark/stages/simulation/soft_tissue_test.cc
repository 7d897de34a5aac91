// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/internal/soft_tissue.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "kinemark/core/random.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/simulation/subject.h"
#include "kinemark/stages/simulation/testing/models.h"

namespace kinemark::simulation {
namespace {

using Eigen::Matrix3Xd;
using Eigen::MatrixXd;

// Recorded minus true in the frame of each marker's body: one 3 x F matrix per marker.
std::vector<Matrix3Xd> displacements(const SimulatedSubject& s) {
  std::vector<Matrix3Xd> out(static_cast<std::size_t>(s.markers.markers()), Matrix3Xd(3, s.markers.frames()));
  model::Workspace w(human());
  for (std::int64_t f = 0; f < s.markers.frames(); ++f) {
    const Eigen::Map<const Eigen::VectorXd> q(s.truth.q.data() + s.truth.index(f, 0), s.truth.size());
    model::kinematics(human(), w, model::state_from_coordinates(human(), q));
    for (std::size_t m = 0; m < out.size(); ++m) {
      const auto marker = static_cast<std::int64_t>(m);
      const auto body = static_cast<std::size_t>(human().markers()[m].body);
      out[m].col(f) = w.rotation[body].transpose() * (s.markers.x(f, marker) - s.true_markers.x(f, marker));
    }
  }
  return out;
}

double rms(const Matrix3Xd& u) { return std::sqrt(u.squaredNorm() / static_cast<double>(u.cols())); }

int marker(const char* name) { return human().description().find_marker(name); }

TEST(SoftTissue, AmplitudesFollowTheFlesh) {
  const Eigen::VectorXd a = 1e3 * soft_tissue_rms_m(human());
  const auto mm = [&](const char* name) { return a[marker(name)]; };
  EXPECT_NEAR(mm("RTHI"), 15.0, 0.5);
  EXPECT_NEAR(mm("RFIN"), 2.0, 1e-9);
  EXPECT_NEAR(mm("LFHD"), 2.0, 1e-9);
  EXPECT_NEAR(mm("LTOE"), 2.0, 1e-9);
  for (const char* name : {"LASI", "C7", "STRN", "RSHO"}) EXPECT_NEAR(mm(name), 5.9, 0.2) << name;
  for (const char* name : {"RTIB", "RUPA"}) EXPECT_NEAR(mm(name), 8.0, 1.5) << name;
  EXPECT_LT(mm("RKNE"), mm("RTHI")) << "less flesh at the joint";
  EXPECT_LT(mm("RHEE"), 5.0);
  EXPECT_GE(a.minCoeff(), 2.0 - 1e-9);
  EXPECT_LE(a.maxCoeff(), 15.0 + 1e-9);
  for (const auto& [left, right] : {std::pair{"LTHI", "RTHI"}, {"LANK", "RANK"}, {"LFRM", "RFRM"}})
    EXPECT_NEAR(mm(left), mm(right), 1e-9);
}

TEST(SoftTissue, DisplacementsHaveTheAmplitudeAndNoMean) {
  for (const double scale : {1.0, 0.4}) {
    const auto s =
        simulate_subject(human(), {.rate_hz = 25.0, .noise_sd_m = 0.0, .soft_tissue = scale}).value();
    const auto u = displacements(s);
    const Eigen::VectorXd expected = scale * soft_tissue_rms_m(human());
    for (std::size_t m = 0; m < u.size(); ++m) {
      EXPECT_NEAR(rms(u[m]), expected[static_cast<Eigen::Index>(m)], 1e-9);
      EXPECT_LT(u[m].rowwise().mean().norm(), 1e-12);
    }
  }
}

TEST(SoftTissue, WithoutImpactsItIsLinearInTheAdjacentAngles) {
  const auto s = simulate_subject(human(), {.motion = MotionKind::tai_chi,
                                            .duration_s = 20.0,
                                            .rate_hz = 10.0,
                                            .noise_sd_m = 0.0,
                                            .soft_tissue = 1.0})
                     .value();
  const auto u = displacements(s);
  const auto explained = [&](const char* name, std::initializer_list<const char*> coordinates) {
    MatrixXd X = MatrixXd::Ones(s.truth.frames(), static_cast<Eigen::Index>(coordinates.size()) + 1);
    Eigen::Index column = 1;
    for (const char* coordinate : coordinates) {
      for (std::int64_t f = 0; f < s.truth.frames(); ++f)
        X(f, column) = s.truth.q[s.truth.index(f, s.truth.find(coordinate))];
      ++column;
    }
    const MatrixXd y = u[static_cast<std::size_t>(marker(name))].transpose();
    return 1.0 - (y - X * X.colPivHouseholderQr().solve(y)).squaredNorm() / y.squaredNorm();
  };
  EXPECT_GT(explained("RTHI", {"hip_flexion_r", "hip_adduction_r", "hip_rotation_r", "knee_angle_r"}),
            1.0 - 1e-12);
  EXPECT_GT(explained("LTIB", {"knee_angle_l", "ankle_angle_l"}), 1.0 - 1e-12);
  EXPECT_LT(explained("RTHI", {"hip_flexion_l", "hip_adduction_l", "elbow_flex_r", "knee_angle_l"}), 0.9);
}

TEST(SoftTissue, ImpactsShakeAtNineHertz) {
  // What the angles do not explain, in a walk, is the oscillation: half of the field at its start.
  const SubjectOptions still{
      .motion = MotionKind::tai_chi, .duration_s = 4.0, .noise_sd_m = 0.0, .soft_tissue = 1.0};
  SubjectOptions walking = still;
  walking.motion = MotionKind::walk;
  const auto roughness = [](const std::vector<Matrix3Xd>& u) {
    double sum = 0.0;
    for (const auto& x : u)
      sum += (x.rightCols(x.cols() - 2) - 2.0 * x.middleCols(1, x.cols() - 2) + x.leftCols(x.cols() - 2))
                 .squaredNorm() /
             x.squaredNorm();
    return sum;
  };
  EXPECT_GT(roughness(displacements(simulate_subject(human(), walking).value())),
            100.0 * roughness(displacements(simulate_subject(human(), still).value())));
}

TEST(SoftTissue, MarkersOfASegmentShareWhatIsAsked) {
  const std::pair<const char*, const char*> pairs[] = {{"RTHI", "RTHAP"}, {"LTHI", "LTHAP"},
                                                       {"RASI", "LPSI"},  {"RTIB", "RANK"},
                                                       {"C7", "RSHO"},    {"LUPA", "LELB"}};
  const internal::Segments segments(human());
  for (const double common : {0.0, 0.3, 0.6, 1.0}) {
    double sum = 0.0;
    int count = 0;
    for (std::uint64_t seed = 1; seed <= 25; ++seed) {
      MatrixXd q(human().coordinate_count(), 200);
      Random random(seed, 0);
      for (auto& angle : q.reshaped()) angle = random.gaussian();
      const auto u = internal::tissue_displacements(segments, q, 2.0,
                                                    {.duration_s = 10.0,
                                                     .rate_hz = 20.0,
                                                     .seed = seed,
                                                     .soft_tissue = 1.0,
                                                     .soft_tissue_common = common});
      for (const auto& [a, b] : pairs) {
        const auto &x = u[static_cast<std::size_t>(marker(a))], &y = u[static_cast<std::size_t>(marker(b))];
        sum += x.cwiseProduct(y).sum() / std::sqrt(x.squaredNorm() * y.squaredNorm());
        ++count;
      }
    }
    EXPECT_NEAR(sum / count, common, 0.06) << common;
  }
}

}  // namespace
}  // namespace kinemark::simulation
