// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Arguments common to the commands that estimate a motion of the model from markers: `ik` and `track`.
#pragma once

#include <fmt/core.h>

#include <string>
#include <utility>
#include <vector>

#include "cli/command.h"
#include "cli/recording_options.h"
#include "kinemark/core/result.h"
#include "kinemark/pipeline/motion/motion_job.h"

namespace kinemark::cli {

/// Options in the units of the command line.
struct MotionArguments {
  std::vector<std::string> weights;
  double noise_mm = 0.0, max_rms_mm = 50.0, max_offset_mm = 50.0;
  bool no_limits = false, no_error_bars = false;
  std::vector<std::string> images;
  std::vector<std::filesystem::path> recordings;  ///< any number
};

/// "NAME=NUMBER"; `what` names the number in the failure.
[[nodiscard]] Result<std::pair<std::string, double>> parse_pair(const std::string& text, const char* what);

/// Files, weights, error bars and gates. Job is an IkJob or a TrackJob.
template <class Job>
void add_motion_options(CLI::App& command, Job& job, MotionArguments& a) {
  command.add_option("-m,--model", job.model, "Body model, .osim; torques need masses")->group("Input");
  command.add_option("-t,--markers", a.recordings, "Marker file, .c3d, .trc, .nwb, .csv, .tsv or .v3d")
      ->group("Input");
  add_recording_options(command, job, pipeline::Doubtful::drop);
  command
      .add_option(
          "--forces", job.forces,
          "External forces, for torques: .c3d or .mat with force plates, .mot or .sto with columns such "
          "as ground_force_vx, .txt of D-Flow, or OpenSim ExternalLoads .xml")
      ->group("Input");
  command.add_option("--rig", job.images.rig, "Calibrated cameras, rig.toml")->group("Images");
  command
      .add_option("--images", a.images,
                  "Points that a camera of the rig saw, CAMERA=FILE: .csv and .h5 of DeepLabCut, .h5 of "
                  "SLEAP, .json of "
                  "OpenPose (or its "
                  "folder), MMPose or COCO. Repeatable.")
      ->group("Images");
  command.add_option("--image-noise", job.images.noise_sd_px, "Noise of a point per axis, px")
      ->capture_default_str()
      ->group("Images");
  command.add_option("--min-likelihood", job.images.min_likelihood, "Less likely points are not seen")
      ->capture_default_str()
      ->group("Images");
  command
      .add_option("--person", job.images.person,
                  "Which person of images that show several: the file's number, else the place in the frame "
                  "or file from 1")
      ->group("Images");
  command
      .add_option(
          "--geometry", job.geometry,
          "Folder with the meshes that the .osim names, for the page; looked into after the model's own "
          "folder and Geometry/ there. Repeatable.")
      ->group("Output");
  command
      .add_option("-o,--output", job.output,
                  "Motion file to write, Q.mot; of one recording walk.c3d, when absent, "
                  "walk.mot beside it")
      ->group("Output");
  command
      .add_flag(
          "--nwb", job.into_nwb,
          "Also write Q_angles.nwb: a copy of the recording's NWB file, untouched, with the angles and their "
          "deviations in a processing module; of other recordings the angles alone")
      ->group("Output");
  command.add_option("--weight", a.weights, "Marker weight NAME=W; 0 leaves the marker out. Repeatable.")
      ->group("Markers");
  command.add_option("--noise", a.noise_mm, "Marker noise per axis, mm; 0 estimates it from the residuals")
      ->capture_default_str()
      ->group("Markers");
  command.add_flag("--no-error-bars", a.no_error_bars, "Skip standard deviations and bounds")
      ->group("Output");
  command.add_flag("--no-limits", a.no_limits, "Let clamped coordinates leave their range")
      ->group("Estimate");
  command.add_option("--max-rms", a.max_rms_mm, "Gate: RMS marker error, mm")
      ->capture_default_str()
      ->group("Quality gates");
  command.add_option("--max-offset", a.max_offset_mm, "Gate: mean marker offset, mm")
      ->capture_default_str()
      ->group("Quality gates");
}

/// Where the motion of one recording goes without --output: beside it, with its name. Empty where that cannot
/// be said: of several recordings, of images alone.
[[nodiscard]] std::filesystem::path motion_beside(const std::vector<std::filesystem::path>& recordings);

/// Copy the command line's arguments to the job.
template <class Job>
[[nodiscard]] Status apply(const MotionArguments& a, Job& job) {
  if (!a.recordings.empty()) job.markers = a.recordings.front();
  bool is_set_up = false;  // which names the output
  if constexpr (requires { job.setup; }) is_set_up = !job.setup.empty();
  if (job.output.empty() && !is_set_up) job.output = motion_beside(a.recordings);
  for (const auto& text : a.weights) {
    const auto weight = parse_pair(text, "WEIGHT");
    if (!weight) return std::unexpected(weight.error());
    job.options.marker_weights.push_back({weight->first, weight->second});
  }
  for (const auto& text : a.images) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
      return fail(Code::usage, fmt::format("'{}' is not CAMERA=FILE", text));
    job.images.cameras.push_back({text.substr(0, equals), text.substr(equals + 1)});
  }
  job.options.marker_noise_sd_m = 1e-3 * a.noise_mm;
  job.options.limits = !a.no_limits;
  job.options.error_bars = !a.no_error_bars;
  job.max_rms_m = 1e-3 * a.max_rms_mm;
  job.max_offset_m = 1e-3 * a.max_offset_mm;
  return {};
}

/// Findings, files, and the summary with --json.
void print_motion(const CommonOptions& common, const pipeline::MotionOutcome& outcome);

}  // namespace kinemark::cli
