// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/forces/force_measures.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "kinemark/core/counted.h"
#include "kinemark/core/index.h"
#include "kinemark/stages/analysis/forces/contacts.h"
#include "kinemark/stages/analysis/path/pivot.h"
#include "kinemark/stages/analysis/path/refits.h"

namespace kinemark::analysis {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kLongestStep_s = 3.0;
constexpr double kStanding_s = 5.0, kStandingInRegion_s = 2.0;
constexpr double kStanding_n = 100.0;
constexpr double kEdge_s = 0.08;  // of standing, at both ends of the recording
constexpr double kLowestCutOff_hz = 0.4;
constexpr double kBeside_s = 0.05;   // of a contact, where noise may move its ends
constexpr double kCopLoad_n = 20.0;  // of a plate that counts for the centre of pressure

/// Series that are smoothed and simulated together, or as they are where they show no noise.
class SmoothedSeries {
 public:
  /// @param seen  samples that tell the noise
  SmoothedSeries(SeriesMatrix x, const std::vector<bool>& seen, double rate_hz) : estimate_(x), pilot_(x) {
    const double noise = math::noise_from_differences(x, seen);
    if (!(noise > 0.0)) return;
    const std::vector<bool> all(at(x.rows()), true);
    const auto choice =
        math::choose_smoothing(x / noise, all, {.lowest = std::min(0.1, kLowestCutOff_hz / rate_hz)});
    if (!choice) return;
    recording_ =
        Recording{.x = std::move(x), .seen = all, .rate_hz = rate_hz, .noise_sd_m = noise, .choice = *choice};
    estimate_ = smoothed(*recording_, kLessSmooth);
    pilot_ = pilot_path(*recording_, 0, recording_->x.rows(), 1, 0);
  }
  [[nodiscard]] const SeriesMatrix& estimate() const { return estimate_; }
  [[nodiscard]] const SeriesMatrix& pilot() const { return pilot_; }
  [[nodiscard]] bool noisy() const { return recording_.has_value(); }
  [[nodiscard]] double cut_off_hz() const {
    return kLessSmooth * recording_->choice.half_power * recording_->rate_hz;
  }
  /// visit(number, smoothed refit, the same before it was smoothed)
  template <class Visit>
  void refit(std::int64_t refits, std::uint64_t seed, std::uint64_t stream, const Visit& visit) const {
    if (!recording_) return;
    const auto axes = pilot_.cols();
    for_each_batch(*recording_, pilot_, {.count = refits, .seed = seed, .stream = stream, .least_too = false},
                   [&](const RefitBatch& batch) {
                     for (std::int64_t k = 0; k < batch.count; ++k)
                       visit(batch.first + k, SeriesMatrix(batch.less.middleCols(axes * k, axes)),
                             SeriesMatrix(batch.simulated.middleCols(axes * k, axes)));
                   });
  }

 private:
  std::optional<Recording> recording_;
  SeriesMatrix estimate_, pilot_;
};

Eigen::MatrixX3d triples(const Array<double>& values) {
  return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>>(
      values.data(), static_cast<Index>(values.size() / 3), 3);
}

/// The axis along which all plates push most; 0 where none does.
Eigen::Vector3d up_of_forces(const data::Wrenches& plates) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& plate : plates.items) {
    const Eigen::MatrixX3d force = triples(plate.force);
    for (Index f = 0; f < force.rows(); ++f)
      if (force.row(f).allFinite()) sum += force.row(f);
  }
  Index axis = 0;
  if (!(sum.cwiseAbs().maxCoeff(&axis) > 0.0)) return Eigen::Vector3d::Zero();
  return Eigen::Vector3d::Unit(axis) * (sum[axis] < 0.0 ? -1.0 : 1.0);
}

/// The contact in another version of its load: noise moves its ends. The same where there is none.
PlateContact contact_again(const PlateContact& contact, const VectorXd& load, double rate_hz) {
  const auto beside = static_cast<std::int64_t>(std::ceil(kBeside_s * rate_hz));
  const auto first = std::max<std::int64_t>(0, contact.first - beside),
             end = std::min<std::int64_t>(load.size(), contact.first + contact.count + beside);
  PlateContact out = contact;
  std::int64_t most = 0;
  for (auto found : find_contacts(load.segment(first, end - first), rate_hz)) {
    found.first += first;
    const auto shared = std::min(found.first + found.count, contact.first + contact.count) -
                        std::max(found.first, contact.first);
    if (shared > most) most = shared, out.first = found.first, out.count = found.count;
  }
  return out;
}

class ForceMeasurement {
 public:
  ForceMeasurement(const data::Wrenches& plates, const ForceMeasureOptions& options, ForceMeasures& out)
      : plates_(plates), options_(options), up_(up_of_forces(plates)), out_(out) {
    regions_ = options.regions;
    if (regions_.empty())
      regions_.push_back(
          {.first_frame = plates.time.number(0), .last_frame = plates.time.number(plates.frames() - 1)});
  }

  void measure() {
    if (up_.isZero()) return;
    for (std::size_t p = 0; p < plates_.items.size(); ++p) measure_steps(p);
    measure_sway();
  }

 private:
  [[nodiscard]] bool is_asked(const ForceDefinition& definition) const {
    const auto& asked = options_.measures;
    return asked.empty() || std::ranges::find(asked, definition.what.id) != asked.end();
  }

  void measure_steps(std::size_t p) {
    const auto& plate = plates_.items[p];
    const Eigen::MatrixX3d force = triples(plate.force);
    const VectorXd load = force * up_;
    std::vector<PlateContact> steps;
    int cut = 0;
    const auto contacts = find_contacts(load, plates_.time.rate_hz);
    for (const auto& contact : contacts) {
      const bool step = static_cast<double>(contact.count) / plates_.time.rate_hz <= kLongestStep_s;
      if (step && contact.whole) steps.push_back(contact);
      cut += step && !contact.whole;
    }
    if (cut > 0)
      out_.notes.push_back(
          fmt::format("{}: {} cut by an end of the recording or of what is known of it, not measured",
                      plate.name, counted(cut, "step")));
    if (steps.empty()) return;
    std::vector<bool> loaded(at(load.size()), false);
    for (const auto& contact : contacts)
      for (std::int64_t f = contact.first; f < contact.first + contact.count; ++f) loaded[at(f)] = true;
    SeriesMatrix known = force;
    for (Index f = 0; f < known.rows(); ++f)
      if (!known.row(f).allFinite()) known.row(f).setZero();
    const SmoothedSeries series(std::move(known), loaded, plates_.time.rate_hz);
    const Eigen::MatrixX3d pressure = triples(plate.point);
    for (const auto& region : regions_) {
      std::int64_t number = 0;
      for (const auto& contact : steps) {
        if (plates_.time.number(contact.first) < region.first_frame ||
            plates_.time.number(contact.first + contact.count - 1) > region.last_frame)
          continue;
        measure_step(p, contact, region, number++, series,
                     direction_of_travel(pressure.middleRows(contact.first, contact.count),
                                         load.segment(contact.first, contact.count)));
      }
    }
  }

  // Whose foot comes to the plate within 50 ms of the contact.
  [[nodiscard]] std::string side_of(const std::string& plate, const PlateContact& contact) const {
    constexpr double kSame_s = 0.05;
    const double begin = plates_.time.time_s(contact.first);
    for (const auto& event : options_.events)
      if (event.source == data::EventSource::plate && event.what == data::FootEvent::strike &&
          event.method == plate && std::abs(event.time_s - begin) < kSame_s)
        return std::string(data::to_string(event.side));
    return {};
  }

  void measure_step(std::size_t p, const PlateContact& contact, const data::Region& region,
                    std::int64_t number, const SmoothedSeries& series, Eigen::Vector3d travel) {
    travel -= up_.dot(travel) * up_;
    // As it was found, and in simulated recordings where their noise puts its ends.
    const auto view_of = [&](const SeriesMatrix& x, const SeriesMatrix* samples) {
      const auto ends =
          samples == nullptr ? contact : contact_again(contact, *samples * up_, plates_.time.rate_hz);
      const Eigen::MatrixX3d force = x.middleRows(ends.first, ends.count);
      return ForceView{.force = force,
                       .load = force * up_,
                       .travel = travel,
                       .pressure = {},
                       .rate_hz = plates_.time.rate_hz};
    };
    data::Measure like{.subject = plates_.items[p].name,
                       .context = side_of(plates_.items[p].name, contact),
                       .region = region.name,
                       .cycle = number,
                       .start_s = plates_.time.time_s(contact.first),
                       .end_s = plates_.time.time_s(contact.first + contact.count - 1)};
    state(ForceScope::step, like, series, view_of, 2 * p + 1);
  }

  // Centre of pressure of all plates together, level; NaN where they bear too little.
  [[nodiscard]] SeriesMatrix level_pressure(VectorXd& load) const {
    const auto frames = plates_.frames();
    SeriesMatrix out = SeriesMatrix::Zero(frames, 2);
    load = VectorXd::Zero(frames);
    Index axis = 0;
    up_.cwiseAbs().maxCoeff(&axis);
    const std::array<Index, 2> level{axis == 0 ? 1 : 0, axis == 2 ? 1 : 2};
    for (const auto& plate : plates_.items)
      for (std::int64_t f = 0; f < frames; ++f) {
        const Eigen::Map<const Eigen::Vector3d> force(plate.force.data() + 3 * f),
            x(plate.point.data() + 3 * f);
        const double bears = force.dot(up_);
        if (std::isnan(bears)) load[f] = kNaN;
        if (!(bears > kCopLoad_n) || !x.allFinite()) continue;
        load[f] += bears;
        for (Index i = 0; i < 2; ++i) out(f, i) += bears * x[level[at(i)]];
      }
    for (std::int64_t f = 0; f < frames; ++f)
      out.row(f) =
          load[f] > 0.0 ? Eigen::RowVector2d(out.row(f) / load[f]) : Eigen::RowVector2d::Constant(kNaN);
    return out;
  }

  void measure_sway() {
    VectorXd load;
    const SeriesMatrix pressure = level_pressure(load);
    const auto edge = static_cast<std::int64_t>(std::ceil(kEdge_s * plates_.time.rate_hz));
    for (const auto& region : regions_) {
      const auto begin = std::max(region.first_frame - plates_.time.number(0), edge),
                 end = std::min(region.last_frame - plates_.time.number(0) + 1, plates_.frames() - edge);
      const double least_s = options_.regions.empty() ? kStanding_s : kStandingInRegion_s;
      if (static_cast<double>(end - begin) < least_s * plates_.time.rate_hz) continue;
      // The stretch and its edges, which the smoother needs.
      const auto first = begin - edge, count = end - begin + 2 * edge;
      bool stands = true;
      for (std::int64_t f = first; f < first + count; ++f) stands = stands && load[f] > kStanding_n;
      if (!stands) continue;
      const SmoothedSeries series(pressure.middleRows(first, count), std::vector<bool>(at(count), true),
                                  plates_.time.rate_hz);
      const auto view_of = [&](const SeriesMatrix& x, const SeriesMatrix*) {
        return ForceView{.force = {},
                         .load = {},
                         .travel = Eigen::Vector3d::Zero(),
                         .pressure = x.middleRows(edge, end - begin),
                         .rate_hz = plates_.time.rate_hz};
      };
      data::Measure like{.subject = "centre of pressure",
                         .region = region.name,
                         .start_s = plates_.time.time_s(begin),
                         .end_s = plates_.time.time_s(end - 1)};
      state(ForceScope::sway, like, series, view_of, 2 * static_cast<std::uint64_t>(begin) + 2);
    }
  }

  // All measures of that scope, of the estimate and of refits.
  template <class ViewOf>
  void state(ForceScope scope, const data::Measure& like, const SmoothedSeries& series, const ViewOf& view_of,
             std::uint64_t stream) {
    std::vector<const ForceDefinition*> asked;
    for (const auto& definition : force_definitions())
      if (definition.scope == scope && is_asked(definition)) asked.push_back(&definition);
    const auto values_of = [&](const SeriesMatrix& x, const SeriesMatrix* samples) {
      const auto view = view_of(x, samples);
      std::vector<double> values;
      for (const auto* definition : asked) values.push_back(definition->value(view));
      return values;
    };
    const auto values = values_of(series.estimate(), nullptr),
               truth = values_of(series.pilot(), &series.pilot());
    std::vector<std::vector<double>> deviations(asked.size(), std::vector<double>(at(options_.refits), kNaN));
    series.refit(options_.refits, options_.seed, stream,
                 [&](std::int64_t k, const SeriesMatrix& x, const SeriesMatrix& samples) {
                   const auto again = values_of(x, &samples);
                   for (std::size_t i = 0; i < asked.size(); ++i) deviations[i][at(k)] = again[i] - truth[i];
                 });
    for (std::size_t i = 0; i < asked.size(); ++i) put(*asked[i], like, values[i], deviations[i], series);
  }

  // Why a measure has no value.
  [[nodiscard]] static std::string no_value(const ForceDefinition& definition) {
    if (definition.scope == ForceScope::sway) return "the centre of pressure does not move";
    if (definition.what.quantity == data::Quantity::impulse)
      return "no direction of travel: the centre of pressure runs by less than 20 mm or is not known";
    return definition.what.quantity == data::Quantity::force_rate
               ? "the load is above a fifth of its peak from the first frame on"
               : "the load has no two humps";
  }

  void put(const ForceDefinition& definition, data::Measure measure, double value,
           const std::vector<double>& deviations, const SmoothedSeries& series) {
    measure.id = definition.what.id;
    measure.quantity = definition.what.quantity;
    measure.interval.level = options_.level;
    measure.method = series.noisy() ? fmt::format("smoothed at {:.3g} Hz", series.cut_off_hz()) : "as it is";
    if (!std::isfinite(value)) {
      if (options_.measures.empty()) return;
      measure.remark = no_value(definition);
      out_.measures.push_back(std::move(measure));
      return;
    }
    measure.value = measure.uncorrected = value;
    if (definition.what.id == "grf_contact_time") {
      // From frame to frame: at most one of each end.
      const double half = 1.0 / plates_.time.rate_hz;
      measure.sd = half / std::sqrt(6.0);
      measure.interval = {.kind = data::IntervalKind::two_sided,
                          .low = value - half,
                          .high = value + half,
                          .level = options_.level};
      measure.method = "frames";
      out_.measures.push_back(std::move(measure));
      return;
    }
    if (options_.refits == 0 || !series.noisy()) {
      measure.remark =
          options_.refits == 0 ? "no interval was asked for" : "no interval: the samples show no noise";
    } else if (const auto found = wide_pivot(value, deviations, options_.level); std::isfinite(found.value)) {
      measure.value = found.value;
      measure.sd = found.sd;
      measure.interval.kind = data::IntervalKind::two_sided;
      measure.interval.low = found.low;
      measure.interval.high = found.high;
      measure.interval.approximate = definition.scope == ForceScope::sway;
      measure.method += fmt::format(", {} refits", options_.refits);
    } else {
      measure.remark = "no interval: too many of the refits do not determine it";
    }
    out_.measures.push_back(std::move(measure));
  }

  const data::Wrenches& plates_;
  const ForceMeasureOptions& options_;
  Eigen::Vector3d up_;
  std::vector<data::Region> regions_;
  ForceMeasures& out_;
};

}  // namespace

Result<ForceMeasures> measure_forces(const data::Wrenches& plates, const ForceMeasureOptions& options) {
  if (auto s = plates.validate(); !s) return std::unexpected(s.error());
  ForceMeasures out;
  ForceMeasurement(plates, options, out).measure();
  if (out.measures.empty())
    return fail(Code::bad_input,
                fmt::format("nobody steps wholly on a plate, nor stands on plates for {:g} s{}",
                            options.regions.empty() ? kStanding_s : kStandingInRegion_s,
                            out.notes.empty() ? "" : "; " + out.notes.front()));
  return out;
}

}  // namespace kinemark::analysis
