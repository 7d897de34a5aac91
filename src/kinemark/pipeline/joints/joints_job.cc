// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/joints/joints_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kinemark/core/version.h"
#include "kinemark/io/file.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/pipeline/files/file_hash.h"
#include "kinemark/pipeline/files/staging.h"
#include "kinemark/pipeline/joints/segments_file.h"
#include "kinemark/stages/skeleton/articulated/articulated.h"
#include "kinemark/stages/trajectory/screening/real_samples.h"
#include "kinemark/stages/trajectory/screening/screen.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;

constexpr double kSureDefect = 0.8;
/// Screening searches for discontinuities of paths. With so large a share of them the recording has no
/// continuous paths: its frames are independent poses.
constexpr double kMostDefects = 0.05;
constexpr std::size_t kDefectsTold = 5;

Status check_method(const std::string& method) {
  if (method == "articulated") return {};
  if (const auto known = skeleton::parse_functional_method(method); !known)
    return fail(Code::usage,
                fmt::format("'{}' is not a method; use articulated, score, sara, gamage, gamage-plain, "
                            "cylinder or constant-distance",
                            method));
  return {};
}

/// Reject the samples of certain findings, with a note.
Status reject_defects(data::Trajectories& markers, JointsOutcome& outcome) {
  const auto findings = trajectory::screen(markers);
  if (!findings) return std::unexpected(findings.error());
  std::vector<trajectory::Finding> sure;
  double samples = 0.0;
  for (const auto& finding : *findings) {
    if (finding.confidence < kSureDefect || finding.defect == trajectory::Defect::clock_jump) continue;
    sure.push_back(finding);
    samples += static_cast<double>(finding.last_frame - finding.first_frame + 1);
  }
  if (sure.empty()) return {};
  if (samples > kMostDefects * static_cast<double>(markers.state.size())) {
    outcome.notes.push_back(
        fmt::format("{:.0f} % of the samples break their paths: frames are taken as poses of their own, and "
                    "nothing was rejected.",
                    100.0 * samples / static_cast<double>(markers.state.size())));
    return {};
  }
  for (std::size_t i = 0; i < sure.size() && i < kDefectsTold; ++i)
    outcome.notes.push_back("Left out: " + sure[i].sentence);
  if (sure.size() > kDefectsTold)
    outcome.notes.push_back(fmt::format("Left out: {} more defects like these.", sure.size() - kDefectsTold));
  auto rest = trajectory::reject_findings(markers, sure, kSureDefect);
  if (!rest) return std::unexpected(rest.error());
  markers = std::move(*rest);
  return {};
}

/// Only measured samples, unless the job asks for all.
Status keep_real(data::Trajectories& markers, JointsOutcome& outcome) {
  const auto upsampling = trajectory::detect_upsampling(markers);
  if (!upsampling) return std::unexpected(upsampling.error());
  auto real = trajectory::keep_real_samples(markers, *upsampling, trajectory::MadeSamples::missing);
  if (!real) return std::unexpected(real.error());
  const auto lost = real->count_missing() - markers.count_missing();
  if (lost == 0) return {};
  outcome.notes.push_back(fmt::format("{} samples that the recorder interpolated were left out.", lost));
  markers = std::move(*real);
  return {};
}

Result<data::SegmentLayout> find_layout(const JointsJob& job, const data::Trajectories& markers,
                                        JointsOutcome& outcome) {
  if (!job.segments.empty()) return read_segments(job.segments, markers.names);
  if (markers.markers() < 4)
    return fail(
        Code::bad_input,
        fmt::format("{} markers in all; a joint needs 4 at least, three on one segment and one on another",
                    markers.markers()));
  skeleton::TopologyOptions options;
  options.noise_sd_m = job.noise_sd_m;
  auto topology = skeleton::find_topology(markers, options);
  if (!topology) return std::unexpected(topology.error());
  outcome.notes.push_back(fmt::format("Found in the data: {} segments, {} joints.",
                                      topology->layout.segments.size(), topology->layout.joints.size()));
  if (topology->layout.segments.size() < 2)
    return fail(Code::bad_input,
                fmt::format("all {} markers keep their distances: they are on one segment, or "
                            "nothing moved, so no joint can be found",
                            markers.markers()));
  outcome.notes.insert(outcome.notes.end(), topology->warnings.begin(), topology->warnings.end());
  outcome.topology = std::move(*topology);
  return outcome.topology->layout;
}

/// The part of the layout that the articulated fit can estimate: the largest tree of segments with two
/// markers or more.
Result<data::SegmentLayout> largest_tree(const data::SegmentLayout& layout, std::vector<std::string>& notes) {
  const auto S = layout.segments.size();
  const auto usable = [&](int s) { return layout.segments[static_cast<std::size_t>(s)].markers.size() >= 2; };
  std::vector<int> tree(S);
  std::iota(tree.begin(), tree.end(), 0);
  for (const auto& joint : layout.joints) {
    if (!usable(joint.parent) || !usable(joint.child)) continue;
    const int from = tree[static_cast<std::size_t>(joint.child)],
              to = tree[static_cast<std::size_t>(joint.parent)];
    std::ranges::replace(tree, from, to);
  }
  int best = 0;
  for (const int t : tree)
    if (std::ranges::count(tree, t) > std::ranges::count(tree, best)) best = t;
  if (static_cast<std::size_t>(std::ranges::count(tree, best)) == S) return layout;
  data::SegmentLayout out;
  std::vector<int> number(S, -1);
  std::string left;
  for (std::size_t s = 0; s < S; ++s) {
    if (tree[s] == best) {
      number[s] = static_cast<int>(out.segments.size());
      out.segments.push_back(layout.segments[s]);
    } else {
      left += (left.empty() ? "" : ", ") + layout.segments[s].name;
    }
  }
  for (const auto& joint : layout.joints) {
    const int parent = number[static_cast<std::size_t>(joint.parent)],
              child = number[static_cast<std::size_t>(joint.child)];
    if (parent >= 0 && child >= 0) out.joints.push_back({joint.name, parent, child});
  }
  if (out.joints.empty())
    return fail(Code::bad_input,
                fmt::format("none of the {} joints found lies between two segments of two markers or more, "
                            "which the articulated method needs; name the segments in a file, or use another "
                            "method",
                            layout.joints.size()));
  notes.push_back(fmt::format(
      "Left out, as the articulated method needs two markers on a segment and one tree of them: {}.", left));
  return out;
}

Result<data::Skeleton> estimate(const JointsJob& job, const data::Trajectories& markers,
                                const data::SegmentLayout& layout, JointsOutcome& outcome,
                                const Progress& progress) {
  if (job.method == "articulated") {
    skeleton::ArticulatedOptions options;
    options.noise_sd_m = job.noise_sd_m;
    options.continuity = job.continuity;
    options.soft_tissue = job.soft_tissue;
    options.joint = job.kind;
    options.threads = job.threads;
    auto fit = skeleton::fit_articulated(markers, layout, options, progress);
    if (!fit) return std::unexpected(fit.error());
    if (job.soft_tissue) outcome.marker_noise_sd_m = std::move(fit->marker_noise_sd_m);
    return std::move(fit->skeleton);
  }
  skeleton::FunctionalOptions options;
  options.method = skeleton::parse_functional_method(job.method).value();
  options.sides = job.sides;
  options.kind = job.kind;
  options.noise_sd_m = job.noise_sd_m;
  return skeleton::find_joints(markers, layout, options);
}

void describe(const JointsJob& job, JointsOutcome& outcome, const std::string& hash) {
  auto& json = outcome.json;
  json = skeleton_json(outcome.skeleton);
  json["version"] = kVersion;
  json["command"] = job.command_line;
  json["input"] = {{"path", job.input.string()}, {"xxh3_64", hash}};
  json["method"] = job.method;
  json["notes"] = outcome.notes;
  json["slips"] = nlohmann::ordered_json::array();
  for (const auto& slip : outcome.slips)
    json["slips"].push_back(
        {{"words", slip.sentence}, {"shift_m", slip.shift_m}, {"sd_m", slip.sd_m}, {"frame", slip.frame}});
  for (std::size_t m = 0; m < outcome.marker_noise_sd_m.size(); ++m)
    if (std::isfinite(outcome.marker_noise_sd_m[m]))
      json["marker_noise"].push_back(
          {{"name", outcome.skeleton.markers[m]}, {"sd_m", outcome.marker_noise_sd_m[m]}});
  if (!outcome.topology) return;
  auto& topology = json["topology"];
  for (std::size_t m = 0; m < outcome.topology->markers.size(); ++m)
    topology["markers"].push_back({{"name", outcome.skeleton.markers[m]},
                                   {"nats", outcome.topology->markers[m].nats},
                                   {"doubtful", outcome.topology->markers[m].doubtful}});
  for (std::size_t j = 0; j < outcome.topology->joints.size(); ++j) {
    const auto& joint = outcome.topology->joints[j];
    topology["joints"].push_back(
        {{"name", outcome.topology->layout.joints[j].name},
         {"residual_m", joint.residual_m},
         {"margin", std::isfinite(joint.margin) ? nlohmann::ordered_json(joint.margin)
                                                : nlohmann::ordered_json(nullptr)},
         {"doubtful", joint.doubtful}});
  }
}

void judge(JointsOutcome& outcome) {
  const auto& skeleton = outcome.skeleton;
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    bool placed = false;
    for (std::int64_t f = 0; f < skeleton.frames() && !placed; ++f)
      placed =
          skeleton.state[skeleton.index(f, static_cast<std::int64_t>(j))] != data::CentreState::undetermined;
    if (placed) continue;
    outcome.exit_status = 1;
    outcome.notes.push_back(fmt::format("Joint '{}' was placed in no frame.", skeleton.joints[j].name));
  }
}

bool into_folder(const fs::path& output) { return !output.has_extension() || fs::is_directory(output); }

std::vector<fs::path> list_targets(const fs::path& output) {
  if (output.empty()) return {};
  if (!into_folder(output))
    return {output, output.parent_path() / (output.stem().string() + "_skeleton.json")};
  return {output / "centres.csv", output / "skeleton.json", output / "centres.c3d", output / "segments.toml"};
}

/// A folder created for the results and removed again if none are written.
class NewFolder {
 public:
  Status make(const fs::path& path) {
    std::error_code error;
    if (fs::create_directories(path, error)) made_ = path;
    if (error) return fail(Code::io, fmt::format("{}: cannot be made: {}", path.string(), error.message()));
    return {};
  }
  void keep() { made_.clear(); }
  NewFolder() = default;
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;
  ~NewFolder() {
    std::error_code ignored;
    if (!made_.empty()) fs::remove(made_, ignored);
  }

 private:
  fs::path made_;
};

Status write_outputs(const JointsOutcome& outcome, const data::Trial& trial,
                     const data::SegmentLayout& layout, Staging& staging) {
  data::Trial centres;
  centres.source = trial.source;
  centres.first_frame = trial.first_frame;
  centres.markers = centre_trajectories(outcome.skeleton);
  const auto& targets = staging.targets();
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const std::string ending = targets[i].extension().string();
    const Status s = ending == ".json" ? io::write_text(staging.path(i), outcome.json.dump(2) + "\n", false)
                     : ending == ".toml"
                         ? io::write_text(staging.path(i), segments_text(layout, trial.markers.names), false)
                         : io::write_markers(staging.path(i), centres, false);
    if (!s) return staging.failure(s.error());
  }
  return staging.commit();
}

}  // namespace

Result<JointsOutcome> run_joints(const JointsJob& job, const Progress& progress) {
  if (auto s = check_method(job.method); !s) return std::unexpected(s.error());
  if (!(job.noise_sd_m >= 0.0) || !std::isfinite(job.noise_sd_m))
    return fail(Code::usage, fmt::format("marker noise of {} mm; need 0 or more", 1e3 * job.noise_sd_m));
  if (job.soft_tissue && job.method != "articulated")
    return fail(Code::usage,
                fmt::format("soft tissue is a term of the articulated method; '{}' has none", job.method));
  auto trial = io::read_markers(job.input, {.rate_hz = io::needs_rate(job.input) ? job.rate_hz : 0.0});
  if (!trial) return std::unexpected(trial.error());
  const auto hash = hash_file(job.input);
  if (!hash) return std::unexpected(hash.error());
  const std::string name = job.input.string();
  if (trial->markers.markers() == 0 || trial->markers.frames() == 0)
    return fail(Code::bad_input, fmt::format("{}: holds {} markers and {} frames; need at least one of each",
                                             name, trial->markers.markers(), trial->markers.frames()));
  JointsOutcome outcome;
  auto& markers = trial->markers;
  if (!job.keep_upsampled)
    if (auto s = keep_real(markers, outcome); !s) return fail_at(name, s.error());
  if (!job.keep_defects)
    if (auto s = reject_defects(markers, outcome); !s) return fail_at(name, s.error());
  auto layout = find_layout(job, markers, outcome);
  if (!layout) return job.segments.empty() ? fail_at(name, layout.error()) : std::unexpected(layout.error());
  if (job.method == "articulated" && outcome.topology) {
    layout = largest_tree(*layout, outcome.notes);
    if (!layout) return fail_at(name, layout.error());
  }
  NewFolder folder;
  if (!job.output.empty() && into_folder(job.output))
    if (auto s = folder.make(job.output); !s) return std::unexpected(s.error());
  const auto targets = list_targets(job.output);
  auto staging = Staging::create(targets, job.force);
  if (!staging) return std::unexpected(staging.error());
  auto found = estimate(job, markers, *layout, outcome, progress);
  if (!found) return fail_at(name, found.error());
  outcome.skeleton = std::move(*found);
  auto slips = skeleton::find_slips(markers, *layout);
  if (!slips) return fail_at(name, slips.error());
  outcome.slips = std::move(*slips);
  // The articulated fit itself reports markers that moved on their segment.
  for (const auto& slip : outcome.slips)
    if (job.method != "articulated" || slip.marker < 0)
      outcome.notes.push_back(slip.sentence + (slip.sentence.ends_with('?') ? "" : "."));
  judge(outcome);
  describe(job, outcome, hash->hex);
  if (auto s = write_outputs(outcome, *trial, *layout, *staging); !s) return std::unexpected(s.error());
  outcome.written = targets;
  folder.keep();
  return outcome;
}

}  // namespace kinemark::pipeline
