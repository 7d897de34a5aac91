// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/utf8.h"
#include "kinemark/io/file.h"
#include "kinemark/io/rig/rig_file.h"
#include "kinemark/io/rig/toml_fields.h"
#include "kinemark/io/rig/toml_text.h"

namespace kinemark::io {
namespace {

using Need = TomlFields::Need;

constexpr std::size_t kMostCameras = 64;
constexpr int kMostParameters = 4096;

Status read_detector(const toml::table& table, const std::string& where, data::Detector& out) {
  TomlFields fields(table, where + ", detector");
  std::string kind(to_string(out.kind));
  fields.text("kind", kind, Need::required)
      .number("half_side_m", out.half_side_m)
      .number("edge", out.edge)
      .integer("warp_degree", out.warp_degree)
      .numbers("warp_x", out.warp_x)
      .numbers("warp_y", out.warp_y)
      .matrix("crosstalk", out.crosstalk)
      .integer("generic_degree", out.generic_degree)
      .numbers("generic", out.generic)
      .vector("gain", out.gain)
      .vector("offset_counts", out.offset_counts)
      .vector("dark_counts", out.dark_counts)
      .number("dark_sd_counts", out.dark_sd_counts)
      .number("light_counts", out.light_counts);
  if (auto s = fields.finish(); !s) return s;
  const auto parsed = data::parse_detector_kind(kind);
  if (!parsed) return fail_at(fields.where(), parsed.error());
  out.kind = *parsed;
  return {};
}

Status read_camera(const toml::table& table, const std::string& name, data::Camera& out) {
  std::string kind;
  TomlFields fields(table, fmt::format("{}: camera '{}'", name,
                                       table["name"].value_or(std::string_view("?")).substr(0, 60)));
  Eigen::MatrixXd rotation = Eigen::Matrix3d::Identity();
  fields.text("name", out.name, Need::required)
      .text("kind", kind, Need::required)
      .matrix("rotation", rotation, Need::required)
      .vector("translation_m", out.cam_from_world.translation, Need::required)
      .number("focal", out.focal, Need::required)
      .number("aspect", out.aspect)
      .vector("principal_point", out.principal_point);
  out.cam_from_world.rotation = rotation;
  const auto* distortion = fields.table("distortion");
  const auto* detector = fields.table("detector");
  const auto* lut = fields.table("table");
  if (auto s = fields.finish(); !s) return s;
  const auto parsed = data::parse_camera_kind(kind);
  if (!parsed) return fail_at(fields.where(), parsed.error());
  out.kind = *parsed;
  if (out.kind == data::CameraKind::pinhole && (detector != nullptr || lut != nullptr))
    return fail(Code::bad_input, fields.where() + ": a pinhole camera has neither detector nor table");
  if (distortion != nullptr) {
    auto& d = out.distortion;
    TomlFields lens(*distortion, fields.where() + ", distortion");
    lens.number("k1", d.k1).number("k2", d.k2).number("k3", d.k3).number("p1", d.p1).number("p2", d.p2);
    if (auto s = lens.finish(); !s) return s;
  }
  if (detector != nullptr)
    if (auto s = read_detector(*detector, fields.where(), out.detector); !s) return s;
  if (lut != nullptr) {
    auto& t = out.table;
    TomlFields nodes(*lut, fields.where() + ", table");
    nodes.integer("nodes", t.nodes, Need::required)
        .number("spacing_m", t.spacing_m, Need::required)
        .number("distance_m", t.distance_m, Need::required)
        .numbers("uv", t.uv);
    if (auto s = nodes.finish(); !s) return s;
  }
  return {};
}

Status read_electronics(const toml::table& table, const std::string& name, data::Electronics& out) {
  TomlFields fields(table, name + ": electronics");
  fields.number("time_constant_s", out.time_constant_s)
      .number("full_scale_a", out.full_scale_a)
      .integer("bits", out.bits)
      .number("converter_noise_counts", out.converter_noise_counts)
      .number("interelectrode_ohm", out.interelectrode_ohm)
      .number("amplifier_noise_v_rthz", out.amplifier_noise_v_rthz)
      .number("feedback_ohm", out.feedback_ohm)
      .number("ambient_a", out.ambient_a)
      .number("temperature_k", out.temperature_k);
  return fields.finish();
}

Status read_timing(const toml::table& table, const std::string& name, data::SlotTiming& out) {
  TomlFields fields(table, name + ": timing");
  fields.number("settle_s", out.settle_s)
      .number("conversion_s", out.conversion_s)
      .number("off_s", out.off_s)
      .flag("dark_slot", out.dark_slot);
  return fields.finish();
}

/// Rows and columns of the parameters listed in `free`; the lower triangle row by row.
Status read_covariance(const toml::table& table, const std::string& name, data::Rig& out) {
  TomlFields fields(table, name + ": covariance");
  std::vector<double> free, lower;
  fields.numbers("free", free).numbers("lower", lower);
  if (auto s = fields.finish(); !s) return s;
  const int n = out.parameter_count();
  if (n > kMostParameters)
    return fail(Code::not_supported,
                fmt::format("{}: a covariance of {} parameters; at most {} are supported", fields.where(), n,
                            kMostParameters));
  if (lower.size() != free.size() * (free.size() + 1) / 2)
    return fail(Code::bad_input,
                fmt::format("{}: lower holds {} numbers for {} parameters; need {}", fields.where(),
                            lower.size(), free.size(), free.size() * (free.size() + 1) / 2));
  double last = -1.0;
  for (const double i : free) {
    if (!(i > last) || !(i < n) || i != std::floor(i))
      return fail(
          Code::bad_input,
          fmt::format("{}: free holds {} after {}; need increasing whole numbers below {}, the number of "
                      "parameters",
                      fields.where(), i, last, n));
    last = i;
  }
  out.covariance.setZero(n, n);
  auto value = lower.begin();
  for (std::size_t i = 0; i < free.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      const auto row = static_cast<Eigen::Index>(free[i]), column = static_cast<Eigen::Index>(free[j]);
      out.covariance(row, column) = out.covariance(column, row) = *value++;
    }
  return {};
}

Result<data::Rig> read_table(const toml::table& table, const std::string& name) {
  data::Rig out;
  TomlFields fields(table, name);
  std::string format;
  int version = 0;
  fields.text("format", format, Need::required)
      .integer("version", version, Need::required)
      .text("id", out.id)
      .text("method", out.method)
      .number("chi2_per_dof", out.chi2_per_dof);
  const auto* electronics = fields.table("electronics");
  const auto* timing = fields.table("timing");
  const auto* cameras = fields.tables("camera");
  const auto* covariance = fields.table("covariance");
  if (!fields.failed() && format != "kinemark-rig")
    return fail(Code::bad_input, fmt::format("{}: no rig; its format is '{}' instead of 'kinemark-rig'", name,
                                             format.substr(0, 60)));
  if (!fields.failed() && version != 1)
    return fail(Code::not_supported,
                fmt::format("{}: version {} of the format; this program reads 1", name, version));
  if (auto s = fields.finish(); !s) return std::unexpected(s.error());
  if (electronics != nullptr)
    if (auto s = read_electronics(*electronics, name, out.electronics); !s) return std::unexpected(s.error());
  if (timing != nullptr)
    if (auto s = read_timing(*timing, name, out.timing); !s) return std::unexpected(s.error());
  if (cameras != nullptr) {
    if (cameras->size() > kMostCameras)
      return fail(Code::not_supported, fmt::format("{}: {} cameras; at most {} are supported", name,
                                                   cameras->size(), kMostCameras));
    for (const toml::node& camera : *cameras)
      if (auto s = read_camera(*camera.as_table(), name, out.cameras.emplace_back()); !s)
        return std::unexpected(s.error());
  }
  // Shapes first: the covariance is laid out by the numbers of warp terms.
  if (auto s = out.validate(); !s) return fail_at(name, s.error());
  if (covariance == nullptr) return out;
  if (auto s = read_covariance(*covariance, name, out); !s) return std::unexpected(s.error());
  if (auto s = out.validate(); !s) return fail_at(name, s.error());
  return out;
}

}  // namespace

Result<data::Rig> parse_rig(std::string_view text, std::string_view name) {
  const auto table = parse_toml(text, std::string(name));
  if (!table) return std::unexpected(table.error());
  auto rig = read_table(*table, std::string(name));
  // Names and keys of the file stand in the sentence, with whatever characters they hold.
  if (!rig) return fail(rig.error().code, printable_sentence(rig.error().message));
  return rig;
}

Result<data::Rig> read_rig(const std::filesystem::path& path) {
  const auto text = read_text(path, kMostTomlBytes);
  if (!text) return std::unexpected(text.error());
  return parse_rig(*text, path.string());
}

}  // namespace kinemark::io
