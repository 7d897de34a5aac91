// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/simulate/simulate_rig_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "kinemark/core/enum_names.h"
#include "kinemark/core/text.h"
#include "kinemark/io/input/recording_input.h"
#include "kinemark/io/recording/counts_recording.h"
#include "kinemark/io/rig/rig_file.h"
#include "kinemark/io/set_mark.h"
#include "kinemark/pipeline/files/file_set.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/simulate/rig_scenes.h"
#include "kinemark/stages/simulation/rig_calibration.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;

constexpr EnumNames<RigSceneKind::markers> kScenes{"tree", "wheel", "sign", "markers"};

Result<StagedScene> stage_markers(const SimulateRigJob& job) {
  if (job.markers.empty()) return fail(Code::usage, "the scene 'markers' needs a marker file");
  const auto input = io::read_marker_input({.path = job.markers});
  if (!input) return std::unexpected(input.error());
  const auto& markers = input->trial.markers;
  auto scene = simulation::markers_as_leds(markers, job.marker_options);
  if (!scene) return fail_at(job.markers.string(), scene.error());
  const auto& time = markers.time;
  return StagedScene{std::move(*scene), static_cast<double>(time.frames - 1) / time.rate_hz, 440};
}

Result<StagedScene> stage(const SimulateRigJob& job) {
  switch (job.scene) {
    case RigSceneKind::tree:
      return stage_tree(job.tree_pose);
    case RigSceneKind::wheel:
      return stage_wheel(job.wheel);
    case RigSceneKind::sign:
      return stage_sign();
    case RigSceneKind::markers:
      return stage_markers(job);
  }
  return fail(Code::usage, "no such scene");
}

/// Index of a name, -1 for "all".
Result<int> find_name(const std::vector<std::string>& names, std::string_view wanted, std::string_view what) {
  if (wanted == "all") return -1;
  const auto at = std::ranges::find(names, wanted);
  if (at != names.end()) return static_cast<int>(at - names.begin());
  return fail(Code::usage, fmt::format("there is no {} '{}'; there are {}", what, wanted, join(names)));
}

bool parse_frame(std::string_view text, std::int64_t& out) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  return error == std::errc() && end == text.data() + text.size() && out >= 0;
}

Status add_occlusion(std::string_view text, const data::Rig& rig, simulation::RigScene& scene) {
  const auto second = text.rfind(':');
  const auto first = second == std::string_view::npos || second == 0 ? second : text.rfind(':', second - 1);
  simulation::Occlusion occlusion;
  const auto wrong = [&] {
    return fail(Code::usage,
                fmt::format("occlusion '{}' is not LED:CAMERA:FIRST-LAST with frames from 0", text));
  };
  if (first == std::string_view::npos || first == second) return wrong();
  const auto frames = text.substr(second + 1);
  const auto dash = frames.find('-');
  if (dash == std::string_view::npos || !parse_frame(frames.substr(0, dash), occlusion.first_frame) ||
      !parse_frame(frames.substr(dash + 1), occlusion.last_frame) ||
      occlusion.last_frame < occlusion.first_frame)
    return wrong();
  std::vector<std::string> cameras;
  for (const auto& camera : rig.cameras) cameras.push_back(camera.name);
  const auto led = find_name(scene.leds, text.substr(0, first), "LED");
  if (!led) return std::unexpected(led.error());
  const auto camera = find_name(cameras, text.substr(first + 1, second - first - 1), "camera");
  if (!camera) return std::unexpected(camera.error());
  occlusion.camera = *camera;
  for (int l = 0; l < static_cast<int>(scene.leds.size()); ++l) {
    occlusion.led = l;
    if (*led < 0 || *led == l) scene.occlusions.push_back(occlusion);
  }
  return {};
}

Result<simulation::RigRecordingOptions> recording_options(const SimulateRigJob& job, const data::Rig& rig,
                                                          const StagedScene& staged) {
  auto out = job.recording;
  out.stream = staged.stream;
  const auto leds = staged.scene.leds.size();
  if (job.highest_rate)
    out.rate_hz =
        rig.timing.highest_rate_hz(static_cast<int>(std::max<std::size_t>(leds, 1)), rig.camera_count());
  if (job.duration_s < 0.0 || !std::isfinite(job.duration_s) || !(out.rate_hz > 0.0))
    return fail(Code::usage, fmt::format("{} s at {} frames per second; need positive numbers",
                                         job.duration_s, out.rate_hz));
  const double frames = (job.duration_s > 0.0 ? job.duration_s : staged.duration_s) * out.rate_hz;
  out.frames = frames < 1e9 ? std::max<std::int64_t>(1, std::llround(frames)) : 1'000'000'000;
  if (job.intensity.empty()) return out;
  out.intensity.assign(leds, 1.0);
  for (const auto& [name, value] : job.intensity) {
    const auto led = find_name(staged.scene.leds, name.empty() ? "all" : name, "LED");
    if (!led) return std::unexpected(led.error());
    for (std::size_t l = 0; l < leds; ++l)
      if (*led < 0 || static_cast<std::size_t>(*led) == l) out.intensity[l] = value;
  }
  return out;
}

data::Table derivatives_table(const simulation::RigRecording& recorded) {
  data::Table out;
  out.name = "derivatives of the LEDs at the time of each frame";
  out.header = {{"units", "m/s and m/s^2"}};
  out.degrees_stated = false;
  for (const auto& led : recorded.truth.names)
    for (const char* of : {"_vx", "_vy", "_vz", "_ax", "_ay", "_az"}) {
      std::string column = led;
      std::ranges::replace(column, ' ', '_');
      out.columns.push_back(column + of);
    }
  const auto leds = recorded.truth.markers();
  for (std::int64_t f = 0; f < recorded.truth.frames(); ++f) {
    out.time_s.push_back(recorded.truth.time.time_s(f));
    for (std::int64_t l = 0; l < leds; ++l)
      for (const auto* rates : {&recorded.derivatives.velocity, &recorded.derivatives.acceleration})
        for (std::size_t axis = 0; axis < 3; ++axis)
          out.values.push_back((*rates)[3 * recorded.truth.index(f, l) + axis]);
  }
  return out;
}

std::vector<std::string> notes_on(const simulation::RigRecording& recorded) {
  const auto& counts = recorded.counts;
  std::vector<std::string> out{fmt::format("{} LED{}, {:.6g} frames per second, {} frames",
                                           counts.led_count(), counts.led_count() == 1 ? "" : "s",
                                           counts.time.rate_hz, counts.frames())};
  for (std::int64_t l = 0; l < counts.led_count(); ++l)
    for (std::int64_t c = 0; c < counts.camera_count(); ++c) {
      std::int64_t beside = 0, bright = 0;
      for (std::int64_t f = 0; f < counts.frames(); ++f) {
        beside += (recorded.hidden[counts.index(f, l, c)] & simulation::kHiddenOffSheet) != 0;
        bright += counts.has_flag(f, l, c, data::kCountSaturated);
      }
      const auto note = [&](std::int64_t n, const char* what) {
        if (n > 0)
          out.push_back(fmt::format("LED '{}' {} camera {} in {} of {} frames",
                                    counts.leds[static_cast<std::size_t>(l)], what,
                                    counts.cameras[static_cast<std::size_t>(c)], n, counts.frames()));
      };
      note(beside, "is beside the sheet of");
      note(bright, "saturates");
    }
  return out;
}

io::RecordingMetadata about(const SimulateRigJob& job, std::string scene) {
  return {"simulation", {{"scene", std::move(scene)}, {"seed", std::to_string(job.seed)}}};
}

ResultFile counts_file(fs::path target, data::Counts counts, std::vector<io::RecordingMetadata> metadata) {
  return {std::move(target), [counts = std::move(counts), metadata = std::move(metadata)](
                                 const fs::path& path, const std::string& set) {
            auto with_set = metadata;
            if (!set.empty()) with_set.push_back({"set", {{"mark", io::set_mark(set)}}});
            return io::write_counts(path, counts, with_set, false);
          }};
}

/// Name of the set of files.
std::string name_set(const simulation::RigRecording& recorded, const std::string& rig_true,
                     const std::string& rig_nominal) {
  const auto& counts = recorded.counts.counts;
  return SetDigest()
      .add("simulate rig")
      .add(rig_true)
      .add(rig_nominal)
      .add({reinterpret_cast<const char*>(counts.data()), counts.size() * sizeof counts[0]})
      .add(recorded.truth)
      .hex();
}

/// Recordings of known things: what a calibration has to know of them travels in the recording.
Status add_calibration(const SimulateRigJob& job, const simulation::PhysicalRig& rig,
                       std::vector<ResultFile>& out) {
  const auto known = [](std::map<std::string, std::string> values) {
    return io::RecordingMetadata{"calibration", std::move(values)};
  };
  if (job.grid) {
    auto grid = simulation::record_grid(rig);
    if (!grid) return std::unexpected(grid.error());
    for (auto& counts : grid->counts)
      out.push_back(
          counts_file(job.folder / ("grid_" + counts.cameras.front() + ".mcap"), counts,
                      {about(job, "grid"), known({{"kind", "grid"},
                                                  {"nodes", std::to_string(grid->nodes)},
                                                  {"spacing_m", fmt::format("{}", grid->spacing_m)},
                                                  {"distance_m", fmt::format("{}", grid->distance_m)}})}));
  }
  // A scene may be too slow or too fast for three LEDs or for one: these are recorded at 100 Hz.
  simulation::RigRecordingOptions recording;
  recording.noise = job.recording.noise;
  recording.threads = job.recording.threads;
  if (job.tree_poses) {
    auto poses = simulation::record_tree_poses(rig, {.recording = recording});
    if (!poses) return std::unexpected(poses.error());
    const auto sides = simulation::tree_sides_m();
    out.push_back(counts_file(job.folder / "tree_poses.mcap", std::move(poses->counts),
                              {about(job, "tree poses"),
                               known({{"kind", "tree"},
                                      {"frames_per_pose", std::to_string(poses->frames_per_pose)},
                                      {"sides_m", fmt::format("{} {} {}", sides[0], sides[1], sides[2])}})}));
  }
  if (!job.scan) return {};
  auto scan = simulation::record_scan(rig, {.recording = recording});
  if (!scan) return std::unexpected(scan.error());
  std::string positions;
  for (const auto x : scan->x_in_stage.colwise()) positions += fmt::format("{} {} {}\n", x.x(), x.y(), x.z());
  out.push_back(
      counts_file(job.folder / "scan.mcap", std::move(scan->counts),
                  {about(job, "scan"), known({{"kind", "scan"},
                                              {"frames_per_place", std::to_string(scan->frames_per_position)},
                                              {"places_m", std::move(positions)}})}));
  return {};
}

}  // namespace

Result<RigSceneKind> parse_rig_scene(std::string_view name) { return kScenes.parse(name, "scene"); }

Result<SimulateRigOutcome> run_simulate_rig(SimulateRigJob job) {
  job.rig.seed = job.recording.seed = job.seed;
  job.recording.threads = job.threads;
  const auto rig = simulation::draw_rig(job.rig);
  if (!rig) return std::unexpected(rig.error());
  auto staged = stage(job);
  if (!staged) return std::unexpected(staged.error());
  for (const auto& occlusion : job.occlusions)
    if (auto s = add_occlusion(occlusion, rig->rig, staged->scene); !s) return std::unexpected(s.error());
  const auto options = recording_options(job, rig->rig, *staged);
  if (!options) return std::unexpected(options.error());
  const auto recorded = simulation::record(*rig, staged->scene, *options);
  if (!recorded) return std::unexpected(recorded.error());

  const std::string scene(kScenes[job.scene]);
  data::Trial truth;
  truth.source = "simulated";
  truth.markers = recorded->truth;
  const fs::path& folder = job.folder;
  std::vector<ResultFile> files;
  files.push_back(counts_file(folder / "recording.mcap", recorded->counts, {about(job, scene)}));
  files.push_back(marker_file(folder / "truth.trc", truth));
  files.push_back(table_file(folder / "truth_derivatives.sto", [&] { return derivatives_table(*recorded); }));
  const std::string rig_true = io::format_rig(simulation::rig_in_room(*rig)),
                    rig_nominal = io::format_rig(rig->nominal);
  files.push_back(toml_file(folder / "rig_true.toml", [&] { return std::string(rig_true); }));
  files.push_back(toml_file(folder / "rig_nominal.toml", [&] { return std::string(rig_nominal); }));
  if (auto s = add_calibration(job, *rig, files); !s) return std::unexpected(s.error());
  std::vector<std::string> names;
  for (const auto& file : files) names.push_back(file.target.filename().string());
  auto staging = Staging::create_in(folder, names, job, {job.markers});
  if (!staging) return std::unexpected(staging.error());
  auto written = write_results(*staging, files, job.progress, "the simulation",
                               name_set(*recorded, rig_true, rig_nominal));
  if (!written) return std::unexpected(written.error());
  SimulateRigOutcome out;
  out.written = std::move(*written);
  out.warnings = notes_on(*recorded);
  return out;
}

}  // namespace kinemark::pipeline
