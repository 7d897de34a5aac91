// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/markers/csv.h"

#include <fmt/format.h>

#include <iterator>
#include <string>
#include <string_view>

#include "kinemark/io/file.h"

namespace kinemark::io {
namespace {

constexpr std::size_t kFlushBytes = 1 << 20;

/// A cell in quotes when it holds what would end it.
std::string quoted(const std::string& cell) {
  if (cell.find_first_of(",\"\r\n") == std::string::npos) return cell;
  std::string out = "\"";
  for (const char c : cell) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

std::string header_line(const data::Trajectories& markers) {
  std::string out = "frame,time_s";
  for (const std::string& name : markers.names)
    for (const char* part : {".x", ".y", ".z", ".state"}) out += "," + quoted(name + part);
  return out + "\n";
}

}  // namespace

Status write_csv(const std::filesystem::path& path, const data::Trial& trial, bool force) {
  if (auto status = trial.validate(); !status) return fail_at(path.string(), status.error());
  auto file = OutputFile::create(path, force);
  if (!file) return std::unexpected(file.error());
  const data::Trajectories& markers = trial.markers;
  if (auto status = file->write(header_line(markers)); !status) return status;
  fmt::memory_buffer out;
  const auto end = std::back_inserter(out);
  for (std::int64_t f = 0; f < markers.frames(); ++f) {
    fmt::format_to(end, "{},{}", trial.first_frame + f, markers.time.time_s(f));
    for (std::int64_t m = 0; m < markers.markers(); ++m) {
      const auto x = markers.x(f, m);
      const std::string_view state = data::to_string(markers.state[markers.index(f, m)]);
      if (markers.present(f, m))
        fmt::format_to(end, ",{},{},{},{}", x[0], x[1], x[2], state);
      else
        fmt::format_to(end, ",,,,{}", state);
    }
    out.push_back('\n');
    if (out.size() < kFlushBytes && f + 1 < markers.frames()) continue;
    if (auto status = file->write(std::string_view(out.data(), out.size())); !status) return status;
    out.clear();
  }
  return file->commit();
}

}  // namespace kinemark::io
