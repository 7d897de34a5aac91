// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "kinemark/core/result.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/control/track_options.h"
#include "kinemark/stream/stream.h"

namespace kinemark::pipeline {

/// A source of frames, and what belongs to it.
struct LiveInput {
  std::unique_ptr<stream::Source> source;     ///< never nullptr
  std::string title;                          ///< for a heading: "Simulated walk", "trial.c3d"
  std::filesystem::path file = {};            ///< that is replayed; empty: none
  std::shared_ptr<const model::Model> model;  ///< whose angles are wanted; may be absent
};

/// Whether an argument names a source and no file: it begins with "sim:" or "replay:".
[[nodiscard]] bool names_live_input(std::string_view argument);

/// Open a source.
///
/// "sim:MOTION?rate=HZ&seconds=S&noise=MM&missing=SHARE": a simulated subject, MOTION as parse_motion_kind(),
/// "walk" when empty; 240 Hz, 60 s, 1 mm and 0 unless told. Its model is kinemark's human, or the one given.
/// "arm": the arm of a macaque that reaches for food, in a sleeve of 16 LEDs, at 60 Hz, LEDs hidden as the
/// arm turns; without a model unless one is given. Frames are made as they come: memory does not grow with
/// the time. "replay:FILE?rate=HZ": a marker file; it comes at its own rate, or at the one told. What follows
/// the last
/// '?' are settings, unless that file is there. Memory: that of the file's samples.
///
/// @param model  .osim whose angles are wanted; empty: that of the simulation, none of a replay
/// Code::usage for a source that is none, a setting that is none or out of range (ten million frames at most
/// are simulated); else fails as the reader of the file and of the model.
[[nodiscard]] Result<LiveInput> open_live_input(std::string_view argument,
                                                const std::filesystem::path& model = {},
                                                std::uint64_t seed = 1);

/// The page of a source, without a frame: `kinemark.live` of the viewer, which asks for a WebSocket at
/// "/live/socket". @param recording  where frames are kept; empty: nowhere  @param track  how the model
/// follows
[[nodiscard]] std::string live_page(const LiveInput& input, const std::filesystem::path& recording,
                                    const motion::TrackOptions& track = {});

}  // namespace kinemark::pipeline
