// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/noise_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "kinemark/core/index.h"

namespace kinemark::math {
namespace {

constexpr std::array kFrom_hz{2.0, 3.0, 4.0, 6.0, 9.0, 13.0, 18.0};
constexpr double kHighestFrom = 0.3;      // cycles per sample
constexpr double kLowestPeriods = 5.0;    // of the longest stretch
constexpr double kIndependent = 0.8;      // of the frequencies of a tapered spectrum
constexpr double kEvidenceOfFilter = 12;  // nats
constexpr double kFloorToNoise = 0.03;    // variance of a filtered recording's floor over its noise: penalty
constexpr double kLargestFloor = 0.01;    // the same: beyond it no filter is claimed
constexpr double kFloorPenalty = 50.0;
constexpr double kPriorSpread = 3.0;                  // of ln variance
constexpr double kKnownCutOff = 0.02;                 // deviation of the logarithm of a cut-off that is told
constexpr double kKnownVariance = 0.3;                // of a variance that is told
constexpr double kSpreadDrawn = 1.3;                  // times the deviations by the curvature
constexpr double kWidestDrawn = 4.0;                  // variance of a parameter that is drawn
constexpr double kNextShare = 0.4;                    // of draws from the next higher frequency
constexpr double kLeastWeight = 0.02;                 // of a model over that of the best
constexpr double kTailLeast = 5.0, kTailMore = 7.0;   // exponents of a tail by a power
constexpr double kFallLeast = 3.0, kFallMore = 17.0;  // of an exponential tail, over the lowest frequency

// Parameters by their place; -1: the model has none of these.
struct Sites {
  int variance = 0, memory = -1, cut_off = -1, floor = -1, tail = -1, slope = -1, count = 0;
};

// What the movement has above the lowest frequency. One form alone is not enough: a power falls slower than
// movements without jumps do, and takes what lies under its end from noise that is slow.
enum class Tail : std::uint8_t { none, power, exponential };

struct Kind {
  NoiseKind kind;
  LowPass form = LowPass::butterworth;
  int order = 0;
  Tail moves = Tail::power;

  [[nodiscard]] Sites sites() const {
    Sites out;
    int next = 1;
    if (kind == NoiseKind::correlated || kind == NoiseKind::correlated_and_white) out.memory = next++;
    if (kind == NoiseKind::filtered) out.cut_off = next++;
    if (kind == NoiseKind::filtered || kind == NoiseKind::correlated_and_white) out.floor = next++;
    if (moves != Tail::none) out.tail = next++, out.slope = next++;
    out.count = next;
    return out;
  }
};

constexpr std::array kKinds{Kind{NoiseKind::white},
                            Kind{NoiseKind::correlated},
                            Kind{NoiseKind::correlated_and_white},
                            Kind{NoiseKind::filtered, LowPass::butterworth, 1},
                            Kind{NoiseKind::filtered, LowPass::butterworth, 2},
                            Kind{NoiseKind::filtered, LowPass::butterworth, 4},
                            Kind{NoiseKind::filtered, LowPass::spline, 2},
                            Kind{NoiseKind::filtered, LowPass::spline, 3},
                            Kind{NoiseKind::filtered, LowPass::spline, 4},
                            Kind{NoiseKind::filtered, LowPass::spline, 5}};

// All kinds with both tails. Without one, slow noise and white only: with white noise on top it would be
// white noise under a tail.
std::vector<Kind> kinds_with_tails() {
  std::vector<Kind> out;
  for (auto kind : kKinds) {
    for (const auto tail : {Tail::none, Tail::power, Tail::exponential}) {
      const bool single = kind.kind == NoiseKind::white || kind.kind == NoiseKind::correlated;
      if (tail == Tail::none && !single) continue;
      kind.moves = tail;
      out.push_back(kind);
    }
  }
  return out;
}

double sigmoid(double x) { return 1.0 / (1.0 + std::exp(-x)); }

// The spectrum from a frequency on, over the square of the typical deviation.
struct Data {
  double lowest = 0.0, rate_hz = 0.0;
  std::vector<double> frequency, power, weight, shape, cosine, log_ratio;
  double frequencies = 0.0;  // that can be told apart
  const NoiseSearch* search = nullptr;

  [[nodiscard]] std::size_t size() const { return frequency.size(); }
};

// Model at parameters, and the derivatives of its logarithm.
class Spectrum {
 public:
  Spectrum(const Kind& kind, const Data& data) : kind_(kind), data_(data), sites_(kind.sites()) {
    if (kind.kind != NoiseKind::filtered) return;
    for (const double f : data.frequency) roll_off_.push_back(roll_off(kind.form, kind.order, f));
  }

  [[nodiscard]] const Sites& sites() const { return sites_; }

  [[nodiscard]] NoiseModel model(const Eigen::VectorXd& at_values) const {
    NoiseModel out{.kind = kind_.kind, .form = kind_.form, .order = kind_.order};
    out.variance = std::exp(at_values[sites_.variance]);
    if (sites_.memory >= 0) out.correlation = 1.0 - std::exp(at_values[sites_.memory]);
    if (sites_.cut_off >= 0) out.half = std::exp(at_values[sites_.cut_off]);
    if (sites_.floor >= 0) out.floor = std::exp(at_values[sites_.floor]);
    return out;
  }

  // Logarithms into `logs`; where `slopes` is not null, bins x parameters.
  void operator()(const Eigen::VectorXd& x, Eigen::VectorXd& logs, Eigen::MatrixXd* slopes) const {
    const double variance = std::exp(x[sites_.variance]);
    const bool moves = sites_.tail >= 0, by_power = kind_.moves == Tail::power;
    const double tail = moves ? std::exp(x[sites_.tail]) : 0.0,
                 share = moves ? sigmoid(x[sites_.slope]) : 0.0;
    const double more = by_power ? kTailMore : kFallMore;
    const double exponent = (by_power ? kTailLeast : kFallLeast) + more * share;
    const double floor = sites_.floor >= 0 ? std::exp(x[sites_.floor]) : 0.0;
    const double forget = sites_.memory >= 0 ? std::exp(x[sites_.memory]) : 1.0, rho = 1.0 - forget;
    const double half = sites_.cut_off >= 0 ? std::exp(x[sites_.cut_off]) : 0.0;
    const double at_half = half > 0.0 ? roll_off_at_half(kind_.form, kind_.order, half) : 1.0;
    double half_slope = 2.0 * kind_.order;  // of ln at_half by ln half
    if (half > 0.0 && kind_.form == LowPass::butterworth) {
      const double turn = std::numbers::pi * std::min(half, 0.49);
      half_slope *= turn / (std::sin(turn) * std::cos(turn));
    }
    logs.resize(static_cast<Eigen::Index>(data_.size()));
    if (slopes != nullptr) slopes->setZero(logs.size(), sites_.count);
    for (Eigen::Index i = 0; i < logs.size(); ++i) {
      const std::size_t k = at(i);
      double noise = variance, by_memory = 0.0;
      if (sites_.memory >= 0) {
        const double down = 1.0 - 2.0 * rho * data_.cosine[k] + rho * rho;
        noise = variance * (1.0 - rho * rho) / down;
        by_memory = variance * forget *
                    (2.0 * rho * down + (1.0 - rho * rho) * 2.0 * (rho - data_.cosine[k])) / (down * down);
      }
      const double away = by_power ? data_.log_ratio[k] : std::expm1(data_.log_ratio[k]);
      const double moved = tail * std::exp(-exponent * away);
      const double gain = sites_.cut_off >= 0 ? 1.0 / (1.0 + roll_off_[k] / at_half) : 1.0;
      const double squared = gain * gain, total = squared * (noise + moved) + floor;
      logs[i] = std::log(total);
      if (slopes == nullptr) continue;
      (*slopes)(i, sites_.variance) = squared * noise / total;
      if (sites_.memory >= 0) (*slopes)(i, sites_.memory) = squared * by_memory / total;
      if (sites_.cut_off >= 0)
        (*slopes)(i, sites_.cut_off) = squared * (noise + moved) * 2.0 * (1.0 - gain) * half_slope / total;
      if (sites_.floor >= 0) (*slopes)(i, sites_.floor) = floor / total;
      if (!moves) continue;
      (*slopes)(i, sites_.tail) = squared * moved / total;
      (*slopes)(i, sites_.slope) = -squared * moved * away * more * share * (1.0 - share) / total;
    }
  }

 private:
  const Kind& kind_;
  const Data& data_;
  Sites sites_;
  std::vector<double> roll_off_;
};

// Bounds and weak priors of the parameters.
struct Priors {
  Eigen::VectorXd low, high, mean, weight;
  int floor = -1;  // place of a filtered recording's floor

  Priors(const Kind& kind, const Data& data) {
    const auto sites = kind.sites();
    low = Eigen::VectorXd::Constant(sites.count, -80.0), high = -low;
    mean = weight = Eigen::VectorXd::Zero(sites.count);
    weight[sites.variance] = 1.0 / (kPriorSpread * kPriorSpread);  // about the typical one
    if (sites.slope >= 0) low[sites.slope] = -6.0, high[sites.slope] = 6.0, weight[sites.slope] = 0.25;
    if (sites.memory >= 0) low[sites.memory] = std::log(0.002), high[sites.memory] = std::log(0.95);
    if (kind.kind != NoiseKind::filtered) return;
    floor = sites.floor;
    low[sites.cut_off] = std::log(std::max(2.0 / data.rate_hz, 0.01));
    high[sites.cut_off] = std::log(0.48);
    const auto& known = data.search->known;
    if (!known) return;
    const double half = std::log(known->half);
    low[sites.cut_off] = std::min(low[sites.cut_off], half - 1.0);
    mean[sites.cut_off] = half, weight[sites.cut_off] = 1.0 / (kKnownCutOff * kKnownCutOff);
    if (!(known->variance > 0.0)) return;
    mean[sites.variance] = std::log(known->variance) - 2.0 * std::log(data.search->typical_sd);
    weight[sites.variance] = 1.0 / (kKnownVariance * kKnownVariance);
  }

  // How far the floor is beyond what a filtered recording has.
  [[nodiscard]] double too_high(const Eigen::VectorXd& x) const {
    return floor < 0 ? 0.0 : std::max(0.0, x[floor] - x[0] - std::log(kFloorToNoise));
  }
  [[nodiscard]] double penalty(const Eigen::VectorXd& x) const {
    const double excess = too_high(x);
    return 0.5 * (weight.array() * (x - mean).array().square()).sum() + kFloorPenalty * excess * excess;
  }
  void add(const Eigen::VectorXd& x, Eigen::VectorXd& slope, Eigen::MatrixXd& curvature) const {
    slope.array() -= weight.array() * (x - mean).array();
    curvature.diagonal() += weight + Eigen::VectorXd::Constant(weight.size(), 1e-6);
    const double excess = too_high(x);
    if (excess <= 0.0) return;
    slope[floor] -= 2.0 * kFloorPenalty * excess;
    slope[0] += 2.0 * kFloorPenalty * excess;
    for (const int i : {0, floor})
      for (const int k : {0, floor}) curvature(i, k) += (i == k ? 2.0 : -2.0) * kFloorPenalty;
  }
};

struct Fitted {
  Eigen::VectorXd x;
  Eigen::MatrixXd curvature;
  double value = -INFINITY;
};

// Damped Fisher scoring from one start.
Fitted fit_from(const Spectrum& spectrum, const Priors& priors, const Data& data, Eigen::VectorXd x) {
  const Eigen::Map<const Eigen::VectorXd> power(data.power.data(), std::ssize(data.power)),
      weight(data.weight.data(), std::ssize(data.weight));
  Eigen::VectorXd logs;
  Eigen::MatrixXd slopes;
  const auto value_of = [&](const Eigen::VectorXd& at_values) {
    spectrum(at_values, logs, nullptr);
    return -(weight.array() * (logs.array() + power.array() * (-logs.array()).exp())).sum() -
           priors.penalty(at_values);
  };
  x = x.cwiseMax(priors.low).cwiseMin(priors.high);
  Fitted out{.x = x, .curvature = {}, .value = value_of(x)};
  double damping = 1e-2;
  for (int iteration = 0; iteration < 60; ++iteration) {
    spectrum(out.x, logs, &slopes);
    const Eigen::VectorXd attraction = weight.array() * (power.array() * (-logs.array()).exp() - 1.0);
    Eigen::VectorXd slope = slopes.transpose() * attraction;
    out.curvature = slopes.transpose() * weight.asDiagonal() * slopes;
    priors.add(out.x, slope, out.curvature);
    double value = -INFINITY;
    Eigen::VectorXd next;
    for (;; damping *= 5.0) {
      Eigen::MatrixXd damped = out.curvature;
      damped.diagonal() *= 1.0 + damping;
      const Eigen::VectorXd step = damped.ldlt().solve(slope).cwiseMax(-2.0).cwiseMin(2.0);
      next = (out.x + step).cwiseMax(priors.low).cwiseMin(priors.high);
      value = value_of(next);
      if (value >= out.value || damping > 1e6) break;
    }
    if (!(value >= out.value)) break;
    const bool done = value - out.value < 1e-6;
    out.x = next, out.value = value;
    damping = std::max(damping / 5.0, 1e-6);
    if (done) break;
  }
  return out;
}

// Logarithm of the mean power at the upper end, and values to start from.
std::vector<Eigen::VectorXd> starts_of(const Kind& kind, const Data& data) {
  const std::size_t n = data.size(), top = std::max<std::size_t>(3, n / 5);
  double high = 0.0;
  for (std::size_t i = n - top; i < n; ++i) high += std::log(data.power[i]) / static_cast<double>(top);
  std::vector<double> sorted = data.power;
  std::ranges::sort(sorted);
  const double middle = std::log(sorted[n / 2]), first = std::log(data.power.front());
  std::vector<Eigen::VectorXd> out;
  const auto start = [&out, count = kind.sites().count](std::initializer_list<double> values) {
    out.emplace_back(Eigen::VectorXd(count));  // a tail, where there is one, stands at the end
    std::copy_n(values.begin(), count, out.back().begin());
  };
  const auto slow = [high](double rho) { return high + std::log(2.0 / (1.0 - rho) / (1.0 + rho)); };
  switch (kind.kind) {
    case NoiseKind::white:
      start({middle, first, 0.0});
      break;
    case NoiseKind::correlated:
      for (const double rho : {0.5, 0.9, 0.98})
        start({slow(rho), std::log(1.0 - rho), first + std::log(0.3), 0.0});
      break;
    case NoiseKind::correlated_and_white:
      for (const double rho : {0.8, 0.97})
        start({slow(rho), std::log(1.0 - rho), high + std::log(0.5), first + std::log(0.3), 0.0});
      break;
    case NoiseKind::filtered: {
      std::vector<double> halves;
      if (data.search->known)
        halves = {data.search->known->half};
      else
        for (const double hz : {5.6, 14.4})
          halves.push_back(std::clamp(hz / data.rate_hz, 2.5 / data.rate_hz, 0.4));
      for (const double half : halves) {
        std::size_t nearest = 0;
        for (std::size_t i = 0; i < n; ++i)
          if (std::abs(data.frequency[i] - 1.3 * half) < std::abs(data.frequency[nearest] - 1.3 * half))
            nearest = i;
        const double gain = gain_of(kind.form, kind.order, half, data.frequency[nearest]);
        start({std::log(data.power[nearest]) - 2.0 * std::log(gain), std::log(half), std::log(sorted.front()),
               first, 0.0});
      }
    }
  }
  return out;
}

// Whether a recording may have been filtered at all: it has much less above than below. How low its floor is
// tells the fit alone: at a low rate a filter lets noise through up to the highest frequency.
bool may_be_filtered(const Data& data) {
  const auto [least, most] = std::ranges::minmax(data.power);
  return least <= 0.03 * most;
}

Data data_of(const NoiseSpectrum& spectrum, double lowest, double rate_hz, const NoiseSearch& search) {
  Data out{.lowest = lowest, .rate_hz = rate_hz, .search = &search};
  const double unit = search.typical_sd * search.typical_sd;
  for (const auto& bin : spectrum.bins(lowest)) {
    out.frequency.push_back(bin.frequency);
    out.power.push_back(std::max(bin.power / unit, 1e-30));
    out.weight.push_back(kIndependent * static_cast<double>(spectrum.axes()) * bin.count);
    out.shape.push_back(bin.shape);
    out.cosine.push_back(std::cos(2.0 * std::numbers::pi * bin.frequency));
    out.log_ratio.push_back(std::log(bin.frequency / lowest));
    out.frequencies += bin.count;
  }
  return out;
}

// Deviance of a fit over what is expected of the right model.
double misfit_of(const Spectrum& spectrum, const Eigen::VectorXd& x, const Data& data) {
  Eigen::VectorXd logs;
  spectrum(x, logs, nullptr);
  double sum = 0.0;
  for (std::size_t i = 0; i < data.size(); ++i) {
    const double ratio = data.power[i] / std::exp(logs[static_cast<Eigen::Index>(i)]);
    sum += 2.0 * data.shape[i] * (ratio - 1.0 - std::log(ratio));
  }
  return sum / static_cast<double>(std::max<std::int64_t>(3, std::ssize(data.power) - x.size()));
}

NoiseModel in_units(NoiseModel model, double typical_sd) {
  model.variance *= typical_sd * typical_sd;
  model.floor *= typical_sd * typical_sd;
  return model;
}

NoiseFits fit_all(const Data& data) {
  const auto& search = *data.search;
  NoiseFits out{.lowest = data.lowest};
  double points = 0.0;
  for (const double weight : data.weight) points += weight;
  const bool filters = search.known || may_be_filtered(data);
  const double floor = search.largest_floor_sd / search.typical_sd;
  static const auto kinds = kinds_with_tails();
  for (const auto& kind : kinds) {
    const bool filter = kind.kind == NoiseKind::filtered;
    if (filter && !filters) continue;
    if (search.known && !(filter && kind.form == search.known->form && kind.order == search.known->order))
      continue;
    const Spectrum spectrum(kind, data);
    const Priors priors(kind, data);
    Fitted best;
    for (const auto& start : starts_of(kind, data))
      if (auto fit = fit_from(spectrum, priors, data, start); fit.value > best.value) best = std::move(fit);
    if (!std::isfinite(best.value)) continue;
    const NoiseModel model = spectrum.model(best.x);
    if (filter && !search.known &&
        (model.floor > floor * floor || model.floor > kLargestFloor * model.variance))
      continue;
    NoiseFit fit{.model = in_units(model, search.typical_sd),
                 .parameters = best.x,
                 .covariance = best.curvature.completeOrthogonalDecomposition().pseudoInverse(),
                 .evidence = best.value - 0.5 * std::log(points) * static_cast<double>(best.x.size()) -
                             (filter ? kEvidenceOfFilter : 0.0)};
    if (out.fits.empty() || fit.evidence > out.fits.front().evidence) {
      out.misfit = misfit_of(spectrum, best.x, data);
      out.fits.insert(out.fits.begin(), std::move(fit));
    } else {
      out.fits.push_back(std::move(fit));
    }
  }
  std::ranges::stable_sort(out.fits, std::ranges::greater{}, &NoiseFit::evidence);
  out.largest_misfit = 1.0 + 2.0 * std::sqrt(16.0 / std::max(32.0, data.frequencies));
  return out;
}

void draw_from(const NoiseFits& from, const NoiseSearch& search, std::int64_t count, Random& random,
               std::vector<NoiseModel>& out) {
  std::vector<double> weights;
  double sum = 0.0;
  for (const auto& fit : from.fits) {
    const double weight = std::exp(fit.evidence - from.fits.front().evidence);
    weights.push_back(weight < kLeastWeight ? 0.0 : weight);
    sum += weights.back();
  }
  std::vector<bool> drawn(weights.size(), false);
  for (std::int64_t k = 0; k < count; ++k) {
    double pick = random.uniform(0.0, sum);
    std::size_t i = 0;
    while (i + 1 < weights.size() && pick >= weights[i]) pick -= weights[i++];
    const auto& fit = from.fits[i];
    const Kind kind{fit.model.kind, fit.model.form, fit.model.order};
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(fit.covariance);
    Eigen::VectorXd off(fit.parameters.size());
    for (Eigen::Index p = 0; p < off.size(); ++p)
      off[p] = kSpreadDrawn * std::sqrt(std::clamp(solver.eigenvalues()[p], 0.0, kWidestDrawn)) *
               random.gaussian();
    if (!drawn[i]) off.setZero();
    drawn[i] = true;
    Eigen::VectorXd x = fit.parameters + solver.eigenvectors() * off;
    const auto sites = kind.sites();
    if (sites.memory >= 0) x[sites.memory] = std::clamp(x[sites.memory], std::log(0.002), 0.0);
    if (sites.cut_off >= 0) x[sites.cut_off] = std::min(x[sites.cut_off], std::log(0.48));
    const Data none;
    out.push_back(in_units(Spectrum(kind, none).model(x), search.typical_sd));
  }
}

}  // namespace

std::optional<FoundNoise> find_noise(const NoiseSpectrum& spectrum, double rate_hz,
                                     const NoiseSearch& search) {
  if (spectrum.empty()) return std::nullopt;
  std::vector<double> from;
  for (const double hz : kFrom_hz) {
    const double lowest = std::max(hz / rate_hz, kLowestPeriods / static_cast<double>(spectrum.longest()));
    if (hz / rate_hz <= kHighestFrom && (from.empty() || lowest > from.back())) from.push_back(lowest);
  }
  std::optional<FoundNoise> out;
  for (const double lowest : from) {
    const Data data = data_of(spectrum, lowest, rate_hz, search);
    if (data.size() < 8) break;
    auto fits = fit_all(data);
    if (fits.fits.empty()) continue;
    if (out && out->chosen.misfit < out->chosen.largest_misfit) {
      out->next = std::move(fits);
      break;
    }
    if (!out || fits.misfit < out->chosen.misfit) out = FoundNoise{.chosen = std::move(fits)};
  }
  return out;
}

std::vector<NoiseModel> draw_noise(const FoundNoise& found, const NoiseSearch& search, std::int64_t count,
                                   Random random) {
  std::vector<NoiseModel> ordered, out;
  const auto of_next = found.next ? std::llround(kNextShare * static_cast<double>(count)) : 0;
  draw_from(found.chosen, search, count - of_next, random, ordered);
  if (found.next) draw_from(*found.next, search, of_next, random, ordered);
  // In any order, so that neighbours and parts are alike.
  for (auto left = std::ssize(ordered); left > 0; --left) {
    const auto pick =
        std::min(left - 1, static_cast<std::int64_t>(random.uniform() * static_cast<double>(left)));
    out.push_back(ordered[at(pick)]);
    ordered[at(pick)] = ordered[at(left - 1)];
  }
  return out;
}

}  // namespace kinemark::math
