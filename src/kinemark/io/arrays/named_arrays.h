// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Plain arrays under names, as people save them from NumPy and MATLAB, made a recording.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"

namespace kinemark::io {

/// An array in the order of C, the last index fastest: of numbers, or of texts.
struct NamedArray {
  std::string name;
  std::vector<std::int64_t> shape;  ///< empty: one value
  std::vector<double> numbers;      ///< as many as the shape says; empty for texts
  std::vector<std::string> texts;   ///< as many as the shape says, UTF-8; empty for numbers
  bool is_text = false;             ///< of which there are none in an empty array

  /// Product of the shape.
  [[nodiscard]] std::int64_t size() const;
};

/// The recording that arrays hold: one array of all positions (frames x markers x 3, another order that names
/// and times settle, or frames x 3 markers) with an array of names, or an array of frames x 3 for each marker
/// under its name; a clock from times in s or a rate in Hz. The unit is the one that an array or `unit` says,
/// else the one of m, cm and mm that makes the recording as large as a body, with a warning. NaN is a missing
/// sample; arrays that are none of these are named in a warning.
///
/// Code::bad_input, with what is there and what was expected; no file is named. The caller checks the trial
/// and makes the message printable. Memory: the arrays and twice the trial.
[[nodiscard]] Result<data::Trial> trial_of_arrays(std::vector<NamedArray> arrays, std::string_view unit);

}  // namespace kinemark::io
