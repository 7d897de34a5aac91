// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <cmath>

#include "kinemark/io/file.h"
#include "kinemark/io/rig/rig_file.h"

namespace kinemark::io {
namespace {

/// Builds TOML text. Numbers are the shortest that read back as the same double.
class TomlText {
 public:
  void line(std::string_view text) { out_.append(text).push_back('\n'); }
  void text(std::string_view key, std::string_view value) {
    out_.append(key).append(" = \"");
    for (const char c : value) {
      if (c == '"' || c == '\\')
        out_.append({'\\', c});
      else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
        out_.append(fmt::format("\\u{:04X}", static_cast<unsigned>(static_cast<unsigned char>(c))));
      else
        out_.push_back(c);
    }
    out_.append("\"\n");
  }
  void number(std::string_view key, double value) {
    out_.append(key).append(" = ");
    add(value);
    out_.push_back('\n');
  }
  template <class Numbers>
  void list(std::string_view key, const Numbers& values) {
    out_.append(key).append(" = ");
    add_list(values);
    out_.push_back('\n');
  }
  void matrix(std::string_view key, const Eigen::MatrixXd& values) {
    out_.append(key).append(" = [");
    for (Eigen::Index i = 0; i < values.rows(); ++i) {
      if (i > 0) out_.append(",\n  ");
      add_list(Eigen::VectorXd(values.row(i)));
    }
    out_.append("]\n");
  }
  [[nodiscard]] std::string take() { return std::move(out_); }

 private:
  void add(double value) {
    const std::size_t begin = out_.size();
    out_.append(fmt::format("{}", value));
    // TOML distinguishes floats from integers by a point or an exponent.
    if (out_.find_first_of(".enai", begin) == std::string::npos) out_.append(".0");
  }
  template <class Numbers>
  void add_list(const Numbers& values) {
    out_.push_back('[');
    std::size_t on_line = 0;
    for (const double v : values) {
      if (on_line++ > 0) out_.append(on_line % 8 == 1 ? ",\n  " : ", ");
      add(v);
    }
    out_.push_back(']');
  }
  std::string out_;
};

void add_camera(TomlText& out, const data::Camera& camera) {
  out.line("\n[[camera]]");
  out.text("name", camera.name);
  out.text("kind", to_string(camera.kind));
  out.line("# camera from world; the camera's axes are x right, y down, z forward");
  out.matrix("rotation", camera.cam_from_world.rotation);
  out.list("translation_m", camera.cam_from_world.translation);
  out.line(camera.kind == data::CameraKind::pinhole ? "# pixels" : "# half-sides of the detector");
  out.number("focal", camera.focal);
  out.number("aspect", camera.aspect);
  out.list("principal_point", camera.principal_point);
  const auto& lens = camera.distortion;
  out.line("[camera.distortion]");
  out.number("k1", lens.k1);
  out.number("k2", lens.k2);
  out.number("k3", lens.k3);
  out.number("p1", lens.p1);
  out.number("p2", lens.p2);
  if (camera.kind == data::CameraKind::pinhole) return;
  const auto& detector = camera.detector;
  out.line("[camera.detector]");
  out.text("kind", to_string(detector.kind));
  out.number("half_side_m", detector.half_side_m);
  out.number("edge", detector.edge);
  out.line(fmt::format("warp_degree = {}", detector.warp_degree));
  out.list("warp_x", detector.warp_x);
  out.list("warp_y", detector.warp_y);
  out.matrix("crosstalk", detector.crosstalk);
  if (!detector.generic.empty()) {
    out.line(fmt::format("generic_degree = {}", detector.generic_degree));
    out.list("generic", detector.generic);
  }
  out.list("gain", detector.gain);
  out.list("offset_counts", detector.offset_counts);
  if (detector.knows_dark()) {
    out.list("dark_counts", detector.dark_counts);
    out.number("dark_sd_counts", detector.dark_sd_counts);
  }
  if (!std::isnan(detector.light_counts)) out.number("light_counts", detector.light_counts);
  if (camera.table.nodes == 0) return;
  out.line("[camera.table]");
  out.line(fmt::format("nodes = {}", camera.table.nodes));
  out.number("spacing_m", camera.table.spacing_m);
  out.number("distance_m", camera.table.distance_m);
  out.list("uv", camera.table.uv);
}

void add_covariance(TomlText& out, const Eigen::MatrixXd& covariance) {
  if (covariance.size() == 0) return;
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < covariance.rows(); ++i)
    if (covariance(i, i) > 0.0) free.push_back(i);
  out.line("\n# of the calibrated parameters, numbered through all cameras; lower triangle, row by row");
  out.line("[covariance]");
  std::string numbers = "free = [";
  std::vector<double> lower;
  for (const auto i : free) {
    numbers += fmt::format("{}{}", numbers.back() == '[' ? "" : ", ", i);
    for (const auto j : free)
      if (j <= i) lower.push_back(covariance(i, j));
  }
  out.line(numbers + "]");
  out.list("lower", lower);
}

}  // namespace

std::string format_rig(const data::Rig& rig) {
  TomlText out;
  out.line("# A rig of cameras, by kinemark. SI units.");
  out.text("format", "kinemark-rig");
  out.line("version = 1");
  if (!rig.id.empty()) out.text("id", rig.id);
  if (!rig.method.empty()) out.text("method", rig.method);
  if (rig.chi2_per_dof > 0.0) out.number("chi2_per_dof", rig.chi2_per_dof);
  const auto& e = rig.electronics;
  out.line("\n[electronics]");
  out.number("time_constant_s", e.time_constant_s);
  out.number("full_scale_a", e.full_scale_a);
  out.line(fmt::format("bits = {}", e.bits));
  out.number("converter_noise_counts", e.converter_noise_counts);
  out.number("interelectrode_ohm", e.interelectrode_ohm);
  out.number("amplifier_noise_v_rthz", e.amplifier_noise_v_rthz);
  out.number("feedback_ohm", e.feedback_ohm);
  out.number("ambient_a", e.ambient_a);
  out.number("temperature_k", e.temperature_k);
  out.line("\n[timing]");
  out.number("settle_s", rig.timing.settle_s);
  out.number("conversion_s", rig.timing.conversion_s);
  out.number("off_s", rig.timing.off_s);
  out.line(fmt::format("dark_slot = {}", rig.timing.dark_slot));
  for (const auto& camera : rig.cameras) add_camera(out, camera);
  add_covariance(out, rig.covariance);
  return out.take();
}

Status write_rig(const std::filesystem::path& path, const data::Rig& rig, bool force) {
  if (auto s = rig.validate(); !s)
    return fail(Code::usage, fmt::format("{}: not written: {}", path.string(), s.error().message));
  return write_text(path, format_rig(rig), force);
}

}  // namespace kinemark::io
