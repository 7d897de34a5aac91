// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pugixml.hpp>
#include <string>
#include <vector>

#include "kinemark/data/muscle_path.h"
#include "kinemark/io/osim/internal/frame_table.h"
#include "kinemark/io/osim/internal/xml_file.h"

namespace kinemark::io::osim {

/// Every element with the tag, in the order of the file.
[[nodiscard]] std::vector<pugi::xml_node> descendants(pugi::xml_node node, std::string_view tag);

/// The muscle, ligament or spring that owns a <GeometryPath>.
[[nodiscard]] pugi::xml_node owner_of_path(pugi::xml_node geometry_path);

/// The frame of a point, marker or station, in any spelling of the versions. No value where none is named.
[[nodiscard]] std::optional<Attachment> frame_of_point(FrameTable& frames, pugi::xml_node point);

/// Names of the three functions of a moving path point, and of the three sockets of their coordinates.
inline constexpr std::array<const char*, 3> kPositions = {"x_location", "y_location", "z_location"};

/// All paths of the model, in the order of the file. What is wrong is noted in the file.
[[nodiscard]] std::vector<data::MusclePath> read_paths(XmlFile& file, FrameTable& frames,
                                                       pugi::xml_node model,
                                                       const data::ModelDescription& description);

}  // namespace kinemark::io::osim
