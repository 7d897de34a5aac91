// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/c3d/rotations.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/io/c3d/number_format.h"
#include "kinemark/math/rotation_fit.h"

namespace kinemark::io {
namespace {

constexpr std::int64_t kNumbers = 17;  // of a rotation: the matrix, and how far it can be trusted
constexpr std::size_t kBytes = 4 * kNumbers;
constexpr double kTolerance = 0.01;
constexpr std::string_view kSuffix = "_4X4";

/// Where the rotations are, and how many.
struct Place {
  std::vector<std::string> labels;
  std::size_t begin = 0;
  TimeBase time;
};

Result<Place> find_place(const C3dReader& reader, std::size_t size) {
  const auto& parameters = reader.parameters();
  const auto& layout = reader.layout();
  if (!parameters.has_group("ROTATION"))
    return fail(Code::bad_input, "has no ROTATION group, no orientations of segments");
  Place out{.labels = parameters.texts("ROTATION", "LABELS"),
            .time = {.rate_hz = layout.rate_hz,
                     .t0_s = static_cast<double>(std::max<std::int64_t>(0, layout.first_frame - 1)) /
                             layout.rate_hz,
                     .frames = layout.frames,
                     .first_number = layout.first_frame}};
  const auto used = static_cast<std::size_t>(
      std::max(0.0, parameters.number("ROTATION", "USED").value_or(static_cast<double>(out.labels.size()))));
  if (used == 0 || used > out.labels.size())
    return fail(Code::bad_input, fmt::format("ROTATION:USED is {}, with {} labels", used, out.labels.size()));
  out.labels.resize(used);
  for (auto& label : out.labels)
    if (label.ends_with(kSuffix)) label.resize(label.size() - kSuffix.size());
  const double ratio = parameters.number("ROTATION", "RATIO").value_or(1.0);
  if (!(ratio >= 1.0) || ratio > 1000.0 || ratio != std::floor(ratio))
    return fail(Code::bad_input, fmt::format("ROTATION:RATIO is {}; expected a whole number from 1", ratio));
  out.time.rate_hz *= ratio;
  out.time.frames *= static_cast<std::int64_t>(ratio);
  const double block = parameters.number("ROTATION", "DATA_START").value_or(0.0);
  if (!(block >= 2.0) || (block - 1.0) * kC3dBlock > static_cast<double>(size))
    return fail(Code::bad_input, fmt::format("ROTATION:DATA_START is {}, outside of the file", block));
  out.begin = (static_cast<std::size_t>(block) - 1) * kC3dBlock;
  const auto there = size > out.begin ? (size - out.begin) / (used * kBytes) : 0;
  if (there < static_cast<std::size_t>(out.time.frames))
    return fail(Code::bad_input,
                fmt::format("ROTATION has {} of {} frames; the file ends there", there, out.time.frames));
  return out;
}

/// w x y z of 16 numbers; NaN where they are none. Code::bad_input where they turn nothing.
Result<std::array<double, 4>> quaternion_of(const std::byte* bytes, Processor processor) {
  Eigen::Matrix3d r;
  for (int column = 0; column < 3; ++column)
    for (int k = 0; k < 3; ++k)
      r(k, column) = load_f32(bytes + 4 * static_cast<std::size_t>(4 * column + k), processor);
  const float trust = load_f32(bytes + 4 * (kNumbers - 1), processor);
  if (!r.allFinite() || !(trust >= 0.0F)) return std::array{kNaN, kNaN, kNaN, kNaN};
  if ((r.transpose() * r - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() > kTolerance ||
      r.determinant() < 0.0)
    return fail(Code::bad_input,
                "the matrix is no rotation: its columns are not of length 1 and at right angles");
  const Eigen::Quaterniond q(math::fit_rotation(r).rotation);  // the nearest rotation
  return std::array{q.w(), q.x(), q.y(), q.z()};
}

Result<data::Orientations> rotations_of(const C3dReader& reader, const ByteSource& source) {
  const auto place = find_place(reader, source.size());
  if (!place) return std::unexpected(place.error());
  data::Orientations out;
  out.names = place->labels;
  out.time = place->time;
  out.warnings = reader.description().warnings;
  std::erase_if(out.warnings,
                [](const std::string& warning) { return warning.starts_with("has no points"); });
  const auto row = at(out.size()) * kBytes;
  Array<std::byte> bytes(row);
  for (std::int64_t f = 0; f < out.frames(); ++f) {
    const auto n = source.read_at(place->begin + at(f) * row, bytes);
    if (!n) return std::unexpected(n.error());
    if (*n < row) return fail(Code::io, "became shorter while it was read");
    for (std::int64_t s = 0; s < out.size(); ++s) {
      const auto q = quaternion_of(bytes.data() + at(s) * kBytes, reader.layout().processor);
      if (!q)
        return fail(Code::bad_input, fmt::format("ROTATION '{}', frame {}: {}", out.names[at(s)],
                                                 out.time.number(f), q.error().message));
      out.quaternion.insert(out.quaternion.end(), q->begin(), q->end());
    }
  }
  if (auto s = out.validate(); !s) return std::unexpected(s.error());
  return out;
}

}  // namespace

Result<data::Orientations> read_rotations(const C3dReader& reader, const ByteSource& source) {
  auto out = rotations_of(reader, source);
  if (!out) return fail_at(source.name(), out.error());
  return out;
}

Result<data::Orientations> read_c3d_rotations(const std::filesystem::path& path) {
  const auto reader = C3dReader::open(path);
  if (!reader) return std::unexpected(reader.error());
  auto file = InputFile::open(path);
  if (!file) return std::unexpected(file.error());
  return read_rotations(*reader, FileSource(std::move(*file)));
}

}  // namespace kinemark::io
