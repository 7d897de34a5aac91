// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/harmonics.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <vector>

namespace kinemark::analysis {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr int kMultiples = 8;                // that are fitted, at least
constexpr int kMultiplesOfMany = 3;          // the same, where leakage between them is small
constexpr double kManyCycles = 100.0;        // from which it is
constexpr double kSamplesEach = 8.0;         // of the highest multiple's period, where samples are many
constexpr double kHighest = 0.45;            // cycles per sample
constexpr double kLeastPeriods = 1.5;        // of the fundamental
constexpr double kTellingShare = 1.0 / 3.0;  // of the squares, that a lower fundamental leaves at most
constexpr double kRounding = 1e-14;          // of the squares, that say nothing
constexpr int kIterations = 30;
constexpr double kUneven = 1.0;  // rad, from which phases are followed
constexpr double kOther = 0.1;   // of the frequency, by which followed phases may move it

// A path by its even and its odd part about the middle, without which a fit would have twice the work.
struct Halves {
  std::int64_t rows = 0;  // of either
  double rate_hz = 0.0;   // of its samples
  Eigen::VectorXd place;  // from 0 to 1, of the later half
  Eigen::MatrixXd even, odd;

  [[nodiscard]] double last_s() const { return (static_cast<double>(rows) - 0.5) / rate_hz; }
  [[nodiscard]] double cycles(double hz) const { return 2.0 * static_cast<double>(rows) / rate_hz * hz; }
};

Halves halves_of(const PathMatrix& x, double rate_hz, const HarmonicForm& form) {
  const double wanted = kSamplesEach * form.count * form.fundamental_hz;
  const auto step = std::max<std::int64_t>(1, static_cast<std::int64_t>(rate_hz / wanted));
  Halves out{.rows = x.rows() / step / 2,
             .rate_hz = rate_hz / static_cast<double>(step),
             .place = {},
             .even = {},
             .odd = {}};
  const auto mean = [&](std::int64_t i) -> Eigen::RowVector3d {
    return x.middleRows(i * step, step).colwise().mean() - x.row(0);
  };
  out.place.resize(out.rows), out.even.resize(out.rows, 3), out.odd.resize(out.rows, 3);
  for (std::int64_t i = 0; i < out.rows; ++i) {
    const Eigen::RowVector3d later = mean(out.rows + i), earlier = mean(out.rows - 1 - i);
    out.place[i] = (static_cast<double>(i) + 0.5) / (static_cast<double>(out.rows) - 0.5);
    out.even.row(i) = later + earlier;
    out.odd.row(i) = later - earlier;
  }
  return out;
}

// One parity of the fit: columns of the trend and of the harmonics, then what these change by with the
// frequency.
struct Parity {
  Eigen::MatrixXd columns;            // rows x (model + multiples)
  Eigen::Index model = 0, first = 0;  // columns of the model; the first of a harmonic
  Eigen::MatrixXd coefficients;       // model x 3
  Eigen::MatrixXd slope;              // multiples x 3: what the residual has of each change
  Eigen::MatrixXd curvature;          // multiples x multiples, freed of the model

  [[nodiscard]] bool solve(const Eigen::MatrixXd& y, Eigen::Index multiples) {
    const Eigen::MatrixXd products = columns.transpose() * columns, right = columns.transpose() * y;
    const Eigen::LDLT<Eigen::MatrixXd> solver(products.topLeftCorner(model, model));
    if (solver.info() != Eigen::Success || !(solver.vectorD().minCoeff() > 0.0)) return false;
    const auto both = products.topRightCorner(model, multiples);
    coefficients = solver.solve(right.topRows(model));
    slope = right.bottomRows(multiples) - both.transpose() * coefficients;
    curvature = products.bottomRightCorner(multiples, multiples) - both.transpose() * solver.solve(both);
    return true;
  }
};

struct Fit {
  Parity even, odd;
  double step = 0.0;  // of the angle at the last sample, rad, that Gauss and Newton take next
};

std::optional<Fit> fit_at(const Halves& halves, const HarmonicForm& form, double hz) {
  const Eigen::Index n = halves.rows, k = form.count, powers = form.trend + 1;
  const double last = kTurn * hz * halves.last_s();
  Fit out;
  out.even.first = (powers + 1) / 2, out.odd.first = powers / 2;
  for (auto* one : {&out.even, &out.odd}) one->model = one->first + k, one->columns.resize(n, one->model + k);
  for (Eigen::Index p = 0; p < powers; ++p) {
    auto& one = p % 2 == 0 ? out.even : out.odd;
    one.columns.col(p / 2) = halves.place.array().pow(static_cast<double>(p));
  }
  const Eigen::ArrayXd cosine = (last * halves.place.array()).cos(),
                       sine = (last * halves.place.array()).sin();
  Eigen::ArrayXd c = cosine, s = sine;
  for (Eigen::Index m = 0; m < k; ++m) {
    out.even.columns.col(out.even.first + m) = c;
    out.odd.columns.col(out.odd.first + m) = s;
    out.even.columns.col(out.even.model + m) = halves.place.array() * s;
    out.odd.columns.col(out.odd.model + m) = halves.place.array() * c;
    const Eigen::ArrayXd next = c * cosine - s * sine;
    s = s * cosine + c * sine;
    c = next;
  }
  // Sums over both halves are twice these; halves of the even and odd part make up for it.
  if (!out.even.solve(0.5 * halves.even, k) || !out.odd.solve(0.5 * halves.odd, k)) return std::nullopt;
  double along = 0.0, across = 0.0;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    Eigen::VectorXd a(k), b(k);
    for (Eigen::Index m = 0; m < k; ++m) {
      a[m] = -static_cast<double>(m + 1) * out.even.coefficients(out.even.first + m, axis);
      b[m] = static_cast<double>(m + 1) * out.odd.coefficients(out.odd.first + m, axis);
    }
    along += a.dot(out.even.slope.col(axis)) + b.dot(out.odd.slope.col(axis));
    across += a.dot(out.even.curvature * a) + b.dot(out.odd.curvature * b);
  }
  if (!(across > 0.0)) return std::nullopt;
  out.step = along / across;
  return out;
}

// The frequency of least squares near that of the form, and its fit.
struct Best {
  double hz = kNaN;
  Fit fit;
};

std::optional<Best> best_near(const Halves& halves, const HarmonicForm& form) {
  if (!(halves.cycles(form.fundamental_hz) >= kLeastPeriods)) return std::nullopt;
  if (halves.rows < 2 * (form.count + form.trend)) return std::nullopt;
  Best out{.hz = form.fundamental_hz, .fit = {}};
  const double per_step = 1.0 / (kTurn * halves.last_s());
  const double farthest = 0.5 / halves.last_s();  // a width of its peak
  for (int i = 0; i < kIterations; ++i) {
    auto fit = fit_at(halves, form, out.hz);
    if (!fit) return std::nullopt;
    out.fit = std::move(*fit);
    const double step = std::clamp(out.fit.step * per_step, -0.25 * farthest, 0.25 * farthest);
    if (std::abs(step) < 1e-9 * out.hz) return out;
    out.hz += step;
    if (std::abs(out.hz - form.fundamental_hz) > farthest) return std::nullopt;
  }
  return out;
}

// What the fit leaves, in the order of time.
Eigen::MatrixXd residual_of(const Halves& halves, const Fit& fit) {
  const Eigen::MatrixXd even = 0.5 * halves.even -
                               fit.even.columns.leftCols(fit.even.model) * fit.even.coefficients,
                        odd =
                            0.5 * halves.odd - fit.odd.columns.leftCols(fit.odd.model) * fit.odd.coefficients;
  Eigen::MatrixXd out(2 * halves.rows, 3);
  out.bottomRows(halves.rows) = even + odd;
  out.topRows(halves.rows) = (even - odd).colwise().reverse();
  return out;
}

// Phases of the dominant frequency over halves of the fundamental's period, every quarter of one, less those
// of the fit.
std::vector<double> phases_of(const Halves& halves, const HarmonicForm& form, const Best& best) {
  const Eigen::MatrixXd residual = residual_of(halves, best.fit);
  const double quarter = 0.25 * halves.rate_hz / best.hz;
  const auto count =
      static_cast<std::int64_t>(std::floor(static_cast<double>(residual.rows()) / quarter)) - 1;
  const auto length = std::min<std::int64_t>(std::llround(2.0 * quarter), residual.rows());
  Eigen::Matrix<std::complex<double>, 3, 1> amplitude;
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    amplitude[axis] = {best.fit.even.coefficients(best.fit.even.first + form.dominant - 1, axis),
                       -best.fit.odd.coefficients(best.fit.odd.first + form.dominant - 1, axis)};
  const double per_sample = kTurn * best.hz * form.dominant / halves.rate_hz;
  std::vector<double> out;
  for (std::int64_t w = 0; w < count; ++w) {
    const auto first =
        std::min<std::int64_t>(residual.rows() - length, std::llround(static_cast<double>(w) * quarter));
    std::complex<double> sum = 0.5 * static_cast<double>(length) * amplitude.squaredNorm();
    for (std::int64_t i = first; i < first + length; ++i) {
      const double angle = per_sample * (static_cast<double>(i - halves.rows) + 0.5);
      sum +=
          std::polar(1.0, -angle) * amplitude.dot(residual.row(i).transpose().cast<std::complex<double>>());
    }
    out.push_back(std::arg(sum));
    if (w > 0) out.back() = out[out.size() - 2] + std::remainder(out.back() - out[out.size() - 2], kTurn);
  }
  return out;
}

// Slope of the line of least squares, per value.
double slope_of(const std::vector<double>& values) {
  const double middle = 0.5 * static_cast<double>(values.size() - 1);
  double with = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double off = static_cast<double>(i) - middle;
    with += off * values[i], squares += off * off;
  }
  return squares > 0.0 ? with / squares : 0.0;
}

HarmonicForm form_with(const PathMatrix& x, double rate_hz, double peak_hz, int dominant) {
  HarmonicForm out{.fundamental_hz = peak_hz / dominant, .dominant = dominant};
  const double cycles = static_cast<double>(x.rows()) / rate_hz * out.fundamental_hz;
  const int wanted = std::max(cycles < kManyCycles ? kMultiples : kMultiplesOfMany, 3 * dominant);
  out.count = std::max(dominant, std::min(wanted, static_cast<int>(kHighest * rate_hz / out.fundamental_hz)));
  out.trend = cycles < 4.0 ? 1 : cycles < 6.0 ? 2 : 3;
  return out;
}

}  // namespace

HarmonicForm harmonic_form(const PathMatrix& x, double rate_hz, double peak_hz) {
  if (!std::isfinite(peak_hz)) return {};
  HarmonicForm out;
  double left = INFINITY;
  for (int dominant = 1; dominant <= 3; ++dominant) {
    auto form = form_with(x, rate_hz, peak_hz, dominant);
    const auto halves = halves_of(x, rate_hz, form);
    if (dominant > 1 && halves.cycles(form.fundamental_hz) < 2.0) break;
    const auto best = best_near(halves, form);
    if (!best) continue;
    const double squares = residual_of(halves, best->fit).squaredNorm();
    if (squares > kTellingShare * left) continue;
    const double all = 0.25 * (halves.even.squaredNorm() + halves.odd.squaredNorm());
    if (dominant > 1 && left < kRounding * all) break;
    form.fundamental_hz = best->hz;
    out = form;
    left = squares;
  }
  return out;
}

HarmonicFit fit_harmonics(const PathMatrix& x, double rate_hz, const HarmonicForm& form) {
  if (std::isnan(form.fundamental_hz)) return {};
  const auto halves = halves_of(x, rate_hz, form);
  const auto best = best_near(halves, form);
  if (!best) return {};
  HarmonicFit out{.dominant_hz = form.dominant * best->hz};
  const auto phases = phases_of(halves, form, *best);
  if (phases.size() < 3) return {};
  const auto [least, most] = std::ranges::minmax(phases);
  const double slope = slope_of(phases), per_value = 4.0 * best->hz / kTurn;
  if (most - least > kUneven) {
    if (std::abs(slope * per_value) > kOther * out.dominant_hz) return {};
    out.dominant_hz += slope * per_value;
  }
  // Phases that go on by chance from cycle to cycle: deviation of a line through them, of few cycles by
  // simulation, since the line takes most of what they differ by.
  double squares = 0.0;
  for (std::size_t i = 2; i < phases.size(); ++i) {
    const double off = phases[i] - phases[i - 2] - (most - least > kUneven ? 2.0 * slope : 0.0);
    squares += off * off / static_cast<double>(phases.size() - 2);
  }
  const double cycles = halves.cycles(best->hz);
  const double of_few = 1.22 * (1.0 + 6.5 * std::pow(cycles - 1.0, -1.9));
  const double per_half = 2.0 * best->hz / kTurn;
  out.wander = 1.2 * squares / cycles * of_few * of_few * per_half * per_half;
  return out;
}

}  // namespace kinemark::analysis
