// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Any bytes: the first tells whether the rest is a document, or frames of OpenPose with zero bytes between.
// Points of whole frames or one sentence, never a crash, a hang or memory without bound.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kinemark/io/keypoints/keypoints_json.h"
#include "kinemark/io/keypoints/openpose.h"

namespace {

using kinemark::Result;
using kinemark::io::Keypoints;
using kinemark::io::KeypointsOptions;

Result<Keypoints> frames_of(std::string_view text, const KeypointsOptions& options) {
  kinemark::io::OpenPoseFrames frames(options);
  for (std::int64_t frame = 0; !text.empty(); ++frame) {
    const auto end = text.find('\0');
    if (auto s = frames.add(frame, text.substr(0, end)); !s) return std::unexpected(s.error());
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return frames.finish();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  KeypointsOptions options;
  if (data[0] == '1' || data[0] == '3') options.person = 1;
  const bool openpose = data[0] == '2' || data[0] == '3';
  const auto read =
      openpose ? frames_of(text, options) : kinemark::io::parse_keypoints_json(text, "fuzz.json", options);
  if (!read) {
    if (read.error().message.find('\n') != std::string::npos) std::abort();
    return 0;
  }
  if (read->frames() < 1 || read->image.size() > 200'000 + 40 * size) std::abort();
  for (std::size_t i = 0; i < read->image.size(); i += 2)
    if (std::isnan(read->image[i]) != std::isnan(read->image[i + 1])) std::abort();
  return 0;
}
