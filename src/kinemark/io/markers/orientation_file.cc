// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/markers/orientation_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <utility>

#include "kinemark/io/c3d/reader.h"
#include "kinemark/io/c3d/rotations.h"
#include "kinemark/io/file.h"
#include "kinemark/io/text/body_orientations.h"
#include "kinemark/io/text/orientation_csv.h"
#include "kinemark/io/text/orientation_table.h"
#include "kinemark/io/text/vendor_exports.h"
#include "kinemark/io/text_dialect.h"

namespace kinemark::io {
namespace {

std::string ending_of(const std::filesystem::path& path) {
  auto out = path.extension().string();
  std::ranges::transform(out, out.begin(), [](unsigned char c) { return std::tolower(c); });
  return out;
}

bool is_table(const std::string& ending) { return ending == ".sto" || ending == ".mot"; }

/// The beginning as the readers see it; nothing where there is none.
Result<std::string> plain_begin(const std::filesystem::path& path) {
  auto begin = read_begin(path);
  if (!begin) return begin;
  return in_plain_dialect(std::move(*begin));
}

bool is_qtm(std::string_view begin) { return vendor_export_of(begin) == VendorExport::qtm; }

Error refusal(const std::filesystem::path& path) {
  return {
      .code = Code::not_supported,
      .message = fmt::format(
          "{}: holds no orientations; they come as .sto with DataType=Quaternion (OpenSense), .c3d with a "
          "ROTATION group (Theia, Visual3D), .tsv of rigid bodies (QTM, 6D), .csv of rigid bodies as "
          "quaternions (Motive), or .csv with time, NAME_w, NAME_x, NAME_y and NAME_z",
          path.string())};
}

Result<data::Orientations> read_bodies_of_qtm(const std::filesystem::path& path) {
  const auto trial = read_vendor_export(path, VendorExport::qtm);
  if (!trial) return std::unexpected(trial.error());
  if (!has_body_axes(*trial)) return std::unexpected(refusal(path));
  auto out = orientations_of_bodies(*trial);
  if (!out) return fail_at(path.string(), out.error());
  return out;
}

}  // namespace

bool has_orientations(const std::filesystem::path& path) {
  const auto ending = ending_of(path);
  if (is_table(ending)) return holds_orientations(path).value_or(false);
  if (ending == ".c3d") {
    const auto reader = C3dReader::open(path);
    return reader && reader->parameters().has_group("ROTATION") &&
           !reader->parameters().texts("ROTATION", "LABELS").empty();
  }
  if (ending != ".tsv" && ending != ".csv") return false;
  const auto begin = plain_begin(path);
  if (!begin) return false;
  if (ending == ".csv") return begins_orientation_csv(*begin);
  return is_qtm(*begin) && begin->find("\nBODY_NAMES\t") != std::string::npos;
}

Result<data::Orientations> read_orientation_file(const std::filesystem::path& path) {
  const auto ending = ending_of(path);
  if (is_table(ending)) return read_orientations(path);
  if (ending == ".c3d") return read_c3d_rotations(path);
  if (ending != ".tsv" && ending != ".csv") return std::unexpected(refusal(path));
  const auto begin = plain_begin(path);
  if (!begin) return std::unexpected(begin.error());
  if (ending == ".tsv" && is_qtm(*begin)) return read_bodies_of_qtm(path);
  // The header of a Motive file may be longer than its beginning.
  const bool may_be = begins_orientation_csv(*begin) || vendor_export_of(*begin) == VendorExport::motive;
  if (ending == ".tsv" || !may_be) return std::unexpected(refusal(path));
  return read_orientation_csv(path);
}

}  // namespace kinemark::io
