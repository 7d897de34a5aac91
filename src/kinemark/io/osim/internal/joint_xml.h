// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pugixml.hpp>
#include <vector>

#include "kinemark/data/model_description.h"
#include "kinemark/io/osim/internal/frame_table.h"
#include "kinemark/io/osim/internal/joint_types.h"
#include "kinemark/io/osim/internal/xml_file.h"

namespace kinemark::io::osim {

/// A joint as stored in the file, before it is known which of its two bodies is nearer to the ground.
struct FileJoint {
  pugi::xml_node node;
  data::JointDescription description;  ///< parent and child as the file names them
  std::vector<int> coordinates;        ///< indices, in the order of the file
};

/// Reads one joint of any supported type and appends its coordinates to the model.
/// @param owner_body  the body around a joint of a document before 4.0; -2: the joint names its child
[[nodiscard]] FileJoint read_joint(XmlFile& file, FrameTable& frames, pugi::xml_node model,
                                   pugi::xml_node node, int owner_body, data::ModelDescription& description);

/// Connects every body to the ground: reverses joints whose child is nearer to the ground than their parent,
/// splits scapulothoracic joints, and puts the result into the description. A joint that closes a
/// loop, or a body that no joint reaches, is noted.
///
/// A reversed joint has the inverse motion: R^-1, then the opposite translation. Where it has both, a
/// massless body
/// "<joint>_intermediate" comes between, with the joints "<joint>_rotation" and "<joint>".
void hang_from_ground(XmlFile& file, std::vector<FileJoint> joints, data::ModelDescription& description);

}  // namespace kinemark::io::osim
