// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <system_error>

#include "kinemark/core/utf8.h"
#include "kinemark/core/version.h"
#include "kinemark/io/bids/channel_list.h"
#include "kinemark/io/bids/motion_bids.h"
#include "kinemark/io/file.h"

namespace kinemark::io {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kFlushBytes = 1 << 20;

std::string text_of(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json description_of_motion(const MotionName& name, const data::Trial& trial) {
  const auto& time = trial.markers.time;
  std::int64_t angles = 0, others = 0;
  for (const auto kind : trial.channels.kinds) (kind == data::ChannelKind::angle ? angles : others) += 3;
  const std::int64_t positions = 3 * trial.markers.markers();
  Json out = {{"TaskName", name.task},
              {"SamplingFrequency", time.rate_hz},
              {"SamplingFrequencyEffective", time.rate_hz},
              {"TrackingSystemName", name.tracksys},
              {"MissingValues", "n/a"},
              {"RecordingType", "continuous"},
              {"RecordingDuration", static_cast<double>(time.frames) / time.rate_hz},
              {"MotionChannelCount", positions + angles + others + (time.t0_s != 0.0 ? 1 : 0)},
              {"POSChannelCount", positions},
              {"TrackedPointsCount", trial.markers.markers()}};
  if (angles > 0) out["JNTANGChannelCount"] = angles;
  if (others > 0) out["MISCChannelCount"] = others;
  if (time.t0_s != 0.0) out["LATENCYChannelCount"] = 1;
  if (!trial.software.empty()) out["SoftwareVersions"] = to_utf8(trial.software);
  return out;
}

Json description_of_frame() {
  return {{"reference_frame",
           {{"Description", "Frame in which positions and directions are given"},
            {"Levels",
             {{"laboratory",
               {{"SpatialAxes", "___"},
                {"RotationRule", "right-hand"},
                {"Description",
                 "The right-handed laboratory frame of the recorder; the recording does not say where its "
                 "axes point"}}}}}}}};
}

Json description_of_dataset(const MotionName& name) {
  std::error_code ignored;
  const auto top = fs::absolute(name.top, ignored).lexically_normal();
  const std::string called = (top.has_filename() ? top : top.parent_path()).filename().string();
  return {{"Name", called.empty() ? "Motion recordings" : to_utf8(called)},
          {"BIDSVersion", "1.9.0"},
          {"DatasetType", "raw"},
          {"GeneratedBy", Json::array({{{"Name", "kinemark"}, {"Version", kVersion}}})}};
}

constexpr std::string_view kReadme =
    "Recordings of movement in the Brain Imaging Data Structure (Motion-BIDS).\n\n"
    "Each folder sub-LABEL holds the recordings of one subject. A recording is a table without a header, "
    "*_motion.tsv, of which\n"
    "*_channels.tsv names the columns and *_motion.json the rate. Positions are in metres, in the laboratory "
    "frame of the recorder.\n"
    "Converted with kinemark. Say here who was recorded, what they did, and how the data may be used.\n";

void append(fmt::memory_buffer& out, double value) {
  if (std::isfinite(value))
    fmt::format_to(std::back_inserter(out), "{}", value);
  else
    out.append(std::string_view("n/a"));
}

Status write_motion(const fs::path& to, const data::Trial& trial) {
  auto file = OutputFile::create(to, false);
  if (!file) return std::unexpected(file.error());
  const auto& m = trial.markers;
  const auto width = static_cast<std::size_t>(3 * trial.channels.count());
  fmt::memory_buffer out;
  for (std::int64_t f = 0; f < m.frames(); ++f) {
    const auto begin = static_cast<std::size_t>(3 * f * m.markers());
    for (std::size_t i = 0; i < 3 * m.names.size(); ++i) {
      if (i > 0) out.push_back('\t');
      append(out, m.x_in_world[begin + i]);
    }
    for (std::size_t i = 0; i < width; ++i) {
      out.push_back('\t');
      append(out, trial.channels.values[static_cast<std::size_t>(f) * width + i]);
    }
    if (m.time.t0_s != 0.0) {
      out.push_back('\t');
      append(out, m.time.time_s(f));
    }
    out.push_back('\n');
    if (out.size() < kFlushBytes && f + 1 < m.frames()) continue;
    if (auto s = file->write(std::string_view(out.data(), out.size())); !s) return s;
    out.clear();
  }
  return file->commit();
}

/// Names stand in cells of a table.
Status check_names(const data::Trial& trial) {
  const auto fits = [](const std::string& text) { return text.find_first_of("\t\r\n") == std::string::npos; };
  for (const auto* names : {&trial.markers.names, &trial.channels.names, &trial.channels.units})
    for (const std::string& name : *names)
      if (!fits(name))
        return fail(Code::bad_input,
                    fmt::format("'{}' holds a tab or a line end, which a table cannot", printable(name)));
  return {};
}

MotionFile text_at(fs::path path, std::string text) {
  return {.path = std::move(path),
          .write = [text = std::move(text)](const fs::path& to) { return write_text(to, text, false); }};
}

}  // namespace

Result<std::vector<MotionFile>> motion_files(const MotionName& name, const data::Trial& trial) {
  const auto at = [&](const Error& error) { return fail_at(name.file("motion.tsv").string(), error); };
  if (auto s = trial.validate(); !s) return at(s.error());
  if (auto s = check_names(trial); !s) return at(s.error());
  if (trial.markers.frames() == 0 || trial.markers.markers() == 0)
    return at({Code::bad_input,
               fmt::format("a motion recording needs a frame and a marker; the trial has {} and {}",
                           trial.markers.frames(), trial.markers.markers())});
  std::vector<MotionFile> out;
  out.push_back({.path = name.file("motion.tsv"),
                 .write = [&trial](const fs::path& to) { return write_motion(to, trial); }});
  out.push_back(text_at(name.file("motion.json"), text_of(description_of_motion(name, trial))));
  out.push_back(text_at(name.file("channels.tsv"), format_columns(columns_of(trial))));
  out.push_back(text_at(name.file("channels.json"), text_of(description_of_frame())));
  std::error_code ignored;
  const auto absent = [&](const char* file) { return !fs::exists(name.top / file, ignored); };
  if (absent("dataset_description.json"))
    out.push_back(text_at(name.top / "dataset_description.json", text_of(description_of_dataset(name))));
  if (absent("README") && absent("README.md") && absent("README.txt") && absent("README.rst"))
    out.push_back(text_at(name.top / "README", std::string(kReadme)));
  return out;
}

}  // namespace kinemark::io
