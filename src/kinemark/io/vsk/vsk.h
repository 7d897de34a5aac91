// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kinemark/core/result.h"

// VSK, Vicon's file of a subject's skeleton; VST, the template that it is made from. docs/formats/vsk.md
namespace kinemark::io {

/// How a segment hangs on its parent.
enum class VskJointKind : std::uint8_t {
  free,          ///< moves and turns as it likes: no joint
  ball,          ///< three angles
  hardy_spicer,  ///< two angles
  hinge,         ///< one angle
  slider,        ///< one distance
  fixed,         ///< not at all
};
[[nodiscard]] std::string_view to_string(VskJointKind kind);  ///< "free", "ball", "hardy_spicer", ...

/// A segment and its joint with its parent.
struct VskSegment {
  std::string name;                        ///< unique
  int parent = -1;                         ///< index of a segment before it; -1: a root
  std::string joint;                       ///< its name; may be empty
  VskJointKind kind = VskJointKind::free;  ///< of the joint
};

/// A marker of the subject.
struct VskMarker {
  std::string name;                             ///< unique
  int segment = -1;                             ///< index of the segment that it is on
  std::optional<Eigen::Vector3d> x_in_segment;  ///< m; none: a template, which holds an expression
  bool required = true;                         ///< false: a recording may lack it
};

/// A measure of the subject.
struct VskParameter {
  std::string name;             ///< unique
  std::string unit;             ///< "m", "kg", "rad"; empty: the file does not say what it is
  std::optional<double> value;  ///< in `unit`, else as the file has it; none: not measured
  std::string expression;       ///< of other parameters; empty: none
};

/// What a VSK file holds.
struct Vsk {
  std::string model;                        ///< "PlugInGait"
  std::vector<VskSegment> segments;         ///< parents first
  std::vector<VskMarker> markers;           ///< in the order of the file
  std::vector<std::pair<int, int>> sticks;  ///< pairs of markers that are drawn joined
  std::vector<VskParameter> parameters;     ///< in the order of the file
  std::vector<std::string> warnings;        ///< what was left out, one sentence each
};

/// Read a VSK or a VST file. Lengths are metres (millimetres in the file), angles radians, masses kilograms.
/// Expressions are kept as text. Code::bad_input, with the element, for what does not fit: no
/// KinematicModel, no segment, names that stand twice, a marker on a segment that is not there; Code::io
/// when it cannot be read. At most 4 MiB are read.
[[nodiscard]] Result<Vsk> read_vsk(const std::filesystem::path& path);

/// The same from memory; `name` stands for the file in messages.
[[nodiscard]] Result<Vsk> parse_vsk(std::string_view xml, std::string_view name);

/// Whether an ending (small letters, with its dot) is that of such a file: .vsk, .vst.
[[nodiscard]] bool is_vsk_ending(std::string_view ending);

}  // namespace kinemark::io
