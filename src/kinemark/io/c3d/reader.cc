// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/c3d/reader.h"

#include <fmt/core.h>
#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/core/parallel.h"
#include "kinemark/io/c3d/analog_format.h"
#include "kinemark/io/c3d/describe.h"
#include "kinemark/io/c3d/foreign_groups.h"
#include "kinemark/io/c3d/point_types.h"
#include "kinemark/io/c3d/provenance.h"
#include "kinemark/io/c3d/unfiltered.h"

namespace kinemark::io {
namespace {

constexpr std::size_t kBufferBytes = 512UL << 10;
// The section's head can state at most 255 blocks; the start of the data may allow more.
constexpr std::size_t kMaxSectionBytes = 4096 * kC3dBlock;

/// Read exactly out.size() bytes.
Status read_exactly(const ByteSource& source, std::size_t offset, std::span<std::byte> out) {
  const auto n = source.read_at(offset, out);
  if (!n) return std::unexpected(n.error());
  if (*n < out.size())
    return fail(Code::io, fmt::format("{}: became shorter while it was read", source.name()));
  return {};
}

/// The processor for which the header's numbers are plausible: for files that do not name it.
Processor guess_processor(std::span<const std::byte, kC3dBlock> block) {
  for (const Processor processor : {Processor::intel, Processor::dec, Processor::mips}) {
    const C3dHeader h = parse_header(block, processor);
    if (h.rate_hz >= 0.1F && h.rate_hz <= 1e5F && std::isfinite(h.scale) && std::abs(h.scale) > 1e-9F &&
        std::abs(h.scale) < 1e9F && h.data_block >= 2)
      return processor;
  }
  return Processor::intel;
}

/// The parameter section up to the data, or to its own count of blocks when the data come first.
Result<Array<std::byte>> read_section(const ByteSource& source, std::size_t begin, std::size_t blocks,
                                      std::size_t data_begin) {
  const std::size_t end = data_begin > begin ? data_begin : begin + blocks * kC3dBlock;
  Array<std::byte> section(std::min({end, source.size(), begin + kMaxSectionBytes}) - begin);
  if (auto status = read_exactly(source, begin, section); !status) return std::unexpected(status.error());
  return section;
}

/// New memory for `count` numbers, in huge pages where the system has them: touching a gigabyte in small
/// pages for the first time takes longer than decoding into it.
template <class T>
std::span<T> room_for(Array<T>& array, std::size_t count) {
  array.resize(count);
#ifdef MADV_HUGEPAGE
  constexpr std::uintptr_t kPage = 2UL << 20;
  const auto begin = (reinterpret_cast<std::uintptr_t>(array.data()) + kPage - 1) / kPage * kPage;
  const auto end = reinterpret_cast<std::uintptr_t>(array.data() + count) / kPage * kPage;
  // Failure is harmless: it only costs time.
  if (begin < end) ::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
#endif
  return array;
}

}  // namespace

Result<C3dReader> C3dReader::open(const std::filesystem::path& path) {
  auto file = InputFile::open(path);
  if (!file) return std::unexpected(file.error());
  return open(std::make_unique<FileSource>(std::move(*file)));
}

Result<C3dReader> C3dReader::open(std::unique_ptr<ByteSource> source) {
  const std::string name = source->name();
  const std::size_t size = source->size();
  if (size < kC3dBlock)
    return fail(
        Code::bad_input,
        fmt::format("{}: is not a C3D file: it has {} bytes, a header alone takes {}. Nothing was read.",
                    name, size, kC3dBlock));
  std::array<std::byte, kC3dBlock> block{};
  if (auto status = read_exactly(*source, 0, block); !status) return std::unexpected(status.error());
  if (!is_c3d_header(block))
    return fail(Code::bad_input,
                fmt::format("{}: is not a C3D file: its second byte is {}, need 80. Nothing was read.", name,
                            std::to_integer<int>(block[1])));

  C3dReader reader;
  data::Trial& trial = reader.description_;
  Processor processor = guess_processor(block);
  const std::size_t begin =
      (std::max<std::size_t>(1, std::to_integer<std::size_t>(block[0])) - 1) * kC3dBlock;
  std::array<std::byte, 4> head{};
  bool has_section = begin > 0 && begin + head.size() <= size;
  if (has_section) {
    if (auto status = read_exactly(*source, begin, head); !status) return std::unexpected(status.error());
    const int code = std::to_integer<int>(head[3]);
    has_section = code >= 84 && code <= 86;
    if (has_section) processor = static_cast<Processor>(code);
  }
  reader.header_ = parse_header(block, processor);
  if (has_section) {
    const std::size_t data_begin = (std::max(1, reader.header_.data_block) - 1UL) * kC3dBlock;
    const auto section = read_section(*source, begin, std::to_integer<std::size_t>(head[2]), data_begin);
    if (!section) return std::unexpected(section.error());
    reader.parameters_ = parse_parameters(*section, processor, trial.warnings);
  }
  if (!reader.parameters_.has_group("POINT"))
    trial.warnings.push_back(fmt::format(
        "has no readable POINT parameters; the header alone is used ({} numbers)", to_string(processor)));
  auto layout = settle_layout(reader.header_, reader.parameters_, processor, size, trial.warnings);
  if (!layout) return fail_at(name, layout.error());
  reader.layout_ = std::move(*layout);
  trial.source = name;
  describe_trial(reader.header_, reader.parameters_, reader.layout_, trial);
  sort_points(reader.parameters_, reader.layout_, trial);
  if (auto s = settle_analog_format(*source, reader.parameters_, trial.analog.names, reader.layout_,
                                    trial.warnings);
      !s)
    return std::unexpected(s.error());
  trial.foreign = find_foreign_groups(reader.parameters_, trial.warnings);
  reader.source_ = std::move(source);
  return reader;
}

Result<C3dSeen> C3dReader::read(std::int64_t first, std::int64_t count, const C3dFrames& out,
                                int threads) const {
  check(first >= 0 && count >= 0 && first + count <= layout_.frames, "frames lie outside the file");
  const auto frames = static_cast<std::size_t>(count);
  const auto markers = static_cast<std::size_t>(layout_.markers);
  const std::size_t channels = 3 * layout_.channel_points.size();
  const auto analog = static_cast<std::size_t>(layout_.analog_per_frame());
  const auto fits = [&](std::size_t size, std::size_t per_frame) {
    return size == 0 || size == frames * per_frame;
  };
  check(fits(out.x_in_world.size(), 3 * markers) && fits(out.state.size(), markers) &&
            fits(out.residual_m.size(), markers) && fits(out.camera_mask.size(), markers) &&
            fits(out.analog.size(), analog) && fits(out.channels.size(), channels),
        "spans must be empty or hold exactly the frames asked for");
  if (count == 0 || layout_.frame_bytes == 0) return C3dSeen{};

  // One stripe of frames per thread, each with one buffer that stays in the cache.
  const std::int64_t stripe = (count + thread_count(threads) - 1) / thread_count(threads);
  const auto block = static_cast<std::int64_t>(std::max<std::size_t>(1, kBufferBytes / layout_.frame_bytes));
  const std::int64_t stripes = (count + stripe - 1) / stripe;
  std::vector<Result<C3dSeen>> seen(static_cast<std::size_t>(stripes), C3dSeen{});
  parallel_for(count, stripe, threads, [&](std::int64_t begin, std::int64_t end) {
    Result<C3dSeen>& mine = seen[static_cast<std::size_t>(begin / stripe)];
    Array<std::byte> buffer(static_cast<std::size_t>(std::min(block, end - begin)) * layout_.frame_bytes);
    for (std::int64_t f = begin; f < end; f += block) {
      const std::int64_t n = std::min(block, end - f);
      const auto bytes = std::span(buffer).first(static_cast<std::size_t>(n) * layout_.frame_bytes);
      const std::size_t offset =
          layout_.data_offset + static_cast<std::size_t>(first + f) * layout_.frame_bytes;
      if (auto status = read_exactly(*source_, offset, bytes); !status) {
        mine = std::unexpected(status.error());
        return;
      }
      const auto part = [&](auto span, std::size_t per_frame) {
        return span.empty() ? span
                            : span.subspan(static_cast<std::size_t>(f) * per_frame,
                                           static_cast<std::size_t>(n) * per_frame);
      };
      *mine += decode_frames(
          layout_, bytes.data(), n,
          {part(out.x_in_world, 3 * markers), part(out.state, markers), part(out.residual_m, markers),
           part(out.camera_mask, markers), part(out.analog, analog), part(out.channels, channels)});
    }
  });
  C3dSeen total;
  for (const Result<C3dSeen>& s : seen) {
    if (!s) return s;
    total += *s;
  }
  return total;
}

Result<data::Trial> read_trial(const C3dReader& reader, const C3dReadOptions& options, C3dSeen* reported) {
  data::Trial trial = reader.description();
  const C3dLayout& layout = reader.layout();
  C3dFrames out;
  if (options.points) {
    const auto samples = static_cast<std::size_t>(layout.frames * layout.markers);
    out.x_in_world = room_for(trial.markers.x_in_world, 3 * samples);
    out.state = room_for(trial.markers.state, samples);
    if (options.residuals) {
      out.residual_m = room_for(trial.residual_m, samples);
      out.camera_mask = room_for(trial.camera_mask, samples);
    }
    trial.channels.frames = trial.channels.count() > 0 ? layout.frames : 0;
    out.channels = room_for(trial.channels.values,
                            3 * static_cast<std::size_t>(layout.frames) * layout.channel_points.size());
  } else {
    trial.markers.names.clear();
    trial.channels = {};
  }
  if (options.analog) {
    trial.analog.samples = layout.frames * layout.samples_per_frame;
    out.analog = room_for(trial.analog.values,
                          static_cast<std::size_t>(trial.analog.samples * layout.analog_channels));
  }
  const auto seen = reader.read(0, layout.frames, out, options.threads);
  if (!seen) return std::unexpected(seen.error());
  if (reported != nullptr) *reported = *seen;
  if (seen->measured == 0) {
    trial.residual_m = {};
    if (seen->unmeasured > 0 && !reader.parameters().number("POINT", kC3dResidualsParameter)) {
      // No sample has a residual, and kinemark's own mark is absent: a residual of 0 then has no meaning.
      trial.warnings.push_back("the file carries no residuals; its samples are taken as measured");
      for (data::SampleState& state : trial.markers.state)
        if (state == data::SampleState::interpolated) state = data::SampleState::measured;
    }
  }
  if (seen->with_cameras == 0) trial.camera_mask = {};
  if (options.points) {
    apply_provenance(reader.parameters(), trial);
    take_calibration_error(reader.parameters(), trial);
    take_filters(reader.parameters(), reader.layout(), trial);
  }
  return trial;
}

Result<data::Trial> read_c3d(const std::filesystem::path& path, const C3dReadOptions& options,
                             C3dSeen* reported) {
  const auto reader = C3dReader::open(path);
  if (!reader) return std::unexpected(reader.error());
  return read_trial(*reader, options, reported);
}

}  // namespace kinemark::io
