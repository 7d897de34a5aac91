// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Messages of a live source as bytes, little end first. The viewer reads them in live/message.ts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/data/trajectories.h"
#include "kinemark/model/model.h"
#include "kinemark/workflow/live/live.h"

namespace kinemark::server {

/// What a message holds behind its head.
enum class LiveKind : std::uint8_t {
  markers = 1,   ///< float32 x[count][3] in m, NaN where there is none; uint8 state[count]
  angles = 2,    ///< float32 value[count], float32 sd[count] in deg or mm; uint8 determined[count]
  sentence = 3,  ///< count bytes of UTF-8
};

/// Bytes of the head: uint8 kind, uint8 version (1), uint16 count, uint32 dropped, float64 frame, float64
/// time_s, float64 due_s, float32 answer_s, 4 bytes of 0. `dropped`: messages of this kind that this viewer
/// did not get so far; `due_s`: when the frame was due, by the steady clock of the server's machine;
/// `answer_s`: how long after its due time the last message was known to be drawn, NaN where that is not
/// known.
inline constexpr std::size_t kLiveHeadBytes = 40;

/// A frame of markers. @param x M x 3, m  @param state M
[[nodiscard]] std::string markers_message(std::int64_t frame, double time_s, double due_s,
                                          std::span<const double> x,
                                          std::span<const data::SampleState> state);
/// By what each coordinate of a model is multiplied in messages: degrees of a radian, millimetres of a metre.
[[nodiscard]] std::vector<double> message_units(const model::Model& model);
/// Angles of a frame. @param pose  of workflow::live()  @param units  of its coordinates
[[nodiscard]] std::string angles_message(const motion::LivePose& pose, std::span<const double> units,
                                         double due_s);
/// Something that people should know; more than 65,535 bytes are cut off.
[[nodiscard]] std::string sentence_message(std::string_view sentence, double due_s);

/// Write into a message what differs between viewers.
void set_viewer_fields(std::string& message, std::uint32_t dropped, float answer_s);

/// What a viewer says: how many messages of this connection it has drawn, a float64; nothing for anything
/// else.
[[nodiscard]] std::optional<std::uint64_t> drawn_count(std::string_view bytes);

}  // namespace kinemark::server
