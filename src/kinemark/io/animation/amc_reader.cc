// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <system_error>
#include <utility>

#include "kinemark/core/counted.h"
#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/number.h"
#include "kinemark/core/units.h"
#include "kinemark/core/utf8.h"
#include "kinemark/io/animation/amc.h"
#include "kinemark/io/animation/internal/asf.h"
#include "kinemark/io/animation/internal/joint_trial.h"
#include "kinemark/io/animation/internal/words.h"
#include "kinemark/io/rate.h"
#include "kinemark/io/text_input.h"

namespace kinemark::io {
namespace {

namespace fs = std::filesystem;
using namespace animation;

constexpr std::size_t kNumbersAlways = 1'000'000;
constexpr std::size_t kMostUnknown = 10'000;

/// The columns that one bone's numbers go to, and how many there are.
struct Columns {
  std::size_t first = 0, count = 0;
};

/// Without a skeleton: up to three numbers of a bone, from one of them on. Of six of the root the first three
/// are its position.
JointNode unknown_joint(const std::string& bone, std::size_t from, std::size_t count) {
  const bool is_root = bone == "root" && count == 6;
  const std::size_t number = from / 3 + (is_root ? 0 : 1);
  JointNode joint{.name = number < 2 ? bone : fmt::format("{}_{}", bone, number), .is_point = false};
  for (std::size_t i = from; i < std::min(count, from + 3); ++i)
    joint.channels.push_back({.is_rotation = !(is_root && from == 0), .axis = static_cast<int>(i - from)});
  return joint;
}

class AmcReader {
 public:
  AmcReader(std::string_view text, JointTree& tree, bool known)
      : text_size_(text.size()), lines_(text), tree_(tree), known_(known) {
    std::size_t first = 0;
    for (const auto& joint : tree.joints) {
      if (!joint.channels.empty()) columns_[joint.name] = {first, joint.channels.size()};
      first += joint.channels.size();
    }
    width_ = first;
  }

  Status read(JointValues& out) {
    while (lines_.next(line_)) {
      if (line_.front() == '#') continue;
      if (line_.front() == ':') {
        const std::string word = in_lower_case(line_);
        if (word == ":radians") degrees_ = false;
        continue;
      }
      std::string_view rest = line_;
      const std::string_view word = take_word(rest);
      if (rest.empty() && word.find_first_not_of("0123456789") == std::string_view::npos) {
        if (auto s = begin_frame(word, out); !s) return s;
        continue;
      }
      if (auto s = take_bone(word, rest, out); !s) return s;
    }
    if (out.frames == 0)
      return fail_in_line(std::max<std::int64_t>(lines_.number(), 1),
                          "the file ends before the first frame, a number on a line of its own");
    out.values.resize(at(out.frames) * width_, kNaN);
    return {};
  }

  [[nodiscard]] std::int64_t first_frame() const { return first_; }
  [[nodiscard]] std::int64_t jumps() const { return jumps_; }

 private:
  Status begin_frame(std::string_view word, JointValues& out) {
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || number > 1'000'000'000'000)
      return fail_in_line(lines_.number(),
                          fmt::format("frame {}; expected a number of up to 12 digits", in_quotes(word)));
    if (out.frames == 0) first_ = number;
    jumps_ += out.frames > 0 && number != last_ + 1;
    last_ = number;
    ++out.frames;
    if (width_ * at(out.frames) > text_size_ + kNumbersAlways)
      return fail_in_line(lines_.number(),
                          fmt::format("{} frames of {} numbers do not fit into the {} bytes of this file",
                                      out.frames, width_, text_size_));
    if (width_ > 0) out.values.resize(at(out.frames) * width_, kNaN);
    return {};
  }

  Status take_bone(std::string_view word, std::string_view rest, JointValues& out) {
    if (out.frames == 0)
      return fail_in_line(lines_.number(),
                          fmt::format("{}; expected the number of a frame first", in_quotes(word)));
    const std::string bone = name_of_bytes(word);
    std::vector<double> numbers;
    while (!trim(rest).empty()) {
      const auto value = take_number(rest, lines_.number(),
                                     fmt::format("number {} of {}", numbers.size() + 1, in_quotes(bone)));
      if (!value) return std::unexpected(value.error());
      numbers.push_back(*value);
    }
    auto found = columns_.find(bone);
    if (found == columns_.end()) {
      if (known_ || out.frames > 1)
        return fail_in_line(lines_.number(), fmt::format("{} is no bone that moves in {}", in_quotes(bone),
                                                         known_ ? "the skeleton" : "the first frame"));
      if (columns_.size() == kMostUnknown)
        return fail_in_line(lines_.number(), fmt::format("more than {} bones", kMostUnknown));
      found = columns_.emplace(bone, Columns{width_, numbers.size()}).first;
      for (std::size_t i = 0; i < numbers.size(); i += 3)
        tree_.joints.push_back(unknown_joint(bone, i, numbers.size()));
      width_ += numbers.size();
      out.values.resize(width_, kNaN);
    }
    const auto [first, count] = found->second;
    if (numbers.size() != count)
      return fail_in_line(lines_.number(), fmt::format("{} numbers of {}; expected {}", numbers.size(),
                                                       in_quotes(bone), count));
    for (std::size_t i = 0; i < count; ++i)
      out.values[(at(out.frames) - 1) * width_ + first + i] = numbers[i];
    return {};
  }

 public:
  /// Angles in degrees, as the trial wants them.
  void make_degrees(JointValues& out) const {
    if (degrees_) return;
    std::size_t c = 0;
    for (const auto& joint : tree_.joints)
      for (const auto& channel : joint.channels) {
        if (channel.is_rotation)
          for (std::size_t i = c; i < out.values.size(); i += width_) out.values[i] *= kDegPerRad;
        ++c;
      }
  }
  [[nodiscard]] std::int64_t frames_with_gaps(const JointValues& values) const {
    std::int64_t n = 0;
    for (std::int64_t f = 0; f < values.frames; ++f) {
      const auto row = values.values.begin() + static_cast<std::ptrdiff_t>(at(f) * width_);
      n +=
          std::any_of(row, row + static_cast<std::ptrdiff_t>(width_), [](double v) { return std::isnan(v); });
    }
    return n;
  }

 private:
  std::size_t text_size_;
  TextLines lines_;
  std::string_view line_;
  JointTree& tree_;
  bool known_, degrees_ = true;
  std::map<std::string, Columns> columns_;
  std::size_t width_ = 0;
  std::int64_t first_ = 1, last_ = 0, jumps_ = 0;
};

std::vector<FileUnit> units_of(double length) {
  constexpr double kInch_m = 0.0254;
  std::vector<FileUnit> out{{fmt::format("an inch divided by {:g}", length), kInch_m / length}};
  if (length != 1.0) {
    out.push_back({fmt::format("an inch times {:g}", length), kInch_m * length});
    out.push_back({fmt::format("a centimetre times {:g}", length), 0.01 * length});
  }
  for (const auto& [name, metres] : {std::pair("cm", 0.01), {"m", 1.0}, {"mm", 0.001}})
    out.push_back({name, metres});
  return out;
}

bool has_ending(const fs::path& path, std::string_view ending) {
  return in_lower_case(path.extension().string()) == ending;
}

}  // namespace

fs::path skeleton_beside(const fs::path& amc) {
  const std::string stem = amc.stem().string();
  const std::string subject = stem.substr(0, stem.rfind('_'));
  std::vector<fs::path> found;
  std::error_code error;
  fs::directory_iterator entry(amc.has_parent_path() ? amc.parent_path() : fs::path("."), error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error))
    if (has_ending(entry->path(), ".asf")) found.push_back(amc.parent_path() / entry->path().filename());
  std::ranges::sort(found);
  for (const auto& name : {stem, subject})
    for (const auto& path : found)
      if (path.stem().string() == name) return path;
  return found.size() == 1 ? found.front() : fs::path();
}

Result<data::Trial> parse_amc(std::string_view amc, std::string_view amc_name,
                              std::optional<std::string_view> asf, std::string_view asf_name,
                              double rate_hz) {
  if (!is_rate(rate_hz))
    return fail(
        Code::usage,
        fmt::format(
            "{}: an AMC file stores no rate; give the rate of its frames in Hz (--rate), 120 for CMU's",
            amc_name));
  AsfSkeleton skeleton;
  std::vector<std::string> warnings;
  if (asf) {
    auto read = parse_asf(*asf);
    if (!read) return fail_at(asf_name, read.error());
    skeleton = std::move(*read);
  } else {
    warnings.emplace_back(
        "there is no skeleton (.asf) beside it nor given (--skeleton): it holds angles, but no points");
  }
  JointValues values;
  AmcReader reader(amc, skeleton.tree, asf.has_value());
  if (auto s = reader.read(values); !s) return fail_at(amc_name, s.error());
  reader.make_degrees(values);
  if (auto s = check_points(skeleton.tree, values.frames, amc.size()); !s)
    return fail_at(amc_name, s.error());
  if (reader.jumps() > 0)
    warnings.push_back(
        fmt::format("numbers of frames jump {}; the rows are taken as frames one after the other",
                    counted(reader.jumps(), "time")));
  if (const auto n = reader.frames_with_gaps(values); n > 0)
    warnings.push_back(fmt::format("{} {} bones out, which are missing there with all that hangs from them",
                                   counted(n, "frame"), n == 1 ? "leaves" : "leave"));
  UnitChoice choice{{"", 1.0}, ""};
  if (asf) {
    choice = choose_unit(fmt::format("length {:g} of the skeleton names no unit", skeleton.length),
                         units_of(skeleton.length), extent_of(skeleton.tree, values));
    warnings.push_back(choice.warning);
  }
  auto trial = trial_of(std::move(skeleton.tree), values, rate_hz, choice.unit.metres);
  trial.source = amc_name;
  trial.format = "AMC";
  trial.first_frame = reader.first_frame();
  trial.warnings.insert(trial.warnings.begin(), warnings.begin(), warnings.end());
  return trial;
}

Result<data::Trial> read_amc(const fs::path& path, const AmcReadOptions& options) {
  const auto amc = read_lines_of_text(path);
  if (!amc) return std::unexpected(amc.error());
  const fs::path skeleton = options.skeleton.empty() ? skeleton_beside(path) : options.skeleton;
  if (skeleton.empty()) return parse_amc(*amc, path.string(), std::nullopt, "", options.rate_hz);
  const auto asf = read_lines_of_text(skeleton);
  if (!asf) return std::unexpected(asf.error());
  auto trial = parse_amc(*amc, path.string(), *asf, skeleton.string(), options.rate_hz);
  if (trial && options.skeleton.empty())
    trial->warnings.insert(trial->warnings.begin(), fmt::format("its skeleton is {}, which is beside it",
                                                                skeleton.filename().string()));
  return trial;
}

}  // namespace kinemark::io
