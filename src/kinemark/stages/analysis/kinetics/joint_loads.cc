// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/kinetics/joint_loads.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/math/smoothing_choice.h"
#include "kinemark/stages/analysis/kinetics/internal/joint_mechanics.h"
#include "kinemark/stages/analysis/kinetics/internal/smooth_markers.h"
#include "kinemark/stages/analysis/path/path_samples.h"
#include "kinemark/stages/analysis/path/refits.h"

namespace kinemark::analysis {
namespace {

using internal::FrameValues;
using internal::JointMechanics;
using internal::LoadOutputs;
using internal::SmoothMarkers;
using State = data::SampleState;

constexpr std::int64_t kLeastRefits = 20;
constexpr std::uint64_t kPlateStream = 1ULL << 40;

/// Noise of the wrenches that feet bear.
class FloorNoise {
 public:
  explicit FloorNoise(const FloorLoad& load) : load_(load) {
    const auto frames = load.wrench.force.rows();
    seen_.assign(at(frames), false);
    for (const auto& contact : load.contacts) {
      // Landing and leaving are quicker than noise.
      const auto edge = contact.count / 8;
      for (auto f = contact.first + edge; f < contact.first + contact.count - edge; ++f) seen_[at(f)] = true;
    }
    const double force = math::noise_from_differences(load.wrench.force, seen_);
    const double moment = math::noise_from_differences(load.wrench.moment, seen_);
    force_n_ = std::isfinite(force) ? force : 0.0;
    moment_nm_ = std::isfinite(moment) ? moment : 0.0;
    for (const auto& contact : load.contacts)
      for (auto f = contact.first; f < contact.first + contact.count; ++f) seen_[at(f)] = true;
  }
  [[nodiscard]] WrenchTrack refit(std::uint64_t seed, std::uint64_t stream, std::int64_t number) const {
    return {.force = with_noise(load_.wrench.force, seen_, force_n_, seed, kPlateStream + 2 * stream, number),
            .moment = with_noise(load_.wrench.moment, seen_, moment_nm_, seed, kPlateStream + 2 * stream + 1,
                                 number)};
  }

 private:
  const FloorLoad& load_;
  std::vector<bool> seen_;
  double force_n_ = 0.0, moment_nm_ = 0.0;
};

/// Sums of refits, about the estimate.
struct Spread {
  Eigen::MatrixXd sum, squares;

  void add(const Eigen::MatrixXd& deviation) {
    if (sum.size() == 0) sum = squares = Eigen::MatrixXd::Zero(deviation.rows(), deviation.cols());
    sum += deviation;
    squares += deviation.cwiseAbs2();
  }
  [[nodiscard]] double sd(std::int64_t row, std::int64_t column, std::int64_t refits) const {
    const auto n = static_cast<double>(refits);
    const double mean = sum(row, column) / n;
    return std::sqrt(std::max(0.0, squares(row, column) / n - mean * mean) * n / (n - 1.0));
  }
};

/// What of a recording an output can be told from.
class Presence {
 public:
  explicit Presence(const data::Trajectories& markers)
      : markers_(markers), seen_(at(markers.markers()), {markers.frames(), -1}) {
    for (std::int64_t f = 0; f < markers.frames(); ++f)
      for (std::int64_t m = 0; m < markers.markers(); ++m)
        if (markers.present(f, m)) seen_[at(m)] = {std::min(seen_[at(m)].first, f), f};
  }

  /// Of a frame for outputs that depend on these markers and on nine frames.
  [[nodiscard]] State of(const std::set<std::int64_t>& used, std::int64_t f) const {
    const std::int64_t begin = f - kDerivativeMargin, last = f + kDerivativeMargin;
    if (begin < 0 || last >= markers_.frames()) return State::missing;
    State worst = State::measured;
    for (const auto m : used) {
      if (!markers_.present(f, m) || seen_[at(m)].first > begin || seen_[at(m)].second < last)
        return State::missing;
      for (auto g = begin; g <= last; ++g)
        if (markers_.state[markers_.index(g, m)] != State::measured) worst = State::interpolated;
    }
    return worst;
  }

 private:
  const data::Trajectories& markers_;
  std::vector<std::pair<std::int64_t, std::int64_t>> seen_;  // first and last frame of each marker
};

SegmentSeries series_of(std::string name, std::vector<std::string> labels, std::string unit,
                        std::int64_t frames) {
  SegmentSeries out{.name = std::move(name),
                    .labels = std::move(labels),
                    .quantity = SubjectQuantity::number,
                    .unit = std::move(unit)};
  out.value.assign(at(frames) * out.size(), kNaN);
  out.sd.assign(at(frames) * out.size(), kNaN);
  out.state.assign(at(frames), State::missing);
  return out;
}

std::vector<std::string> labels_of(const std::array<SegmentDefinition::AxisComponent, 3>& components) {
  return {components[0].label, components[1].label, components[2].label};
}

/// Formulas with one of the subject's measures larger, and smaller, by its deviation.
using MovedTracks = std::vector<std::pair<FormulaTracks, FormulaTracks>>;

Result<MovedTracks> moved_tracks(const SegmentDefinition& d, const SegmentInput& input,
                                 const SegmentOptions& options, const LoadOutputs& outputs,
                                 const FormulaTracks& tracks) {
  MovedTracks out;
  for (const auto& used : tracks.constant_parameters()) {
    SegmentInput plus = input, minus = input;
    plus.given.insert(plus.given.begin(), {used.name, used.value + used.sd, used.from});
    minus.given.insert(minus.given.begin(), {used.name, used.value - used.sd, used.from});
    auto larger = FormulaTracks::create(d, plus, options, outputs.list);
    if (!larger) return std::unexpected(larger.error());
    auto smaller = FormulaTracks::create(d, minus, options, outputs.list);
    if (!smaller) return std::unexpected(smaller.error());
    out.emplace_back(std::move(*larger), std::move(*smaller));
  }
  return out;
}

/// The work of find_joint_loads().
class LoadFinder {
 public:
  LoadFinder(const SegmentDefinition& d, const SegmentInput& input, const data::Wrenches& plates,
             const JointLoadOptions& options, const LoadOutputs& outputs, const FormulaTracks& tracks,
             const MovedTracks& moved)
      : d_(d),
        markers_(*input.markers),
        plates_(plates),
        options_(options),
        outputs_(outputs),
        tracks_(tracks),
        moved_(moved),
        mechanics_(d, tracks, outputs, options),
        smooth_(markers_, used_markers(), options.segments.noise_sd_m, input.noise,
                options.segments.threads) {}

  JointLoads find() {
    JointLoads out;
    out.warnings = tracks_.lack_sentences(lacking_names());
    const auto values = mechanics_.values_of(smooth_.paths());
    const FloorLoads floor = floor_of(values);
    std::ranges::copy(floor.notes, std::back_inserter(out.warnings));
    std::vector<FloorNoise> noise;
    noise.reserve(feet_.size());
    for (std::size_t i = 0; i < feet_.size(); ++i) {
      noise.emplace_back(floor.feet[i]);
      for (const auto& contact : floor.feet[i].contacts)
        out.steps.push_back({.body = d_.bodies[feet_[i]].name,
                             .plate = plates_.items[contact.plate].name,
                             .begin_s = markers_.time.time_s(contact.first),
                             .end_s = markers_.time.time_s(contact.first + contact.count - 1)});
    }
    std::vector<WrenchTrack> loads;
    for (const auto& foot : floor.feet) loads.push_back(foot.wrench);
    const auto estimates = all_loads(mechanics_, values, loads);
    const auto constant = constant_variance(estimates, loads);
    std::vector<Spread> spread(estimates.size());
    for (std::int64_t k = 0; k < options_.refits; ++k) {
      const auto again = mechanics_.values_of(smooth_.refit(options_.seed, k));
      for (std::size_t i = 0; i < loads.size(); ++i) loads[i] = noise[i].refit(options_.seed, i, k);
      const auto refit = all_loads(mechanics_, again, loads);
      for (std::size_t i = 0; i < estimates.size(); ++i) spread[i].add(refit[i] - estimates[i]);
    }
    store(floor, estimates, spread, constant, values, out);
    return out;
  }

 private:
  [[nodiscard]] std::set<std::int64_t> used_markers() const {
    std::set<std::int64_t> out;
    for (std::size_t i = 0; i < outputs_.list.size(); ++i)
      for (const auto m : tracks_.markers_of(i)) out.insert(m);
    return out;
  }
  // Joints that cannot be computed, by the first thing that each lacks.
  [[nodiscard]] std::vector<std::string> lacking_names() const {
    std::vector<std::string> names(outputs_.list.size());
    const auto blame = [&](std::size_t first, std::size_t end, const std::string& name) {
      for (auto i = first; i < end; ++i) {
        if (tracks_.lacks(i).empty()) continue;
        names[i] += names[i].empty() ? name : ", " + name;
        return true;
      }
      return false;
    };
    for (std::size_t i = 0; i < d_.joints.size(); ++i) {
      if (mechanics_.has_joint(i)) continue;
      const std::string name = d_.joints[i].name + "Moment";
      const auto& j = outputs_.joints[i];
      bool found = blame(j.centre, j.per + 1, name);
      for (const auto& body : d_.joints[i].bodies) {
        const auto b = mechanics_.index_of_body(body);
        found = found ||
                blame(outputs_.bodies[b].mass, outputs_.bodies[b].floor + d_.bodies[b].floor.size(), name);
      }
    }
    return names;
  }

  FloorLoads floor_of(const FrameValues& values) {
    std::vector<FootTrack> feet;
    for (std::size_t b = 0; b < d_.bodies.size(); ++b) {
      if (!mechanics_.has_foot(b)) continue;
      feet_.push_back(b);
      feet.push_back(mechanics_.foot_of(b, values));
    }
    return find_floor_loads(plates_, feet, options_.segments.up);
  }

  // What constant errors of the subject's measures add to the variance of each load.
  [[nodiscard]] std::vector<Eigen::MatrixXd> constant_variance(const std::vector<Eigen::MatrixXd>& estimates,
                                                               const std::vector<WrenchTrack>& feet) const {
    std::vector<Eigen::MatrixXd> out;
    for (const auto& e : estimates) out.emplace_back(Eigen::MatrixXd::Zero(e.rows(), e.cols()));
    if (options_.refits == 0) return out;
    const auto loads_by = [&](const FormulaTracks& tracks) {
      const JointMechanics mechanics(d_, tracks, outputs_, options_);
      return all_loads(mechanics, mechanics.values_of(smooth_.paths()), feet);
    };
    for (const auto& [larger, smaller] : moved_) {
      const auto plus = loads_by(larger), minus = loads_by(smaller);
      for (std::size_t i = 0; i < out.size(); ++i)
        for (Eigen::Index k = 0; k < out[i].size(); ++k) {
          const double there = *(estimates[i].data() + k);
          const double up = *(plus[i].data() + k) - there, down = *(minus[i].data() + k) - there;
          // One side may be beyond what geometry allows.
          const double step = !std::isfinite(up) ? down : !std::isfinite(down) ? up : 0.5 * (up - down);
          if (std::isfinite(step)) *(out[i].data() + k) += step * step;
        }
    }
    return out;
  }

  [[nodiscard]] std::vector<Eigen::MatrixXd> all_loads(const JointMechanics& mechanics,
                                                       const FrameValues& values,
                                                       const std::vector<WrenchTrack>& feet) const {
    std::vector<const WrenchTrack*> floor(d_.bodies.size(), nullptr);
    for (std::size_t i = 0; i < feet_.size(); ++i) floor[feet_[i]] = &feet[i];
    std::vector<Eigen::MatrixXd> out;
    for (const auto& foot : feet) out.emplace_back(foot.force);
    for (std::size_t j = 0; j < d_.joints.size(); ++j)
      if (mechanics.has_joint(j)) out.push_back(mechanics.loads_of(j, values, floor, markers_.time.rate_hz));
    return out;
  }

  // Columns [first, first + labels) of a matrix and of its spread.
  void fill(SegmentSeries& series, const Eigen::MatrixXd& values, const Spread& spread,
            const Eigen::MatrixXd& constant, std::int64_t first, const std::vector<State>& state,
            double per) const {
    for (std::int64_t f = 0; f < values.rows(); ++f) {
      if (state[at(f)] == State::missing) continue;
      for (std::size_t k = 0; k < series.size(); ++k) {
        const auto column = first + static_cast<std::int64_t>(k);
        const auto i = at(f) * series.size() + k;
        series.value[i] = values(f, column) / per;
        if (options_.refits > 0)
          series.sd[i] =
              std::hypot(spread.sd(f, column, options_.refits), std::sqrt(constant(f, column))) / per;
      }
      series.state[at(f)] =
          std::isfinite(series.value[at(f) * series.size()]) ? state[at(f)] : State::missing;
    }
  }

  void store(const FloorLoads& floor, const std::vector<Eigen::MatrixXd>& estimates,
             const std::vector<Spread>& spread, const std::vector<Eigen::MatrixXd>& constant,
             const FrameValues& values, JointLoads& out) const {
    const auto frames = markers_.frames();
    const Presence presence(markers_);
    for (std::size_t i = 0; i < feet_.size(); ++i) {
      const auto& name = d_.bodies[feet_[i]].ground_reaction;
      if (name.empty()) continue;
      std::vector<State> state(at(frames), State::measured);
      for (std::int64_t f = 0; f < frames; ++f)
        if (!floor.feet[i].known[at(f)]) state[at(f)] = State::missing;
      auto series = series_of(name, {"x", "y", "z"}, "N/kg", frames);
      fill(series, estimates[i], spread[i], constant[i], 0, state, per_of_body(feet_[i], values));
      out.series.push_back(std::move(series));
    }
    std::size_t at_estimate = feet_.size();
    for (std::size_t j = 0; j < d_.joints.size(); ++j) {
      if (!mechanics_.has_joint(j)) continue;
      const auto state = states_of(j, floor, presence);
      const auto& joint = d_.joints[j];
      const auto& estimate = estimates[at_estimate];
      const auto& always = constant[at_estimate];
      const auto& deviation = spread[at_estimate++];
      auto force = series_of(joint.name + "Force", labels_of(joint.force), "N/kg", frames);
      auto moment = series_of(joint.name + "Moment", labels_of(joint.moment), "N m/kg", frames);
      auto power = series_of(joint.name + "Power", {}, "W/kg", frames);
      fill(force, estimate, deviation, always, 0, state, 1.0);
      fill(moment, estimate, deviation, always, 3, state, 1.0);
      fill(power, estimate, deviation, always, 6, state, 1.0);
      for (auto* series : {&force, &moment, &power}) out.series.push_back(std::move(*series));
    }
  }

  // Of the first joint beyond which the body is.
  [[nodiscard]] double per_of_body(std::size_t body, const FrameValues& values) const {
    for (std::size_t j = 0; j < d_.joints.size(); ++j)
      if (mechanics_.has_joint(j) &&
          std::ranges::find(d_.joints[j].bodies, d_.bodies[body].name) != d_.joints[j].bodies.end())
        return mechanics_.per(j, values);
    return kNaN;
  }

  [[nodiscard]] std::vector<State> states_of(std::size_t joint, const FloorLoads& floor,
                                             const Presence& presence) const {
    std::set<std::int64_t> used;
    const auto take = [&](std::size_t first, std::size_t end) {
      for (auto i = first; i < end; ++i)
        for (const auto m : tracks_.markers_of(i)) used.insert(m);
    };
    take(outputs_.joints[joint].centre, outputs_.joints[joint].per + 1);
    std::vector<const FloorLoad*> loads;
    for (const auto& name : d_.joints[joint].bodies) {
      const auto b = mechanics_.index_of_body(name);
      take(outputs_.bodies[b].mass, outputs_.bodies[b].floor + d_.bodies[b].floor.size());
      const auto foot = std::ranges::find(feet_, b);
      if (foot != feet_.end()) loads.push_back(&floor.feet[at(foot - feet_.begin())]);
    }
    std::vector<State> out(at(markers_.frames()));
    for (std::int64_t f = 0; f < markers_.frames(); ++f) {
      out[at(f)] = presence.of(used, f);
      for (const auto* load : loads)
        if (!load->known[at(f)]) out[at(f)] = State::missing;
    }
    return out;
  }

  const SegmentDefinition& d_;
  const data::Trajectories& markers_;
  const data::Wrenches& plates_;
  const JointLoadOptions& options_;
  const LoadOutputs& outputs_;
  const FormulaTracks& tracks_;
  const MovedTracks& moved_;
  JointMechanics mechanics_;
  SmoothMarkers smooth_;
  std::vector<std::size_t> feet_;  // bodies that plates can bear
};

}  // namespace

Status JointLoadOptions::check() const {
  if (auto s = segments.check(); !s) return s;
  if (!(gravity >= 0.0) || !std::isfinite(gravity))
    return fail(Code::usage, fmt::format("gravity of {:g} m/s^2: expected 0 or more", gravity));
  if (refits != 0 && refits < kLeastRefits)
    return fail(Code::usage, fmt::format("{} refits: expected 0 or at least {}", refits, kLeastRefits));
  return {};
}

Result<JointLoads> find_joint_loads(const SegmentDefinition& definition, const SegmentInput& input,
                                    const data::Wrenches& plates, const JointLoadOptions& options) {
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  if (auto s = definition.check(); !s) return std::unexpected(s.error());
  if (definition.joints.empty() || plates.items.empty()) return JointLoads{};
  const LoadOutputs outputs(definition);
  const auto tracks = FormulaTracks::create(definition, input, options.segments, outputs.list);
  if (!tracks) return std::unexpected(tracks.error());
  MovedTracks moved;
  if (options.refits > 0) {
    auto made = moved_tracks(definition, input, options.segments, outputs, *tracks);
    if (!made) return std::unexpected(made.error());
    moved = std::move(*made);
  }
  return LoadFinder(definition, input, plates, options, outputs, *tracks, moved).find();
}

}  // namespace kinemark::analysis
