// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Shapes whose measures are known in closed form, without noise: planes, circles, ellipses, boxes, curvature
// and torsion of helices, helical axes. Arguments: shapes of each kind (default 200), first seed (default 1).
#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <string>

#include "kinemark/core/random.h"
#include "kinemark/stages/analysis/path/path_samples.h"
#include "kinemark/stages/analysis/path/shape.h"
#include "kinemark/stages/analysis/segments/rotation_angles.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using analysis::SeriesMatrix;

constexpr double kBound = 1e-9;
constexpr double kTurn = 2.0 * std::numbers::pi;

// Where a shape lies in the laboratory.
struct Pose {
  explicit Pose(Random& random) {
    const Eigen::Vector4d q(random.gaussian(), random.gaussian(), random.gaussian(), random.gaussian());
    rotation = Eigen::Quaterniond(q.normalized()).toRotationMatrix();
    place = Eigen::Vector3d(random.gaussian(), random.gaussian(), random.gaussian());
  }
  SeriesMatrix of(std::int64_t n, const std::function<Eigen::Vector3d(std::int64_t)>& own) const {
    SeriesMatrix out(n, 3);
    for (std::int64_t i = 0; i < n; ++i) out.row(i) = (place + rotation * own(i)).transpose();
    return out;
  }
  Eigen::Matrix3d rotation;
  Eigen::Vector3d place;
};

double relative(double found, double truth) { return std::abs(found / truth - 1.0); }

// Each returns its largest error: over the truth of sizes, in metres of what is 0, in radians of directions.
double plane(Random& random) {
  const Pose pose(random);
  const auto flat = pose.of(100, [&](std::int64_t) {
    return Eigen::Vector3d(random.uniform(-0.3, 0.3), random.uniform(-0.1, 0.1), 0.0);
  });
  const auto axes = analysis::principal_axes(flat);
  const Eigen::Vector3d normal = axes.axes.col(2);
  const double slope = normal.cross(pose.rotation.col(2)).norm();
  // Coordinates +-a, +-b, +-c, each sign with each: deviations a, b, c.
  const Eigen::Vector3d half(random.uniform(0.2, 0.3), random.uniform(0.05, 0.15),
                             random.uniform(0.001, 0.02));
  const auto thick = pose.of(8, [&](std::int64_t k) {
    return Eigen::Vector3d(k & 1 ? half[0] : -half[0], k & 2 ? half[1] : -half[1],
                           k & 4 ? half[2] : -half[2]);
  });
  const Eigen::Vector3d variance = analysis::principal_axes(thick).variance;
  return std::max({std::sqrt(axes.variance[2]), slope, relative(std::sqrt(variance[2]), half[2]),
                   relative(std::sqrt(variance[0] / variance[1]), half[0] / half[1])});
}

double circle(Random& random) {
  const Pose pose(random);
  const double radius = random.uniform(0.02, 0.5), share = random.uniform(0.2, 3.0);
  const auto x = pose.of(200, [&](std::int64_t i) {
    const double angle = kTurn * share * static_cast<double>(i) / 199.0;
    return Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), 0.0);
  });
  return relative(analysis::circle_diameter(analysis::along_axes(x, analysis::principal_axes(x))),
                  2.0 * radius);
}

double ellipse(Random& random) {
  const Pose pose(random);
  const double a = random.uniform(0.1, 0.4), b = a * random.uniform(0.1, 0.9),
               share = random.uniform(0.6, 3.0);
  const auto x = pose.of(200, [&](std::int64_t i) {
    const double angle = kTurn * share * static_cast<double>(i) / 199.0;
    return Eigen::Vector3d(a * std::cos(angle), b * std::sin(angle), 0.0);
  });
  const auto found = analysis::ellipse_axes(analysis::along_axes(x, analysis::principal_axes(x)));
  return std::max(relative(found.major, 2.0 * a), relative(found.minor, 2.0 * b));
}

// All corners of a box, and samples inside.
double box(Random& random) {
  const Pose pose(random);
  Eigen::Vector3d side(random.uniform(0.3, 0.5), random.uniform(0.15, 0.29), random.uniform(0.02, 0.14));
  const auto x = pose.of(60, [&](std::int64_t k) -> Eigen::Vector3d {
    if (k < 8) return {k & 1 ? side[0] : 0.0, k & 2 ? side[1] : 0.0, k & 4 ? side[2] : 0.0};
    return {side[0] * random.uniform(), side[1] * random.uniform(), side[2] * random.uniform()};
  });
  return (analysis::smallest_box(x, analysis::principal_axes(x)) - side)
      .cwiseQuotient(side)
      .cwiseAbs()
      .maxCoeff();
}

// A helix of radius r whose pitch over a turn is 2 pi c, 200 samples a turn: curvature r / (r^2 + c^2),
// torsion c / (r^2 + c^2).
analysis::PathSamples helix(const Pose& pose, double r, double c) {
  constexpr std::int64_t kSamples = 600;
  const double step = kTurn / 200.0, rate = 100.0;
  const auto x = pose.of(kSamples, [&](std::int64_t i) {
    const double angle = step * static_cast<double>(i);
    return Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), c * angle);
  });
  constexpr auto kMargin = analysis::kDerivativeMargin;
  return analysis::differentiate(x, kMargin, kSamples - 2 * kMargin, rate);
}
double curvature(Random& random) {
  const Pose pose(random);
  const double r = random.uniform(0.05, 0.4), c = r * random.uniform(0.1, 1.0);
  return relative(analysis::median_curvature(analysis::curvature_terms_of(helix(pose, r, c))),
                  r / (r * r + c * c));
}
double torsion(Random& random) {
  const Pose pose(random);
  const double r = random.uniform(0.05, 0.4), c = r * random.uniform(0.1, 1.0);
  return relative(analysis::median_torsion(analysis::curvature_terms_of(helix(pose, r, c))),
                  c / (r * r + c * c));
}

// A turn about a line and a slide along it, between two poses of a segment.
double helical_axis(Random& random) {
  const Pose axis(random), pose(random);
  const Eigen::Vector3d direction = axis.rotation.col(0);
  const double angle = random.uniform(0.02, 3.1), slide = random.uniform(-0.2, 0.2);
  const math::SE3 screw{
      .rotation = Eigen::AngleAxisd(angle, direction).toRotationMatrix(),
      .translation = axis.place - Eigen::AngleAxisd(angle, direction) * axis.place + slide * direction};
  const math::SE3 first{.rotation = pose.rotation, .translation = pose.place};
  const math::SE3 second = screw * first;
  const auto found = analysis::helical_axis(second * first.inverse());
  const Eigen::Vector3d across = found.point - axis.place;
  return std::max({std::abs(found.angle_rad - angle), std::abs(found.translation_m - slide),
                   (found.direction - direction).norm(), across.cross(direction).norm()});
}

struct Kind {
  const char* name;
  double (*error)(Random& random);
};
constexpr std::array kKinds{Kind{"planes", plane},
                            Kind{"circles", circle},
                            Kind{"ellipses", ellipse},
                            Kind{"boxes", box},
                            Kind{"curvature", curvature},
                            Kind{"torsion of helices", torsion},
                            Kind{"helical axes", helical_axis}};

int run(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 200;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  for (std::size_t k = 0; k < kKinds.size(); ++k) {
    double worst = 0.0;
    int beyond = 0;
    for (int i = 0; i < count; ++i) {
      Random random(seed + static_cast<std::uint64_t>(i), k);
      const double error = kKinds[k].error(random);
      worst = std::isnan(error) ? INFINITY : std::max(worst, error);
      beyond += !(error <= kBound);
    }
    testing_support::print_row(beyond == 0, fmt::format("closed_forms: {}", kKinds[k].name),
                               fmt::format("{:g}", kBound),
                               fmt::format("{:.1e} at most, {} of {} beyond", worst, beyond, count));
  }
  return testing_support::exit_status();
}

const testing_support::AcceptanceCheck kCheck("closed_forms", run);

}  // namespace
