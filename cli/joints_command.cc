// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <memory>
#include <string>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/many_inputs.h"
#include "cli/recording_options.h"
#include "kinemark/pipeline/files/json_text.h"
#include "kinemark/pipeline/joints/joints_json.h"

namespace kinemark::cli {
namespace {

struct JointsArguments {
  pipeline::JointsJob job;
  ManyArguments many;
  std::string sides = "both", kind = "auto";
  double noise_mm = 0.0;
  bool no_continuity = false;
};

Status read_names(JointsArguments& arguments) {
  auto& job = arguments.job;
  const auto sides = skeleton::parse_sides(arguments.sides);
  if (!sides) return std::unexpected(sides.error());
  job.sides = *sides;
  const auto kind = data::parse_joint_choice(arguments.kind);
  if (!kind) return std::unexpected(kind.error());
  job.kind = *kind;
  return {};
}

/// The centres of each recording as a file in the folder --output.
int run_many_joints(const CommonOptions& common, JointsArguments& arguments) {
  auto& many = arguments.many;
  many.output = arguments.job.output;
  many.pages = arguments.job.report;
  if (many.to.empty()) many.to = "csv";
  if (auto s = many.check_format(); !s) return report_error(s.error());
  if (auto s = pipeline::check_for_several(arguments.job); !s) return report_error(s.error());
  if (!arguments.job.figures.empty())
    return report_error(Error{Code::usage, "--figures draws one recording; several were given"});
  const auto find_one = [&arguments](const std::filesystem::path& input, const std::filesystem::path& output,
                                     const std::filesystem::path& page,
                                     const pipeline::JobSettings& settings) -> Result<pipeline::JobOutcome> {
    pipeline::JointsJob one = arguments.job;
    static_cast<pipeline::JobSettings&>(one) = settings;
    one.input = input;
    drop_what_it_states(one, input);
    one.output = output;
    one.report = page;
    return pipeline::run_joints(one);
  };
  return run_each(common, many, many.to, "_skeleton.json", find_one);
}

int run_command(const CommonOptions& common, JointsArguments& arguments) {
  if (auto s = read_names(arguments); !s) return report_error(s.error());
  auto& job = arguments.job;
  job.noise_sd_m = 1e-3 * arguments.noise_mm;
  job.continuity = !arguments.no_continuity;
  auto& many = arguments.many;
  if (many.are_many()) return run_many_joints(common, arguments);
  if (auto s = many.check_single(); !s) return report_error(s.error());
  job.input = many.inputs.front();
  settle(common, "frames", job);
  const auto outcome = pipeline::run_joints(job);
  if (!outcome) return report_error(outcome.error());
  const auto& skeleton = outcome->skeleton;
  std::string counts = fmt::format("{} frames at {:g} Hz, {} segments, {} joints", skeleton.frames(),
                                   skeleton.time.rate_hz, skeleton.segments.size(), skeleton.joints.size());
  if (std::isfinite(skeleton.noise_sd_m))
    counts += fmt::format("; marker noise {:.2f} mm per axis", 1e3 * skeleton.noise_sd_m);
  say(common, counts + ".");
  for (const auto& line : pipeline::skeleton_description(skeleton)) say(common, line);
  for (const auto& warning : skeleton.warnings) say(common, "attention: " + warning);
  for (const auto& note : outcome->warnings) say(common, "note: " + note);
  say_written(common, *outcome);
  if (common.json) print_result(pipeline::json_text(pipeline::joints_json(job, *outcome)) + "\n");
  return outcome->exit_status();
}

}  // namespace

void add_joints(CLI::App& app, const CommonOptions& common, Run& run) {
  auto* command =
      app.add_subcommand("joints", "Joint centres and axes from markers, each with its covariance");
  command->footer(
      "Without --segments the names of known marker sets tell the segments, else how the markers move: a "
      "joint "
      "is\n"
      "known where segmentations that the data allow agree on it. Exit status 1: a joint is not determined, "
      "a\n"
      "segment or joint was left out as no body's, or a joint could be placed in no frame.\n"
      "Several recordings, or a folder of them: --output is a folder for a file of centres each, in the "
      "format of --to; what "
      "is there already is not done again.");
  const auto arguments = std::make_shared<JointsArguments>();
  auto& job = arguments->job;
  command
      ->add_option("IN", arguments->many.inputs, "Recordings, .c3d, .trc, .csv or .nwb, or folders of them")
      ->required();
  command
      ->add_option("--to", arguments->many.to,
                   "Format of the files of several recordings: " + written_formats() + " (csv)")
      ->type_name("FORMAT")
      ->group("Several recordings");
  add_many_options(*command, arguments->many);
  command
      ->add_option("--segments", job.segments,
                   "TOML: [[segment]] name, markers; [[joint]] name, parent (or \"ground\"), child; [[end]] "
                   "name, segment, "
                   "marker; or the .vsk of a Vicon subject")
      ->group("Input");
  command
      ->add_option("-o,--output", job.output,
                   "Folder (centres.csv, centres.c3d, skeleton.json, segments.toml), or a file .c3d, .trc, "
                   ".csv, .nwb; "
                   "what is found is printed alone when absent")
      ->group("Output");
  command
      ->add_option("--report", job.report,
                   "Also write the page that shows the result, R.html; a folder for several")
      ->group("Output");
  command
      ->add_option("--figures", job.figures,
                   "Also draw the limb in several postures from its markers, F.svg: dots, black line, shadow")
      ->group("Output");
  command
      ->add_option("--method", job.method,
                   "articulated, score, sara, gamage, gamage-plain, cylinder or constant-distance")
      ->capture_default_str()
      ->group("Estimate");
  command
      ->add_option("--sides", arguments->sides, "Segments that hold the centre still: both, parent or child")
      ->capture_default_str()
      ->group("Estimate");
  command->add_option("--kind", arguments->kind, "Kind of the joints: auto (from the data), ball or hinge")
      ->capture_default_str()
      ->group("Estimate");
  command->add_option("--noise", arguments->noise_mm, "Marker noise per axis, mm; 0 finds it from the data")
      ->capture_default_str()
      ->group("Estimate");
  command
      ->add_flag("--no-continuity", arguments->no_continuity,
                 "articulated: each frame on its own, nothing smoothed or bridged")
      ->group("Estimate");
  command
      ->add_flag("--soft-tissue", job.soft_tissue,
                 "articulated: every marker has a noise of its own, found from the data")
      ->group("Estimate");
  add_recording_options(*command, job, pipeline::Doubtful::drop);
  command->add_flag("--keep-upsampled", job.keep_upsampled, "Use samples that the recorder interpolated, too")
      ->group("Input");
  command->callback(
      [&common, arguments, &run] { run = [&common, arguments] { return run_command(common, *arguments); }; });
}

}  // namespace kinemark::cli
