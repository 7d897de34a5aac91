// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/markers/marker_format.h"

#include <algorithm>
#include <utility>

#include "kinemark/io/animation/amc.h"
#include "kinemark/io/animation/bvh.h"
#include "kinemark/io/animation/glb.h"
#include "kinemark/io/bids/motion_bids.h"
#include "kinemark/io/c3d/reader.h"
#include "kinemark/io/c3d/writer.h"
#include "kinemark/io/matlab/mat.h"
#include "kinemark/io/numpy/npz.h"
#include "kinemark/io/nwb/nwb.h"
#include "kinemark/io/recording/mcap_markers.h"
#include "kinemark/io/text/marker_table.h"
#include "kinemark/io/text/trajectories_csv.h"
#include "kinemark/io/text/trc.h"
#include "kinemark/io/text/v3d.h"
#include "kinemark/io/text/vendor_exports.h"
#include "kinemark/io/xdf/xdf.h"

namespace kinemark::io {
namespace {

namespace fs = std::filesystem;

using ReadOptions = const MarkerReadOptions&;
using Box = Eigen::AlignedBox3d&;
using WriteOptions = const MarkerWriteOptions&;

// The header block of a C3D is never without zero bytes; a text may well have a 'P' (0x50) in second place.
bool begins_c3d(std::string_view begin) {
  return begin.size() > 1 && begin[1] == '\x50' && begin.find('\0') != std::string_view::npos;
}

/// A text that begins with `word`, or with a byte-order mark or a quote before it.
bool begins_with(std::string_view begin, std::string_view word) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (begin.starts_with(kByteOrderMark)) begin.remove_prefix(kByteOrderMark.size());
  if (begin.starts_with('"')) begin.remove_prefix(1);
  return begin.starts_with(word);
}

bool begins_trc(std::string_view begin) { return begins_with(begin, "PathFileType"); }

bool begins_amc(std::string_view begin) {
  return begin.starts_with("#!OML:ASF") || begin.find(":FULLY-SPECIFIED") != std::string_view::npos;
}

/// The fifth line of Visual3D's text is that of its axes. One that was cut before it still begins with an
/// empty cell and the C3D that each column is from.
bool begins_v3d(std::string_view begin) {
  const auto first = begin.substr(0, begin.find('\n'));
  const bool of_c3d = first.starts_with('\t') && first.find(".c3d") != std::string_view::npos;
  for (int line = 1; line < 5; ++line) {
    const auto end = begin.find('\n');
    if (end == std::string_view::npos) return of_c3d;
    begin.remove_prefix(end + 1);
  }
  return begin.starts_with("ITEM\t");
}

bool begins_bvh(std::string_view begin) { return begins_with(begin, "HIERARCHY"); }

bool begins_nwb(std::string_view begin) { return begin.starts_with("\x89HDF\r\n\x1a\n"); }

template <VendorExport which>
bool begins_export(std::string_view begin) {
  return vendor_export_of(begin) == which;
}

Result<data::Trial> read_c3d_trial(const fs::path& path, ReadOptions, Box box_m) {
  C3dSeen seen;
  auto trial = read_c3d(path, {}, &seen);
  box_m = seen.box_m;
  return trial;
}

/// The part of an NWB file that a trial holds.
Result<data::Trial> read_nwb_trial(const fs::path& path, ReadOptions, Box) {
  auto file = read_nwb(path);
  if (!file) return std::unexpected(file.error());
  data::Trial trial = std::move(file->trial);
  trial.source = path.string();
  trial.format = "NWB";
  trial.units_in_file = "m";
  const NwbMetadata& metadata = file->metadata;
  trial.software = metadata.recorder.empty() ? metadata.software : metadata.recorder;
  trial.warnings = std::move(file->warnings);
  if (file->derivatives && !file->derivatives->velocity.empty())
    trial.unread.emplace_back("derivatives of markers");
  return trial;
}

Result<data::Trial> read_v3d_trial(const fs::path& path, ReadOptions options, Box) {
  auto text = read_v3d(path, {.rate_hz = options.rate_hz});
  if (!text) return std::unexpected(text.error());
  // Angles go along as those of a BVH or AMC do.
  data::Channels& angles = text->trial.channels;
  for (const std::string& signal : text->orientations.names) angles.names.push_back(signal + "_angles_XYZ");
  if (angles.names.empty()) return std::move(text->trial);
  angles.kinds.assign(angles.names.size(), data::ChannelKind::angle);
  angles.units.assign(angles.names.size(), "deg");
  angles.rate_hz = options.rate_hz;
  angles.frames = text->orientations.frames;
  angles.values = std::move(text->orientations.angles_deg);
  return std::move(text->trial);
}

template <VendorExport which>
Result<data::Trial> read_export(const fs::path& path, ReadOptions options, Box) {
  return read_vendor_export(path, which, options.unit, options.rate_hz);
}

/// Several files: pipeline::write_motion_bids() lets them appear together.
Status refuse_several(const fs::path& path, const data::Trial&, WriteOptions) {
  return check_marker_format(path);
}

Status write_nwb_trial(const fs::path& path, const data::Trial& trial, WriteOptions options) {
  NwbMetadata metadata;
  metadata.set = options.set;
  metadata.recorder = trial.software == metadata.software ? "" : trial.software;
  if (!trial.source.empty()) metadata.sources.push_back({.file = trial.source});
  return write_nwb(path, trial, nullptr, metadata,
                   {.force = options.force, .ndx_pose = options.ndx_pose, .beside = &trial.beside});
}

using enum Kept;
//                                         provenance covariance times  residuals channels analog events
//                                         plates groups filters calibration
constexpr std::array<Kept, kParts> kOfC3d = {whole, in_part, none,  whole, whole, whole,
                                             whole, whole,   whole, whole, whole};
constexpr std::array<Kept, kParts> kOfNwb = {whole, whole, whole, whole, whole, whole,
                                             whole, whole, none,  whole, whole};
constexpr std::array<Kept, kParts> kOfCsv = {whole, whole, whole, none,  none, none,
                                             none,  none,  none,  whole, whole};
constexpr std::array<Kept, kParts> kOfBids = {none, none, none, none, whole, none,
                                              none, none, none, none, none};
constexpr std::array<Kept, kParts> kOfMat = kOfNwb;

constexpr std::array kFormats = {
    MarkerFormat{.name = "C3D",
                 .extension = ".c3d",
                 .begins = begins_c3d,
                 .read = read_c3d_trial,
                 .write =
                     [](const fs::path& path, const data::Trial& trial, WriteOptions o) {
                       return write_c3d(path, trial, {.force = o.force, .set = o.set, .lost = o.lost});
                     },
                 .kept = kOfC3d,
                 .precision = "float, mm"},
    MarkerFormat{
        .name = "TRC",
        .extension = ".trc",
        .begins = begins_trc,
        .read = [](const fs::path& path, ReadOptions, Box) { return read_trc(path); },
        .write = [](const fs::path& path, const data::Trial& trial,
                    WriteOptions o) { return write_trc(path, trial, {.force = o.force, .set = o.set}); },
        .precision = "double, mm"},
    MarkerFormat{.name = "NWB",
                 .extension = ".nwb",
                 .begins = begins_nwb,
                 .read = read_nwb_trial,
                 .write = write_nwb_trial,
                 .kept = kOfNwb,
                 .precision = "double, m"},
    MarkerFormat{
        .name = "MAT",
        .extension = ".mat",
        .begins = is_mat,
        .read = [](const fs::path& path, ReadOptions o, Box) { return read_mat(path, o.unit); },
        .write = [](const fs::path& path, const data::Trial& trial,
                    WriteOptions o) { return write_mat(path, trial, {.force = o.force, .set = o.set}); },
        .may_lack_unit = true,
        .kept = kOfMat,
        .precision = "double, m"},
    MarkerFormat{.name = "NPZ",
                 .extension = ".npz",
                 .begins = is_npz,
                 .read = [](const fs::path& path, ReadOptions o, Box) { return read_npz(path, o.unit); },
                 .may_lack_unit = true},
    MarkerFormat{.name = "XDF",
                 .extension = ".xdf",
                 .begins = is_xdf,
                 .read = [](const fs::path& path, ReadOptions, Box) { return read_xdf(path); }},
    MarkerFormat{.name = "MCAP",
                 .extension = ".mcap",
                 .begins = is_mcap,
                 .read = [](const fs::path& path, ReadOptions, Box) { return read_mcap_markers(path); }},
    MarkerFormat{.name = "Qualisys TSV",
                 .extension = ".tsv",
                 .begins = begins_export<VendorExport::qtm>,
                 .read = read_export<VendorExport::qtm>},
    MarkerFormat{.name = "Motion-BIDS",
                 .extension = ".tsv",
                 .read = [](const fs::path& path, ReadOptions, Box) { return read_motion_bids(path); },
                 .write = refuse_several,
                 .one_file = false,
                 .kept = kOfBids,
                 .precision = "double, m"},
    MarkerFormat{.name = "Motive CSV",
                 .extension = ".csv",
                 .begins = begins_export<VendorExport::motive>,
                 .read = read_export<VendorExport::motive>},
    MarkerFormat{.name = "Vicon CSV",
                 .extension = ".csv",
                 .begins = begins_export<VendorExport::vicon>,
                 .read = read_export<VendorExport::vicon>},
    MarkerFormat{.name = "PhaseSpace CSV",
                 .extension = ".csv",
                 .begins = begins_export<VendorExport::phasespace>,
                 .read = read_export<VendorExport::phasespace>},
    MarkerFormat{.name = "D-Flow text",
                 .extension = ".txt",
                 .begins = begins_d_flow,
                 .read = read_export<VendorExport::coordinates>,
                 .may_lack_unit = true,
                 .mostly_others = true},
    MarkerFormat{.name = "table of coordinates without times",
                 .extension = ".csv",
                 .begins = lacks_times,
                 .read = read_export<VendorExport::coordinates>,
                 .stores_rate = false,
                 .may_lack_unit = true},
    MarkerFormat{.name = "table of coordinates",
                 .extension = ".csv",
                 .begins = begins_export<VendorExport::coordinates>,
                 .read = read_export<VendorExport::coordinates>,
                 .may_lack_unit = true},
    MarkerFormat{
        .name = "CSV",
        .extension = ".csv",
        .read = [](const fs::path& path, ReadOptions o, Box) { return read_trajectories_csv(path, o.unit); },
        .write = [](const fs::path& path, const data::Trial& trial,
                    WriteOptions o) { return write_trajectories_csv(path, trial, o.force); },
        .may_lack_unit = true,
        .kept = kOfCsv,
        .precision = "double, m"},
    MarkerFormat{.name = "OpenSim table of markers",
                 .extension = ".sto",
                 .begins = begins_marker_table,
                 .read = [](const fs::path& path, ReadOptions, Box) { return read_marker_table(path); },
                 .mostly_others = true},
    MarkerFormat{.name = "Visual3D text",
                 .extension = ".v3d",
                 .begins = begins_v3d,
                 .read = read_v3d_trial,
                 .stores_rate = false},
    MarkerFormat{.name = "BVH",
                 .extension = ".bvh",
                 .begins = begins_bvh,
                 .read = [](const fs::path& path, ReadOptions, Box) { return read_bvh(path); }},
    MarkerFormat{.name = "AMC",
                 .extension = ".amc",
                 .begins = begins_amc,
                 .read =
                     [](const fs::path& path, ReadOptions options, Box) {
                       return read_amc(path, {.rate_hz = options.rate_hz, .skeleton = options.skeleton});
                     },
                 .stores_rate = false},
    MarkerFormat{.name = "GLB",
                 .extension = ".glb",
                 .write = [](const fs::path& path, const data::Trial& trial,
                             WriteOptions o) { return write_glb(path, trial, o.force); },
                 .precision = "float, m"},
};

std::vector<std::string> extensions(bool written) {
  std::vector<std::string> out;
  for (const MarkerFormat& f : kFormats)
    if ((written ? f.write != nullptr && f.one_file : f.read != nullptr && !f.mostly_others) &&
        std::ranges::find(out, f.extension) == out.end())
      out.emplace_back(f.extension);
  return out;
}

}  // namespace

std::span<const MarkerFormat> marker_formats() { return kFormats; }

const MarkerFormat* written_format(std::string_view extension) {
  for (const MarkerFormat& f : kFormats)
    if (f.write != nullptr && f.extension == extension) return &f;
  return nullptr;
}

std::vector<std::string> read_extensions() { return extensions(false); }

std::vector<std::string> written_extensions() { return extensions(true); }

}  // namespace kinemark::io
