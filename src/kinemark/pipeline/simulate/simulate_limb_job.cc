// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/simulate/simulate_limb_job.h"

#include <fmt/core.h>

#include <algorithm>

#include "kinemark/io/file.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/pipeline/files/staging.h"
#include "kinemark/pipeline/internal/new_folder.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;

/// A basic string of TOML; names of simulated limbs need no more.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

/// Joint centres first, then every marker.
data::Trajectories truth_of(const simulation::LimbRecording& limb) {
  std::vector<std::string> names;
  for (const auto& joint : limb.layout.joints) names.push_back(joint.name);
  names.insert(names.end(), limb.markers.names.begin(), limb.markers.names.end());
  auto out = data::Trajectories::all_missing(std::move(names), limb.markers.time);
  std::ranges::fill(out.state, data::SampleState::measured);
  const std::size_t centres = 3 * limb.layout.joints.size(), markers = 3 * limb.markers.names.size();
  auto to = out.x_in_world.begin();
  for (std::int64_t f = 0; f < out.frames(); ++f) {
    const auto frame = static_cast<std::size_t>(f);
    to = std::copy_n(limb.centre_in_world.data() + frame * centres, centres, to);
    to = std::copy_n(limb.x_true.data() + frame * markers, markers, to);
  }
  return out;
}

Status write_text(const fs::path& path, const std::string& text) {
  auto file = io::OutputFile::create(path, false);
  if (!file) return std::unexpected(file.error());
  if (auto s = file->write(text); !s) return s;
  return file->commit();
}

}  // namespace

std::string segment_layout_toml(const data::SegmentLayout& layout, const std::vector<std::string>& markers) {
  std::string out;
  for (const auto& segment : layout.segments) {
    std::string names;
    for (const int m : segment.markers)
      names += (names.empty() ? "" : ", ") + quoted(markers[static_cast<std::size_t>(m)]);
    out += fmt::format("[[segment]]\nname = {}\nmarkers = [{}]\n\n", quoted(segment.name), names);
  }
  const auto segment = [&](int index) {
    return quoted(layout.segments[static_cast<std::size_t>(index)].name);
  };
  for (const auto& joint : layout.joints)
    out += fmt::format("[[joint]]\nname = {}\nparent = {}\nchild = {}\n\n", quoted(joint.name),
                       segment(joint.parent), segment(joint.child));
  out.pop_back();
  return out;
}

Result<LimbJobOutcome> simulate_limb(const LimbJob& job, const Progress& progress) {
  const auto limb = job.scene == LimbScene::arm ? simulation::simulate_chain(job.arm)
                                                : simulation::simulate_sleeve(job.macaque);
  if (!limb) return std::unexpected(limb.error());
  auto recorded = simulation::upsample(limb->markers, job.upsample);
  if (!recorded) return std::unexpected(recorded.error());
  LimbJobOutcome out;
  const double samples = static_cast<double>(limb->markers.state.size());
  out.notes.push_back(
      fmt::format("{} markers, {} frames at {:.6g} Hz, {:.0f} % of the samples seen", limb->markers.markers(),
                  limb->markers.frames(), limb->markers.time.rate_hz,
                  100.0 * (1.0 - static_cast<double>(limb->markers.count_missing()) / samples)));
  if (job.upsample.factor > 1)
    out.notes.push_back(fmt::format("the recorder makes {} frames at {:.6g} Hz of them", recorded->frames(),
                                    recorded->time.rate_hz));

  const internal::NewFolder folder(job.folder);
  if (folder.error())
    return fail(Code::io,
                fmt::format("{}: cannot be made ({})", job.folder.string(), folder.error().message()));
  auto staging = Staging::create({job.folder / "markers.c3d", job.folder / "markers.trc",
                                  job.folder / "truth.csv", job.folder / "segments.toml"},
                                 job.force);
  if (!staging) return std::unexpected(staging.error());
  data::Trial stream, truth;
  stream.source = truth.source = "simulated";
  stream.markers = std::move(*recorded);
  truth.markers = truth_of(*limb);
  const auto files = static_cast<std::int64_t>(staging->targets().size());
  for (std::int64_t i = 0; i < files; ++i) {
    const auto path = staging->path(static_cast<std::size_t>(i));
    const Status written = i == 3 ? write_text(path, segment_layout_toml(limb->layout, limb->markers.names))
                                  : io::write_markers(path, i == 2 ? truth : stream, false);
    if (!written) return staging->failure(written.error());
    if (progress && !progress(i + 1, files)) return fail(Code::cancelled, "the simulation was stopped");
  }
  if (auto s = staging->commit(); !s) return std::unexpected(s.error());
  out.written = staging->targets();
  return out;
}

}  // namespace kinemark::pipeline
