// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/merge_trials.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "kinemark/core/counted.h"
#include "kinemark/core/index.h"
#include "kinemark/data/calibration_error.h"
#include "kinemark/data/filtering.h"

namespace kinemark::pipeline {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Copies `n` values of a sample where both arrays have them.
template <class T>
void copy_sample(const Array<T>& from, std::size_t i, Array<T>& to, std::size_t j, std::size_t n = 1) {
  if (from.empty() || to.empty()) return;
  for (std::size_t k = 0; k < n; ++k) to[j * n + k] = from[i * n + k];
}

/// The same method, order and cut-off; the noise that each file found may differ.
bool same_filter(const data::FilterUsed& a, const data::FilterUsed& b) {
  if (!data::is_filter(a) || !data::is_filter(b)) return data::is_filter(a) == data::is_filter(b);
  const bool same_cutoff = std::isnan(a.cutoff_hz)
                               ? std::isnan(b.cutoff_hz)
                               : std::abs(a.cutoff_hz - b.cutoff_hz) <= 1e-6 * a.cutoff_hz;
  return a.method == b.method && a.order == b.order && same_cutoff;
}

/// Joins one trial after the other into the result.
class Merger {
 public:
  explicit Merger(std::vector<data::Trial>& trials) : trials_(trials) {}

  Result<data::Trial> merge() {
    if (auto s = check_clocks(); !s) return std::unexpected(s.error());
    if (auto s = make_room(); !s) return std::unexpected(s.error());
    for (const auto& trial : trials_)
      if (auto s = add_markers(trial); !s) return std::unexpected(s.error());
    if (auto s = add_channels(); !s) return std::unexpected(s.error());
    add_analog();
    add_events();
    add_the_rest();
    return std::move(out_);
  }

 private:
  static std::unexpected<Error> differ(const data::Trial& a, const data::Trial& b, const std::string& what) {
    return fail(Code::bad_input, fmt::format("{} and {} cannot be merged: {}", a.source, b.source, what));
  }

  /// Time of frame number 0 of a file.
  static double clock_of(const data::Trial& t) {
    return t.markers.time.t0_s - static_cast<double>(t.first_frame) / t.markers.time.rate_hz;
  }

  Status check_clocks() const {
    const auto& first = trials_.front();
    const double rate_hz = first.markers.time.rate_hz;
    for (const auto& t : trials_) {
      if (std::abs(t.markers.time.rate_hz - rate_hz) > 1e-6 * rate_hz)
        return differ(
            first, t,
            fmt::format("{:g} and {:g} frames per second; need one rate", rate_hz, t.markers.time.rate_hz));
      if (std::abs(clock_of(t) - clock_of(first)) > 0.5 / rate_hz)
        return differ(first, t,
                      fmt::format("frame 1 is at {:.4f} and at {:.4f} s; need files of one recording, which "
                                  "count frames and time alike",
                                  clock_of(first) + 1.0 / rate_hz, clock_of(t) + 1.0 / rate_hz));
    }
    return {};
  }

  Status make_room() {
    std::int64_t first = trials_.front().first_frame, last = trials_.front().last_frame(), recorded = 0;
    std::vector<std::string> names;
    for (const auto& t : trials_) {
      first = std::min(first, t.first_frame);
      last = std::max(last, t.last_frame());
      recorded += t.markers.frames();
      for (const auto& name : t.markers.names)
        if (columns_.emplace(name, std::ssize(names)).second) names.push_back(name);
    }
    const std::int64_t frames = last - first + 1;
    if (frames > 10 * recorded)
      return differ(trials_.front(), trials_.back(),
                    fmt::format("{} frames from the first to the last, of which {} are in the files", frames,
                                recorded));
    const auto earliest = std::ranges::min_element(trials_, {}, &data::Trial::first_frame);
    out_.first_frame = first;
    out_.markers =
        data::Trajectories::all_missing(std::move(names), {.rate_hz = earliest->markers.time.rate_hz,
                                                           .t0_s = earliest->markers.time.t0_s,
                                                           .frames = frames,
                                                           .first_number = first});
    const std::size_t samples = out_.markers.state.size();
    for (const auto& t : trials_) {
      if (!t.markers.covariance.empty()) out_.markers.covariance.assign(6 * samples, kNone);
      if (!t.markers.sample_offset_s.empty()) out_.markers.sample_offset_s.assign(samples, 0.0);
      if (!t.markers.unfiltered_in_world.empty()) out_.markers.unfiltered_in_world.assign(3 * samples, kNone);
      if (!t.markers.filters.empty())
        out_.markers.filters.assign(columns_.size(),
                                    {.method = "none", .cutoff_hz = kNone, .noise_sd_m = kNone});
      if (!t.residual_m.empty()) out_.residual_m.assign(samples, std::numeric_limits<float>::quiet_NaN());
      if (!t.camera_mask.empty()) out_.camera_mask.assign(samples, 0);
    }
    return {};
  }

  Status add_markers(const data::Trial& t) {
    for (std::int64_t m = 0; m < t.markers.markers(); ++m)
      if (auto s = add_filter(t, m); !s) return s;
    for (std::int64_t f = 0; f < t.markers.frames(); ++f)
      for (std::int64_t m = 0; m < t.markers.markers(); ++m) {
        const std::int64_t frame = f + t.first_frame - out_.first_frame;
        const std::int64_t column = columns_.at(t.markers.names[at(m)]);
        if (!out_.markers.present(frame, column))
          copy_marker(t, f, m, frame, column);
        else if (t.markers.present(f, m)) {
          const double apart_m = (t.markers.x(f, m) - out_.markers.x(frame, column)).norm();
          if (apart_m > kSameSample_m)
            return differ(trials_.front(), t,
                          fmt::format("'{}' lies {:.1f} mm apart in frame {}; leave it out of one of them",
                                      t.markers.names[at(m)], 1e3 * apart_m, f + t.first_frame));
        }
      }
    return {};
  }

  /// A marker that several files hold went through one filter.
  Status add_filter(const data::Trial& t, std::int64_t m) {
    const std::string& name = t.markers.names[at(m)];
    if (out_.markers.filters.empty()) return {};
    auto& filter = out_.markers.filters[at(columns_.at(name))];
    const data::FilterUsed here = t.markers.filters.empty() ? data::FilterUsed{} : t.markers.filters[at(m)];
    const bool is_first = filtered_.insert(name).second;
    if (is_first && data::is_filter(here)) filter = here;
    if (!is_first && !same_filter(here, filter))
      return differ(trials_.front(), t,
                    fmt::format("'{}' went through different filters; leave it out of one of them", name));
    return {};
  }

  /// One sample with all that is known of it.
  void copy_marker(const data::Trial& t, std::int64_t f, std::int64_t m, std::int64_t frame,
                   std::int64_t column) {
    const auto& from = t.markers;
    const std::size_t i = from.index(f, m), j = out_.markers.index(frame, column);
    out_.markers.state[j] = from.state[i];
    out_.markers.x(frame, column) = from.x(f, m);
    copy_sample(from.covariance, i, out_.markers.covariance, j, 6);
    copy_sample(from.unfiltered_in_world, i, out_.markers.unfiltered_in_world, j, 3);
    if (const auto method = from.made_by(f, m); !method.empty())
      out_.markers.set_method(frame, column, method);
    if (!from.sample_offset_s.empty())
      out_.markers.sample_offset_s[j] =
          from.sample_offset_s[std::ssize(from.sample_offset_s) == from.markers() ? at(m) : i];
    copy_sample(t.residual_m, i, out_.residual_m, j);
    copy_sample(t.camera_mask, i, out_.camera_mask, j);
  }

  Status add_channels() {
    auto& all = out_.channels;
    for (const auto& t : trials_)
      for (std::int64_t c = 0; c < t.channels.count(); ++c) {
        const auto found = std::ranges::find(all.names, t.channels.names[at(c)]);
        if (found == all.names.end()) {
          all.names.push_back(t.channels.names[at(c)]);
          all.kinds.push_back(t.channels.kinds[at(c)]);
          all.units.push_back(t.channels.units[at(c)]);
        } else if (const auto k = at(found - all.names.begin());
                   all.kinds[k] != t.channels.kinds[at(c)] || all.units[k] != t.channels.units[at(c)]) {
          return differ(
              trials_.front(), t,
              fmt::format("channel '{}' is of another kind or unit; leave it out of one of them", *found));
        }
      }
    if (all.names.empty()) return {};
    all.rate_hz = out_.markers.time.rate_hz;
    all.frames = out_.markers.frames();
    all.values.assign(at(3 * all.frames * all.count()), kNone);
    for (const auto& t : trials_)
      for (std::int64_t c = 0; c < t.channels.count(); ++c) {
        const auto k = std::ranges::find(all.names, t.channels.names[at(c)]) - all.names.begin();
        for (std::int64_t f = 0; f < t.channels.frames; ++f)
          copy_where_missing(&t.channels.values[at(3 * (f * t.channels.count() + c))],
                             &all.values[at(3 * ((f + t.first_frame - out_.first_frame) * all.count() + k))]);
      }
    return {};
  }

  static void copy_where_missing(const double* from, double* to) {
    for (int k = 0; k < 3; ++k)
      if (std::isnan(to[k])) to[k] = from[k];
  }

  void add_analog() {
    std::vector<const data::Trial*> with;
    for (const auto& t : trials_)
      if (!t.analog.names.empty()) with.push_back(&t);
    if (with.empty()) return;
    std::ranges::sort(with, {}, [](const data::Trial* t) { return t->first_frame; });
    const auto& first = *with.front();
    const double per_frame = first.analog.rate_hz / first.markers.time.rate_hz;
    const auto per = std::llround(per_frame);
    std::int64_t next = out_.first_frame;  // frame whose analog samples come next
    data::AnalogChannels joined{
        .names = first.analog.names, .units = first.analog.units, .rate_hz = first.analog.rate_hz};
    bool fits = per > 0 && std::abs(per_frame - static_cast<double>(per)) < 1e-6;
    for (const auto* t : with) {
      const auto& a = t->analog;
      fits = fits && a.names == joined.names && a.units == joined.units && a.rate_hz == joined.rate_hz &&
             a.samples == per * t->markers.frames() && t->first_frame <= next;
      if (!fits) break;
      if (t->last_frame() < next) continue;
      joined.values.insert(joined.values.end(),
                           a.values.begin() + (next - t->first_frame) * per * std::ssize(joined.names),
                           a.values.end());
      next = t->last_frame() + 1;
    }
    if (!fits || next != out_.first_frame + out_.markers.frames()) {
      out_.warnings.push_back(
          fmt::format("{} and {} left out: the files do not hold the same ones over all frames",
                      counted(std::ssize(first.analog.names), "analog channel"),
                      counted(std::ssize(first.force_plates), "force plate")));
      return;
    }
    joined.samples = per * out_.markers.frames();
    out_.analog = std::move(joined);
    out_.force_plates = first.force_plates;
    out_.unloaded_s = first.unloaded_s;
  }

  void add_events() {
    const double half_s = 0.5 / out_.markers.time.rate_hz;
    for (const auto& t : trials_)
      for (const auto& e : t.events) {
        const bool known = std::ranges::any_of(out_.events, [&](const data::Event& o) {
          return o.label == e.label && o.context == e.context && std::abs(o.time_s - e.time_s) < half_s;
        });
        if (!known) out_.events.push_back(e);
      }
    std::ranges::stable_sort(out_.events, {}, &data::Event::time_s);
  }

  void add_the_rest() {
    auto& first = trials_.front();
    out_.source = first.source;
    out_.format = first.format;
    out_.units_in_file = first.units_in_file;
    out_.software = first.software;
    out_.foreign = std::move(first.foreign);
    add_calibration_error();
    add_beside();
    for (std::size_t i = 0; i < trials_.size(); ++i) {
      for (const auto& what : trials_[i].unread)
        out_.unread.push_back(fmt::format("{} of {}", what, trials_[i].source));
      for (const auto& warning : trials_[i].warnings)
        out_.warnings.push_back(fmt::format("{}: {}", trials_[i].source, warning));
      if (i > 0 && !trials_[i].foreign.empty())
        out_.warnings.push_back(fmt::format(
            "{} of {} left out; those of {} are kept",
            counted(std::ssize(trials_[i].foreign), "group of parameters", "groups of parameters"),
            trials_[i].source, out_.source));
    }
  }

  /// One file can be copied; what the others hold besides movement is named.
  void add_beside() {
    const auto kept = std::ranges::find_if(trials_, [](const auto& t) { return !t.beside.file.empty(); });
    if (kept == trials_.end()) return;
    out_.beside = std::move(kept->beside);
    for (auto other = std::next(kept); other != trials_.end(); ++other) {
      const auto& objects = other->beside.objects;
      if (objects.empty()) continue;
      const auto more = objects.size() > 1 ? fmt::format(" and {} more", objects.size() - 1) : std::string();
      out_.unread.push_back(
          fmt::format("what {} holds besides movement ({}{})", other->source, objects.front().path, more));
    }
  }

  /// Of one rig it is the same in all files; of several rigs nobody knows it for all markers.
  void add_calibration_error() {
    const auto text = data::to_text(trials_.front().calibration_error);
    if (std::ranges::all_of(trials_,
                            [&](const auto& t) { return data::to_text(t.calibration_error) == text; }))
      out_.calibration_error = trials_.front().calibration_error;
    else
      out_.warnings.emplace_back(
          "what calibrations leave unknown of positions is left out: the files do not hold the same");
  }

  std::vector<data::Trial>& trials_;
  std::map<std::string, std::int64_t> columns_;  ///< of the markers, by name
  std::set<std::string> filtered_;               ///< markers whose filter is settled
  data::Trial out_;
};

}  // namespace

Result<data::Trial> merge_trials(std::vector<data::Trial> trials) {
  if (trials.empty()) return fail(Code::usage, "nothing to merge");
  if (trials.size() == 1) return std::move(trials.front());
  return Merger(trials).merge();
}

}  // namespace kinemark::pipeline
