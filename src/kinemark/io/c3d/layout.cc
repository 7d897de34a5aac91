// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/c3d/layout.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/length_unit.h"
#include "kinemark/io/rate.h"

namespace kinemark::io {
namespace {

using Warnings = std::vector<std::string>;

constexpr std::string_view kHeader = "the header";
constexpr std::int64_t kMaxWord = 65535;  // where 16 bits end

/// 16-bit counts are written signed or unsigned alike; -1 is 65535.
std::int64_t as_count(double value) {
  if (!std::isfinite(value) || value > 1e12) return 0;
  const auto n = static_cast<std::int64_t>(std::llround(std::max(value, -65536.0)));
  return n < 0 ? n + 65536 : n;
}

std::optional<std::int64_t> count_of(const C3dParameters& p, std::string_view group, std::string_view name) {
  const auto value = p.number(group, name);
  return value ? std::optional(as_count(*value)) : std::nullopt;
}

bool usable(double value) { return std::isfinite(value) && value > 0.0; }

/// Contents of a frame, and the stated number of frames.
struct Shape {
  std::int64_t points = 0;
  std::int64_t channels = 0;
  std::int64_t samples = 0;

  [[nodiscard]] std::size_t frame_bytes(bool is_float) const {
    return static_cast<std::size_t>(4 * points + channels * samples) * (is_float ? 4 : 2);
  }
  friend bool operator==(const Shape&, const Shape&) = default;
};

Shape header_shape(const C3dHeader& h) {
  Shape s{.points = h.points};
  if (h.samples_per_frame > 0 && h.analog_per_frame > 0) {
    s.samples = h.samples_per_frame;
    s.channels = h.analog_per_frame / h.samples_per_frame;
  }
  return s;
}

Shape parameter_shape(const C3dParameters& p, const C3dHeader& h, double rate_hz) {
  const Shape from_header = header_shape(h);
  Shape s;
  s.points = count_of(p, "POINT", "USED").value_or(from_header.points);
  s.channels = count_of(p, "ANALOG", "USED").value_or(from_header.channels);
  s.samples = from_header.samples;
  if (s.channels > 0 && s.samples == 0 && h.analog_per_frame > 0) s.samples = h.analog_per_frame / s.channels;
  const double ratio = p.number("ANALOG", "RATE").value_or(0.0) / rate_hz;
  if (usable(ratio) && ratio > 0.5 && ratio < 65536.0 && std::abs(ratio - std::round(ratio)) < 0.01 * ratio)
    s.samples = std::llround(ratio);
  if (s.channels == 0 || s.samples == 0) s.channels = s.samples = 0;
  return s;
}

std::string text_of(const Shape& s) {
  return fmt::format("{} points and {} analog channels of {} samples a frame", s.points, s.channels,
                     s.samples);
}

struct Claim {
  std::string_view source;
  std::int64_t frames = 0;
};

/// Two 16-bit words, the low one first.
std::optional<std::int64_t> field(const C3dParameters& p, std::string_view name) {
  const C3dParameter* found = p.find("TRIAL", name);
  if (found == nullptr || found->numbers.empty()) return std::nullopt;
  const std::int64_t low = as_count(found->numbers[0]);
  return found->numbers.size() < 2 ? low : low + 65536 * as_count(found->numbers[1]);
}

/// The numbers of frames stated in the file, the most trustworthy first.
std::vector<Claim> frame_claims(const C3dHeader& h, const C3dParameters& p) {
  std::vector<Claim> claims;
  const auto first = field(p, "ACTUAL_START_FIELD");
  const auto last = field(p, "ACTUAL_END_FIELD");
  if (first && last) claims.push_back({"TRIAL:ACTUAL_END_FIELD", *last - *first + 1});
  if (const auto n = count_of(p, "POINT", "LONG_FRAMES")) claims.push_back({"POINT:LONG_FRAMES", *n});
  if (const auto n = count_of(p, "POINT", "FRAMES")) claims.push_back({"POINT:FRAMES", *n});
  claims.push_back({kHeader, h.last_frame - h.first_frame + 1});
  std::erase_if(claims, [](const Claim& c) { return c.frames <= 0; });
  return claims;
}

/// The frames end in the file's last block.
bool fills(std::int64_t frames, std::size_t frame_bytes, std::size_t data_bytes) {
  if (frame_bytes == 0 || frames <= 0) return false;
  const std::size_t room = data_bytes / frame_bytes;
  const auto n = static_cast<std::size_t>(frames);
  return n <= room && data_bytes - n * frame_bytes <= kC3dBlock;
}

Result<std::int64_t> settle_frames(const std::vector<Claim>& claims, std::size_t frame_bytes,
                                   std::size_t data_bytes, Warnings& warnings) {
  if (frame_bytes == 0) return claims.empty() ? 0 : claims.front().frames;
  const auto there = static_cast<std::int64_t>(data_bytes / frame_bytes);
  if (there == 0)
    return fail(
        Code::bad_input,
        fmt::format("ends before its first frame: a frame takes {} bytes, {} are there. Nothing was read.",
                    frame_bytes, data_bytes));
  for (const Claim& claim : claims) {
    if (!fills(claim.frames, frame_bytes, data_bytes)) continue;
    if (claim.frames != claims.front().frames)
      warnings.push_back(fmt::format("{} states {} frames, {} {}, and the file holds that many",
                                     claims.front().source, claims.front().frames, claim.source,
                                     claim.frames));
    const Claim& header = claims.back();
    if (header.source == kHeader && header.frames != claim.frames && claim.frames < kMaxWord)
      warnings.push_back(fmt::format("{} states {} frames, {} {}; the parameter is used", claim.source,
                                     claim.frames, header.source, header.frames));
    return claim.frames;
  }
  if (claims.empty()) {
    warnings.push_back(fmt::format("does not state the number of frames; the file has room for {}", there));
    return there;
  }
  const Claim& best = claims.front();
  if (best.frames > there) {
    warnings.push_back(fmt::format("is cut short: {} states {} frames, {} whole ones are there", best.source,
                                   best.frames, there));
    return there;
  }
  // Sixteen bits end at 65535: without another entry the number of frames of a longer file follows from its
  // size.
  if (there >= kMaxWord && best.frames <= kMaxWord) {
    warnings.push_back(fmt::format("{} states {} frames, the file holds {}, which are read", best.source,
                                   best.frames, there));
    return there;
  }
  warnings.push_back(fmt::format("has {} more bytes after the {} frames that {} states; they are left out",
                                 data_bytes - static_cast<std::size_t>(best.frames) * frame_bytes,
                                 best.frames, best.source));
  return best.frames;
}

/// Where the data begin: a block number, from POINT:DATA_START unless only the header's can be right.
Result<std::size_t> settle_data_block(const C3dHeader& h, const C3dParameters& p, std::size_t file_bytes,
                                      const Shape& shape, bool is_float, const std::vector<Claim>& claims,
                                      Warnings& warnings) {
  const auto in_file = [&](std::int64_t block) {
    return block >= 2 && static_cast<std::size_t>(block - 1) * kC3dBlock <= file_bytes;
  };
  const auto start = count_of(p, "POINT", "DATA_START");
  const std::int64_t said = start.value_or(0);
  const bool header_good = in_file(h.data_block);
  if (!in_file(said)) {
    if (!header_good)
      return fail(Code::bad_input,
                  fmt::format("points to its data at block {}; the file has {} blocks. Nothing was read.",
                              said > 0 ? said : h.data_block, (file_bytes + kC3dBlock - 1) / kC3dBlock));
    if (p.has_group("POINT"))
      warnings.push_back(fmt::format("POINT:DATA_START is {}; the header's block {} is used",
                                     start ? std::to_string(said) : "missing", h.data_block));
    return static_cast<std::size_t>(h.data_block);
  }
  if (!header_good || said == h.data_block) return static_cast<std::size_t>(said);
  const auto filled = [&](std::int64_t block) {
    const std::size_t bytes = file_bytes - static_cast<std::size_t>(block - 1) * kC3dBlock;
    return std::ranges::any_of(
        claims, [&](const Claim& c) { return fills(c.frames, shape.frame_bytes(is_float), bytes); });
  };
  const bool header_wins = filled(h.data_block) && !filled(said);
  warnings.push_back(fmt::format("POINT:DATA_START is block {}, the header says {}; the {} is used", said,
                                 h.data_block, header_wins ? "header's" : "parameter's"));
  return static_cast<std::size_t>(header_wins ? h.data_block : said);
}

Status settle_rate_and_scale(C3dLayout& out, const C3dHeader& h, const C3dParameters& p, Warnings& warnings) {
  const auto stated = p.number("POINT", "RATE");
  const double rate = stated.value_or(0.0);
  if (stated)
    if (const auto known = states_rate(rate, "POINT:RATE", warnings); !known)
      return std::unexpected(known.error());
  out.rate_hz = usable(rate) ? rate : h.rate_hz;
  if (!usable(out.rate_hz))
    return fail(Code::bad_input,
                fmt::format("has no frame rate: POINT:RATE is {}, the header's is {}; need a number of Hz "
                            "above 0. Nothing was read.",
                            rate, h.rate_hz));
  if (auto s = check_rate(out.rate_hz, "the header's frame rate"); !s) return s;
  if (usable(rate) && usable(h.rate_hz) && std::abs(rate - h.rate_hz) > 1e-3 * rate)
    warnings.push_back(
        fmt::format("POINT:RATE is {} Hz, the header says {} Hz; the parameter is used", rate, h.rate_hz));
  if (!usable(rate) && p.has_group("POINT"))
    warnings.push_back(stated ? fmt::format("the header's rate of {} Hz is used", h.rate_hz)
                              : fmt::format("POINT:RATE is missing; the header's {} Hz are used", h.rate_hz));

  const auto good = [](double s) { return std::isfinite(s) && s != 0.0; };
  const double said = p.number("POINT", "SCALE").value_or(0.0);
  double scale = good(said) ? said : h.scale;
  if (!good(scale))
    return fail(Code::bad_input,
                fmt::format("parameter POINT:SCALE is {}; need < 0 (float points) or > 0 (integer points). "
                            "Nothing was read.",
                            said));
  if (!good(said) && p.has_group("POINT"))
    warnings.push_back(fmt::format("POINT:SCALE is missing; the header's {} is used", h.scale));
  if (good(said) && good(h.scale) && (said < 0.0) != (h.scale < 0.0F)) {
    warnings.push_back(
        fmt::format("POINT:SCALE is {}, the header says {}: one is for integer, one for float "
                    "points; the parameter is used",
                    said, h.scale));
  } else if (scale > 0.0 && good(said) && good(h.scale) && std::abs(said - h.scale) > 1e-3 * said) {
    // Programs used to write a header of their own in front of a parameter section kept as a template, so
    // the scale that belongs to the integers is the header's.
    warnings.push_back(
        fmt::format("POINT:SCALE is {}, the header says {}; the header's is used", said, h.scale));
    scale = h.scale;
  }
  out.is_float = scale < 0.0;
  out.scale = std::abs(scale);
  return {};
}

void settle_units(C3dLayout& out, const C3dParameters& p, Warnings& warnings) {
  out.units = p.text("POINT", "UNITS");
  const auto factor = metres_per_unit(out.units);
  out.metres_per_unit = factor.value_or(1e-3);
  if (out.units.empty())
    warnings.push_back("POINT:UNITS is missing; mm is assumed");
  else if (const auto like = units_like(out.units); !factor && like.size() == 1) {
    out.metres_per_unit = like[0].metres;
    warnings.push_back(
        fmt::format("POINT:UNITS is '{}', not a known length; taken for {}", out.units, like[0].name));
  } else if (!factor)
    warnings.push_back(fmt::format("POINT:UNITS is '{}', not a known length; mm is assumed", out.units));
}

void settle_analog(C3dLayout& out, const C3dParameters& p, Warnings& warnings) {
  const auto channels = static_cast<std::size_t>(out.analog_channels);
  std::string format = p.text("ANALOG", "FORMAT");
  out.analog_unsigned = !format.empty() && (format[0] == 'U' || format[0] == 'u');
  out.analog_scale = p.numbers("ANALOG", "SCALE");
  out.analog_offset = p.numbers("ANALOG", "OFFSET");
  if (out.analog_scale.size() < channels)
    warnings.push_back(fmt::format("ANALOG:SCALE has {} values for {} channels; 1 is used for the others",
                                   out.analog_scale.size(), channels));
  if (out.analog_offset.size() < channels)
    warnings.push_back(fmt::format("ANALOG:OFFSET has {} values for {} channels; 0 is used for the others",
                                   out.analog_offset.size(), channels));
  out.analog_scale.resize(channels, 1.0);
  out.analog_offset.resize(channels, 0.0);
  const double general = p.number("ANALOG", "GEN_SCALE").value_or(1.0);
  const C3dParameter* offset = p.find("ANALOG", "OFFSET");
  for (double& s : out.analog_scale) s *= general;
  if (const auto zeros = std::ranges::count(out.analog_scale, 0.0); zeros > 0)
    warnings.push_back(
        fmt::format("ANALOG:SCALE, times GEN_SCALE, is 0 for {} of {} channels: whatever they held, they are "
                    "0 throughout",
                    zeros, channels));
  if (out.analog_unsigned && offset != nullptr && offset->type == C3dType::int16)
    for (double& o : out.analog_offset)
      if (o < 0.0) o += 65536.0;
}

}  // namespace

Result<C3dLayout> settle_layout(const C3dHeader& header, const C3dParameters& parameters, Processor processor,
                                std::size_t file_bytes, Warnings& warnings) {
  C3dLayout out;
  out.processor = processor;
  if (auto status = settle_rate_and_scale(out, header, parameters, warnings); !status)
    return std::unexpected(status.error());

  const std::vector<Claim> claims = frame_claims(header, parameters);
  Shape shape = parameter_shape(parameters, header, out.rate_hz);
  const Shape other = header_shape(header);
  const auto block = settle_data_block(header, parameters, file_bytes, shape, out.is_float, claims, warnings);
  if (!block) return std::unexpected(block.error());
  out.data_offset = (*block - 1) * kC3dBlock;
  const std::size_t data_bytes = file_bytes - out.data_offset;
  if (shape != other && parameters.has_group("POINT")) {
    const auto filled = [&](const Shape& s) {
      return std::ranges::any_of(
          claims, [&](const Claim& c) { return fills(c.frames, s.frame_bytes(out.is_float), data_bytes); });
    };
    const bool header_wins = filled(other) && !filled(shape);
    if (header_wins || shape.frame_bytes(out.is_float) != other.frame_bytes(out.is_float))
      warnings.push_back(
          fmt::format("the parameters state {}, the header {}; {} used", text_of(shape), text_of(other),
                      header_wins ? "only the header's fit the file and are" : "the parameters are"));
    if (header_wins) shape = other;
  }
  out.points = shape.points;
  out.analog_channels = shape.channels;
  out.samples_per_frame = shape.samples;
  out.frame_bytes = shape.frame_bytes(out.is_float);

  const auto frames = settle_frames(claims, out.frame_bytes, data_bytes, warnings);
  if (!frames) return std::unexpected(frames.error());
  out.frames = *frames;
  if (out.frames <= 0)
    return fail(Code::bad_input,
                "holds no frames: neither points, nor analog channels, nor a count. Nothing was read.");
  out.first_frame = field(parameters, "ACTUAL_START_FIELD").value_or(header.first_frame);
  settle_units(out, parameters, warnings);
  settle_analog(out, parameters, warnings);
  return out;
}

}  // namespace kinemark::io
