// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "cli/screens/canvas.h"
#include "cli/screens/key.h"
#include "kinemark/core/result.h"

namespace kinemark::screens {

/// The terminal that this program runs in, taken over until it is destroyed. One at a time.
class Terminal {
 public:
  /// Code::usage where input or output is no terminal, or where its kind (TERM) cannot place characters;
  /// Code::not_supported in a program built without ncurses.
  [[nodiscard]] static Result<std::unique_ptr<Terminal>> open();
  virtual ~Terminal() = default;
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;
  [[nodiscard]] virtual int rows() const = 0;
  [[nodiscard]] virtual int columns() const = 0;
  /// Show it; what did not change is not sent.
  virtual void show(const Canvas& canvas) = 0;
  /// The next key; Kind::none after this time, and when the terminal was made larger or smaller.
  [[nodiscard]] virtual Key wait(int milliseconds) = 0;

 protected:
  Terminal() = default;
};

}  // namespace kinemark::screens
