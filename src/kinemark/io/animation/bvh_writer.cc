// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <ranges>
#include <utility>

#include "kinemark/core/distinct_names.h"
#include "kinemark/core/index.h"
#include "kinemark/core/units.h"
#include "kinemark/io/animation/bvh.h"
#include "kinemark/io/file.h"
#include "kinemark/math/euler.h"

namespace kinemark::io {
namespace {

constexpr double kUnitsPerMetre = 100.0;  // centimetres, as most programs have it
constexpr double kMoves_m = 1e-7;
constexpr std::size_t kBlock = 1UL << 20;

/// A BVH file has one root in the eyes of most readers: bodies that hang from the laboratory get one.
PoseTree with_one_root(const PoseTree& poses) {
  if (std::ranges::count(poses.bodies, -1, &PoseTree::Body::parent) == 1) return poses;
  PoseTree out{.bodies = {{.name = "laboratory"}}, .time = poses.time, .world_from_body = {}};
  for (auto body : poses.bodies) {
    ++body.parent;
    out.bodies.push_back(std::move(body));
  }
  const std::size_t n = poses.bodies.size();
  for (std::size_t f = 0; f < at(poses.time.frames); ++f) {
    out.world_from_body.emplace_back();
    const auto row = poses.world_from_body.begin() + static_cast<std::ptrdiff_t>(f * n);
    out.world_from_body.insert(out.world_from_body.end(), row, row + static_cast<std::ptrdiff_t>(n));
  }
  return out;
}

/// Names of joints end at a blank for many readers, and at a brace for all.
std::vector<std::string> joint_names(const PoseTree& poses) {
  std::vector<std::string> names;
  for (const auto& body : poses.bodies) {
    names.push_back(body.name);
    for (char& c : names.back())
      if (static_cast<unsigned char>(c) <= ' ' || c == '{' || c == '}') c = '_';
  }
  make_distinct(names);
  return names;
}

class BvhText {
 public:
  explicit BvhText(const PoseTree& poses)
      : poses_(poses),
        names_(joint_names(poses)),
        children_(poses.children()),
        angles_(poses.bodies.size(), Eigen::Vector3d::Zero()) {
    for (std::size_t b = 0; b < poses.bodies.size(); ++b)
      moves_.push_back(poses.bodies[b].parent < 0 || poses.moves_in_parent(b, kMoves_m));
  }

  std::string hierarchy() {
    std::string out = "HIERARCHY\n";
    // Without recursion: a model may be one long chain.
    std::vector<std::pair<std::size_t, bool>> open;  // body, and whether it is to be closed
    open.emplace_back(0, false);
    std::size_t depth = 0;
    while (!open.empty()) {
      const auto [body, closes] = open.back();
      open.pop_back();
      if (closes) {
        --depth;
        out += std::string(2 * depth, ' ') + "}\n";
        continue;
      }
      order_.push_back(body);
      begin_joint(body, std::string(2 * depth, ' '), out);
      ++depth;
      open.emplace_back(body, true);
      for (const auto child : std::views::reverse(children_[body])) open.emplace_back(child, false);
    }
    return out + fmt::format("MOTION\nFrames: {}\nFrame Time: {:.12f}\n", poses_.time.frames,
                             1.0 / poses_.time.rate_hz);
  }

  /// One row. Frames must come in their order, so that angles go on from the ones before.
  void append_row(std::int64_t frame, std::string& out) {
    const Eigen::Matrix3d zxy{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
    auto to = std::back_inserter(out);
    for (const auto body : order_) {
      const math::SE3 pose = poses_.pose_in_parent(frame, body);
      const Eigen::Vector3d x = kUnitsPerMetre * pose.translation;
      if (moves_[body]) fmt::format_to(to, "{:.6f} {:.6f} {:.6f} ", x.x(), x.y(), x.z());
      angles_[body] = math::to_angles_about(zxy, pose.rotation, angles_[body]);
      const Eigen::Vector3d degrees = kDegPerRad * angles_[body];
      fmt::format_to(to, "{:.6f} {:.6f} {:.6f} ", degrees.x(), degrees.y(), degrees.z());
    }
    out.back() = '\n';
  }

 private:
  void begin_joint(std::size_t body, const std::string& pad, std::string& out) const {
    const auto offset = [](const Eigen::Vector3d& x_m) {
      const Eigen::Vector3d x = kUnitsPerMetre * x_m;
      return fmt::format("OFFSET {:.6f} {:.6f} {:.6f}\n", x.x(), x.y(), x.z());
    };
    const bool is_root = poses_.bodies[body].parent < 0;
    out += fmt::format("{}{} {}\n{}{{\n{}  ", pad, is_root ? "ROOT" : "JOINT", names_[body], pad, pad);
    // Where numbers move a joint some readers add them to its offset and others put them in its place.
    out += offset(moves_[body] ? Eigen::Vector3d(Eigen::Vector3d::Zero())
                               : poses_.pose_in_parent(0, body).translation);
    out += fmt::format("{}  CHANNELS {}Zrotation Xrotation Yrotation\n", pad,
                       moves_[body] ? "6 Xposition Yposition Zposition " : "3 ");
    if (children_[body].empty())
      out += fmt::format("{0}  End Site\n{0}  {{\n{0}    {1}{0}  }}\n", pad,
                         offset(poses_.bodies[body].end_in_body));
  }

  const PoseTree& poses_;
  std::vector<std::string> names_;
  std::vector<std::vector<std::size_t>> children_;
  std::vector<bool> moves_;
  std::vector<std::size_t> order_;       ///< of the joints in the file
  std::vector<Eigen::Vector3d> angles_;  ///< of the frame before, rad
};

}  // namespace

Status write_bvh(const std::filesystem::path& path, const PoseTree& poses, bool force) {
  if (auto s = poses.validate(); !s) return fail_at(path.string(), s.error());
  const PoseTree tree = with_one_root(poses);
  auto file = OutputFile::create(path, force);
  if (!file) return std::unexpected(file.error());
  BvhText writer(tree);
  std::string text = writer.hierarchy();
  for (std::int64_t f = 0; f < tree.time.frames; ++f) {
    writer.append_row(f, text);
    if (text.size() < kBlock && f + 1 < tree.time.frames) continue;
    if (auto s = file->write(text); !s) return s;
    text.clear();
  }
  return file->commit();
}

}  // namespace kinemark::io
