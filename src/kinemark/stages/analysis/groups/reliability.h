// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Test and retest: how far a measure tells subjects apart, and what change is more than chance.
#pragma once

#include <cstdint>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/core/result.h"
#include "kinemark/data/measure.h"

namespace kinemark::analysis {

/// One measure of n subjects in k sessions.
struct RepeatedMeasure {
  std::int64_t subjects = 0;   ///< n, at least 2
  std::int64_t sessions = 0;   ///< k, at least 2
  std::vector<double> values;  ///< n x k, SI; a subject with a value missing is left out
  std::vector<double>
      noise_sd;  ///< n x k, the part of each value's deviation that is measurement noise, SI; empty: unknown
};

/// An estimate and its two-sided interval.
struct Bounded {
  double value = kNaN;  ///< as estimated
  double low = kNaN;    ///< lower end
  double high = kNaN;   ///< upper end
};

/// What a measure is worth when it is taken again.
struct Reliability {
  std::int64_t subjects = 0;  ///< with a value in every session
  std::int64_t left_out = 0;  ///< subjects with a value missing
  double level = 0.95;        ///< of the intervals
  double mean = kNaN;         ///< of all values
  Bounded agreement;          ///< ICC(2,1): one session, subjects and sessions at random, absolute agreement
  Bounded consistency;  ///< ICC(3,1): one session, sessions fixed, differences between sessions left out
  Bounded sem;  ///< standard error of measurement: root of the error variance, same unit as the measure
  double sem_agreement = kNaN;  ///< the same with the variance between sessions in it
  double mdc = kNaN;            ///< minimal detectable change, 1.96 sqrt(2) sem
  double noise = kNaN;          ///< RMS of the measurement noise; NaN: unknown
  double sem_movement = kNaN;   ///< sem with measurement noise taken out: what subjects themselves vary; 0
                                ///< where noise explains all
  double consistency_movement = kNaN;  ///< ICC(3,1) without measurement noise; NaN: unknown
};

/// Two-way analysis of variance of subjects and sessions (Shrout & Fleiss 1979; intervals: McGraw & Wong
/// 1996).
/// @return  Code::bad_input where fewer than 2 subjects or sessions are left, or the arrays do not fit
[[nodiscard]] Result<Reliability> reliability(const RepeatedMeasure& measure, double level = 0.95);

}  // namespace kinemark::analysis
