// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/number.h"
#include "kinemark/io/animation/bvh.h"
#include "kinemark/io/animation/internal/bvh_hierarchy.h"
#include "kinemark/io/animation/internal/joint_trial.h"
#include "kinemark/io/animation/internal/words.h"
#include "kinemark/io/rate.h"
#include "kinemark/io/text_input.h"

namespace kinemark::io {
namespace {

using namespace animation;

const std::vector<FileUnit>& bvh_units() {
  static const std::vector<FileUnit> kUnits{{"cm", 0.01}, {"m", 1.0}, {"mm", 0.001}};
  return kUnits;
}

/// The rest of the next line, which must begin with `key` and a colon: "Frame Time: 0.01".
Result<std::string_view> after_key(TextLines& lines, std::string_view key) {
  std::string_view line;
  if (!lines.next(line))
    return fail_in_line(lines.number(), fmt::format("the file ends; expected '{}:'", key));
  const std::string lower = in_lower_case(line);
  if (!lower.starts_with(in_lower_case(key)))
    return fail_in_line(lines.number(), fmt::format("{}; expected '{}:'", in_quotes(line), key));
  line.remove_prefix(key.size());
  line = trim(line);
  if (line.starts_with(':')) line.remove_prefix(1);
  return trim(line);
}

/// The rate of a frame time as written: where one digit more or less in its last place would hold a whole
/// rate, that rate was meant.
double rate_of(double frame_time_s, std::string_view written) {
  const double rate_hz = 1.0 / frame_time_s;
  const auto point = written.find('.');
  if (point == std::string_view::npos || written.find_first_of("eE") != std::string_view::npos)
    return rate_hz;
  const double half_digit_s = 0.5000001 * std::pow(10.0, -static_cast<double>(written.size() - point - 1));
  const double whole_hz = std::round(rate_hz);
  return whole_hz > 0.0 && std::abs(1.0 / whole_hz - frame_time_s) <= half_digit_s ? whole_hz : rate_hz;
}

/// One row into `out`; how many numbers it had.
Result<std::size_t> read_row(std::string_view line, std::int64_t number, std::size_t channels,
                             JointValues& out) {
  for (std::size_t c = 0;; ++c) {
    const std::string_view word = take_word(line);
    if (word.empty()) return c;
    if (c == channels)
      return fail_in_line(number,
                          fmt::format("more than {} numbers; expected one for each channel", channels));
    const auto value = parse_number(word);
    if (!value)
      return fail_in_line(number, fmt::format("number {} is {}; expected a number", c + 1, in_quotes(word)));
    out.values.push_back(std::isfinite(*value) ? *value : kNaN);
  }
}

Result<JointValues> read_rows(TextLines& lines, std::size_t channels, std::vector<std::string>& warnings) {
  JointValues out;
  std::string_view line;
  while (lines.next(line)) {
    const auto numbers = read_row(line, lines.number(), channels, out);
    if (!numbers) return std::unexpected(numbers.error());
    if (*numbers < channels) {
      if (!lines.peek().empty() || out.frames == 0)
        return fail_in_line(lines.number(),
                            fmt::format("{} numbers; expected {}, one for each channel", *numbers, channels));
      warnings.push_back(fmt::format("line {}: the last row ends after {} of {} numbers and is left out",
                                     lines.number(), *numbers, channels));
      out.values.resize(at(out.frames) * channels);
      break;
    }
    ++out.frames;
  }
  if (out.frames == 0) return fail_in_line(lines.number(), "the file ends before the first row of numbers");
  return out;
}

/// Of the root, or of the joints below it: do the positions of the first frame stand for the offsets? Then
/// they are near them.
bool stand_for_offsets(const JointTree& tree, const JointValues& values, bool of_root) {
  double from_offsets = 0.0, from_zero = 0.0;
  std::size_t c = 0;
  for (const auto& joint : tree.joints)
    for (const auto& channel : joint.channels) {
      const double value = values.values[c++];
      if (channel.is_rotation || (joint.parent < 0) != of_root || std::isnan(value)) continue;
      from_offsets += std::abs(value - joint.offset(channel.axis));
      from_zero += std::abs(value);
    }
  return from_offsets < from_zero;
}

/// Positions instead of offsets, for joints that have all three.
void let_stand_for_offsets(JointTree& tree, bool of_root) {
  for (auto& joint : tree.joints)
    if ((joint.parent < 0) == of_root)
      joint.stands_for_offset = std::ranges::count(joint.channels, false, &JointChannel::is_rotation) == 3;
}

Result<data::Trial> parse(std::string_view text) {
  TextLines lines(text);
  auto tree = parse_bvh_hierarchy(lines);
  if (!tree) return std::unexpected(tree.error());
  std::vector<std::string> warnings;
  const std::size_t channels = tree->channel_count();
  if (channels == 0) return fail_in_line(lines.number(), "no joint has CHANNELS");
  std::string_view motion;
  lines.next(motion);
  const auto announced = after_key(lines, "Frames");
  if (!announced) return std::unexpected(announced.error());
  const auto frames = parse_number(*announced);
  if (!frames)
    return fail_in_line(lines.number(), fmt::format("Frames: {}; expected a number", in_quotes(*announced)));
  const auto written = after_key(lines, "Frame Time");
  if (!written) return std::unexpected(written.error());
  const auto frame_time_s = parse_number(*written);
  if (!frame_time_s || !is_rate(1.0 / *frame_time_s))
    return fail_in_line(lines.number(),
                        fmt::format("Frame Time: {}; expected seconds, {:g} to {:g}", in_quotes(*written),
                                    1.0 / kFastest_hz, 1.0 / kSlowest_hz));
  auto values = read_rows(lines, channels, warnings);
  if (!values) return std::unexpected(values.error());
  if (auto s = check_points(*tree, values->frames, text.size()); !s) return std::unexpected(s.error());
  if (*frames != static_cast<double>(values->frames))
    warnings.push_back(fmt::format("the file announces {:.15g} frames and holds {}, which are used", *frames,
                                   values->frames));
  for (const bool of_root : {true, false}) {
    if (!stand_for_offsets(*tree, *values, of_root)) continue;
    let_stand_for_offsets(*tree, of_root);
    warnings.push_back(
        fmt::format("positions of {} are those of {} in the first frame, and are taken in {} place",
                    of_root ? "the root" : "joints below the root", of_root ? "its offset" : "the offsets",
                    of_root ? "its" : "their"));
  }
  auto choice = choose_unit("the file states no unit of length", bvh_units(), extent_of(*tree, *values));
  warnings.push_back(std::move(choice.warning));
  auto trial = trial_of(std::move(*tree), *values, rate_of(*frame_time_s, *written), choice.unit.metres);
  trial.format = "BVH";
  trial.warnings.insert(trial.warnings.begin(), warnings.begin(), warnings.end());
  return trial;
}

}  // namespace

Result<data::Trial> parse_bvh(std::string_view text, std::string_view name) {
  auto trial = parse(text);
  if (!trial) return fail_at(name, trial.error());
  trial->source = name;
  return trial;
}

Result<data::Trial> read_bvh(const std::filesystem::path& path) {
  const auto text = read_lines_of_text(path);
  if (!text) return std::unexpected(text.error());
  return parse_bvh(*text, path.string());
}

}  // namespace kinemark::io
