// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/keypoints/keypoints_json.h"

#include "kinemark/io/keypoints/internal/coco.h"
#include "kinemark/io/keypoints/internal/json_pieces.h"
#include "kinemark/io/keypoints/internal/mmpose.h"

namespace kinemark::io {

Result<Keypoints> parse_keypoints_json(std::string_view text, const std::string& name,
                                       const KeypointsOptions& options) {
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  internal::MmposeVideo mmpose(options, text.size());
  internal::CocoVideo coco(options, text.size());
  auto status = internal::read_pieces(text, [&](std::string_view key, const nlohmann::json& piece) -> Status {
    if (auto s = mmpose.take(key, piece); !s) return s;
    return coco.take(key, piece);
  });
  if (!status) return fail_at(name, status.error());
  if (!mmpose.any() && !coco.any())
    return fail_at(name, {Code::bad_input,
                          "holds no points: need JSON of MMPose (instance_info), COCO (images, annotations, "
                          "categories) or OpenPose (people)"});
  auto points = mmpose.any() ? mmpose.finish() : coco.finish();
  if (!points) return fail_at(name, points.error());
  return points;
}

}  // namespace kinemark::io
