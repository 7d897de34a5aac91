// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/keypoints/internal/point_frames.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/core/missing.h"
#include "kinemark/core/utf8.h"

namespace kinemark::io::internal {
namespace {

constexpr std::size_t kMostPoints = 1000;
// A person of M points takes at least 6 M bytes of text. So many values for each byte are a person who is
// seen in one frame of a hundred.
constexpr std::size_t kMostPointsOfAByte = 20, kMostPointsAnyway = 100'000;
// Beyond any video at 1000 Hz; keeps sums of numbers of frames in range.
constexpr std::int64_t kMostFrames = 1'000'000'000;

}  // namespace

Result<const Person*> PointFrames::choose(std::span<const Person> people) const {
  if (!options_.person) {
    if (people.size() > 1)
      return fail(Code::not_supported,
                  fmt::format("shows {} people; choose one with --person", people.size()));
    return people.empty() ? nullptr : &people.front();
  }
  const auto same = [&](const Person& p) { return p.number == options_.person; };
  const bool numbered = std::ranges::any_of(people, [](const Person& p) { return p.number.has_value(); });
  if (numbered) {
    const auto found = std::ranges::find_if(people, same);
    if (found == people.end()) return nullptr;
    if (std::find_if(found + 1, people.end(), same) != people.end())
      return fail(Code::bad_input, fmt::format("shows person {} twice", *options_.person));
    return &*found;
  }
  if (*options_.person < 1 || std::cmp_greater(*options_.person, people.size())) return nullptr;
  return &people[static_cast<std::size_t>(*options_.person - 1)];
}

Status PointFrames::make_room(std::size_t points) {
  const auto frames = static_cast<std::size_t>(frames_);
  if (frames > (kMostPointsAnyway + kMostPointsOfAByte * bytes_) / std::max<std::size_t>(points, 1))
    return fail(Code::bad_input,
                fmt::format("{} frames of {} points, but almost nobody is in them", frames_, points));
  points_ = points;
  image_.resize(2 * frames * points, kNaN);
  return {};
}

Status PointFrames::add(std::int64_t frame, std::span<const Person> people, std::size_t bytes) {
  bytes_ += bytes;
  if (frame < 0 || frame > kMostFrames)
    return fail(Code::bad_input, fmt::format("is frame {}; need 0 to {}", frame, kMostFrames));
  if (!first_) first_ = frame;
  if (frame - *first_ < frames_)
    return fail(Code::bad_input,
                fmt::format("comes after frame {}; need frames that rise, each once", *first_ + frames_ - 1));
  frames_ = frame - *first_ + 1;
  const auto person = choose(people);
  if (!person) return std::unexpected(person.error());
  const std::size_t points = *person == nullptr ? points_ : (*person)->values.size() / 3;
  if (points_ != 0 && points != points_)
    return fail(Code::bad_input,
                fmt::format("shows a person of {} points; the one before has {}", points, points_));
  if (points > kMostPoints)
    return fail(Code::bad_input,
                fmt::format("shows a person of {} points; at most {} are read", points, kMostPoints));
  if (auto s = make_room(points); !s) return s;
  if (*person == nullptr) return {};
  chosen_ = true;
  double* out = image_.data() + image_.size() - 2 * points;
  const double* value = (*person)->values.data();
  for (std::size_t m = 0; m < points; ++m, out += 2, value += 3) {
    // A score of 0 says that nothing was found, whatever is asked.
    const bool seen = value[2] > 0.0 && value[2] >= options_.min_likelihood && std::isfinite(value[2]);
    if (!seen || !std::isfinite(value[0]) || !std::isfinite(value[1])) continue;
    out[0] = value[0];
    out[1] = value[1];
  }
  return {};
}

/// Shares of an image are no pixels.
Status PointFrames::check_scale() const {
  bool any = false;
  for (const double x : image_) {
    if (std::abs(x) > 1.0) return {};
    any = any || !std::isnan(x);
  }
  return any ? fail(Code::bad_input,
                    "all coordinates lie between -1 and 1; need pixels of the camera's images")
             : Status();
}

Result<Keypoints> PointFrames::finish(std::vector<std::string> names) {
  if (frames_ == 0) return fail(Code::bad_input, "has no frames");
  if (!chosen_)
    return fail(Code::bad_input, options_.person ? fmt::format("{} frames, but none shows person {}", frames_,
                                                               *options_.person)
                                                 : fmt::format("{} frames, but none shows anybody", frames_));
  if (points_ == 0) return fail(Code::bad_input, "its person has no points");
  if (names.size() != points_)
    return fail(Code::bad_input, fmt::format("names {} points; a person has {}", names.size(), points_));
  for (auto& name : names) {
    name = name_of_bytes(name);
    if (name.empty()) return fail(Code::bad_input, "one of its points has no name");
  }
  auto sorted = names;
  std::ranges::sort(sorted);
  if (const auto twice = std::ranges::adjacent_find(sorted); twice != sorted.end())
    return fail(Code::bad_input, fmt::format("point '{}' occurs twice", printable(*twice, 40)));
  if (auto s = check_scale(); !s) return std::unexpected(s.error());
  return Keypoints{.names = std::move(names), .image = std::move(image_)};
}

}  // namespace kinemark::io::internal
