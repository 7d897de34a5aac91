// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/normals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "kinemark/core/check.h"
#include "kinemark/core/random.h"
#include "kinemark/core/wide.h"

namespace kinemark::math {
namespace {

constexpr std::int64_t kBlock = 128;  // pairs at once
constexpr std::int64_t kOneBits = 0x3FF0000000000000;
constexpr std::int64_t kMantissa = 0x000FFFFFFFFFFFFF;
constexpr double kRounding = 0x1.8p52;  // added and taken off again: the nearest whole number

// sum over k of c[k] z^k.
template <std::size_t kTerms>
[[gnu::always_inline]] inline void polynomial(const std::array<double, kTerms>& c, const Lanes& z,
                                              Lanes& out) {
  spread(out, c[kTerms - 1]);
  for (std::size_t k = kTerms - 1; k-- > 0;) out = out * z + c[k];
}

// 2 atanh(s) / s in s^2, to |s| < 0.172.
constexpr std::array kLog{2.0,      2.0 / 3,  2.0 / 5,  2.0 / 7,  2.0 / 9, 2.0 / 11,
                          2.0 / 13, 2.0 / 15, 2.0 / 17, 2.0 / 19, 2.0 / 21};
// sin(a) / a and cos(a) in a^2, to |a| < pi / 4.
constexpr std::array kSine{1.0,
                           -1.0 / 6,
                           1.0 / 120,
                           -1.0 / 5040,
                           1.0 / 362880,
                           -1.0 / 39916800,
                           1.0 / 6227020800.0,
                           -1.0 / 1307674368000.0,
                           1.0 / 355687428096000.0};
constexpr std::array kCosine{1.0,
                             -1.0 / 2,
                             1.0 / 24,
                             -1.0 / 720,
                             1.0 / 40320,
                             -1.0 / 3628800,
                             1.0 / 479001600.0,
                             -1.0 / 87178291200.0,
                             1.0 / 20922789888000.0};

// ln w = e ln 2 + 2 atanh((m - 1) / (m + 1)) with w = 2^e m, m from sqrt(1/2) to sqrt(2).
[[gnu::always_inline]] inline void logarithm(Lanes& w) {
  const LaneBits bits = reinterpret_cast<LaneBits>(w);
  LaneBits mantissa = (bits & kMantissa) | kOneBits;
  const Lanes m = reinterpret_cast<Lanes>(mantissa);
  const LaneBits high = m > std::numbers::sqrt2;  // -1 where one more halving is due
  // The exponent as a number: its bits below those of 2^52.
  const LaneBits biased = ((bits >> 52) - high) | 0x4330000000000000;
  const Lanes exponent = reinterpret_cast<Lanes>(biased) - (0x1p52 + 1023.0);
  const Lanes half = high ? m * 0.5 : m;
  const Lanes s = (half - 1.0) / (half + 1.0);
  Lanes series;
  polynomial(kLog, s * s, series);
  // ln 2 in two parts, the first of which times an exponent is exact.
  constexpr double kLn2High = 0x1.62e42fefa38p-1, kLn2Low = 0x1.ef35793c7673p-45;
  w = exponent * kLn2High + (s * series + exponent * kLn2Low);
}

// sin and cos of 2 pi v for v from 0 to 1: the nearest quarter turn taken off.
[[gnu::always_inline]] inline void turn(const Lanes& v, Lanes& sine, Lanes& cosine) {
  const Lanes shifted = v * 4.0 + kRounding;
  const LaneBits quarter = reinterpret_cast<LaneBits>(shifted);
  const Lanes angle = (v - (shifted - kRounding) * 0.25) * (2.0 * std::numbers::pi);
  const Lanes squared = angle * angle;
  Lanes s, c;
  polynomial(kSine, squared, s);
  polynomial(kCosine, squared, c);
  s *= angle;
  const LaneBits odd = (quarter & 1) != 0, sine_below = (quarter & 2) != 0,
                 cosine_below = ((quarter + 1) & 2) != 0;
  sine = odd ? c : s;
  cosine = odd ? s : c;
  sine = sine_below ? -sine : sine;
  cosine = cosine_below ? -cosine : cosine;
}

// From the bits of two draws: radius^2 and both parts of a unit vector.
[[gnu::always_inline]] inline void polar(const std::int64_t* first, const std::int64_t* second,
                                         double* squared, double* cosines, double* sines) {
  for (std::int64_t i = 0; i < kBlock; i += kLanes) {
    LaneBits a, b;
    __builtin_memcpy(&a, first + i, sizeof a);
    __builtin_memcpy(&b, second + i, sizeof b);
    a = ((a >> 12) & kMantissa) | kOneBits;
    b = ((b >> 12) & kMantissa) | kOneBits;
    Lanes rest = 2.0 - reinterpret_cast<Lanes>(a);  // 1 - u of a draw u from 0 to 1
    const Lanes share = reinterpret_cast<Lanes>(b) - 1.0;
    logarithm(rest);
    store(squared + i, -2.0 * rest);
    Lanes s, c;
    turn(share, s, c);
    store(sines + i, s);
    store(cosines + i, c);
  }
}

[[gnu::always_inline]] inline void logarithms_of(double* values, std::int64_t count) {
  std::int64_t i = 0;
  Lanes w;
  for (; i + kLanes <= count; i += kLanes) {
    load(w, values + i);
    logarithm(w);
    store(values + i, w);
  }
  if (i == count) return;
  spread(w, 1.0);
  for (std::int64_t k = i; k < count; ++k) w[k - i] = values[k];
  logarithm(w);
  for (std::int64_t k = i; k < count; ++k) values[k] = w[k - i];
}

}  // namespace

void fill_normals(std::uint64_t seed, std::uint64_t stream, std::int64_t first, std::span<double> out) {
  check(first >= 0 && first % 2 == 0, "normal numbers are made in pairs");
  constexpr std::uint64_t kStep = 0x9E3779B97F4A7C15ULL;
  const std::uint64_t key = mix64(seed) ^ mix64(stream + 0x632BE59BD9B4E019ULL);
  std::uint64_t counter = key + (static_cast<std::uint64_t>(first) + 1) * kStep;
  std::array<std::int64_t, kBlock> a, b;
  std::array<double, kBlock> squared, cosines, sines;
  const auto count = static_cast<std::int64_t>(out.size());
  for (std::int64_t begin = 0; begin < count; begin += 2 * kBlock) {
    const std::int64_t pairs = std::min(kBlock, (count - begin + 1) / 2);
    for (std::size_t i = 0; i < static_cast<std::size_t>(kBlock); ++i, counter += 2 * kStep) {
      a[i] = static_cast<std::int64_t>(mix64(counter));
      b[i] = static_cast<std::int64_t>(mix64(counter + kStep));
    }
    run_wide<polar>(static_cast<const std::int64_t*>(a.data()), static_cast<const std::int64_t*>(b.data()),
                    squared.data(), cosines.data(), sines.data());
    double* to = out.data() + begin;
    for (std::int64_t p = 0; p < pairs; ++p) {
      const auto i = static_cast<std::size_t>(p);
      const double radius = std::sqrt(squared[i]);
      to[2 * p] = radius * cosines[i];
      if (begin + 2 * p + 1 < count) to[2 * p + 1] = radius * sines[i];
    }
  }
}

void logarithms(std::span<double> values) {
  run_wide<logarithms_of>(values.data(), static_cast<std::int64_t>(values.size()));
}

}  // namespace kinemark::math
