// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/core/result.h"
#include "kinemark/stream/frame.h"

namespace kinemark::stream {

/// Takes frames in the order in which they come. To be used by one thread at a time.
class Sink {
 public:
  Sink() = default;
  virtual ~Sink() = default;
  Sink(const Sink&) = delete;
  Sink& operator=(const Sink&) = delete;
  /// One frame, of which nothing is kept that is not copied. After a failure it takes no more.
  [[nodiscard]] virtual Status push(const Frame& frame) = 0;
  /// No more frames come. To be called once, and not after a failure.
  [[nodiscard]] virtual Status finish() = 0;
};

}  // namespace kinemark::stream
