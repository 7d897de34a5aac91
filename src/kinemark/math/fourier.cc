// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/fourier.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/core/index.h"
#include "kinemark/core/wide.h"

namespace kinemark::math {
namespace {

// One factor of the transform: of length n with stride s, from one pair of arrays to the other.
struct Pass {
  const double *re, *im;
  double *to_re, *to_im;
  const double *cosines, *sines;
  std::int64_t n, s, whole;
};

// Discrete transforms of a few numbers, in place.
template <int kFactor>
[[gnu::always_inline]] inline void few(Lanes* re, Lanes* im) {
  if constexpr (kFactor == 2) {
    const Lanes r = re[0] - re[1], i = im[0] - im[1];
    re[0] += re[1], im[0] += im[1];
    re[1] = r, im[1] = i;
  } else if constexpr (kFactor == 3) {
    const double half_root = 0.5 * std::numbers::sqrt3;
    const Lanes sum_re = re[1] + re[2], sum_im = im[1] + im[2];
    const Lanes turn_re = half_root * (re[1] - re[2]), turn_im = half_root * (im[1] - im[2]);
    const Lanes mid_re = re[0] - 0.5 * sum_re, mid_im = im[0] - 0.5 * sum_im;
    re[0] += sum_re, im[0] += sum_im;
    re[1] = mid_re + turn_im, im[1] = mid_im - turn_re;
    re[2] = mid_re - turn_im, im[2] = mid_im + turn_re;
  } else if constexpr (kFactor == 4) {
    const Lanes a_re = re[0] + re[2], a_im = im[0] + im[2], b_re = re[0] - re[2], b_im = im[0] - im[2];
    const Lanes c_re = re[1] + re[3], c_im = im[1] + im[3], d_re = re[1] - re[3], d_im = im[1] - im[3];
    re[0] = a_re + c_re, im[0] = a_im + c_im;
    re[1] = b_re + d_im, im[1] = b_im - d_re;
    re[2] = a_re - c_re, im[2] = a_im - c_im;
    re[3] = b_re - d_im, im[3] = b_im + d_re;
  } else {
    // Cosine and sine of a fifth and of two fifths of a turn.
    constexpr double c1 = 0.30901699437494742410, c2 = -0.80901699437494742410;
    constexpr double s1 = 0.95105651629515357212, s2 = 0.58778525229247312917;
    const Lanes a_re = re[1] + re[4], a_im = im[1] + im[4], b_re = re[2] + re[3], b_im = im[2] + im[3];
    const Lanes c_re = re[1] - re[4], c_im = im[1] - im[4], d_re = re[2] - re[3], d_im = im[2] - im[3];
    const Lanes e_re = re[0] + c1 * a_re + c2 * b_re, e_im = im[0] + c1 * a_im + c2 * b_im;
    const Lanes f_re = re[0] + c2 * a_re + c1 * b_re, f_im = im[0] + c2 * a_im + c1 * b_im;
    const Lanes g_re = s1 * c_re + s2 * d_re, g_im = s1 * c_im + s2 * d_im;
    const Lanes h_re = s2 * c_re - s1 * d_re, h_im = s2 * c_im - s1 * d_im;
    re[0] += a_re + b_re, im[0] += a_im + b_im;
    re[1] = e_re + g_im, im[1] = e_im - g_re;
    re[4] = e_re - g_im, im[4] = e_im + g_re;
    re[2] = f_re + h_im, im[2] = f_im - h_re;
    re[3] = f_re - h_im, im[3] = f_im + h_re;
  }
}

template <int kFactor>
[[gnu::always_inline]] inline void transform_pass(const Pass& of) {
  const std::int64_t m = of.n / kFactor, step = of.whole / of.n, s = of.s;
  for (std::int64_t p = 0; p < m; ++p) {
    double c[kFactor], d[kFactor];
    for (int j = 1; j < kFactor; ++j) c[j] = of.cosines[p * j * step], d[j] = of.sines[p * j * step];
    for (std::int64_t q = 0; q < s; ++q) {
      Lanes re[kFactor], im[kFactor];
      for (int l = 0; l < kFactor; ++l) {
        load(re[l], of.re + kLanes * (q + s * (p + m * l)));
        load(im[l], of.im + kLanes * (q + s * (p + m * l)));
      }
      few<kFactor>(re, im);
      double *to_re = of.to_re + kLanes * (q + s * kFactor * p),
             *to_im = of.to_im + kLanes * (q + s * kFactor * p);
      store(to_re, re[0]), store(to_im, im[0]);
      for (int j = 1; j < kFactor; ++j) {
        store(to_re + kLanes * s * j, re[j] * c[j] + im[j] * d[j]);
        store(to_im + kLanes * s * j, im[j] * c[j] - re[j] * d[j]);
      }
    }
  }
}

}  // namespace

bool FourierTransform::fits(std::int64_t length) {
  if (length < 8 || length % 8 != 0) return false;
  for (const std::int64_t prime : {2, 3, 5})
    while (length % prime == 0) length /= prime;
  return length == 1;
}

std::int64_t FourierTransform::good_length(std::int64_t n) {
  constexpr std::int64_t kMany = 2048;
  const std::int64_t step = n < kMany ? 8 : 32;
  std::int64_t length = (std::max<std::int64_t>(n, 1) + step - 1) / step * step;
  while (!fits(length)) length += step;
  return length;
}

FourierTransform::FourierTransform(std::int64_t length) : length_(length), part_(length / 8) {
  check(fits(length), "a transform's length is a multiple of 8 without prime factors above 5");
  for (auto* values : {&cosines_, &sines_, &join_cos_, &join_sin_}) values->resize(at(part_));
  for (auto* values : {&real_, &imaginary_, &other_real_, &other_imaginary_}) values->resize(at(length / 2));
  for (std::int64_t k = 0; k < part_; ++k) {
    const double turn = 2.0 * std::numbers::pi * static_cast<double>(k);
    cosines_[at(k)] = std::cos(turn / static_cast<double>(part_));
    sines_[at(k)] = std::sin(turn / static_cast<double>(part_));
    join_cos_[at(k)] = std::cos(turn / static_cast<double>(length));
    join_sin_[at(k)] = std::sin(turn / static_cast<double>(length));
  }
}

// From the four transforms, side by side, that of all pairs: frequency k + part q from number k of each.
void FourierTransform::join() {
  for (std::int64_t k = 0; k < part_; ++k) {
    const double c1 = join_cos_[at(k)], s1 = join_sin_[at(k)];  // of 2 pi k / length
    const double c2 = c1 * c1 - s1 * s1, s2 = 2.0 * c1 * s1;    // of twice that: a step of a pair
    double re[4], im[4], c = 1.0, s = 0.0;
    for (int r = 0; r < 4; ++r) {
      const double x = real_[at(4 * k + r)], y = imaginary_[at(4 * k + r)];
      re[r] = x * c + y * s, im[r] = y * c - x * s;
      const double next = c * c2 - s * s2;
      s = s * c2 + c * s2, c = next;
    }
    const double a_re = re[0] + re[2], a_im = im[0] + im[2], b_re = re[0] - re[2], b_im = im[0] - im[2];
    const double c_re = re[1] + re[3], c_im = im[1] + im[3], d_re = re[1] - re[3], d_im = im[1] - im[3];
    other_real_[at(k)] = a_re + c_re, other_imaginary_[at(k)] = a_im + c_im;
    other_real_[at(k + part_)] = b_re + d_im, other_imaginary_[at(k + part_)] = b_im - d_re;
    other_real_[at(k + 2 * part_)] = a_re - c_re, other_imaginary_[at(k + 2 * part_)] = a_im - c_im;
    other_real_[at(k + 3 * part_)] = b_re - d_im, other_imaginary_[at(k + 3 * part_)] = b_im + d_re;
  }
}

void FourierTransform::add_power(const Eigen::Ref<const Eigen::VectorXd>& series,
                                 Eigen::Ref<Eigen::VectorXd> power) {
  const std::int64_t n = series.size(), half = length_ / 2;
  check(n <= length_ && power.size() <= half + 1, "a transform is as long as its series, or longer");
  // Even samples are the real, odd ones the imaginary parts of half as many.
  for (std::int64_t i = 0; i < half; ++i) {
    real_[at(i)] = 2 * i < n ? series[2 * i] : 0.0;
    imaginary_[at(i)] = 2 * i + 1 < n ? series[2 * i + 1] : 0.0;
  }
  std::int64_t left = part_, s = 1;
  while (left > 1) {
    const Pass pass{.re = real_.data(),
                    .im = imaginary_.data(),
                    .to_re = other_real_.data(),
                    .to_im = other_imaginary_.data(),
                    .cosines = cosines_.data(),
                    .sines = sines_.data(),
                    .n = left,
                    .s = s,
                    .whole = part_};
    const std::int64_t factor = left % 4 == 0 ? 4 : left % 5 == 0 ? 5 : left % 3 == 0 ? 3 : 2;
    if (factor == 4) run_wide<transform_pass<4>>(pass);
    if (factor == 5) run_wide<transform_pass<5>>(pass);
    if (factor == 3) run_wide<transform_pass<3>>(pass);
    if (factor == 2) run_wide<transform_pass<2>>(pass);
    left /= factor, s *= factor;
    std::swap(real_, other_real_), std::swap(imaginary_, other_imaginary_);
  }
  join();
  // Even and odd samples apart again, and one after the other.
  constexpr double kEighth = 0.5 * std::numbers::sqrt2;
  const double part_cos[5] = {1.0, kEighth, 0.0, -kEighth, -1.0},
               part_sin[5] = {0.0, kEighth, 1.0, kEighth, 0.0};
  for (std::int64_t k = 0; k < power.size(); ++k) {
    const std::int64_t here = k % half, there = (half - k) % half, eighth = k / part_;
    const double x = other_real_[at(here)], y = other_imaginary_[at(here)];
    const double u = other_real_[at(there)], v = -other_imaginary_[at(there)];
    const double rest_cos = eighth == 4 ? 1.0 : join_cos_[at(k - eighth * part_)];
    const double rest_sin = eighth == 4 ? 0.0 : join_sin_[at(k - eighth * part_)];
    const double c = rest_cos * part_cos[eighth] - rest_sin * part_sin[eighth];
    const double w = rest_sin * part_cos[eighth] + rest_cos * part_sin[eighth];
    // Odd part: (z - z') / 2i, turned by -2 pi k / length.
    const double odd_re = 0.5 * (y - v), odd_im = -0.5 * (x - u);
    const double re = 0.5 * (x + u) + odd_re * c + odd_im * w;
    const double im = 0.5 * (y + v) + odd_im * c - odd_re * w;
    power[k] += re * re + im * im;
  }
}

}  // namespace kinemark::math
