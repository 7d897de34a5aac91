// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/c3d/writer.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "kinemark/core/array.h"
#include "kinemark/io/c3d/plan.h"
#include "kinemark/io/c3d/provenance.h"
#include "kinemark/io/file.h"

namespace kinemark::io {
namespace {

using data::SampleState;

constexpr std::size_t kBufferBytes = 512UL << 10;

/// Turns frames into bytes.
class FrameEncoder {
 public:
  FrameEncoder(const data::Trial& trial, const C3dPlan& plan)
      : trial_(trial),
        plan_(plan),
        points_(trial.markers.markers()),
        channels_(trial.analog.names.size()),
        units_per_metre_(plan.units_per_metre / (plan.integers ? plan.scale : 1.0)),
        steps_per_metre_(plan.units_per_metre / plan.scale) {}

  [[nodiscard]] std::size_t frame_bytes() const {
    const auto analog = channels_ * static_cast<std::size_t>(plan_.samples_per_frame);
    return (4 * (static_cast<std::size_t>(points_) + plan_.channel_factor.size() + plan_.unfiltered.size()) +
            analog) *
           (plan_.integers ? 2 : 4);
  }

  void encode(std::int64_t frame, std::byte* out) {
    at_ = out;
    for (std::int64_t m = 0; m < points_; ++m) point(frame, m);
    for (std::size_t c = 0; c < plan_.channel_factor.size(); ++c) channel(static_cast<std::size_t>(frame), c);
    for (const auto m : plan_.unfiltered) unfiltered(frame, m);
    const auto samples = channels_ * static_cast<std::size_t>(plan_.samples_per_frame);
    const double* analog = trial_.analog.values.data() + static_cast<std::size_t>(frame) * samples;
    for (std::size_t i = 0; i < samples; ++i) put(analog[i] / plan_.analog_scale[i % channels_]);
  }

 private:
  void put(double value) {
    if (plan_.integers) {
      store_u16(at_, static_cast<std::uint16_t>(std::lround(value)), plan_.processor);
      at_ += 2;
    } else {
      store_f32(at_, static_cast<float>(value), plan_.processor);
      at_ += 4;
    }
  }

  /// Camera mask and residual in steps, at least one.
  double measured_word(std::size_t i) const {
    double steps = 1.0;
    if (!trial_.residual_m.empty() && std::isfinite(trial_.residual_m[i]))
      steps = std::clamp(std::round(trial_.residual_m[i] * steps_per_metre_), 1.0, 255.0);
    const int mask = trial_.camera_mask.empty() ? 0 : trial_.camera_mask[i] & 0x7F;
    return 256.0 * mask + steps;
  }

  void point(std::int64_t frame, std::int64_t m) {
    if (!trial_.markers.present(frame, m)) {
      for (const double v : {0.0, 0.0, 0.0, -1.0}) put(v);
      return;
    }
    const std::size_t i = trial_.markers.index(frame, m);
    Eigen::Vector3d x = units_per_metre_ * trial_.markers.x(frame, m);
    const double smallest = plan_.integers ? 0.5 : 1e-30;
    if (x.cwiseAbs().maxCoeff() < smallest) x.z() = plan_.integers ? 1.0 : 1e-6;
    for (const double v : x) put(v);
    put(trial_.markers.state[i] == SampleState::measured ? measured_word(i) : 0.0);
  }

  /// A sample from before its filter, or missing.
  void unfiltered(std::int64_t frame, std::int64_t m) {
    const std::size_t i = trial_.markers.index(frame, m);
    const double* x = trial_.markers.unfiltered_in_world.data() + 3 * i;
    const bool there = std::isfinite(x[0]);
    for (std::size_t axis = 0; axis < 3; ++axis) put(there ? units_per_metre_ * x[axis] : 0.0);
    put(there ? measured_word(i) : -1.0);
  }

  /// Numbers of the file that they came from; not measured, or missing. A point that is there has three.
  void channel(std::size_t frame, std::size_t c) {
    const double* values = trial_.channels.values.data() + 3 * (frame * plan_.channel_factor.size() + c);
    const double unit = plan_.channel_factor[c] / (plan_.integers ? plan_.scale : 1.0);
    const bool there = std::any_of(values, values + 3, [](double v) { return std::isfinite(v); });
    for (std::size_t axis = 0; axis < 3; ++axis) put(std::isfinite(values[axis]) ? values[axis] * unit : 0.0);
    put(there ? 0.0 : -1.0);
  }

  const data::Trial& trial_;
  const C3dPlan& plan_;
  std::int64_t points_;
  std::size_t channels_;
  double units_per_metre_;  ///< stored units
  double steps_per_metre_;  ///< residual steps
  std::byte* at_ = nullptr;
};

Status write_frames(OutputFile& file, const data::Trial& trial, const C3dPlan& plan) {
  FrameEncoder encoder(trial, plan);
  const std::size_t bytes = encoder.frame_bytes();
  if (bytes == 0) return {};
  const std::int64_t frames = trial.markers.frames();
  const auto block = static_cast<std::int64_t>(std::max<std::size_t>(1, kBufferBytes / bytes));
  Array<std::byte> buffer(static_cast<std::size_t>(std::min(block, frames)) * bytes);
  for (std::int64_t f = 0; f < frames; f += block) {
    const std::int64_t n = std::min(block, frames - f);
    for (std::int64_t k = 0; k < n; ++k)
      encoder.encode(f + k, buffer.data() + static_cast<std::size_t>(k) * bytes);
    if (auto status =
            file.write(std::span<const std::byte>(buffer).first(static_cast<std::size_t>(n) * bytes));
        !status)
      return status;
  }
  const std::size_t rest = static_cast<std::size_t>(frames) * bytes % kC3dBlock;
  const std::array<std::byte, kC3dBlock> padding{};
  return rest == 0 ? Status{} : file.write(std::span(padding).first(kC3dBlock - rest));
}

/// How many channels have a number in a frame, and not all three.
std::int64_t channels_in_part(const data::Channels& channels) {
  std::int64_t count = 0;
  for (std::size_t c = 0; c < channels.names.size(); ++c)
    for (std::size_t i = 3 * c; i < channels.values.size(); i += 3 * channels.names.size()) {
      const auto numbers = std::ranges::count_if(std::span(channels.values).subspan(i, 3),
                                                 [](double v) { return std::isfinite(v); });
      if (numbers == 0 || numbers == 3) continue;
      ++count;
      break;
    }
  return count;
}

}  // namespace

Status write_c3d(const std::filesystem::path& path, const data::Trial& trial,
                 const C3dWriteOptions& options) {
  const auto lose = [&](std::string what) {
    if (options.lost) options.lost->push_back(std::move(what));
  };
  // Points beside the markers are not worth the markers.
  auto plan = plan_c3d(trial, options);
  if (!plan && plan.error().code == Code::not_supported && !trial.markers.unfiltered_in_world.empty()) {
    plan = plan_c3d(trial, options, false);
    if (plan) lose("samples from before the filter had no room in the file");
  }
  if (!plan) return fail_at(path.string(), plan.error());
  if (const auto part = channels_in_part(trial.channels); part > 0)
    lose(fmt::format("{} fewer than three numbers: those that are not there are kept as 0 in a .c3d file",
                     part == 1 ? "1 channel that is no marker has"
                               : fmt::format("{} channels that are no markers have", part)));
  // What does not fit gives way: what is carried for others first, then how samples were filled.
  std::span<const data::ForeignGroup> foreign = trial.foreign;
  auto section = encode_parameters(plan->parameters, plan->processor, foreign);
  if (!section && !foreign.empty()) {
    lose(fmt::format("{} that kinemark does not read had no room in the file",
                     foreign.size() == 1 ? "1 group of parameters"
                                         : fmt::format("{} groups of parameters", foreign.size())));
    foreign = {};
    section = encode_parameters(plan->parameters, plan->processor);
  }
  if (!section && std::erase_if(plan->parameters.groups,
                                [](const C3dGroup& g) { return g.name == kProvenanceGroup; }) > 0) {
    lose("how samples were filled and smoothed had no room in the file: filled ones read as interpolated");
    section = encode_parameters(plan->parameters, plan->processor);
  }
  if (!section && !plan->unfiltered.empty()) {
    lose("samples from before the filter had no room in the file");
    plan = plan_c3d(trial, options, false);
    std::erase_if(plan->parameters.groups, [](const C3dGroup& g) { return g.name == kProvenanceGroup; });
    section = encode_parameters(plan->parameters, plan->processor);
  }
  if (!section) return fail_at(path.string(), section.error());
  // The section's length does not depend on where the data begin, so it is encoded once to know and once for
  // good.
  plan->header.data_block = static_cast<int>(2 + section->size() / kC3dBlock);
  for (C3dParameter& p : plan->parameters.group("POINT").parameters)
    if (p.name == "DATA_START") p.numbers = {static_cast<double>(plan->header.data_block)};
  section = encode_parameters(plan->parameters, plan->processor, foreign);

  auto file = OutputFile::create(path, options.force);
  if (!file) return std::unexpected(file.error());
  if (auto status = file->write(encode_header(plan->header, plan->processor)); !status) return status;
  if (auto status = file->write(*section); !status) return status;
  if (auto status = write_frames(*file, trial, *plan); !status) return status;
  return file->commit();
}

}  // namespace kinemark::io
