// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/gait.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/parallel.h"
#include "kinemark/core/random.h"
#include "kinemark/stages/analysis/gait/contradictions.h"
#include "kinemark/stages/analysis/gait/marker_events.h"
#include "kinemark/stages/analysis/gait/plate_events.h"
#include "kinemark/stages/analysis/gait/spatiotemporal.h"

namespace kinemark::analysis {
namespace {

using data::FootEvent;
using data::Side;

constexpr std::int64_t kPrintDraws = 19;  // that tell what noise does to a print
constexpr std::uint64_t kPrintSeed = 0x7072696e74;

// How the ground moves, as far as it does, with an error of its speed.
Eigen::RowVector2d belt_of(const GaitKind& kind, const Ground& ground, double error_m_per_s = 0.0) {
  if (!kind.belt) return {0.0, 0.0};
  return (1.0 + error_m_per_s / ground.velocity.norm()) * ground.velocity;
}

// By how much heels move while they stand, by side: variance in the stretch of a print, m^2, less what noise
// makes of it. One share for all prints, as a few tell their noise badly.
std::array<double, 2> own_variances(std::span<const GaitCycle> cycles,
                                    const std::array<double, 2>& noise_variance) {
  std::array<double, 2> sum{}, count{};
  for (const auto& cycle : cycles)
    if (const auto side = data::index_of(cycle.side); std::isfinite(cycle.print.x.x()))
      sum[side] += cycle.print.sd * cycle.print.sd, count[side] += 1.0;
  const double all = sum[0] + sum[1], noise = noise_variance[0] * count[0] + noise_variance[1] * count[1];
  const double share = all > 0.0 ? std::max(0.0, 1.0 - noise / all) : 0.0;
  for (const std::size_t side : {0, 1}) sum[side] *= share / std::max(1.0, count[side]);
  return sum;
}

// Every footprint moved by its own error; one that stands in several cycles, by the same.
void jitter(std::vector<GaitCycle>& cycles, const std::array<double, 2>& variance, Random& random) {
  std::map<std::pair<Side, double>, Eigen::Vector2d> moved;
  const auto move = [&](Side side, double strike_s, Footprint& print) {
    const auto [found, is_new] = moved.try_emplace({side, strike_s});
    if (is_new) {
      const double x = random.gaussian(), y = random.gaussian();
      found->second = std::sqrt(variance[data::index_of(side)]) * Eigen::Vector2d(x, y);
    }
    print.x += found->second;
  };
  for (auto& cycle : cycles) {
    move(cycle.side, cycle.start_s, cycle.print);
    move(cycle.side, cycle.end_s, cycle.next_print);
    if (std::isfinite(cycle.other_strike_s))
      move(data::opposite(cycle.side), cycle.other_strike_s, cycle.other_print);
  }
}

/// One number to compute: which definition, of which stretch, of which foot.
struct Slot {
  const GaitDefinition* definition;
  std::size_t region;
  Side side;  // each_side: whose
};

class GaitMeasurement {
 public:
  GaitMeasurement(const GaitSmoother& smoother, const MarkerEvents& markers, const EventsFound& found,
                  const TimeBase& time, const GaitOptions& options)
      : smoother_(smoother), markers_(markers), found_(found), time_(time), options_(options) {
    regions_ = options.regions;
    if (regions_.empty())
      regions_.push_back({.first_frame = time.number(0), .last_frame = time.number(time.frames - 1)});
    for (std::size_t r = 0; r < regions_.size(); ++r)
      for (const auto& definition : gait_definitions()) {
        const auto& asked = options.measures;
        if (!asked.empty() && std::ranges::find(asked, definition.what.id) == asked.end()) continue;
        slots_.push_back({&definition, r, Side::left});
        if (definition.scope == GaitScope::each_side) slots_.push_back({&definition, r, Side::right});
      }
  }

  void measure(Gait& out) {
    const auto& paths = smoother_.paths();
    strides_ = find_strides(found_.events);
    out.cycles = analysis::cycles_of(paths, found_.events, strides_, belt_of(markers_.kind, markers_.belt),
                                     backward());
    const auto values = values_of(out.cycles);
    const auto refits = at(options_.refits);
    if (refits > 0) noise_alone_ = measure_noise();
    own_variances_ = own_variances(out.cycles, noise_alone_.print);
    std::vector<std::vector<double>> deviations(slots_.size(), std::vector<double>(refits));
    std::vector<std::vector<double>> noise(found_.events.size(), std::vector<double>(refits));
    parallel_for(options_.refits, 1, options_.threads, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t k = begin; k < end; ++k) {
        const auto again = refit(k, noise);
        for (std::size_t i = 0; i < slots_.size(); ++i)
          deviations[i][at(k)] = slots_[i].definition->is_deviation()
                                     ? again[i] * again[i] - values[i] * values[i]
                                     : again[i] - values[i];
      }
    });
    out.events = found_.events;
    for (std::size_t i = 0; i < out.events.size() && refits > 0; ++i)
      out.events[i].sd_s = std::hypot(out.events[i].sd_s, event_noise(noise[i]));
    for (std::size_t i = 0; i < slots_.size(); ++i) state(slots_[i], values[i], deviations[i], out);
  }

 private:
  [[nodiscard]] bool backward() const { return markers_.kind.direction == GaitDirection::backward; }

  std::vector<GaitCycle> cycles_in(std::span<const GaitCycle> cycles, std::size_t region) const {
    std::vector<GaitCycle> out;
    for (const auto& cycle : cycles)
      if (time_.number(time_.nearest_frame(cycle.start_s)) >= regions_[region].first_frame &&
          time_.number(time_.nearest_frame(cycle.end_s)) <= regions_[region].last_frame)
        out.push_back(cycle);
    return out;
  }

  std::vector<GaitCycle> cycles_of(const Slot& slot, std::span<const GaitCycle> cycles) const {
    auto out = cycles_in(cycles, slot.region);
    if (slot.definition->scope == GaitScope::body) return out;
    const Side of = slot.definition->of_other ? data::opposite(slot.side) : slot.side;
    std::erase_if(out, [of](const auto& cycle) { return cycle.side != of; });
    return out;
  }

  std::vector<double> values_of(std::span<const GaitCycle> cycles) const {
    std::vector<double> out;
    for (const auto& slot : slots_) out.push_back(slot.definition->value(cycles_of(slot, cycles)));
    return out;
  }

  // What noise by itself does to footprints and to the belt.
  struct NoiseAlone {
    std::array<double, 2>
        print{};        // variance of a standing heel within the stretch of its print, m^2, by side
    double belt = 0.0;  // squared half of what heels and toes differ by, (m/s)^2
  };
  NoiseAlone measure_noise() const {
    NoiseAlone out;
    std::array<double, 2> count{};
    for (std::int64_t k = 0; k < kPrintDraws; ++k) {
      const auto paths = smoother_.noise_alone(options_.seed ^ kPrintSeed, k);
      for (const auto& cycle : analysis::cycles_of(paths, found_.events, strides_, {0.0, 0.0}))
        if (const auto side = data::index_of(cycle.side); std::isfinite(cycle.print.x.x()))
          out.print[side] += cycle.print.sd * cycle.print.sd, count[side] += 1.0;
      const double apart = belt_velocity(paths, markers_.steps, Ground{}).sd;
      out.belt += apart * apart / static_cast<double>(kPrintDraws);
    }
    for (const std::size_t side : {0, 1}) out.print[side] /= std::max(1.0, count[side]);
    return out;
  }

  // What a belt of changing speed is ahead of itself by, as each stance errs by what they scatter by.
  math::SeriesMatrix pace_error(std::int64_t k, const GaitPaths& paths) const {
    Random random(options_.seed, mix64(0x62656c74) ^ static_cast<std::uint64_t>(k));
    auto pace = markers_.pace;
    const double scatter = pace.scatter();
    for (double& x : pace.m_per_s) x = scatter * random.gaussian();
    return pace.ahead_of(0.0, paths.frames(), paths.rate_hz);
  }

  // All values of a simulated recording; `noise` gets what its noise does to each event, NaN where it is not
  // found.
  std::vector<double> refit(std::int64_t k, std::vector<std::vector<double>>& noise) const {
    auto paths = smoother_.with_noise(options_.seed, k);
    const bool even = markers_.pace.m_per_s.empty();
    if (!even) paths.go_back(pace_error(k, paths));
    const auto ground = ground_velocity(paths, markers_.ground.velocity);
    const auto again = find_edges_again(paths, markers_.steps, ground.velocity, markers_.edges);
    const bool running = markers_.kind.manner != GaitManner::walk;
    Random random(options_.seed, mix64(0x6576656e74) ^ static_cast<std::uint64_t>(k));
    std::array<double, 2> of_kind{};
    std::array<std::array<double, 2>, 2> of_foot{};  // by side
    for (const FootEvent what : data::kFootEvents) of_kind[data::index_of(what)] = random.gaussian();
    for (auto& side : of_foot)
      for (double& draw : side) draw = random.gaussian();
    auto events = found_.events;
    for (std::size_t i = 0; i < events.size(); ++i) {
      auto& event = events[i];
      const auto what = data::index_of(event.what);
      const auto& error = found_.error[i];
      if (found_.edge[i] >= 0) {
        const auto& edge = again[at(found_.edge[i])];
        const double after = fuse(edge.after_s, edge.what, running, paths.foot(edge.side).set, 0.0).after_s;
        noise[i][at(k)] = paths.time_s(edge.frame) + after - found_.offset[what].offset_s - event.time_s;
      }
      event.time_s += noise[i][at(k)] + error.kind_s * of_kind[what] +
                      error.foot_s * of_foot[data::index_of(event.side)][what] +
                      error.own_s * random.gaussian();
    }
    const double belt_variance = markers_.belt.sd * markers_.belt.sd - noise_alone_.belt;
    const double belt_error = std::sqrt(std::max(0.0, belt_variance)) * random.gaussian();
    const auto belt = even ? belt_velocity(paths, markers_.steps, ground) : markers_.belt;
    // What this recording would not have shown, no cycle begins or ends with.
    auto cycles =
        analysis::cycles_of(paths, events, strides_, belt_of(markers_.kind, belt, belt_error), backward());
    jitter(cycles, own_variances_, random);
    return values_of(cycles);
  }

  void state(const Slot& slot, double value, std::span<const double> deviations, Gait& out) const {
    const auto& definition = *slot.definition;
    const bool asked = !options_.measures.empty();
    // Which side is left along the way depends on whether it is gone forward.
    const bool doubted = markers_.kind.direction_doubted && definition.what.id == "step_width";
    if (doubted) value = kNaN;
    if (!std::isfinite(value) && !asked) return;
    const auto cycles = cycles_of(slot, out.cycles);
    data::Measure measure{
        .id = std::string(definition.what.id),
        .context = definition.scope == GaitScope::each_side ? std::string(data::to_string(slot.side)) : "",
        .region = regions_[slot.region].name,
        .quantity = definition.what.quantity,
        .value = value};
    if (!cycles.empty()) {
      measure.start_s = std::ranges::min(cycles, {}, &GaitCycle::start_s).start_s;
      measure.end_s = std::ranges::max(cycles, {}, &GaitCycle::end_s).end_s;
    }
    measure.interval.level = options_.level;
    measure.method =
        fmt::format("{} stride{}, {} refits", cycles.size(), cycles.size() == 1 ? "" : "s", options_.refits);
    if (!std::isfinite(value)) {
      if (doubted)
        measure.remark = "forward or backward cannot be known, and so its sign";
      else if (cycles.empty())
        measure.remark = definition.of_other ? "no stride of the other foot was seen whole"
                                             : "no stride was seen from strike to strike";
      else
        measure.remark = definition.is_deviation() ? "too few strides show what it needs"
                                                   : "what it needs was not seen in any stride";
    } else if (options_.refits > 0) {
      const auto pivoted = definition.interval(value, deviations, options_.level);
      if (std::isfinite(pivoted.value)) {
        measure.uncorrected = value;
        measure.value = pivoted.value;
        measure.sd = pivoted.sd;
        measure.interval.kind = data::IntervalKind::two_sided;
        measure.interval.low = pivoted.low;
        measure.interval.high = pivoted.high;
        if (definition.is_deviation() && pivoted.low <= 0.0) {
          measure.interval.kind = data::IntervalKind::at_most;
          measure.interval.low = kNaN;
          measure.remark = "not distinguishable from 0";
        }
      } else {
        measure.remark = "no interval: more than a tenth of the refits do not determine it";
      }
    }
    out.measures.push_back(std::move(measure));
  }

  const GaitSmoother& smoother_;
  const MarkerEvents& markers_;
  const EventsFound& found_;
  TimeBase time_;
  const GaitOptions& options_;
  std::vector<data::Region> regions_;
  std::vector<Slot> slots_;
  std::vector<Stride> strides_;
  NoiseAlone noise_alone_;
  std::array<double, 2> own_variances_{};  // of standing heels
};

// How many events come from where, how sources agree, and strikes between which one is missing.
void note_events(const EventsFound& found, Gait& out) {
  for (const FootEvent what : data::kFootEvents) {
    std::string by;
    for (const auto source :
         {data::EventSource::plate, data::EventSource::kinematics, data::EventSource::file}) {
      const auto count = std::ranges::count_if(
          found.events, [&](const auto& event) { return event.what == what && event.source == source; });
      if (count > 0)
        by += fmt::format("{}{} by {}", by.empty() ? "" : ", ", count,
                          source == data::EventSource::plate        ? "plates"
                          : source == data::EventSource::kinematics ? "markers"
                                                                    : "the file");
    }
    if (!by.empty()) out.notes.push_back(fmt::format("{}: {}", data::to_string(what), by));
  }
  std::ranges::copy(found.notes, std::back_inserter(out.notes));
  for (const auto& agreement : found.agreement) out.notes.push_back(sentence_of(agreement));
  for (const auto& bridge : find_bridges(found.events))
    out.notes.push_back(fmt::format(
        "{} foot: no strike is found between {:.2f} and {:.2f} s, {:.1f} times the usual stride; that is no "
        "stride",
        bridge.side == Side::left ? "left" : "right", bridge.start_s, bridge.end_s, bridge.strides));
}

// The speed and stride that are said are those that are measured, where there are whole strides: one walk has
// one speed.
void take_strides(Gait& out) {
  if (out.cycles.empty()) return;
  out.kind.longer_than_s = kNaN;
  for (const auto& definition : gait_definitions()) {
    const double value = definition.scope == GaitScope::body ? definition.value(out.cycles) : kNaN;
    if (definition.what.id == "gait_speed" && std::isfinite(value)) out.kind.speed_m_per_s = value;
    if (definition.what.id == "cadence" && std::isfinite(value)) out.kind.stride_s = 2.0 / value;
  }
}

// "-y" of the axis that is nearest.
std::string axis_name(const Eigen::Vector3d& direction) {
  Eigen::Index axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  return fmt::format("{}{}", direction[axis] < 0.0 ? "-" : "", "xyz"[axis]);
}

// What contradicts something that is measured here; labels count where events are those of the file.
void take_contradictions(const Contradictions& against, const FileEvents& of_file, const EventsFound& found,
                         Gait& out) {
  const auto add = [](const std::vector<std::string>& from, std::vector<std::string>& to) {
    std::ranges::copy(from, std::back_inserter(to));
  };
  for (const auto* said : {&against.plates, &of_file.notes}) add(*said, out.notes);
  for (const auto* said : {&against.names, &against.plates}) add(*said, out.contradicted);
  const bool by_file = std::ranges::any_of(
      found.events, [](const auto& event) { return event.source == data::EventSource::file; });
  if (by_file)
    for (const auto* said : {&of_file.notes, &against.labels}) add(*said, out.contradicted);
}

}  // namespace

double event_noise(std::span<const double> moved_s) {
  double squares = 0.0;
  std::size_t found = 0;
  for (const double moved : moved_s)
    if (std::isfinite(moved)) squares += moved * moved, ++found;
  const bool enough = found > 0 && 10 * (moved_s.size() - found) <= moved_s.size();
  return enough ? std::sqrt(squares / static_cast<double>(found)) : kNaN;
}

Result<Gait> analyze_gait(const data::Trajectories& markers, const GaitEvidence& evidence,
                          const GaitOptions& options) {
  const auto which = find_gait_markers(markers, options.markers);
  if (!which) return std::unexpected(which.error());
  auto smoother = GaitSmoother::create(markers, *which, options.noise_sd_m, options.up);
  if (!smoother) return std::unexpected(smoother.error());
  const auto of_markers = find_marker_events(*smoother, *which);
  if (!of_markers) return std::unexpected(of_markers.error());
  if (const auto standing = smoother->standing(); options.up && !options.up->isApprox(standing))
    return fail(Code::bad_input,
                fmt::format("{} is stated to point up, the pelvis stands above the feet along {}",
                            axis_name(*options.up), axis_name(standing)));
  const bool by_markers = options.choice == EventChoice::best || options.choice == EventChoice::kinematics;
  if (by_markers && !of_markers->kind.not_gait.empty())
    return fail(Code::bad_input, "not locomotion: " + of_markers->kind.not_gait);
  Gait out{.kind = of_markers->kind, .person = which->person};
  out.treadmill = out.kind.belt, out.belt_speed_m_per_s = out.kind.belt_m_per_s;
  std::ranges::copy(which->notes, std::back_inserter(out.notes));
  std::ranges::move(findings_of(*smoother, *of_markers), std::back_inserter(out.notes));
  PlateEvents of_plates;
  if (evidence.plates != nullptr)
    of_plates = find_plate_events(*evidence.plates, smoother->in_laboratory(), smoother->upright());
  std::ranges::move(of_plates.notes, std::back_inserter(out.notes));
  auto of_file = events_of_file(evidence.events, markers.time);
  const auto found = find_gait_events(*of_markers, of_plates.events, of_file.events, options.choice);
  take_contradictions(find_contradictions(*smoother, *of_markers, evidence, of_file.events, NamesOf::sides),
                      of_file, found, out);
  if (found.events.empty())
    return fail(Code::bad_input, fmt::format("there are no events of feet by {}", to_string(options.choice)));
  out.agreement = found.agreement;
  out.out_of_step = found.out_of_step;
  note_events(found, out);
  if (options.refits > 0) {
    smoother->find_noise(options.threads);
    std::ranges::move(smoother->noise().sentences(), std::back_inserter(out.notes));
    out.noises = smoother->noise().found;
  }
  GaitMeasurement(*smoother, *of_markers, found, markers.time, options).measure(out);
  take_strides(out);
  if (out.kind.not_gait.empty()) out.notes.insert(out.notes.begin(), out.kind.sentence());
  return out;
}

}  // namespace kinemark::analysis
