// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/internal/limb_build.h"

#include <fmt/core.h>

#include <algorithm>

#include "kinemark/core/random.h"

namespace kinemark::simulation::internal {

Status in_range(const char* name, double value, double low, double high) {
  if (value >= low && value <= high) return {};  // false for NaN
  return fail(Code::usage, fmt::format("{} is {}; expected {} to {}", name, value, low, high));
}

LimbRecording empty_limb(const std::vector<std::string>& segments, const std::vector<std::string>& joints,
                         const std::vector<std::string>& prefixes, int markers_per_segment,
                         const TimeBase& time, const std::vector<std::string>& on_last) {
  LimbRecording out;
  std::vector<std::string> names;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    data::SegmentLayout::Segment segment{segments[s], {}};
    for (int k = 0; k < markers_per_segment; ++k) {
      segment.markers.push_back(static_cast<int>(names.size()));
      names.push_back(fmt::format("{}{}", prefixes[s], k));
    }
    for (std::size_t k = 0; s + 1 == segments.size() && k < on_last.size(); ++k) {
      segment.markers.push_back(static_cast<int>(names.size()));
      names.push_back(on_last[k]);
    }
    out.x_in_segment.emplace_back(Eigen::Matrix3Xd::Zero(3, std::ssize(segment.markers)));
    out.layout.segments.push_back(std::move(segment));
  }
  for (std::size_t j = 0; j < joints.size(); ++j)
    out.layout.joints.push_back({joints[j], static_cast<int>(j), static_cast<int>(j) + 1});
  out.markers = data::Trajectories::all_missing(std::move(names), time);
  const auto frames = static_cast<std::size_t>(time.frames);
  out.x_true.resize(out.markers.x_in_world.size());
  out.centre_in_world.resize(frames * joints.size() * 3);
  out.end_in_world.resize(frames * 3);
  return out;
}

void record_limb(LimbRecording& limb, double noise_sd_m, double missing, std::uint64_t seed,
                 std::span<const double> weight) {
  Random noise(seed, static_cast<std::uint64_t>(LimbStream::noise));
  Random loss(seed, static_cast<std::uint64_t>(LimbStream::loss));
  constexpr double kMost = 0.98;  // of a frame's samples, so that some remain in the worst frames
  const std::size_t markers = limb.markers.names.size();
  auto& x = limb.markers.x_in_world;
  for (std::size_t i = 0; i < limb.markers.state.size(); ++i) {
    const double share = weight.empty() ? missing : std::min(kMost, missing * weight[i / markers]);
    const bool lost = loss.uniform() < share;
    limb.markers.state[i] = lost ? data::SampleState::missing : data::SampleState::measured;
    if (lost) continue;
    noise.seek(6 * i);  // two uniforms a Gaussian: the same noise whatever is lost
    for (std::size_t a = 3 * i; a < 3 * i + 3; ++a) x[a] = limb.x_true[a] + noise_sd_m * noise.gaussian();
  }
}

}  // namespace kinemark::simulation::internal
