// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "kinemark/core/result.h"
#include "kinemark/data/model_description.h"

namespace kinemark::io {

/// The description as an OpenSim document of version 40000, which OpenSim 4.0 and later open: bodies, joints,
/// couplers, point constraints and markers. Reading it back gives the same motion to rounding (1e-15).
///
/// A joint keeps its OpenSim type where its axes still are those of the type, otherwise it becomes a
/// CustomJoint (a WeldJoint if it cannot move). The two halves of a scapulothoracic joint are joined again.
///
/// Blanks and the characters \ * + / in names, which OpenSim 4 does not allow, become '_'. Coordinates come
/// back in the order of their joints.
///
/// Refused with Code::not_supported, because OpenSim has no form for it: an axis with two coordinates outside
/// an ellipsoid, more than three rotations or translations in a joint, parallel rotation axes, a coordinate
/// that drives several joints or none, a natural spline.
[[nodiscard]] Result<std::string> format_osim(const data::ModelDescription& description);

/// Options of write_osim().
struct WriteOsimOptions {
  bool force = false;  ///< replace a file that exists
  std::string set;     ///< of files that it belongs to (set_mark()), as a comment; empty: none
};

/// Write format_osim() to `path`, whole or not at all.
[[nodiscard]] Status write_osim(const std::filesystem::path& path, const data::ModelDescription& description,
                                const WriteOsimOptions& options = {});

/// Write a document that is ready, as format_osim() and OsimDocument::format() make it.
[[nodiscard]] Status write_osim_text(const std::filesystem::path& path, const std::string& text,
                                     const WriteOsimOptions& options = {});

}  // namespace kinemark::io
