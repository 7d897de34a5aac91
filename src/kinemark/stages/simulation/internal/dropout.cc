// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/internal/dropout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "kinemark/core/index.h"
#include "kinemark/core/parallel.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/workspace.h"
#include "kinemark/stages/simulation/internal/streams.h"

namespace kinemark::simulation::internal {
namespace {

using Eigen::Vector3d;

constexpr double kShortGap_s = 0.06, kLongGap_s = 0.5, kShortShare = 0.7;
constexpr std::size_t kCameras = 8;
constexpr double kRing_m = 4.0;
constexpr double kGraze_m = 0.05;  // a line of sight this far from a limb is free
constexpr std::int64_t kGrain = 32;

std::int64_t wanted(double share, std::int64_t samples) {
  return std::llround(share * static_cast<double>(samples));
}

// Nearest distance between the segments from a to b and from c to d.
double distance_of_lines(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
  const Vector3d u = b - a, v = d - c, r = a - c;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), ur = u.dot(r), vr = v.dot(r);
  const double det = uu * vv - uv * uv;
  double s = det > 1e-12 * uu * vv ? std::clamp((uv * vr - vv * ur) / det, 0.0, 1.0) : 0.0;
  const double t = vv > 1e-12 ? std::clamp((uv * s + vr) / vv, 0.0, 1.0) : 0.0;
  s = uu > 1e-12 ? std::clamp((uv * t - ur) / uu, 0.0, 1.0) : 0.0;
  return (r + s * u - t * v).norm();
}

std::array<Vector3d, kCameras> camera_ring(const model::Model& model, const Eigen::MatrixXd& states,
                                           const SubjectOptions& options) {
  const Vector3d up =
      model.gravity().norm() > 0.0 ? Vector3d(-model.gravity().normalized()) : Vector3d(Vector3d::UnitY());
  // Around the mean position of the markers over some frames; the floor is the lowest marker.
  model::Workspace w(model);
  Vector3d centre = Vector3d::Zero();
  double floor = INFINITY;
  const auto every = std::max<Eigen::Index>(1, states.cols() / 50);
  int used = 0;
  for (Eigen::Index f = 0; f < states.cols(); f += every, ++used) {
    model::kinematics(model, w, states.col(f));
    centre += w.marker.rowwise().mean();
    floor = std::min(floor, (up.transpose() * w.marker).minCoeff());
  }
  centre /= used;
  centre += (floor - up.dot(centre)) * up;

  Random random = stream(options.seed, Draw::cameras);
  const double start = random.uniform(0.0, 2.0 * std::numbers::pi);
  const Vector3d east = up.unitOrthogonal(), north = up.cross(east);
  std::array<Vector3d, kCameras> cameras;
  for (std::size_t k = 0; k < kCameras; ++k) {
    const double angle = start + 2.0 * std::numbers::pi * static_cast<double>(k) / kCameras;
    cameras[k] =
        centre + kRing_m * (std::cos(angle) * east + std::sin(angle) * north) + (k % 2 == 0 ? 1.0 : 2.5) * up;
  }
  return cameras;
}

struct Capsule {
  Vector3d from, to;
};

// How well the second best camera sees a marker: 1 straight on, 0 at the rim or grazing a limb, negative when
// hidden.
double second_best(const Vector3d& marker, const Vector3d& outward, int own_segment,
                   const std::vector<Capsule>& capsules, const Segments& segments,
                   const std::array<Vector3d, kCameras>& cameras) {
  double best = -INFINITY, second = -INFINITY;
  for (const Vector3d& camera : cameras) {
    double seen = outward.dot((camera - marker).normalized());
    for (std::size_t s = 0; s < capsules.size() && seen > second; ++s) {
      if (static_cast<int>(s) == own_segment)
        continue;  // the facing angle covers the segment under the marker
      const double free =
          distance_of_lines(marker, camera, capsules[s].from, capsules[s].to) - segments.all[s].radius_m;
      seen = std::min(seen, free / kGraze_m);
    }
    if (seen > best) {
      second = best;
      best = seen;
    } else {
      second = std::max(second, seen);
    }
  }
  return std::max(second, -1.0);
}

}  // namespace

double mean_gap_frames(double rate_hz) {
  // One frame, and one more for each k >= 1 that a gap is longer than k + 0.5 frames.
  const auto more = [rate_hz](double mean_s) {
    const double mean = mean_s * rate_hz;
    return std::exp(-1.5 / mean) / (1.0 - std::exp(-1.0 / mean));
  };
  return 1.0 + kShortShare * more(kShortGap_s) + (1.0 - kShortShare) * more(kLongGap_s);
}

std::int64_t draw_gap_frames(Random& random, double rate_hz) {
  const double mean_s = random.uniform() < kShortShare ? kShortGap_s : kLongGap_s;
  const double length_s = -mean_s * std::log(1.0 - random.uniform());
  return std::max<std::int64_t>(1, std::llround(length_s * rate_hz));
}

Lost random_gaps(std::int64_t frames, std::int64_t markers, const SubjectOptions& options) {
  Lost lost(static_cast<std::size_t>(frames * markers), 0);
  Random random = stream(options.seed, Draw::gaps);
  std::int64_t left = wanted(options.dropout_random, frames * markers);
  while (left > 0) {
    const auto marker = static_cast<std::int64_t>(random.uniform(0.0, static_cast<double>(markers)));
    const auto start = static_cast<std::int64_t>(random.uniform(0.0, static_cast<double>(frames)));
    const auto length = draw_gap_frames(random, options.rate_hz);
    for (std::int64_t f = start; f < std::min(frames, start + length) && left > 0; ++f) {
      auto& flag = lost[static_cast<std::size_t>(f * markers + marker)];
      if (flag == 0) --left;
      flag = 1;
    }
  }
  return lost;
}

Lost lines_of_sight(const model::Model& model, const Segments& segments, const Eigen::MatrixXd& states,
                    const SubjectOptions& options) {
  const std::int64_t frames = states.cols(), markers = model.marker_count();
  const auto samples = static_cast<std::size_t>(frames * markers);
  Lost lost(samples, 0);
  const std::int64_t count = wanted(options.dropout_sight, frames * markers);
  if (count == 0) return lost;

  const auto cameras = camera_ring(model, states, options);
  std::vector<Vector3d>
      outward;  // in the segment; zero for markers on the ground, which every camera sees alike
  for (std::size_t m = 0; m < segments.of_marker.size(); ++m) {
    Vector3d out = Vector3d::Zero();
    if (const int s = segments.of_marker[m]; s >= 0) {
      const Segment& segment = segments.all[at(s)];
      out = segments.marker_in_segment[m] -
            nearest_on_line(segment.line_from, segment.line_to, segments.marker_in_segment[m]);
      if (out.norm() > 1e-9) out.normalize();
    }
    outward.push_back(out);
  }

  std::vector<double> score(samples);
  parallel_for(frames, kGrain, options.threads, [&](std::int64_t begin, std::int64_t end) {
    model::Workspace w(model);
    std::vector<Capsule> capsules(segments.all.size());
    for (std::int64_t f = begin; f < end; ++f) {
      model::kinematics(model, w, states.col(f));
      for (std::size_t s = 0; s < capsules.size(); ++s) {
        const int body = segments.all[s].body;
        capsules[s] = {model::point_in_world(w, body, segments.all[s].line_from),
                       model::point_in_world(w, body, segments.all[s].line_to)};
      }
      for (std::int64_t m = 0; m < markers; ++m) {
        const auto i = static_cast<std::size_t>(m);
        const int own = segments.of_marker[i];
        const Vector3d facing =
            own < 0 ? outward[i] : Vector3d(w.rotation[at(segments.all[at(own)].body)] * outward[i]);
        score[static_cast<std::size_t>(f * markers + m)] =
            second_best(w.marker.col(m), facing, own, capsules, segments, cameras);
      }
    }
  });
  for (std::int64_t m = 0; m < markers; ++m) {
    double mean = 0.0;
    for (std::int64_t f = 0; f < frames; ++f)
      mean += score[static_cast<std::size_t>(f * markers + m)] / static_cast<double>(frames);
    for (std::int64_t f = 0; f < frames; ++f) score[static_cast<std::size_t>(f * markers + m)] -= mean;
  }

  // The worst `count`, ties by index, so that the choice is unique.
  std::vector<std::size_t> order(samples);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto worse = [&](std::size_t a, std::size_t b) {
    return score[a] != score[b] ? score[a] < score[b] : a < b;
  };
  std::nth_element(order.begin(), order.begin() + (count - 1), order.end(), worse);
  for (std::int64_t i = 0; i < count; ++i) lost[order[static_cast<std::size_t>(i)]] = 1;
  return lost;
}

}  // namespace kinemark::simulation::internal
