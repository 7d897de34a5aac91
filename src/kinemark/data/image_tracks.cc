// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/image_tracks.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace kinemark::data {

Status ImageTracks::validate() const {
  if (!(time.rate_hz > 0.0) || !std::isfinite(time.rate_hz))
    return fail(Code::bad_input, fmt::format("image tracks have a rate of {} Hz", time.rate_hz));
  if (noise_sd.size() != cameras.size())
    return fail(Code::bad_input, fmt::format("image tracks have {} cameras, but noise of {}", cameras.size(),
                                             noise_sd.size()));
  for (std::size_t c = 0; c < cameras.size(); ++c)
    if (!(noise_sd[c] > 0.0) || !std::isfinite(noise_sd[c]))
      return fail(Code::bad_input, fmt::format("camera '{}' has an image noise of {}; need more than 0",
                                               cameras[c].name, noise_sd[c]));
  const std::size_t numbers =
      2 * static_cast<std::size_t>(std::max<std::int64_t>(0, frames())) * cameras.size() * names.size();
  if (image.size() != numbers)
    return fail(Code::bad_input, fmt::format("image tracks hold {} numbers; need {}", image.size(), numbers));
  return {};
}

}  // namespace kinemark::data
