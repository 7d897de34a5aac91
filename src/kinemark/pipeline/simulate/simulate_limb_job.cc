// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/simulate/simulate_limb_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "kinemark/core/counted.h"
#include "kinemark/core/version.h"
#include "kinemark/io/nwb/nwb.h"
#include "kinemark/pipeline/files/file_set.h"
#include "kinemark/pipeline/files/result_files.h"

namespace kinemark::pipeline {
namespace {

/// A basic string of TOML; names of simulated limbs need no more.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

/// Joint centres first, origin and end where they have names, then every marker.
data::Trajectories truth_of(const simulation::LimbRecording& limb) {
  std::vector<std::string> names;
  for (const auto& joint : limb.layout.joints) names.push_back(joint.name);
  if (!limb.origin_name.empty()) names.push_back(limb.origin_name);
  if (!limb.end_name.empty()) names.push_back(limb.end_name);
  names.insert(names.end(), limb.markers.names.begin(), limb.markers.names.end());
  auto out = data::Trajectories::all_missing(std::move(names), limb.markers.time);
  std::ranges::fill(out.state, data::SampleState::measured);
  const std::size_t centres = 3 * limb.layout.joints.size(), markers = 3 * limb.markers.names.size();
  auto to = out.x_in_world.begin();
  for (std::int64_t f = 0; f < out.frames(); ++f) {
    const auto frame = static_cast<std::size_t>(f);
    to = std::copy_n(limb.centre_in_world.data() + frame * centres, centres, to);
    if (!limb.origin_name.empty()) to = std::fill_n(to, 3, 0.0);
    if (!limb.end_name.empty()) to = std::copy_n(limb.end_in_world.data() + 3 * frame, 3, to);
    to = std::copy_n(limb.x_true.data() + frame * markers, markers, to);
  }
  return out;
}

/// What lies beside the markers, where it is asked for.
Result<simulation::NeuralSession> neurons_of(const SimulateLimbJob& job,
                                             const simulation::LimbRecording& limb) {
  if (!job.neurons.any()) return simulation::NeuralSession{};
  auto options = job.neurons;
  options.seed = job.seed;
  return simulation::simulate_neurons(limb.end_in_world, limb.markers.time, options);
}

/// "20 units with 5,400 spikes, 4 trials, field potentials of 4 channels".
std::string describe(const simulation::NeuralSession& session) {
  std::size_t spikes = 0, channels = 0;
  for (const auto& unit : session.neural.units) spikes += unit.times_s.size();
  for (const auto& field : session.fields) channels += field.channels.size();
  const auto* trials = session.neural.find_intervals("trials");
  return fmt::format("{} with {}, {}, field potentials of {}",
                     counted(static_cast<std::int64_t>(session.neural.units.size()), "unit"),
                     counted(static_cast<std::int64_t>(spikes), "spike"),
                     counted(trials == nullptr ? 0 : static_cast<std::int64_t>(trials->rows.size()), "trial"),
                     counted(static_cast<std::int64_t>(channels), "channel"));
}

/// Markers with what was recorded beside them. Both must live until the file is written.
ResultFile session_file(std::filesystem::path target, const SimulateLimbJob& job, const data::Trial& trial,
                        const simulation::NeuralSession& session) {
  const io::NwbMetadata metadata{.session_description = "a simulated arm beside simulated neurons",
                                 .species = "Macaca mulatta",
                                 .version = std::string(kVersion),
                                 .command = job.command_line,
                                 .seed = job.seed};
  return {.target = std::move(target),
          .write = [&trial, &session, metadata](const std::filesystem::path& staged,
                                                const std::string& set) -> Status {
            auto writer =
                io::NwbWriter::create(staged, io::NwbOutline::of(trial.markers, nullptr), metadata, {});
            if (!writer) return std::unexpected(writer.error());
            if (auto s = writer->write(trial.markers); !s) return s;
            if (auto s = writer->write_signals(trial); !s) return s;
            if (auto s = writer->write_neural(session.neural, session.fields); !s) return s;
            return writer->commit(set);
          }};
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
  for (const auto& end : layout.ends)
    out += end.stays()
               ? fmt::format("[[joint]]\nname = {}\nparent = \"ground\"\nchild = {}\n\n", quoted(end.name),
                             quoted(end.segment))
               : fmt::format("[[end]]\nname = {}\nsegment = {}\nmarker = {}\n\n", quoted(end.name),
                             quoted(end.segment), quoted(markers[static_cast<std::size_t>(end.marker)]));
  out.pop_back();
  return out;
}

Result<SimulateLimbOutcome> run_simulate_limb(const SimulateLimbJob& job) {
  auto arm = job.arm;
  auto macaque = job.macaque;
  arm.seed = macaque.seed = job.seed;
  const auto limb =
      job.scene == LimbScene::arm ? simulation::simulate_chain(arm) : simulation::simulate_sleeve(macaque);
  if (!limb) return std::unexpected(limb.error());
  auto recorded = simulation::upsample(limb->markers, job.upsample);
  if (!recorded) return std::unexpected(recorded.error());
  SimulateLimbOutcome out;
  const double samples = static_cast<double>(limb->markers.state.size());
  out.warnings.push_back(
      fmt::format("{} markers, {} frames at {:.6g} Hz, {:.0f} % of the samples seen", limb->markers.markers(),
                  limb->markers.frames(), limb->markers.time.rate_hz,
                  100.0 * (1.0 - static_cast<double>(limb->markers.count_missing()) / samples)));
  if (job.upsample.factor > 1)
    out.warnings.push_back(fmt::format("the recorder makes {} frames at {:.6g} Hz of them",
                                       recorded->frames(), recorded->time.rate_hz));

  const auto session = neurons_of(job, *limb);
  if (!session) return std::unexpected(session.error());
  if (job.neurons.any()) out.warnings.push_back(describe(*session));
  std::vector<std::string> names{"markers.c3d", "markers.trc", "truth.csv", "segments.toml"};
  if (job.neurons.any()) names.emplace_back("session.nwb");
  auto staging = Staging::create_in(job.folder, names, job, {});
  if (!staging) return std::unexpected(staging.error());
  data::Trial stream, truth;
  stream.source = truth.source = "simulated";
  stream.markers = std::move(*recorded);
  truth.markers = truth_of(*limb);
  const auto& targets = staging->targets();
  const std::string layout = segment_layout_toml(limb->layout, limb->markers.names);
  const std::string set =
      SetDigest().add("simulate limb").add(layout).add(stream.markers).add(truth.markers).hex();
  std::vector<ResultFile> files{marker_file(targets[0], stream), marker_file(targets[1], stream),
                                marker_file(targets[2], truth),
                                toml_file(targets[3], [&] { return std::string(layout); })};
  if (job.neurons.any()) files.push_back(session_file(targets[4], job, stream, *session));
  auto written = write_results(*staging, files, job.progress, "the simulation", set);
  if (!written) return std::unexpected(written.error());
  out.written = std::move(*written);
  return out;
}

}  // namespace kinemark::pipeline
