// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/joints/internal/joints_parts.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/core/text.h"

namespace kinemark::workflow {
namespace {

constexpr std::size_t kSegmentsNamed = 8;

std::size_t markers_placed(const data::Skeleton& skeleton) {
  std::size_t n = 0;
  for (const auto& segment : skeleton.segments) n += segment.markers.size();
  return n;
}

/// One joint's centres, states and covariances.
void copy_centres(const data::Skeleton& from, std::size_t joint, data::Skeleton& to, std::size_t to_joint) {
  for (std::int64_t f = 0; f < from.frames(); ++f) {
    const std::size_t i = from.index(f, static_cast<std::int64_t>(joint)),
                      k = to.index(f, static_cast<std::int64_t>(to_joint));
    to.state[k] = from.state[i];
    std::copy_n(from.centre_in_world.data() + 3 * i, 3, to.centre_in_world.data() + 3 * k);
    std::copy_n(from.covariance.data() + 6 * i, 6, to.covariance.data() + 6 * k);
  }
}

}  // namespace

std::string names_of(const data::SegmentLayout& layout) {
  std::vector<std::string> names;
  for (const auto& segment : layout.segments) names.push_back("'" + segment.name + "'");
  return fmt::format("segment{} {}", names.size() == 1 ? "" : "s", join_names(names, kSegmentsNamed));
}

void append(const data::SegmentLayout& layout, data::SegmentLayout& to) {
  const int first = static_cast<int>(to.segments.size());
  to.segments.insert(to.segments.end(), layout.segments.begin(), layout.segments.end());
  for (const auto& joint : layout.joints)
    to.joints.push_back({joint.name, first + joint.parent, first + joint.child});
}

data::Skeleton join_skeletons(std::vector<data::Skeleton> parts) {
  check(!parts.empty(), "one skeleton at least");
  if (parts.size() == 1) return std::move(parts.front());
  data::Skeleton out;
  out.markers = parts.front().markers;
  out.time = parts.front().time;
  double squares = 0.0, markers = 0.0;
  for (const auto& part : parts) {
    const int segment = static_cast<int>(out.segments.size()), joint = static_cast<int>(out.joints.size());
    out.segments.insert(out.segments.end(), part.segments.begin(), part.segments.end());
    for (auto one : part.joints) {
      one.parent_segment += segment;
      one.child_segment += segment;
      out.joints.push_back(std::move(one));
    }
    for (auto length : part.lengths) {
      length.joint_a += joint;
      length.joint_b += joint;
      out.lengths.push_back(std::move(length));
    }
    out.warnings.insert(out.warnings.end(), part.warnings.begin(), part.warnings.end());
    const auto n = static_cast<double>(markers_placed(part));
    squares += n * part.noise_sd_m * part.noise_sd_m;
    markers += n;
  }
  out.noise_sd_m = std::sqrt(squares / std::max(markers, 1.0));
  out.allocate_centres();
  std::size_t to = 0;
  for (const auto& part : parts)
    for (std::size_t j = 0; j < part.joints.size(); ++j, ++to) copy_centres(part, j, out, to);
  return out;
}

}  // namespace kinemark::workflow
