// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What scipy's Butterworth filter makes of a signal, forwards and backwards.
#pragma once

#include <cmath>
#include <vector>

namespace kinemark::testing_support {

/// 120 samples.
inline std::vector<double> filtfilt_signal() {
  std::vector<double> x;
  for (int i = 0; i < 120; ++i)
    x.push_back(std::sin(0.07 * i) + 0.3 * std::cos(0.61 * i + 0.2) + 0.1 * std::sin(2.3 * i) + 0.002 * i);
  return x;
}

/// scipy 1.x: b, a = butter(order, 2 * cutoff); filtfilt(b, a, x), with its defaults, at the samples
/// kFiltfiltAt.
struct FiltfiltReference {
  int order;
  double cutoff;
  double y[7];
};
inline constexpr int kFiltfiltAt[7] = {0, 1, 17, 60, 101, 118, 119};
inline constexpr FiltfiltReference kFiltfilt[] = {
    {2,
     0.06,
     {0.29920467596381783, 0.27221682140058917, 0.94740475732209839, -0.72841241357596609,
      0.92699963392738383, 0.94264596269433842, 0.84071827868535443}},
    {4,
     0.06,
     {0.30542945257119342, 0.28784555116766303, 0.97751315751281809, -0.74825552968259568,
      0.89966758819672332, 0.9463211996552805, 0.8430732984636522}},
    {6,
     0.11,
     {0.29645227366780225, 0.17378512015221337, 0.8660164018384926, -0.59598392839825454, 1.0379519551526113,
      0.94394793295147761, 0.82338514461891432}},
    {2,
     0.4,
     {0.29370152644954561, 0.33637300120614277, 0.91565673424619298, -0.58275100911574018, 1.0527783295134299,
      0.93958102915073805, 0.83062058202160405}},
    {8,
     0.2,
     {0.29391688717321413, 0.26025003645167277, 0.83876328098549713, -0.56488469189508717, 1.0664516473040593,
      0.86523587661604751, 0.83125871371002857}},
};

}  // namespace kinemark::testing_support
