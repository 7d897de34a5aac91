// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Is a recording the mirror image of a body?
#pragma once

#include <string>

#include "kinemark/data/trajectories.h"
#include "kinemark/stages/motion/foundations/standing_body.h"

namespace kinemark::motion {

/// Whether the mirror image of a recording shows the body, and the recording does not: in most of three
/// evenly picked frames. False where fewer than six markers of the body are seen. About 0.1 s.
[[nodiscard]] bool shows_mirrored_body(const StandingBody& body, const data::Trajectories& recording);

/// "cal.c3d shows a mirrored body: ...", with the causes that look alike.
[[nodiscard]] std::string describe_mirrored(const std::string& recording);

}  // namespace kinemark::motion
