// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/taichi/landmarks.h"

#include <fmt/core.h>

#include <cmath>
#include <cstdint>

#include "kinemark/core/text.h"
#include "kinemark/math/scalar_function.h"
#include "kinemark/math/statistics.h"

namespace kinemark::studies {
namespace {

using data::Trajectories;
using Eigen::Vector3d;

constexpr double kMostFrames = 1e6;  // 4.6 hours at 60 Hz, half a gigabyte of landmarks

/// Mean of one landmark over its samples.
Vector3d mean_position(const Trajectories& markers, std::int64_t m) {
  Vector3d sum = Vector3d::Zero();
  double count = 0.0;
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    if (markers.present(f, m)) {
      sum += markers.x(f, m);
      count += 1.0;
    }
  return sum / count;
}

/// True: z points up; false: y does.
Result<bool> z_is_up(const Trajectories& markers) {
  const auto at = [&](std::string_view name) { return mean_position(markers, markers.find(name)); };
  const Vector3d up = 0.5 * (at("FHead") + at("BHead")) - 0.5 * (at("LAnkle") + at("RAnkle"));
  if (!up.allFinite()) return fail(Code::bad_input, "head or ankles are never seen");
  if (up.z() > 0.8 * up.norm()) return true;
  if (up.y() > 0.8 * up.norm()) return false;
  return fail(Code::bad_input,
              fmt::format("the head lies ({:.2f}, {:.2f}, {:.2f}) m from the ankles on average; expected it "
                          "above them along y or z",
                          up.x(), up.y(), up.z()));
}

/// Samples without a gap, as functions of time.
struct Run {
  std::vector<double> time_s;
  std::array<std::vector<double>, 3> x;
};

Status resample(const Run& run, Trajectories& out, std::int64_t m) {
  if (run.time_s.size() < 2) return {};
  std::array<math::ScalarFunction, 3> path;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    auto spline = math::ScalarFunction::natural_spline(run.time_s, run.x[axis]);
    if (!spline) return std::unexpected(spline.error());
    path[axis] = std::move(*spline);
  }
  for (std::int64_t f = 0; f < out.frames(); ++f) {
    const double t = out.time.time_s(f);
    if (t < run.time_s.front() || t > run.time_s.back()) continue;
    for (std::size_t axis = 0; axis < 3; ++axis)
      out.x(f, m)[static_cast<Eigen::Index>(axis)] = path[axis](t).f;
    out.state[out.index(f, m)] = data::SampleState::interpolated;
    out.set_method(f, m, "cubic spline through the frames");
  }
  return {};
}

}  // namespace

std::vector<LandmarkAttachment> landmark_attachments() {
  std::vector<LandmarkAttachment> attachments;
  for (const auto name : kTaiChiLandmarks) {
    const std::string landmark(name);
    const std::string side = landmark[0] == 'R' ? "_r" : "_l";
    const std::string part = landmark.substr(1);
    if (landmark == "FHead" || landmark == "BHead")
      attachments.push_back({landmark, "head", ""});
    else if (landmark == "Neck")
      attachments.push_back({landmark, "thorax", "neck"});
    else if (landmark == "Thorax")
      attachments.push_back({landmark, "thorax", ""});
    else if (landmark == "Pelvis")
      attachments.push_back({landmark, "pelvis", ""});
    else if (part == "Shoulder")
      attachments.push_back({landmark, "clavicle" + side, "acromial" + side});
    else if (part == "Elbow")
      attachments.push_back({landmark, "humerus" + side, "elbow" + side});
    else if (part == "Wrist")
      attachments.push_back({landmark, "radius" + side, "radius_hand" + side});
    else if (part == "Hand")
      attachments.push_back({landmark, "hand" + side, ""});
    else if (part == "Hip")
      attachments.push_back({landmark, "pelvis", "hip" + side});
    else if (part == "Knee")
      attachments.push_back({landmark, "femur" + side, "knee" + side});
    else if (part == "Ankle")
      attachments.push_back({landmark, "tibia" + side, "ankle" + side});
    else
      attachments.push_back({landmark, "calcn" + side, ""});
  }
  return attachments;
}

Result<Trajectories> prepare_landmarks(const Trajectories& recorded, double rate_hz) {
  std::vector<std::string> absent;
  for (const auto name : kTaiChiLandmarks)
    if (recorded.find(name) < 0) absent.emplace_back(name);
  if (!absent.empty())
    return fail(Code::bad_input,
                fmt::format("the recording lacks {}; the 21 landmarks of the tai chi recording were expected",
                            join(absent)));
  if (recorded.frames() < 2) return fail(Code::bad_input, "the recording holds fewer than two frames");
  const auto z_up = z_is_up(recorded);
  if (!z_up) return std::unexpected(z_up.error());

  const double duration_s = static_cast<double>(recorded.frames() - 1) / recorded.time.rate_hz;
  if (!(rate_hz > 0.0 && recorded.time.rate_hz > 0.0 && duration_s * rate_hz + 1.0 <= kMostFrames))
    return fail(
        Code::bad_input,
        fmt::format("{} frames at {} Hz are {} s; at {} Hz these would be {:.3g} frames, and the study "
                    "takes {:.0f} at most",
                    recorded.frames(), recorded.time.rate_hz, duration_s, rate_hz, duration_s * rate_hz + 1.0,
                    kMostFrames));
  const TimeBase time{.rate_hz = rate_hz,
                      .t0_s = recorded.time.t0_s,
                      .frames = static_cast<std::int64_t>(std::floor(duration_s * rate_hz + 1e-9)) + 1};
  auto out = Trajectories::all_missing({kTaiChiLandmarks.begin(), kTaiChiLandmarks.end()}, time);
  for (std::int64_t m = 0; m < out.markers(); ++m) {
    const auto from = recorded.find(out.names[static_cast<std::size_t>(m)]);
    Run run;
    for (std::int64_t f = 0; f <= recorded.frames(); ++f) {
      if (f < recorded.frames() && recorded.present(f, from)) {
        const Vector3d x = recorded.x(f, from);
        run.time_s.push_back(recorded.time.time_s(f));
        run.x[0].push_back(x.x());
        run.x[1].push_back(*z_up ? x.z() : x.y());
        run.x[2].push_back(*z_up ? -x.y() : x.z());
      } else if (!run.time_s.empty()) {
        if (auto status = resample(run, out, m); !status) return std::unexpected(status.error());
        run = {};
      }
    }
  }
  return out;
}

double median_distance(const Trajectories& landmarks, std::string_view a, std::string_view b) {
  const auto i = landmarks.find(a);
  const auto j = landmarks.find(b);
  std::vector<double> distances;
  for (std::int64_t f = 0; f < landmarks.frames(); ++f)
    if (landmarks.present(f, i) && landmarks.present(f, j))
      distances.push_back((landmarks.x(f, i) - landmarks.x(f, j)).norm());
  return math::upper_median(distances);
}

}  // namespace kinemark::studies
