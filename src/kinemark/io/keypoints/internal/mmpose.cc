// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/keypoints/internal/mmpose.h"

#include <fmt/core.h>

#include <utility>

#include "kinemark/io/keypoints/internal/json_numbers.h"

namespace kinemark::io::internal {
namespace {

using Json = nlohmann::json;

/// Values of an instance: its keypoints with their scores, or 1 where it has none.
Result<Person> person_of(const Json& instance) {
  if (!instance.is_object() || !instance.contains("keypoints"))
    return fail(Code::bad_input, "has no keypoints");
  const Json& keypoints = instance["keypoints"];
  const auto found = instance.find("keypoint_scores");
  const bool scored = found != instance.end() && !found->is_null();
  if (!keypoints.is_array() || (scored && (!is_row(*found) || found->size() != keypoints.size())))
    return fail(Code::bad_input, "its keypoints are not as many as its keypoint_scores, or no list");
  Person person{.number = whole_number(instance, {"track_id", "instance_id"}), .values = {}};
  person.values.reserve(3 * keypoints.size());
  for (std::size_t m = 0; m < keypoints.size(); ++m) {
    const Json& point = keypoints[m];
    if (is_row(point) && point.size() == 3)
      return fail(Code::not_supported, "has points in three dimensions; need pixels of an image, x and y");
    if (!is_row(point) || point.size() != 2)
      return fail(Code::bad_input, fmt::format("its keypoint {} is not two numbers, x and y", m));
    person.values.push_back(number_or_nan(point[0]));
    person.values.push_back(number_or_nan(point[1]));
    person.values.push_back(scored ? number_or_nan((*found)[m]) : 1.0);
  }
  return person;
}

/// Names in the order of the points: {"0": "nose", "1": ...}. Empty where there are none.
std::vector<std::string> names_of(const Json& meta) {
  std::vector<std::string> names;
  const auto found = meta.is_object() ? meta.find("keypoint_id2name") : meta.end();
  if (!meta.is_object() || found == meta.end() || !found->is_object()) return names;
  for (std::size_t m = 0; m < found->size(); ++m) {
    const auto name = found->find(std::to_string(m));
    if (name == found->end() || !name->is_string()) return {};
    names.push_back(name->get<std::string>());
  }
  return names;
}

}  // namespace

Status MmposeVideo::take(std::string_view key, const Json& piece) {
  if (key == "meta_info") names_ = names_of(piece);
  const bool alone = key.empty() && piece.is_object() && piece.contains("instances");
  return key == "instance_info" || alone ? take_frame(piece) : Status();
}

Status MmposeVideo::take_frame(const Json& frame) {
  const auto number = whole_number(frame, {"frame_id"});
  if (!number || !frame.contains("instances") || !frame["instances"].is_array())
    return fail(Code::bad_input, "its instance_info is no list of frames, with frame_id and instances each");
  std::vector<Person> people;
  for (const Json& instance : frame["instances"]) {
    auto person = person_of(instance);
    if (!person)
      return fail_at(fmt::format("frame {}: person {}", *number, people.size() + 1), person.error());
    people.push_back(std::move(*person));
  }
  if (auto s = frames_.add(*number, people, any_ ? 0 : bytes_); !s)
    return fail_at(fmt::format("frame {}", *number), s.error());
  any_ = true;
  return {};
}

Result<Keypoints> MmposeVideo::finish() {
  if (names_.empty())
    for (std::size_t m = 0; m < frames_.points(); ++m) names_.push_back(fmt::format("keypoint_{}", m));
  return frames_.finish(std::move(names_));
}

}  // namespace kinemark::io::internal
