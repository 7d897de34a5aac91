// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "kinemark/core/result.h"
#include "kinemark/io/text/keypoints_csv.h"

namespace kinemark::io {

/// Points of a video in one document of JSON. MMPose: `instance_info` with `frame_id` and `instances`, or the
/// list of them alone. COCO: `images`, `annotations` and `categories`, in which each image is a frame. A
/// point is not seen where its score is 0 or too low or its coordinates are no numbers, and nobody is seen in
/// frames that are left out. Points in three dimensions, and several people where none is chosen, are
/// Code::not_supported; anything that makes no sense is Code::bad_input with its frame. `name` stands in
/// messages. Memory is bounded by a multiple of the text. docs/formats/keypoints.md
[[nodiscard]] Result<Keypoints> parse_keypoints_json(std::string_view text, const std::string& name,
                                                     const KeypointsOptions& options = {});

}  // namespace kinemark::io
