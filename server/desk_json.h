// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A desk in JSON: how it is, DeskState of docs/formats/pages.md, and what a page asks of it.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/desk/desk_session.h"

namespace kinemark::server {

/// How a session stands. Numbers that are not known are null; of each LED and camera some spots of the last
/// second come, the newest among them.
[[nodiscard]] nlohmann::ordered_json desk_json(const pipeline::DeskState& state);

/// What a session can be asked for, in its words: the calls of pipeline::DeskSession.
enum class DeskAction : std::uint8_t {
  look,
  open,
  leave_source,
  start,
  set_up,
  restart_guide,
  intensity,
  record,
  stop,
  keep,
  discard
};

/// A call, and what it takes.
struct DeskRequest {
  DeskAction action = DeskAction::look;
  std::string uri;         ///< of `open`
  pipeline::Wanted lines;  ///< of `start`
  int led = 0;             ///< of `intensity`, from 0
  double intensity = 1.0;  ///< of `intensity`
};

/// Parse {"do": "start", "leds": "3", "rate_hz": "", "duration_s": 20, "subject": "S1", "trial": "01"},
/// {"do": "open", "uri": "sim:rig"}, {"do": "intensity", "led": 0, "value": 0.5} and, of all others,
/// {"do": NAME}. Lines of a set-up are texts, or numbers. Code::bad_input, one sentence: no such object, a
/// member too many or too few, a value of another type, a text with a control character; an address of no
/// device that is attached: files are not opened for pages.
/// @param now  lines of a set-up that are not told
[[nodiscard]] Result<DeskRequest> parse_desk_request(std::string_view body, const pipeline::Wanted& now);

/// Do it.
void ask_desk(const DeskRequest& request, pipeline::DeskSession& session);

}  // namespace kinemark::server
