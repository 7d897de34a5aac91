// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/animation/internal/bvh_hierarchy.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/utf8.h"

namespace kinemark::io::animation {
namespace {

/// "Xposition", "zrotation", in any case.
std::optional<JointChannel> channel_named(std::string_view word) {
  const std::string name = in_lower_case(word);
  if (name.empty() || name.front() < 'x' || name.front() > 'z') return std::nullopt;
  const std::string_view kind = std::string_view(name).substr(1);
  if (kind != "rotation" && kind != "position") return std::nullopt;
  return JointChannel{.is_rotation = kind == "rotation", .axis = name.front() - 'x'};
}

/// Words of the hierarchy one by one, whatever stands on a line with them.
class Hierarchy {
 public:
  explicit Hierarchy(TextLines& lines) : lines_(lines) {}

  Result<JointTree> parse() {
    if (in_lower_case(word()) != "hierarchy")
      return fail_in_line(std::max<std::int64_t>(lines_.number(), 1),
                          fmt::format("{}; expected HIERARCHY, as a BVH file begins", in_quotes(last_)));
    while (true) {
      if (rest_.empty() && in_lower_case(lines_.peek()) == "motion") break;
      if (auto s = take(in_lower_case(word())); !s) return std::unexpected(s.error());
    }
    if (!open_.empty())
      return fail_in_line(lines_.number(), fmt::format("MOTION follows; expected the '}}' that closes {}",
                                                       in_quotes(name(open_.back()))));
    if (tree_.joints.empty()) return fail_in_line(lines_.number(), "MOTION follows; expected a ROOT");
    return std::move(tree_);
  }

 private:
  /// The next word, or brace, which may touch others; empty at the end of the text.
  std::string_view word() {
    while (true) {
      const std::string_view before = rest_;
      last_ = take_word(rest_);
      if (const auto brace = last_.find_first_of("{}"); brace != std::string_view::npos) {
        last_ = last_.substr(0, std::max<std::size_t>(brace, 1));
        rest_ = before.substr(static_cast<std::size_t>(last_.data() + last_.size() - before.data()));
      }
      if (!last_.empty() || !lines_.next(rest_)) return last_;
    }
  }

  [[nodiscard]] const std::string& name(int joint) const { return tree_.joints[at(joint)].name; }
  [[nodiscard]] std::unexpected<Error> wrong(const std::string& what) const {
    return fail_in_line(lines_.number(), what);
  }

  Status take(const std::string& keyword) {
    if (keyword.empty())
      return wrong(open_.empty() ? std::string("the file ends; expected MOTION")
                                 : fmt::format("the file ends within {}", in_quotes(name(open_.back()))));
    if (keyword == "}") return close();
    if (keyword == "root") return open_.empty() ? open() : wrong("a ROOT within a joint; expected JOINT");
    if (open_.empty()) return wrong(fmt::format("{}; expected ROOT or MOTION", in_quotes(last_)));
    if (keyword == "joint") return at_end_site_ ? wrong("a JOINT within an End Site") : open();
    if (keyword == "end") return at_end_site_ ? wrong("an End Site within an End Site") : open_end_site();
    if (keyword == "offset") return take_offset();
    if (keyword == "channels") return take_channels();
    return wrong(fmt::format("{}; expected OFFSET, CHANNELS, JOINT, End Site or '}}'", in_quotes(last_)));
  }

  /// After the name: '{', on the same line or a later one.
  Status begin(std::string joint) {
    if (word() != "{")
      return wrong(fmt::format("{}; expected the '{{' that opens {}", in_quotes(last_), in_quotes(joint)));
    if (std::ssize(open_) == kDeepest)
      return wrong(fmt::format("joints are nested more than {} deep", kDeepest));
    tree_.joints.push_back({.name = std::move(joint), .parent = open_.empty() ? -1 : open_.back()});
    open_.push_back(static_cast<int>(tree_.joints.size()) - 1);
    has_offset_ = has_channels_ = false;
    return {};
  }

  Status open() {
    // A name may hold blanks.
    const auto end = std::min(rest_.find('{'), rest_.size());
    std::string joint = name_of_bytes(rest_.substr(0, end));
    rest_.remove_prefix(end);
    return begin(joint.empty() ? "joint" : std::move(joint));
  }

  Status open_end_site() {
    if (in_lower_case(word()) != "site")
      return wrong(fmt::format("End {}; expected End Site", in_quotes(last_)));
    if (auto s = begin(name(open_.back()) + "_end"); !s) return s;
    at_end_site_ = true;
    return {};
  }

  Status close() {
    if (open_.empty()) return wrong("a '}' too many");
    open_.pop_back();
    at_end_site_ = false;
    has_offset_ = has_channels_ = true;  // the parent's own come before its children
    return {};
  }

  Status take_offset() {
    if (has_offset_)
      return wrong(
          fmt::format("a second OFFSET, or one after the children, in {}", in_quotes(name(open_.back()))));
    has_offset_ = true;
    constexpr std::array<std::string_view, 3> kParts{"x of the offset", "y of the offset", "z of the offset"};
    for (int axis = 0; axis < 3; ++axis) {
      const auto value = take_number(rest_, lines_.number(), kParts[at(axis)]);
      if (!value) return std::unexpected(value.error());
      tree_.joints[at(open_.back())].offset(axis) = *value;
    }
    return {};
  }

  Status take_channels() {
    JointNode& joint = tree_.joints[at(open_.back())];
    if (at_end_site_ || has_channels_)
      return wrong(fmt::format("CHANNELS a second time, after the children or of an End Site, in {}",
                               in_quotes(joint.name)));
    has_channels_ = true;
    const auto count = take_number(rest_, lines_.number(), "the number of channels");
    if (!count) return std::unexpected(count.error());
    if (!(*count >= 0.0 && *count <= 6.0) || *count != static_cast<int>(*count))
      return wrong(fmt::format("{:g} channels; expected 0 to 6", *count));
    for (int c = 0; c < static_cast<int>(*count); ++c) {
      const auto channel = channel_named(word());
      if (!channel)
        return wrong(fmt::format("channel {}; expected Xposition to Zrotation", in_quotes(last_)));
      joint.channels.push_back(*channel);
    }
    const auto rotations = std::ranges::count_if(joint.channels, &JointChannel::is_rotation);
    if (rotations > 3 || std::ssize(joint.channels) - rotations > 3)
      return wrong(fmt::format("{} rotations and {} positions; expected at most three of each", rotations,
                               std::ssize(joint.channels) - rotations));
    return {};
  }

  TextLines& lines_;
  JointTree tree_;
  std::vector<int> open_;
  std::string_view rest_, last_;
  bool at_end_site_ = false, has_offset_ = false, has_channels_ = false;
};

}  // namespace

Result<JointTree> parse_bvh_hierarchy(TextLines& lines) { return Hierarchy(lines).parse(); }

}  // namespace kinemark::io::animation
