// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/keypoints/openpose.h"

#include <fmt/core.h>

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "kinemark/io/keypoints/internal/json_numbers.h"
#include "kinemark/io/keypoints/internal/json_pieces.h"
#include "kinemark/io/keypoints/internal/openpose_names.h"
#include "kinemark/io/keypoints/internal/point_frames.h"

namespace kinemark::io {
namespace {

using internal::OpenPoseLayout;
using internal::Person;
using nlohmann::json;

/// One person with the values of all her parts, and how many points each part has.
Result<std::pair<Person, OpenPoseLayout>> person_of(const json& piece) {
  if (!piece.is_object()) return fail(Code::bad_input, "is no object of JSON");
  std::pair<Person, OpenPoseLayout> out;
  auto& [person, layout] = out;
  person.number = internal::whole_number(piece, {"person_id"});
  if (person.number && *person.number < 0) person.number.reset();
  for (std::size_t part = 0; part < internal::kOpenPoseParts.size(); ++part) {
    const auto found = piece.find(internal::kOpenPoseParts[part].key);
    if (found == piece.end()) continue;
    if (!internal::is_row(*found) || found->size() % 3 != 0)
      return fail(Code::bad_input, fmt::format("{} is no list of x, y and confidence of each point",
                                               internal::kOpenPoseParts[part].key));
    layout[part] = found->size() / 3;
    for (const json& value : *found) person.values.push_back(internal::number_or_nan(value));
  }
  const auto in_space = piece.find("pose_keypoints_3d");
  if (person.values.empty() && in_space != piece.end() && !in_space->empty())
    return fail(
        Code::not_supported,
        "has pose_keypoints_3d alone, points in three dimensions without a unit; need pose_keypoints_2d");
  if (person.values.empty()) return fail(Code::bad_input, "has no pose_keypoints_2d");
  return out;
}

}  // namespace

struct OpenPoseFrames::State {
  KeypointsOptions options;
  internal::PointFrames frames;
  std::optional<OpenPoseLayout> layout;
};

OpenPoseFrames::OpenPoseFrames(const KeypointsOptions& options)
    : state_(std::make_unique<State>(State{options, internal::PointFrames(options), {}})) {}
OpenPoseFrames::OpenPoseFrames(OpenPoseFrames&&) noexcept = default;
OpenPoseFrames& OpenPoseFrames::operator=(OpenPoseFrames&&) noexcept = default;
OpenPoseFrames::~OpenPoseFrames() = default;

bool is_openpose(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r\n");
  return begin != std::string_view::npos && text[begin] == '{' &&
         text.substr(0, 512).find("\"people\"") != std::string_view::npos;
}

Status OpenPoseFrames::add(std::int64_t frame, std::string_view text) {
  if (auto s = state_->options.check(); !s) return s;
  if (!is_openpose(text)) return fail(Code::bad_input, "is no frame of OpenPose: need an object with people");
  std::vector<Person> people;
  auto status = internal::read_pieces(text, [&](std::string_view key, const json& piece) -> Status {
    if (key != "people") return {};
    auto read = person_of(piece);
    if (!read) return fail_at(fmt::format("person {}", people.size() + 1), read.error());
    if (!state_->layout) state_->layout = read->second;
    if (*state_->layout != read->second)
      return fail(Code::bad_input,
                  fmt::format("person {} has points of {}; those before have {}", people.size() + 1,
                              internal::describe(read->second), internal::describe(*state_->layout)));
    people.push_back(std::move(read->first));
    return {};
  });
  if (!status) return status;
  return state_->frames.add(frame, people, text.size());
}

Result<Keypoints> OpenPoseFrames::finish() {
  if (!state_->layout) return state_->frames.finish({});
  auto names = internal::openpose_names(*state_->layout);
  if (!names) return std::unexpected(names.error());
  return state_->frames.finish(std::move(*names));
}

}  // namespace kinemark::io
