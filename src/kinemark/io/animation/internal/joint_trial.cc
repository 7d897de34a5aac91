// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/animation/internal/joint_trial.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "kinemark/core/distinct_names.h"
#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/units.h"

namespace kinemark::io::animation {
namespace {

constexpr double kPerson_m = 1.7;
constexpr double kLeastPerson_m = 0.3, kMostPerson_m = 3.0;
constexpr std::size_t kPointsAlways = 1'000'000;

/// Places the joints of one frame after another.
class Placer {
 public:
  explicit Placer(const JointTree& tree)
      : tree_(tree), x_(tree.joints.size()), rotation_(tree.joints.size()), values_(tree.channel_count()) {}

  /// Of one frame in degrees; a joint with a number missing in it or above it is NaN.
  std::span<const Eigen::Vector3d> place(std::span<const double> values) {
    std::size_t c = 0;
    for (const auto& joint : tree_.joints)
      for (const auto& channel : joint.channels) {
        values_[c] = channel.is_rotation ? values[c] * kRadPerDeg : values[c];
        ++c;
      }
    place_joints(tree_, values_, x_, rotation_);
    return x_;
  }

 private:
  const JointTree& tree_;
  std::vector<Eigen::Vector3d> x_;
  std::vector<Eigen::Matrix3d> rotation_;
  std::vector<double> values_;
};

std::span<const double> frame_of(const JointValues& values, std::size_t channels, std::int64_t frame) {
  return {values.values.data() + at(frame) * channels, channels};
}

/// What of a joint becomes a channel: its rotations, or where it stands when nothing else shows that.
struct JointColumns {
  std::string name;  ///< "Hips_angles_ZXY"
  data::ChannelKind kind = data::ChannelKind::angle;
  std::vector<std::size_t> columns;  ///< of a frame's numbers
};

std::vector<JointColumns> channel_columns(const JointTree& tree) {
  std::vector<JointColumns> out;
  std::size_t c = 0;
  for (const auto& joint : tree.joints) {
    const bool turns = std::ranges::any_of(joint.channels, &JointChannel::is_rotation);
    JointColumns found{.name = joint.name + (turns ? "_angles_" : "_position_"),
                       .kind = turns ? data::ChannelKind::angle : data::ChannelKind::other,
                       .columns = {}};
    for (const auto& channel : joint.channels) {
      if (channel.is_rotation == turns) {
        found.name += "XYZ"[channel.axis];
        found.columns.push_back(c);
      }
      ++c;
    }
    const bool shows = turns || !joint.is_point;
    if (shows && !found.columns.empty()) out.push_back(std::move(found));
  }
  return out;
}

data::Channels channels_of(const JointTree& tree, const JointValues& values, double rate_hz) {
  data::Channels out;
  const auto columns = channel_columns(tree);
  if (columns.empty()) return out;
  for (const auto& joint : columns) {
    out.names.push_back(joint.name);
    out.kinds.push_back(joint.kind);
    out.units.emplace_back(joint.kind == data::ChannelKind::angle ? "deg" : "");
  }
  make_distinct(out.names);
  out.rate_hz = rate_hz;
  out.frames = values.frames;
  out.values.reserve(3 * columns.size() * at(values.frames));
  const std::size_t width = tree.channel_count();
  for (std::int64_t f = 0; f < values.frames; ++f) {
    const auto row = frame_of(values, width, f);
    for (const auto& joint : columns)
      for (std::size_t k = 0; k < 3; ++k)
        out.values.push_back(k < joint.columns.size() ? row[joint.columns[k]] : kNaN);
  }
  return out;
}

}  // namespace

UnitChoice choose_unit(std::string_view why, const std::vector<FileUnit>& units, double extent) {
  const auto off = [&](const FileUnit& unit) { return std::abs(std::log(extent * unit.metres / kPerson_m)); };
  FileUnit unit = extent > 0.0 ? *std::ranges::min_element(units, {}, off) : units.front();
  const double size_m = extent * unit.metres;
  std::string warning =
      fmt::format("{}; {} is taken, which makes the skeleton {:.3g} m large", why, unit.name, size_m);
  if (!(size_m >= kLeastPerson_m && size_m <= kMostPerson_m))
    warning += fmt::format(": no person, for which {} to {} m were expected", kLeastPerson_m, kMostPerson_m);
  return {std::move(unit), std::move(warning)};
}

double extent_of(const JointTree& tree, const JointValues& values) {
  const std::size_t channels = tree.channel_count();
  Placer placer(tree);
  for (std::int64_t f = 0; f < values.frames; ++f) {
    const auto row = frame_of(values, channels, f);
    if (!std::ranges::all_of(row, [](double v) { return std::isfinite(v); })) continue;
    Eigen::AlignedBox3d box;
    const auto x = placer.place(row);
    for (std::size_t j = 0; j < x.size(); ++j)
      if (tree.joints[j].is_point) box.extend(x[j]);
    const double extent = box.isEmpty() ? 0.0 : box.sizes().maxCoeff();
    return std::isfinite(extent) ? extent : 0.0;
  }
  return 0.0;
}

Status check_points(const JointTree& tree, std::int64_t frames, std::size_t bytes) {
  const auto points = at(std::ranges::count_if(tree.joints, &JointNode::is_point));
  if (points == 0 || at(frames) <= (bytes + kPointsAlways) / points) return {};
  return fail(Code::bad_input, fmt::format("{} frames of {} joints do not fit into the {} bytes of this file",
                                           frames, points, bytes));
}

data::Trial trial_of(JointTree tree, const JointValues& values, double rate_hz, double metres_per_unit) {
  const std::size_t channels = tree.channel_count();
  data::Trial trial;
  std::vector<std::size_t> points;
  for (std::size_t j = 0; j < tree.joints.size(); ++j)
    if (tree.joints[j].is_point) points.push_back(j);
  std::vector<std::string> names;
  for (const auto j : points) names.push_back(tree.joints[j].name);
  if (const auto repeated = make_distinct(names); repeated.changed > 0)
    trial.warnings.push_back(fmt::format("{} joints share a name with another ('{}'); each got a number",
                                         repeated.changed, repeated.example));
  trial.markers =
      data::Trajectories::all_missing(std::move(names), {.rate_hz = rate_hz, .frames = values.frames});
  trial.channels = channels_of(tree, values, rate_hz);
  Placer placer(tree);
  for (std::int64_t f = 0; f < values.frames; ++f) {
    const auto x = placer.place(frame_of(values, channels, f));
    for (std::size_t p = 0; p < points.size(); ++p) {
      const Eigen::Vector3d x_m = x[points[p]] * metres_per_unit;
      if (!x_m.allFinite()) continue;
      trial.markers.x(f, static_cast<std::int64_t>(p)) = x_m;
      trial.markers.state[trial.markers.index(f, static_cast<std::int64_t>(p))] = data::SampleState::measured;
    }
  }
  return trial;
}

}  // namespace kinemark::io::animation
