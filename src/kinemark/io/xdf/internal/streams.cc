// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/xdf/internal/streams.h"

#include <fmt/core.h>

#include <bit>
#include <cstring>
#include <optional>
#include <string_view>

#include "kinemark/core/missing.h"
#include "kinemark/core/utf8.h"

static_assert(std::endian::native == std::endian::little, "numbers are read as they lie in memory");

namespace kinemark::io::internal {
namespace {

enum Tag : std::uint16_t { kStreamHeader = 2, kSamples = 3, kClockOffset = 4 };

constexpr std::size_t kMagic = 4;
constexpr std::size_t kMostHeader = 64UL << 20;  // bytes of XML

/// Takes numbers from bytes, nothing where there are too few.
class Cursor {
 public:
  explicit Cursor(std::span<const std::byte> bytes) : rest_(bytes) {}

  [[nodiscard]] std::size_t left() const { return rest_.size(); }
  [[nodiscard]] std::span<const std::byte> rest() const { return rest_; }

  std::optional<std::span<const std::byte>> bytes(std::uint64_t size) {
    if (size > rest_.size()) return std::nullopt;
    const auto out = rest_.first(size);
    rest_ = rest_.subspan(size);
    return out;
  }
  template <class T>
  std::optional<T> take() {
    const auto raw = bytes(sizeof(T));
    if (!raw) return std::nullopt;
    T out;
    std::memcpy(&out, raw->data(), sizeof(T));
    return out;
  }
  /// A size of 1, 4 or 8 bytes, as the byte before it says.
  std::optional<std::uint64_t> size() {
    switch (take<std::uint8_t>().value_or(0)) {
      case 1:
        return take<std::uint8_t>();
      case 4:
        return take<std::uint32_t>();
      case 8:
        return take<std::uint64_t>();
      default:
        return std::nullopt;
    }
  }

 private:
  std::span<const std::byte> rest_;
};

template <class T>
double value_at(const std::byte* at) {
  T out;
  std::memcpy(&out, at, sizeof(T));
  return static_cast<double>(out);
}

double number(XdfFormat format, const std::byte* at) {
  switch (format) {
    case XdfFormat::float32:
      return value_at<float>(at);
    case XdfFormat::double64:
      return value_at<double>(at);
    case XdfFormat::int8:
      return value_at<std::int8_t>(at);
    case XdfFormat::int16:
      return value_at<std::int16_t>(at);
    case XdfFormat::int32:
      return value_at<std::int32_t>(at);
    case XdfFormat::int64:
      return value_at<std::int64_t>(at);
    default:
      return kNaN;
  }
}

/// The values of a sample; false when they do not fit.
bool take_values(Cursor& in, XdfStream& stream) {
  const XdfHeader& h = stream.header;
  if (h.format == XdfFormat::string) {
    std::string first;
    for (std::size_t c = 0; c < h.channels; ++c) {
      const auto size = in.size();
      const auto text = size ? in.bytes(*size) : std::nullopt;
      if (!text) return false;
      if (c == 0) first.assign(reinterpret_cast<const char*>(text->data()), text->size());
    }
    stream.texts.push_back(std::move(first));
    return true;
  }
  const std::size_t each = size_of(h.format);
  const auto values = in.bytes(each * h.channels);
  if (!values) return false;
  for (const XdfMarker& marker : h.markers)
    for (const std::size_t channel : marker.channel)
      stream.positions.push_back(number(h.format, values->data() + each * channel));
  return true;
}

bool take_samples(Cursor in, XdfStream& stream) {
  const auto count = in.size();
  if (!count) return false;
  for (std::uint64_t i = 0; i < *count; ++i) {
    const auto stamp = in.take<std::uint8_t>();
    if (!stamp || (*stamp != 0 && *stamp != 8)) return false;
    const auto time = *stamp == 8 ? in.take<double>() : kNaN;
    if (!time || !take_values(in, stream)) return false;
    stream.time_s.push_back(*time);
  }
  return in.left() == 0;
}

class Walk {
 public:
  /// What a chunk says; a failure is told without its place.
  Status chunk(std::uint16_t tag, Cursor in) {
    if (tag != kStreamHeader && tag != kSamples && tag != kClockOffset) return {};
    const auto id = in.take<std::uint32_t>();
    if (!id) return fail(Code::bad_input, "a chunk without the number of its stream");
    if (tag == kStreamHeader) return begin_stream(*id, in.rest());
    const auto found = out.streams.find(*id);
    if (found == out.streams.end())
      return fail(Code::bad_input, fmt::format("a chunk of stream {}, which has no header before it", *id));
    if (tag == kSamples && !take_samples(in, found->second))
      return fail(Code::bad_input, fmt::format("samples of stream '{}' do not fill their chunk",
                                               printable(found->second.header.name, 80)));
    if (tag == kClockOffset) {
      const auto when = in.take<double>(), offset = in.take<double>();
      if (!when || !offset) return fail(Code::bad_input, "a clock offset is cut short");
      found->second.offsets.emplace_back(*when, *offset);
    }
    return {};
  }

  XdfStreams out;

 private:
  Status begin_stream(std::uint32_t id, std::span<const std::byte> xml) {
    if (xml.size() > kMostHeader)
      return fail(Code::bad_input, fmt::format("a header of {} bytes", xml.size()));
    auto header = parse_xdf_header({reinterpret_cast<const char*>(xml.data()), xml.size()});
    if (!header) return std::unexpected(header.error());
    if (!out.streams
             .try_emplace(
                 id,
                 XdfStream{
                     .header = std::move(*header), .time_s = {}, .positions = {}, .texts = {}, .offsets = {}})
             .second)
      return fail(Code::bad_input, fmt::format("stream {} has a second header", id));
    return {};
  }
};

}  // namespace

Result<XdfStreams> read_xdf_streams(std::span<const std::byte> file) {
  Walk walk;
  Cursor in(file.subspan(std::min(kMagic, file.size())));
  while (in.left() > 0) {
    const std::size_t place = file.size() - in.left();
    const auto size = in.size();
    const auto content = size ? in.bytes(*size) : std::nullopt;
    if (!content) {
      const auto lengths = static_cast<std::uint8_t>(file[place]);
      if (lengths != 1 && lengths != 4 && lengths != 8)
        return fail(Code::bad_input,
                    fmt::format("byte {}: a chunk begins with {}; expected 1, 4 or 8", place, lengths));
      walk.out.warnings.push_back(
          fmt::format("the file ends in the middle of a chunk, at byte {}; what came before is read", place));
      break;
    }
    Cursor chunk(*content);
    const auto tag = chunk.take<std::uint16_t>();
    if (!tag)
      return fail(Code::bad_input, fmt::format("byte {}: a chunk of {} bytes", place, content->size()));
    if (auto s = walk.chunk(*tag, chunk); !s) return fail_at(fmt::format("byte {}", place), s.error());
  }
  return std::move(walk.out);
}

}  // namespace kinemark::io::internal
