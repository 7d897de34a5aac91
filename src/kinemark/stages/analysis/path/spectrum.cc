// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/spectrum.h"

#include <complex>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "kinemark/core/check.h"

namespace kinemark::analysis {

Eigen::VectorXd amplitudes(const Eigen::VectorXd& series, std::int64_t length) {
  check(length >= series.size() && length > 0, "a transform is as long as its series, or longer");
  std::vector<double> padded(static_cast<std::size_t>(length), 0.0);
  for (Eigen::Index i = 0; i < series.size(); ++i) padded[static_cast<std::size_t>(i)] = series[i];
  Eigen::FFT<double> transform;
  transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<std::complex<double>> spectrum;
  transform.fwd(spectrum, padded);
  Eigen::VectorXd out(length / 2 + 1);
  for (Eigen::Index k = 0; k < out.size(); ++k) out[k] = std::abs(spectrum[static_cast<std::size_t>(k)]);
  return out;
}

}  // namespace kinemark::analysis
