// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/multitaper.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinemark/core/check.h"
#include "kinemark/core/index.h"
#include "kinemark/math/fourier.h"

namespace kinemark::math {
namespace {

constexpr int kTapers = 5;
constexpr double kTimeBandwidth = 4.0;
constexpr int kDifferences = 6;
constexpr std::int64_t kLongestStretch = 4096;
constexpr std::int64_t kMostStretches = 8;
constexpr int kBins = 44;
constexpr double kWidening = 1.3;          // exponent by which bins grow with the frequency
constexpr double kTaperFrequencies = 8.0;  // that the tapers of one frequency mix
constexpr std::int64_t kBridged = 2;       // missing samples in a row

// A symmetric matrix with these on and beside its diagonal.
struct Tridiagonal {
  Eigen::VectorXd diagonal, beside;

  // How many eigenvalues lie above a number (Sturm's sequence).
  [[nodiscard]] int above(double value) const {
    int count = 0;
    double q = 1.0;
    for (Eigen::Index i = 0; i < diagonal.size(); ++i) {
      const double b = i == 0 ? 0.0 : beside[i - 1];
      q = diagonal[i] - value - (i == 0 ? 0.0 : b * b / q);
      if (q == 0.0) q = 1e-300;
      count += q > 0.0;
    }
    return count;
  }

  // The k-th largest eigenvalue, k from 0, by halving.
  [[nodiscard]] double eigenvalue(int k) const {
    const double bound = diagonal.cwiseAbs().maxCoeff() + 2.0 * beside.cwiseAbs().maxCoeff();
    double low = -bound, high = bound;
    for (int i = 0; i < 200 && high - low > 1e-14 * bound; ++i) {
      const double middle = 0.5 * (low + high);
      (above(middle) > k ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }

  // Solves (matrix - value) x = x in place: Gauss with exchange of neighbouring rows.
  void solve_shifted(double value, Eigen::VectorXd& x) const {
    const Eigen::Index n = diagonal.size();
    Eigen::VectorXd a = diagonal.array() - value, b = Eigen::VectorXd::Zero(n), c = Eigen::VectorXd::Zero(n);
    b.head(n - 1) = beside;
    for (Eigen::Index i = 0; i + 1 < n; ++i) {
      double low = beside[i], next = a[i + 1], after = i + 2 < n ? beside[i + 1] : 0.0;
      if (std::abs(low) > std::abs(a[i])) {
        std::swap(a[i], low);
        std::swap(b[i], next);
        std::swap(c[i], after);
        std::swap(x[i], x[i + 1]);
      }
      if (a[i] == 0.0) a[i] = 1e-300;
      const double factor = low / a[i];
      a[i + 1] = next - factor * b[i];
      b[i + 1] = after - factor * c[i];
      x[i + 1] -= factor * x[i];
    }
    if (a[n - 1] == 0.0) a[n - 1] = 1e-300;
    for (Eigen::Index i = n - 1; i >= 0; --i) {
      double sum = x[i];
      if (i + 1 < n) sum -= b[i] * x[i + 1];
      if (i + 2 < n) sum -= c[i] * x[i + 2];
      x[i] = sum / a[i];
    }
  }
};

// A missing sample by the polynomial through the three seen ones nearest on both sides; false where there are
// fewer within six samples.
bool bridge(SeriesMatrix& x, const std::vector<bool>& seen, std::int64_t i) {
  std::vector<std::int64_t> before, behind;
  for (std::int64_t k = i - 1; k >= std::max<std::int64_t>(0, i - 6) && before.size() < 3; --k)
    if (seen[at(k)]) before.push_back(k);
  for (std::int64_t k = i + 1; k < std::min(x.rows(), i + 7) && behind.size() < 3; ++k)
    if (seen[at(k)]) behind.push_back(k);
  if (before.size() < 3 || behind.size() < 3) return false;
  before.insert(before.end(), behind.begin(), behind.end());
  x.row(i).setZero();
  for (const auto a : before) {
    double weight = 1.0;
    for (const auto b : before)
      if (a != b) weight *= static_cast<double>(i - b) / static_cast<double>(a - b);
    x.row(i) += weight * x.row(a);
  }
  return true;
}

// Series with short gaps bridged, and what is known of it then.
std::vector<bool> bridged(SeriesMatrix& x, const std::vector<bool>& seen) {
  std::vector<bool> known = seen;
  const auto n = std::ssize(seen);
  for (std::int64_t i = 0; i < n; ++i) {
    if (seen[at(i)]) continue;
    std::int64_t end = i;
    while (end < n && !seen[at(end)]) ++end;
    if (end - i <= kBridged)
      for (std::int64_t k = i; k < end; ++k) known[at(k)] = bridge(x, seen, k);
    i = end;
  }
  return known;
}

// Mean square, axes averaged, by which a bridged sample misses the noise of its own: of seen samples from the
// bridge over their neighbours. It is a sixth difference.
double square_off_bridge(const SeriesMatrix& x, const std::vector<bool>& seen) {
  double sum = 0.0;
  std::int64_t count = 0, run = 0;
  for (std::int64_t i = 0; i < x.rows(); ++i) {
    run = seen[at(i)] ? run + 1 : 0;
    if (run < 7) continue;
    const auto off = (x.row(i) + x.row(i - 6) - 6.0 * (x.row(i - 1) + x.row(i - 5)) +
                      15.0 * (x.row(i - 2) + x.row(i - 4)) - 20.0 * x.row(i - 3)) /
                     20.0;
    sum += off.squaredNorm() / static_cast<double>(x.cols());
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

// Bridged samples have the noise of their neighbours, which colours white noise: of a share p of samples the
// power P at a frequency where the bridge's gain is W is P (1 + p (W - 1))^2 + p (1 - p) times the mean
// square off the bridge. Undone here; what is taken off is at most half of what is there.
void undo_bridges(double share, double square_off, double step, Eigen::VectorXd& power) {
  for (Eigen::Index i = 0; i < power.size(); ++i) {
    const double off =
        std::pow(2.0 * std::sin(std::numbers::pi * static_cast<double>(i + 1) * step), 6) / 20.0;
    const double kept = 1.0 - share * off;
    const double own = std::max(power[i] - share * (1.0 - share) * square_off, 0.5 * power[i]);
    power[i] = own / std::max(0.25, kept * kept);
  }
}

}  // namespace

std::vector<Eigen::VectorXd> slepian_tapers(std::int64_t length, double time_bandwidth, int count) {
  check(length >= 16 && count >= 1 && count < 2.0 * time_bandwidth, "tapers need samples and few of them");
  const auto n = static_cast<double>(length);
  Tridiagonal matrix{.diagonal = Eigen::VectorXd(length), .beside = Eigen::VectorXd(length - 1)};
  const double cosine = std::cos(2.0 * std::numbers::pi * time_bandwidth / n);
  for (std::int64_t i = 0; i < length; ++i) {
    const double middle = 0.5 * (n - 1.0) - static_cast<double>(i);
    matrix.diagonal[i] = middle * middle * cosine;
    if (i > 0) matrix.beside[i - 1] = 0.5 * static_cast<double>(i) * (n - static_cast<double>(i));
  }
  std::vector<Eigen::VectorXd> out;
  for (int k = 0; k < count; ++k) {
    const double value = matrix.eigenvalue(k);
    Eigen::VectorXd x(length);
    for (std::int64_t i = 0; i < length; ++i)
      x[i] = std::cos(std::numbers::pi * k * (static_cast<double>(i) + 0.5) / n) + 0.1;
    for (int round = 0; round < 3; ++round) {
      x.normalize();
      matrix.solve_shifted(value, x);
      for (const auto& better : out) x -= better.dot(x) / better.squaredNorm() * better;
    }
    out.push_back(x.normalized());
  }
  return out;
}

NoiseSpectrum::Stretch NoiseSpectrum::spectrum_of(const SeriesMatrix& x) {
  const std::int64_t n = x.rows(), used = n - kDifferences;
  FourierTransform transform(FourierTransform::good_length(n));
  const std::int64_t length = transform.length(), count = (length - 1) / 2;
  Stretch out{.samples = n, .step = 1.0 / static_cast<double>(length), .power = Eigen::VectorXd(count)};
  const auto tapers = slepian_tapers(used, kTimeBandwidth, kTapers);
  SeriesMatrix difference = x;
  Eigen::VectorXd power(length / 2 + 1);
  for (int k = 1; k <= kDifferences; ++k) {
    difference = (difference.bottomRows(n - k) - difference.topRows(n - k)).eval();
    power.setZero();
    for (Eigen::Index axis = 0; axis < x.cols(); ++axis)
      for (const auto& taper : tapers) {
        const Eigen::VectorXd tapered =
            difference.col(axis).segment((kDifferences - k) / 2, used).cwiseProduct(taper);
        transform.add_power(tapered, power);
      }
    const double scale = 1.0 / static_cast<double>(x.cols() * kTapers);
    for (std::int64_t i = 0; i < count; ++i) {
      const double gain = 2.0 * std::sin(std::numbers::pi * static_cast<double>(i + 1) * out.step);
      const double here = scale * power[i + 1] / std::pow(gain, 2 * k);
      out.power[i] = k == 1 ? here : std::min(out.power[i], here);
    }
  }
  return out;
}

NoiseSpectrum::NoiseSpectrum(const SeriesMatrix& series, const std::vector<bool>& seen)
    : axes_(series.cols()) {
  SeriesMatrix x = series;
  const auto known = bridged(x, seen);
  const double square_off = square_off_bridge(series, seen);
  struct Part {
    std::int64_t first, count;
  };
  std::vector<Part> parts;
  const auto n = std::ssize(known);
  for (std::int64_t i = 0; i < n; ++i) {
    if (!known[at(i)]) continue;
    std::int64_t end = i;
    while (end < n && known[at(end)]) ++end;
    for (std::int64_t first = i; end - first >= kLeastStretch;) {
      const std::int64_t count = std::min(end - first, kLongestStretch);
      parts.push_back({.first = first, .count = count});
      first += count;
    }
    i = end;
  }
  std::ranges::stable_sort(parts, std::ranges::greater{}, &Part::count);
  // The longest ones; of more that are as long, those at even distances.
  const auto as_long = std::ranges::count(parts, kLongestStretch, &Part::count);
  const std::int64_t taken = std::min<std::int64_t>(kMostStretches, std::ssize(parts));
  for (std::int64_t k = 0; k < taken; ++k) {
    const auto& part = parts[at(as_long > taken ? k * (as_long - 1) / (taken - 1) : k)];
    longest_ = std::max(longest_, part.count);
    // A fraction of the longest says nothing more, and of other frequencies.
    if (4 * part.count < longest_) continue;
    auto& stretch = stretches_.emplace_back(spectrum_of(x.middleRows(part.first, part.count)));
    const auto begin = seen.begin() + part.first;
    const auto missing = std::count(begin, begin + part.count, false);
    if (missing > 0)
      undo_bridges(static_cast<double>(missing) / static_cast<double>(part.count), square_off, stretch.step,
                   stretch.power);
  }
}

std::vector<SpectrumBin> NoiseSpectrum::bins(double lowest) const {
  std::vector<SpectrumBin> out;
  if (stretches_.empty()) return out;
  // Edges at frequencies that the longest stretch tells apart.
  const double resolution = 1.0 / static_cast<double>(longest_);
  const double begin = std::max(lowest, resolution);
  const auto count = static_cast<std::int64_t>(std::floor((0.5 - begin) / resolution));
  std::vector<double> edges;
  for (int i = 0; i <= kBins; ++i) {
    const double at_share = std::pow(static_cast<double>(i) / kBins, kWidening) * static_cast<double>(count);
    const double edge = begin + resolution * std::round(at_share);
    if (edges.empty() || edge > edges.back() + 0.5 * resolution) edges.push_back(edge);
  }
  for (std::size_t b = 0; b + 1 < edges.size(); ++b) {
    SpectrumBin bin;
    double weight = 0.0;
    for (const auto& stretch : stretches_) {
      double logarithms = 0.0, frequencies = 0.0;
      std::int64_t here = 0;
      const auto first = static_cast<std::int64_t>(std::ceil(edges[b] / stretch.step - 1e-9));
      for (auto i = std::max<std::int64_t>(1, first);
           i <= stretch.power.size() && static_cast<double>(i) * stretch.step < edges[b + 1] - 1e-12; ++i) {
        logarithms += std::log(std::max(stretch.power[i - 1], 1e-300));
        frequencies += static_cast<double>(i) * stretch.step;
        ++here;
      }
      if (here == 0) continue;
      const double size = static_cast<double>(here),
                   stated = size * stretch.step * static_cast<double>(stretch.samples);
      bin.power += stated * std::exp(logarithms / size);
      bin.frequency += stated * frequencies / size;
      bin.count += stated;
      bin.shape += static_cast<double>(kTapers * axes_) * std::max(1.0, stated / kTaperFrequencies);
      weight += stated;
    }
    if (weight == 0.0) continue;
    bin.power /= weight;
    bin.frequency /= weight;
    out.push_back(bin);
  }
  return out;
}

}  // namespace kinemark::math
