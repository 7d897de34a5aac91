// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/arrays/named_arrays.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "kinemark/core/distinct_names.h"
#include "kinemark/core/index.h"
#include "kinemark/core/length_unit.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/text.h"
#include "kinemark/core/utf8.h"
#include "kinemark/io/position_name.h"
#include "kinemark/io/rate.h"
#include "kinemark/io/sample_clock.h"

namespace kinemark::io {
namespace {

constexpr std::size_t kNamed = 8;
constexpr std::array<std::string_view, 6> kTimes{"t", "time", "times", "time_s", "timestamps", "timestamp"};
constexpr std::array<std::string_view, 10> kRates{"fs",         "rate",       "rate_hz", "fps",
                                                  "frame_rate", "framerate",  "freq",    "sampling_rate",
                                                  "frequency",  "sample_rate"};
constexpr std::array<std::string_view, 9> kNames{"names",     "labels",      "marker_names",
                                                 "markers",   "point_names", "marker_labels",
                                                 "keypoints", "bodyparts",   "node_names"};
constexpr std::array<std::string_view, 3> kUnits{"unit", "units", "length_unit"};
constexpr std::string_view kExpected =
    "expected an array of frames x markers x 3 with one of names, or an array of frames x 3 for each marker, "
    "and "
    "times in s ('t') or a rate in Hz ('fs')";

template <std::size_t N>
bool is_one_of(const std::array<std::string_view, N>& words, std::string_view name) {
  std::string lower(name);
  std::ranges::transform(lower, lower.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return std::ranges::find(words, lower) != words.end();
}

/// "markers (100 x 20 x 3)".
std::string describe(const NamedArray& named) {
  std::vector<std::string> axes;
  for (const auto n : named.shape) axes.push_back(fmt::format("{}", n));
  return fmt::format("{} ({})", printable(named.name, 63), axes.empty() ? "one value" : join(axes, " x "));
}

std::string describe_all(const std::vector<NamedArray>& arrays) {
  std::vector<std::string> out;
  for (const auto& array : arrays) out.push_back(describe(array));
  return out.empty() ? "no array" : join_some(out, kNamed);
}

/// Paths that lie along the rows (3 x frames) are turned, and rows of all markers (frames x 3 markers, as a
/// table has them) get an axis for these.
void shape_arrays(std::vector<NamedArray>& arrays) {
  std::int64_t markers = 0;
  for (const auto& array : arrays)
    if (array.is_text && array.shape.size() == 1 && is_one_of(kNames, array.name)) markers = array.size();
  for (auto& array : arrays) {
    if (array.is_text || array.shape.size() != 2) continue;
    if (array.shape[0] == 3 && array.shape[1] > 3) {
      const auto frames = at(array.shape[1]);
      std::vector<double> turned(array.numbers.size());
      for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t f = 0; f < frames; ++f) turned[3 * f + k] = array.numbers[k * frames + f];
      array.numbers = std::move(turned);
      array.shape = {array.shape[1], 3};
    } else if (markers > 1 && array.shape[1] == 3 * markers) {
      array.shape = {array.shape[0], markers, 3};
    }
  }
}

/// What the arrays are.
class Archive {
 public:
  explicit Archive(std::vector<NamedArray> arrays) : arrays_(std::move(arrays)) {
    for (const auto& array : arrays_) {
      const bool one = array.size() == 1, row = array.shape.size() == 1;
      const bool may_be_position = !array.is_text && !names_no_position(array.name);
      if (array.is_text && one && is_one_of(kUnits, array.name))
        unit_ = array.texts.front();
      else if (array.is_text && row && is_one_of(kNames, array.name) && names_ == nullptr)
        names_ = &array;
      else if (!array.is_text && row && !one && is_one_of(kTimes, array.name) && times_ == nullptr)
        times_ = &array;
      else if (!array.is_text && one && is_one_of(kRates, array.name) && rate_ == 0.0)
        rate_ = array.numbers.front();
      else if (may_be_position && array.shape.size() == 3 && array.size() > 0)
        blocks_.push_back(&array);
      else if (may_be_position && array.shape.size() == 2 && array.shape[1] == 3 && array.shape[0] > 1)
        paths_.push_back(&array);
      else
        others_.push_back(&array);
    }
  }

  Result<data::Trial> read(std::string_view unit) {
    data::Trial trial;
    auto positions = blocks_.empty() ? from_paths(trial) : from_block(trial);
    if (!positions) return std::unexpected(positions.error());
    if (auto s = place_rows(*positions, trial); !s) return std::unexpected(s.error());
    if (auto s = settle_unit(unit, trial); !s) return std::unexpected(s.error());
    if (!others_.empty()) {
      std::vector<std::string> said;
      for (const auto* other : others_) said.push_back(describe(*other));
      trial.warnings.push_back(
          fmt::format("{} of {} arrays are no positions, names or times and are not read: {}", others_.size(),
                      arrays_.size(), join_some(said, kNamed)));
    }
    return trial;
  }

 private:
  /// Rows of all markers, one after another: frames x markers x 3.
  struct Rows {
    std::int64_t frames = 0;
    std::vector<double> x;
  };

  [[nodiscard]] std::unexpected<Error> unfit(std::string_view what) const {
    return fail(Code::bad_input, fmt::format("{}: holds {}; {}", what, describe_all(arrays_), kExpected));
  }

  /// An array of frames x 3 for each marker.
  Result<Rows> from_paths(data::Trial& trial) {
    if (paths_.empty()) return unfit("no positions are found");
    Rows out{.frames = times_ != nullptr ? times_->size() : paths_.front()->shape[0], .x = {}};
    std::erase_if(paths_, [&](const NamedArray* path) {
      const bool other = path->shape[0] != out.frames;
      if (other) others_.push_back(path);
      return other;
    });
    if (paths_.empty()) return unfit("times and positions differ in length");
    for (const auto* path : paths_) trial.markers.names.push_back(path->name);
    for (std::int64_t f = 0; f < out.frames; ++f)
      for (const auto* path : paths_)
        out.x.insert(out.x.end(), path->numbers.begin() + 3 * f, path->numbers.begin() + 3 * f + 3);
    return out;
  }

  /// Which axis is frames, markers and coordinates; nothing where several orders fit.
  [[nodiscard]] std::optional<std::array<std::size_t, 3>> order_of(
      const std::vector<std::int64_t>& shape) const {
    std::optional<std::array<std::size_t, 3>> found;
    for (const auto& order :
         {std::array<std::size_t, 3>{0, 1, 2}, {1, 0, 2}, {0, 2, 1}, {2, 1, 0}, {1, 2, 0}, {2, 0, 1}}) {
      if (shape[order[2]] != 3) continue;
      if (times_ != nullptr && shape[order[0]] != times_->size()) continue;
      if (names_ != nullptr && shape[order[1]] != names_->size()) continue;
      // Without times the usual order is meant where it fits.
      if (found && (*found)[0] == 0 && (*found)[1] == 1) return found;
      if (found) return std::nullopt;
      found = order;
    }
    return found;
  }

  /// One array of all positions.
  Result<Rows> from_block(data::Trial& trial) {
    std::erase_if(blocks_, [&](const NamedArray* block) {
      const bool other = !order_of(block->shape);
      if (other) others_.push_back(block);
      return other;
    });
    if (blocks_.empty()) return unfit("no array of three axes is as long as its names and times");
    if (blocks_.size() > 1) return unfit("several arrays may be the positions");
    const auto& array = *blocks_.front();
    const auto order = *order_of(array.shape);
    std::array<std::int64_t, 3> stride{array.shape[1] * array.shape[2], array.shape[2], 1};
    const std::int64_t frames = array.shape[order[0]], markers = array.shape[order[1]];
    if (names_ != nullptr) trial.markers.names = names_->texts;
    if (names_ == nullptr) {
      for (std::int64_t m = 0; m < markers; ++m)
        trial.markers.names.push_back(fmt::format("point {}", m + 1));
      trial.warnings.push_back(
          fmt::format("no array names the {} markers; they are called 'point n'", markers));
    }
    Rows out{.frames = frames, .x = {}};
    out.x.reserve(array.numbers.size());
    for (std::int64_t f = 0; f < frames; ++f)
      for (std::int64_t m = 0; m < markers; ++m)
        for (std::int64_t k = 0; k < 3; ++k)
          out.x.push_back(
              array.numbers[at(f * stride[order[0]] + m * stride[order[1]] + k * stride[order[2]])]);
    for (const auto* path : paths_) others_.push_back(path);
    return out;
  }

  /// The frames of the rows, by their times or one after another.
  Result<SampleClock> clock_of(std::int64_t rows) const {
    if (times_ != nullptr) {
      if (times_->size() != rows) return unfit("times and positions differ in length");
      const auto& times = times_->numbers;
      if (!std::ranges::all_of(times, [](double t) { return std::isfinite(t); }))
        return fail(Code::bad_input,
                    fmt::format("array '{}': a time is no number", printable(times_->name, 63)));
      auto clock = find_clock(times, is_rate(rate_) ? rate_ : 0.0);
      if (!clock) return fail_at(fmt::format("array '{}'", printable(times_->name, 63)), clock.error());
      // 0.01, 0.02, ... is no exact step in binary.
      const double round_hz = std::round(clock->rate_hz * 1e6) / 1e6;
      if (std::abs(clock->rate_hz - round_hz) < 1e-9 * round_hz) clock->rate_hz = round_hz;
      return clock;
    }
    if (!is_rate(rate_)) return unfit(rate_ == 0.0 ? "no clock is found" : "the rate is none");
    SampleClock clock{.rate_hz = rate_, .start_s = 0.0, .frame = {}, .dropped = 0, .widest_gap_s = 0.0};
    for (std::int64_t f = 0; f < rows; ++f) clock.frame.push_back(f);
    return clock;
  }

  Status place_rows(const Rows& rows, data::Trial& trial) const {
    const auto clock = clock_of(rows.frames);
    if (!clock) return std::unexpected(clock.error());
    auto names = std::move(trial.markers.names);
    for (std::size_t m = 0; m < names.size(); ++m)
      if (names[m].empty()) names[m] = fmt::format("point {}", m + 1);
    if (const auto repeated = make_distinct(names); repeated.changed > 0)
      trial.warnings.push_back(
          fmt::format("{} marker names stand twice ('{}' is the first); a number is added to each",
                      repeated.changed, printable(repeated.example, 63)));
    const auto markers = names.size();
    trial.markers = data::Trajectories::all_missing(
        std::move(names),
        {.rate_hz = clock->rate_hz, .t0_s = clock->start_s, .frames = clock->frame.back() + 1});
    for (std::size_t r = 0; r < at(rows.frames); ++r)
      for (std::size_t m = 0; m < markers; ++m) {
        const double* const x = rows.x.data() + 3 * (r * markers + m);
        if (!std::isfinite(x[0]) || !std::isfinite(x[1]) || !std::isfinite(x[2])) continue;
        const auto f = clock->frame[r];
        trial.markers.x(f, static_cast<std::int64_t>(m)) = Eigen::Vector3d(x[0], x[1], x[2]);
        trial.markers.state[trial.markers.index(f, static_cast<std::int64_t>(m))] =
            data::SampleState::measured;
      }
    if (clock->dropped > 0)
      trial.warnings.push_back(fmt::format("times skip {} frames, which are missing", clock->dropped));
    return {};
  }

  Status settle_unit(std::string_view given, data::Trial& trial) const {
    std::string unit = unit_.empty() ? std::string(given) : unit_;
    auto metres = metres_per_unit(unit);
    if (!unit.empty() && !metres)
      return fail(Code::bad_input,
                  fmt::format("the unit of length is '{}'; expected mm, cm or m", printable(unit, 40)));
    if (!metres) {
      const double extent = extent_of(trial.markers);
      static const std::array<LengthUnitName, 3> kChoice{{{"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}}};
      const auto likely = unit_of_body_size(kChoice, extent);
      if (!likely)
        return fail(
            Code::bad_input,
            fmt::format("states no unit of length, and its coordinates, which reach over {:.4g}, may be of "
                        "several; give it with --unit mm, cm or m, or as an array 'unit'",
                        extent));
      unit = likely->name;
      metres = likely->metres;
      trial.warnings.push_back(
          fmt::format("no unit of length is stated; taken for {}, as the markers reach over {:.3g} m then",
                      unit, extent * likely->metres));
    }
    for (double& x : trial.markers.x_in_world) x *= *metres;
    trial.units_in_file = unit;
    return {};
  }

  /// The largest of the three extents of all samples.
  static double extent_of(const data::Trajectories& markers) {
    double widest = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      double least = INFINITY, most = -INFINITY;
      for (std::size_t i = k; i < markers.x_in_world.size(); i += 3) {
        least = std::fmin(least, markers.x_in_world[i]);
        most = std::fmax(most, markers.x_in_world[i]);
      }
      if (most > least) widest = std::max(widest, most - least);
    }
    return widest;
  }

  std::vector<NamedArray> arrays_;
  std::vector<const NamedArray*> blocks_, paths_, others_;
  const NamedArray* names_ = nullptr;
  const NamedArray* times_ = nullptr;
  double rate_ = 0.0;
  std::string unit_;
};

}  // namespace

std::int64_t NamedArray::size() const {
  std::int64_t out = 1;
  for (const auto n : shape) out *= n;
  return out;
}

Result<data::Trial> trial_of_arrays(std::vector<NamedArray> arrays, std::string_view unit) {
  shape_arrays(arrays);
  Archive archive(std::move(arrays));
  return archive.read(unit);
}

}  // namespace kinemark::io
