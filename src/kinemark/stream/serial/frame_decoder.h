// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Bytes of the serial line to frames of counts, and what was lost on the way.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace kinemark::stream {

inline constexpr std::uint8_t kFrameStart1 = 0xA5, kFrameStart2 = 0x5A;  ///< first bytes of a frame
inline constexpr std::size_t kFrameHead = 12, kFrameTail = 2;            ///< bytes around the counts
inline constexpr int kSerialBits = 10;                                   ///< of a count

/// Size of the frames of one plan: S slots (LEDs and, last, a dark one), C cameras.
struct FrameShape {
  int slots = 0;    ///< S, 1 to 255
  int cameras = 0;  ///< C, 1 to 255

  /// four electrodes of 10 bits: 5 bytes
  [[nodiscard]] std::size_t bytes() const {
    return kFrameHead + 5 * static_cast<std::size_t>(slots) * static_cast<std::size_t>(cameras) + kFrameTail;
  }
};

/// One frame that came whole.
struct SerialFrame {
  std::int64_t number = 0;           ///< from 0 at the start; frames that were lost are counted
  std::int64_t dropped = 0;          ///< frames that the device could not send until then, within those lost
  std::vector<std::int16_t> counts;  ///< S x C x 4
};

/// What was lost since the start.
struct SerialLosses {
  std::int64_t lost = 0;       ///< frames that never came, whoever lost them
  std::int64_t by_device = 0;  ///< frames that the device says it could not send, within `lost`
  std::int64_t refused = 0;    ///< whole frames that came twice or whose number cannot be
  std::int64_t stray = 0;      ///< bytes that belong to no frame
};

/// Finds frames in a stream of bytes of which some are lost, doubled, swapped or changed. A frame counts when
/// its first bytes, its shape and its check agree; where they do not, one byte is passed over and the search
/// goes on, so that every frame that came whole is found, also right behind a damaged one. A damaged frame
/// passes for a whole one in 1 of 65,536 cases. Memory: one frame and what was pushed.
class FrameDecoder {
 public:
  /// A contract: 1 to 255 slots and cameras.
  explicit FrameDecoder(FrameShape shape);
  /// Take bytes in, in the order in which they came.
  void push(std::span<const std::uint8_t> bytes);
  /// The next whole frame, its memory used again; false: more bytes are needed.
  [[nodiscard]] bool next(SerialFrame& frame);
  /// up to the last frame that next() gave
  [[nodiscard]] const SerialLosses& losses() const { return losses_; }

 private:
  [[nodiscard]] bool can_begin(std::size_t at) const;
  [[nodiscard]] bool accept(std::size_t at, SerialFrame& frame);
  FrameShape shape_;
  std::vector<std::uint8_t> bytes_;
  std::size_t at_ = 0;
  std::int64_t expected_ = 0;
  std::uint32_t dropped_ = 0;
  SerialLosses losses_;
};

}  // namespace kinemark::stream
