// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/model_description.h"

namespace kinemark::io {

/// A model as the text of another format.
struct RobotText {
  std::string text;               ///< the whole file
  std::vector<std::string> lost;  ///< what it cannot hold, a sentence each
};

/// As MJCF, MuJoCo's own: bodies with mass, centre and inertia, a hinge or slide named as its coordinate for
/// each simple motion (simplify()) with its range where it is clamped, markers as sites, gravity, what
/// follows as equalities by polynomials of degree 4, the default posture as key "default". Names as
/// make_names_legal(). Angles in rad. The model must have passed validate().
[[nodiscard]] RobotText mjcf_of(const data::ModelDescription& model);

/// As URDF: the same but markers, gravity and the default posture, which it cannot hold. A body with several
/// motions hangs from links without mass, "<body>_axis1" and so on; what follows is a mimic by the best line.
[[nodiscard]] RobotText urdf_of(const data::ModelDescription& model);

/// Write a model as .xml or .mjcf (mjcf_of()) or .urdf (urdf_of()); what was lost. Code::usage for another
/// extension; else as OutputFile.
[[nodiscard]] Result<std::vector<std::string>> write_robot(const std::filesystem::path& path,
                                                           const data::ModelDescription& model, bool force);

}  // namespace kinemark::io
