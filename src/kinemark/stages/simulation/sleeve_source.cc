// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/sleeve_source.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "kinemark/core/random.h"
#include "kinemark/stages/simulation/internal/limb_build.h"
#include "kinemark/stages/simulation/internal/sleeve_arm.h"
#include "kinemark/stages/simulation/internal/sleeve_sight.h"

namespace kinemark::simulation {
namespace {

constexpr double kExtent_s = 60.0;  // of the beginning, whose markers give the extent

int led_count(const SleeveOptions& options) { return 2 * options.leds_per_segment + (options.tip ? 1 : 0); }

std::array<Eigen::Vector3d, 2> extent_of(const SleeveOptions& options) {
  internal::ArmMotion motion(options);
  const auto leds = internal::sleeve_leds(options);
  Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = low;  // the shoulder
  const auto frames = std::min(options.frames(), static_cast<std::int64_t>(kExtent_s * options.rate_hz) + 1);
  for (std::int64_t f = 0; f < frames; ++f) {
    const auto pose = motion.next();
    for (int led = 0; led < led_count(options); ++led) {
      const auto x = internal::led_in_world(options, leds, pose, led, Eigen::Vector3d::Zero()).x;
      low = low.cwiseMin(x);
      high = high.cwiseMax(x);
    }
  }
  return {low, high};
}

}  // namespace

struct SleeveSource::Impl {
  explicit Impl(const SleeveOptions& asked)
      : options(asked),
        motion(asked),
        sight(asked),
        leds(internal::sleeve_leds(asked)),
        noise(asked.seed, static_cast<std::uint64_t>(internal::LimbStream::noise)),
        loss(asked.seed, static_cast<std::uint64_t>(internal::LimbStream::loss)) {}

  SleeveOptions options;
  internal::ArmMotion motion;
  internal::SleeveSight sight;
  std::array<Eigen::Matrix3Xd, 2> leds;
  Random noise, loss;
  std::int64_t next = 0;
};

SleeveSource::SleeveSource(std::unique_ptr<Impl> impl, stream::SourceFacts facts)
    : Source(std::move(facts)), impl_(std::move(impl)) {}

SleeveSource::~SleeveSource() = default;

Result<std::unique_ptr<SleeveSource>> SleeveSource::create(const SleeveOptions& options,
                                                           stream::SourceFacts facts) {
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  if (options.skin_m != 0.0)
    return fail(Code::usage, "skin needs a whole recording; expected 0 for a stream");
  const auto layout = internal::empty_limb(
      {"upper_arm", "forearm"}, {"elbow"}, {"u", "f"}, options.leds_per_segment, {options.rate_hz, 0.0, 0},
      options.tip ? std::vector<std::string>{"w0"} : std::vector<std::string>{});
  facts.markers = layout.markers.names;
  facts.rate_hz = options.rate_hz;
  facts.t0_s = 0.0;
  facts.frames = options.frames();
  facts.up = Eigen::Vector3d::UnitZ();
  facts.up_from = "the simulated arm";
  facts.extent_m = extent_of(options);
  return std::unique_ptr<SleeveSource>(new SleeveSource(std::make_unique<Impl>(options), std::move(facts)));
}

Result<bool> SleeveSource::next(stream::Frame& frame) {
  auto& s = *impl_;
  if (s.next == *facts().frames) return false;
  const int leds = led_count(s.options);
  frame.number = s.next;
  frame.time_s = static_cast<double>(s.next) / facts().rate_hz;
  frame.clear(static_cast<std::size_t>(leds));
  const auto pose = s.motion.next();
  s.sight.begin_frame(pose.wrist);
  for (int led = 0; led < leds; ++led) {
    const auto at = static_cast<std::size_t>(led);
    const auto [x, normal] = internal::led_in_world(s.options, s.leds, pose, led, Eigen::Vector3d::Zero());
    const bool lost = s.loss.uniform() < s.options.missing;
    if (s.options.line_of_sight && !s.sight.sees(led, x, normal)) continue;
    if (lost) continue;
    s.noise.seek(6 * (static_cast<std::uint64_t>(s.next) * static_cast<std::uint64_t>(leds) + at));
    for (int a = 0; a < 3; ++a)
      frame.x_in_world[3 * at + static_cast<std::size_t>(a)] =
          x[a] + s.options.noise_sd_m * s.noise.gaussian();
    frame.state[at] = data::SampleState::measured;
  }
  ++s.next;
  return true;
}

}  // namespace kinemark::simulation
