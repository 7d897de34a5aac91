// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "cli/screens/canvas.h"
#include "cli/screens/key.h"

namespace kinemark::screens {

/// One line to fill in.
struct Field {
  std::string label;  ///< "Rate, Hz"
  std::string value;  ///< UTF-8, as typed
  std::string hint;   ///< what to type, shown while it is chosen
};

/// Lines to fill in, one of which is chosen: up and down choose, characters are added at its end, backspace
/// takes the last away.
class Form {
 public:
  explicit Form(std::vector<Field> fields) : fields_(std::move(fields)) {}
  /// Whether the key was one of the form's.
  bool press(const Key& key);
  /// From a row down, one row for each field and one for the hint of the chosen one.
  void draw(Canvas& canvas, int row, int column) const;
  [[nodiscard]] const std::string& value(std::size_t field) const { return fields_[field].value; }
  void set(std::size_t field, std::string value) { fields_[field].value = std::move(value); }
  [[nodiscard]] int rows() const { return static_cast<int>(fields_.size()) + 2; }  ///< that draw() takes

 private:
  std::vector<Field> fields_;
  std::size_t chosen_ = 0;
};

}  // namespace kinemark::screens
