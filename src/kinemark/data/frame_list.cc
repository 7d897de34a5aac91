// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/frame_list.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <utility>
#include <vector>

#include "kinemark/core/utf8.h"

namespace kinemark::data {
namespace {

constexpr std::size_t kStretchesNamed = 6;
constexpr std::size_t kFewestInPattern = 3, kFewestNearly = 6;
constexpr double kNearly = 0.8;  // of the distances from frame to frame

/// "every third", "every 12th".
std::string every(std::int64_t distance) {
  constexpr std::array<std::string_view, 9> kWords{"second",  "third",  "fourth", "fifth", "sixth",
                                                   "seventh", "eighth", "ninth",  "tenth"};
  if (distance - 2 < std::ssize(kWords))
    return fmt::format("every {}", kWords.at(static_cast<std::size_t>(distance - 2)));
  const auto ones = distance % 10, tens = distance / 10 % 10;
  const char* end = tens == 1 ? "th" : ones == 1 ? "st" : ones == 2 ? "nd" : ones == 3 ? "rd" : "th";
  return fmt::format("every {}{}", distance, end);
}

/// The distance that most neighbours have, and how many have it.
std::pair<std::int64_t, std::size_t> usual_distance(std::span<const std::int64_t> frames) {
  std::vector<std::int64_t> distances;
  for (std::size_t i = 1; i < frames.size(); ++i) distances.push_back(frames[i] - frames[i - 1]);
  std::ranges::sort(distances);
  std::pair<std::int64_t, std::size_t> best{0, 0};
  for (std::size_t i = 0; i < distances.size();) {
    std::size_t end = i;
    while (end < distances.size() && distances[end] == distances[i]) ++end;
    if (end - i > best.second) best = {distances[i], end - i};
    i = end;
  }
  return best;
}

std::string stretches_of(std::span<const std::int64_t> frames, const TimeBase& time) {
  std::string text;
  std::size_t stretches = 0;
  for (std::size_t i = 0; i < frames.size(); ++stretches) {
    std::size_t end = i + 1;
    while (end < frames.size() && frames[end] == frames[end - 1] + 1) ++end;
    if (stretches < kStretchesNamed) {
      text += stretches > 0 ? ", " : "";
      text += end == i + 1 ? fmt::format("{}", time.number(frames[i]))
                           : fmt::format("{} to {}", time.number(frames[i]), time.number(frames[end - 1]));
    }
    i = end;
  }
  if (stretches > kStretchesNamed)
    text += fmt::format(" and {} more span{}", stretches - kStretchesNamed,
                        stretches == kStretchesNamed + 1 ? "" : "s");
  return text;
}

constexpr std::int64_t kFarthestNumber = 1'000'000'000;  // by its absolute value

/// Takes a whole number from the front of a text.
bool take_number(std::string_view& text, std::int64_t& out) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  if (error != std::errc() || out > kFarthestNumber || out < -kFarthestNumber) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return true;
}

bool take(std::string_view& text, char c) {
  if (!text.starts_with(c)) return false;
  text.remove_prefix(1);
  return true;
}

/// A piece of a list: frames from first to last in steps.
struct Piece {
  std::int64_t first = 0, last = 0, step = 1;
};

bool parse_piece(std::string_view text, Piece& out) {
  if (!take_number(text, out.first)) return false;
  out.last = out.first;
  if (text.empty()) return true;
  if (!take(text, '-') || !take_number(text, out.last) || out.last < out.first) return false;
  if (text.empty()) return true;
  return take(text, '/') && take_number(text, out.step) && out.step >= 1 && text.empty();
}

}  // namespace

std::string words_of_frames(std::span<const std::int64_t> frames, const TimeBase& time) {
  if (frames.empty()) return "";
  if (frames.size() == 1) return fmt::format("frame {}", time.number(frames.front()));
  const auto [distance, count] = usual_distance(frames);
  const std::size_t all = frames.size() - 1;
  const auto from_to = [&] {
    return fmt::format(" frame from {} to {}", time.number(frames.front()), time.number(frames.back()));
  };
  if (distance > 1 && count == all && frames.size() >= kFewestInPattern) return every(distance) + from_to();
  if (distance > 1 && frames.size() >= kFewestNearly &&
      static_cast<double>(count) >= kNearly * static_cast<double>(all))
    return "nearly " + every(distance) + from_to();
  return "frames " + stretches_of(frames, time);
}

std::string format_frame_list(std::span<const std::int64_t> frames) {
  std::string text;
  for (std::size_t i = 0; i < frames.size();) {
    std::size_t end = i + 1;
    const std::int64_t step = end < frames.size() ? frames[end] - frames[i] : 1;
    while (end < frames.size() && frames[end] - frames[end - 1] == step) ++end;
    if (step > 1 && end - i < kFewestInPattern) end = i + 1;  // two frames are no pattern
    text += text.empty() ? "" : ",";
    text += fmt::format("{}", frames[i]);
    if (end - i > 1) text += fmt::format("-{}", frames[end - 1]);
    if (end - i > 1 && step > 1) text += fmt::format("/{}", step);
    i = end;
  }
  return text;
}

Result<std::vector<std::int64_t>> parse_frame_list(std::string_view text, std::size_t most) {
  std::vector<std::int64_t> frames;
  for (std::size_t begin = 0;;) {
    const auto end = text.find(',', begin);
    const auto piece_text = text.substr(begin, end == std::string_view::npos ? end : end - begin);
    Piece piece;
    if (!parse_piece(piece_text, piece))
      return fail(Code::bad_input, fmt::format("'{}' is no list of frames; need 1,4,19-20 or 1-127/3",
                                               printable(piece_text, 60)));
    if (!frames.empty() && piece.first <= frames.back())
      return fail(Code::bad_input,
                  fmt::format("frame {} comes after frame {}; need a list of frames in order", piece.first,
                              frames.back()));
    if (static_cast<std::size_t>((piece.last - piece.first) / piece.step) >=
        most - std::min(most, frames.size()))
      return fail(Code::bad_input, fmt::format("a list of more than {} frames", most));
    for (auto f = piece.first; f <= piece.last; f += piece.step) frames.push_back(f);
    if (end == std::string_view::npos) return frames;
    begin = end + 1;
  }
}

}  // namespace kinemark::data
