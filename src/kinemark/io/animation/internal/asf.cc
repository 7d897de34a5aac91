// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/animation/internal/asf.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/units.h"
#include "kinemark/core/utf8.h"
#include "kinemark/io/animation/internal/words.h"
#include "kinemark/math/euler.h"

namespace kinemark::io::animation {
namespace {

constexpr std::size_t kMostBones = 10'000;

/// One bone as the file has it.
struct Bone {
  std::string name;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  double length = 0.0;
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  std::vector<JointChannel> channels;
  int parent = -1;  ///< index; -1: none yet
  std::int64_t line = 0;
};

class AsfReader {
 public:
  explicit AsfReader(std::string_view text) : lines_(text) {}

  Result<AsfSkeleton> read() {
    bones_.push_back({.name = "root"});
    index_["root"] = 0;
    while (lines_.next(line_)) {
      if (line_.front() == '#') continue;
      const std::string word = in_lower_case(take_word(line_));
      if (word.starts_with(':')) section_ = word;
      if (auto s = take(word); !s) return std::unexpected(s.error());
    }
    if (open_) return wrong("the file ends within begin and end");
    return assemble();
  }

 private:
  [[nodiscard]] std::unexpected<Error> wrong(const std::string& what) const {
    return fail_in_line(std::max<std::int64_t>(lines_.number(), 1), what);
  }

  Status take(const std::string& word) {
    if (section_.empty())
      return wrong(fmt::format("{}; expected a section, as :version, of an ASF file", in_quotes(word)));
    if (section_ == ":units") return take_unit(word);
    if (section_ == ":root") return take_root(word);
    if (section_ == ":bonedata") return take_bone(word);
    if (section_ == ":hierarchy") return take_hierarchy(word);
    return {};
  }

  Status take_unit(const std::string& word) {
    if (word == "length") {
      const auto length = number("the length");
      if (!length) return std::unexpected(length.error());
      if (!(*length > 0.0)) return wrong(fmt::format("the length is {:g}; expected more than 0", *length));
      length_ = *length;
    }
    if (word == "angle") degrees_ = !in_lower_case(take_word(line_)).starts_with("rad");
    return {};
  }

  Status take_root(const std::string& word) {
    Bone& root = bones_.front();
    if (word == "order") return take_channels(root);
    if (word == "axis") root_axes_ = take_word(line_);
    if (word == "position") return take_vector("position", root.direction);
    if (word == "orientation") {
      Eigen::Vector3d angles;
      if (auto s = take_vector("orientation", angles); !s) return s;
      return set_axes(root, angles, root_axes_.empty() ? "XYZ" : root_axes_);
    }
    return {};
  }

  Status take_bone(const std::string& word) {
    if (word == ":bonedata") return {};
    if (word == "begin") {
      if (open_) return wrong("begin within begin and end");
      if (bones_.size() > kMostBones) return wrong(fmt::format("more than {} bones", kMostBones));
      open_ = true;
      bones_.push_back({.line = lines_.number()});
      return {};
    }
    if (!open_) return wrong(fmt::format("{}; expected begin", in_quotes(word)));
    Bone& bone = bones_.back();
    if (word == "end") return end_bone(bone);
    if (word == "name") bone.name = name_of_bytes(take_word(line_));
    if (word == "direction") return take_vector("direction", bone.direction);
    if (word == "length") return take_length(bone);
    if (word == "dof") return take_channels(bone);
    if (word == "axis") {
      Eigen::Vector3d angles;
      if (auto s = take_vector("axis", angles); !s) return s;
      return set_axes(bone, angles, take_word(line_));
    }
    return {};  // id, limits, bodymass, cofmass and what others may add
  }

  Status end_bone(const Bone& bone) {
    open_ = false;
    if (bone.name.empty()) return fail_in_line(bone.line, "this bone has no name");
    if (!index_.emplace(bone.name, static_cast<int>(bones_.size()) - 1).second)
      return wrong(fmt::format("bone {} occurs twice", in_quotes(bone.name)));
    return {};
  }

  Status take_length(Bone& bone) {
    const auto length = number("the length");
    if (!length) return std::unexpected(length.error());
    bone.length = *length;
    return {};
  }

  Status take_channels(Bone& bone) {
    bone.channels.clear();
    for (auto name = in_lower_case(take_word(line_)); !name.empty(); name = in_lower_case(take_word(line_))) {
      if (name == "l")
        return fail(Code::not_supported,
                    fmt::format("line {}: bone {} changes its length (dof l), which is not supported",
                                lines_.number(), in_quotes(bone.name)));
      if (name.size() != 2 || (name[0] != 'r' && name[0] != 't') || name[1] < 'x' || name[1] > 'z')
        return wrong(fmt::format("{}; expected rx, ry, rz, tx, ty or tz", in_quotes(name)));
      bone.channels.push_back({.is_rotation = name[0] == 'r', .axis = name[1] - 'x'});
    }
    const auto rotations = std::ranges::count_if(bone.channels, &JointChannel::is_rotation);
    if (rotations > 3 || std::ssize(bone.channels) - rotations > 3)
      return wrong("more than three rotations or translations");
    return {};
  }

  Status set_axes(Bone& bone, const Eigen::Vector3d& angles, std::string_view order) {
    const std::string axes = in_lower_case(order);
    if (axes.size() != 3 || axes.find_first_not_of("xyz") != std::string::npos)
      return wrong(fmt::format("order of axes {}; expected one like XYZ", in_quotes(order)));
    bone.axes.setIdentity();
    // The first is turned about first, and all about axes that stay.
    for (std::size_t i = 0; i < 3; ++i) {
      const int axis = axes[i] - 'x';
      bone.axes = math::axis_angle(Eigen::Vector3d::Unit(axis),
                                   angles[static_cast<int>(i)] * (degrees_ ? kRadPerDeg : 1.0)) *
                  bone.axes;
    }
    return {};
  }

  Status take_hierarchy(const std::string& word) {
    if (word == ":hierarchy" || word == "begin" || word == "end") return {};
    // The first word of the line again, in its own letters.
    const auto parent = find(word_as_written(word));
    if (!parent) return std::unexpected(parent.error());
    for (auto name = take_word(line_); !name.empty(); name = take_word(line_)) {
      const auto child = find(name);
      if (!child) return std::unexpected(child.error());
      Bone& bone = bones_[at(*child)];
      if (*child == 0 || bone.parent >= 0)
        return wrong(fmt::format("bone {} hangs from a second one", in_quotes(name)));
      bone.parent = *parent;
    }
    return {};
  }

  [[nodiscard]] std::string_view word_as_written(const std::string& word) const {
    return {line_.data() - word.size(), word.size()};
  }

  Result<int> find(std::string_view name) const {
    const auto found = index_.find(name_of_bytes(name));
    if (found == index_.end()) return wrong(fmt::format("there is no bone {}", in_quotes(name)));
    return found->second;
  }

  Result<double> number(std::string_view what) { return take_number(line_, lines_.number(), what); }

  Status take_vector(std::string_view what, Eigen::Vector3d& out) {
    for (int i = 0; i < 3; ++i) {
      const auto value = number(fmt::format("number {} of the {}", i + 1, what));
      if (!value) return std::unexpected(value.error());
      out(i) = *value;
    }
    return {};
  }

  /// Bones in an order in which each follows the one that it hangs from.
  Result<AsfSkeleton> assemble() {
    std::vector<std::vector<std::size_t>> children(bones_.size());
    for (std::size_t b = 1; b < bones_.size(); ++b) {
      if (bones_[b].parent < 0)
        return fail_in_line(bones_[b].line, fmt::format("bone {} hangs from nothing in :hierarchy",
                                                        in_quotes(bones_[b].name)));
      children[at(bones_[b].parent)].push_back(b);
    }
    AsfSkeleton out{.tree = {}, .length = length_};
    const Bone& root = bones_.front();
    if (root.channels.empty()) return fail_in_line(lines_.number(), "there is no :root with its order");
    out.tree.joints.push_back({.name = "root",
                               .offset = root.direction,
                               .axes = root.axes,
                               .channels = root.channels,
                               .about_fixed_axes = true});
    std::vector<std::pair<std::size_t, int>> open;  // a bone, and the joint that it hangs from
    for (const auto child : children[0]) open.emplace_back(child, 0);
    std::size_t placed = 1;
    for (std::size_t next = 0; next < open.size(); ++next, ++placed) {
      const auto [b, parent] = open[next];
      const Bone& bone = bones_[b];
      const Bone& above = bones_[at(bone.parent)];
      const Eigen::Vector3d offset = bone.parent == 0 ? Eigen::Vector3d(Eigen::Vector3d::Zero())
                                                      : Eigen::Vector3d(above.length * above.direction);
      const int joint = static_cast<int>(out.tree.joints.size());
      out.tree.joints.push_back({.name = bone.name,
                                 .parent = parent,
                                 .offset = offset,
                                 .axes = bone.axes,
                                 .channels = bone.channels,
                                 .about_fixed_axes = true,
                                 .is_point = false});
      out.tree.joints.push_back(
          {.name = bone.name + "_end", .parent = joint, .offset = bone.length * bone.direction});
      for (const auto child : children[b]) open.emplace_back(child, joint);
    }
    if (placed != bones_.size())
      return fail_in_line(lines_.number(), "bones hang from one another in a circle");
    return out;
  }

  TextLines lines_;
  std::string_view line_, root_axes_;
  std::string section_;
  std::vector<Bone> bones_;
  std::map<std::string, int> index_;
  double length_ = 1.0;
  bool degrees_ = true, open_ = false;
};

}  // namespace

Result<AsfSkeleton> parse_asf(std::string_view text) { return AsfReader(text).read(); }

}  // namespace kinemark::io::animation
