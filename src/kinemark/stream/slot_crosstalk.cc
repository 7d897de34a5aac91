// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/slot_crosstalk.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kinemark::stream {

void SlotCrosstalk::Span::add(double x, double y) {
  ++frames;
  const double n = static_cast<double>(frames), off_x = x - mean_x, off_y = y - mean_y;
  mean_x += off_x / n;
  mean_y += off_y / n;
  xx += off_x * (x - mean_x);
  xy += off_x * (y - mean_y);
  yy += off_y * (y - mean_y);
}

void SlotCrosstalk::Channel::end_span() {
  ++spans;
  frames += now.frames;
  xx += now.xx;
  xy += now.xy;
  yy += now.yy;
  xx_xx += now.xx * now.xx;
  xx_xy += now.xx * now.xy;
  xy_xy += now.xy * now.xy;
  now = {};
}

void SlotCrosstalk::Channel::add(double x, double y) {
  now.add(x, y);
  if (now.frames == kSpan) end_span();
}

SlotCrosstalk::SlotCrosstalk(const data::Counts& like)
    : observations_(like.leds.size() * like.cameras.size()),
      cameras_(like.dark_time_s.size() / 4),
      last_(4 * cameras_),
      known_(cameras_),
      channels_(4 * cameras_) {
  if (cameras_ == 0) return;
  const double dark_s = like.dark_offset_s(0).mean();
  double before_s = -std::numeric_limits<double>::infinity(), latest_s = before_s;
  int last = -1;
  for (int l = 0; l < static_cast<int>(like.leds.size()); ++l) {
    const double at_s = like.offset_s(l, 0).mean();
    if (at_s < dark_s && at_s > before_s) before_s = at_s, led_ = l;
    if (at_s > latest_s) latest_s = at_s, last = l;
  }
  frame_before_ = led_ < 0;
  if (frame_before_) led_ = last;
}

void SlotCrosstalk::add_frame(const Block& block, std::size_t frame) {
  const std::int64_t number = block.first_frame + static_cast<std::int64_t>(frame);
  const bool follows = number == last_frame_ + 1;
  last_frame_ = number;
  for (std::size_t c = 0; c < cameras_; ++c) {
    const std::size_t at = frame * observations_ + static_cast<std::size_t>(led_) * cameras_ + c;
    const bool usable = (block.flags[at] & (data::kCountLost | data::kCountSaturated)) == 0;
    const bool take = frame_before_ ? follows && known_[c] : usable;
    for (std::size_t k = 0; k < 4; ++k) {
      const double now = block.counts[4 * at + k], x = frame_before_ ? last_[4 * c + k] : now;
      if (take) channels_[4 * c + k].add(x, block.dark[4 * (frame * cameras_ + c) + k]);
      last_[4 * c + k] = now;
    }
    known_[c] = usable;
  }
}

void SlotCrosstalk::add(const Block& block) {
  if (led_ < 0) return;
  for (std::size_t f = 0; f < static_cast<std::size_t>(block.frames); ++f) add_frame(block, f);
}

std::vector<SlotShare> SlotCrosstalk::found() const {
  std::vector<SlotShare> out(cameras_);
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const Channel& channel = channels_[i];
    if (channel.spans < kLeastSpans || !(channel.xx > 0.0)) continue;
    const double share = channel.xy / channel.xx, n = static_cast<double>(channel.spans);
    const double scatter =
        std::max(0.0, channel.xy_xy - 2.0 * share * channel.xx_xy + share * share * channel.xx_xx);
    const double in_common = std::max(0.0, channel.yy - share * channel.xy) / channel.xx;
    const auto k = static_cast<Eigen::Index>(i % 4);
    out[i / 4].share(k) = share;
    out[i / 4].sd(k) = std::hypot(std::sqrt(scatter * n / (n - 1.0)) / channel.xx, in_common);
  }
  return out;
}

}  // namespace kinemark::stream
