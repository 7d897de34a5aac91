// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/camera_makers.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <string>

#include "kinemark/io/text/internal/cells.h"
#include "kinemark/io/text/internal/maker_headers.h"
#include "kinemark/io/text/internal/marker_rows.h"
#include "kinemark/io/text_input.h"

namespace kinemark::io {
namespace {

using internal::Lines;
using internal::MakerHeader;

std::string_view format_name(MakerText which) {
  switch (which) {
    case MakerText::qtm:
      return "QTM TSV";
    case MakerText::motive:
      return "Motive CSV";
    case MakerText::vicon:
      return "Vicon CSV";
  }
  return "";
}

Result<MakerHeader> parse_header(Lines& lines, MakerText which, data::Trial& trial) {
  switch (which) {
    case MakerText::qtm:
      return internal::parse_qtm_header(lines, trial);
    case MakerText::motive:
      return internal::parse_motive_header(lines, trial);
    case MakerText::vicon:
      return internal::parse_vicon_header(lines, trial);
  }
  return fail(Code::usage, "no such text");
}

/// What follows the rows of trajectories.
void note_rest(Lines& lines, MakerText which, data::Trial& trial) {
  if (const std::int64_t line = lines.skip_blank(); line > 0)
    trial.warnings.push_back(fmt::format("a blank line ends the {}; line {} and what follows is not read",
                                         which == MakerText::vicon ? "trajectories" : "data", line));
}

Result<data::Trial> parse(std::string_view text, MakerText which) {
  Lines lines(text);
  data::Trial trial;
  trial.format = format_name(which);
  const auto header = parse_header(lines, which, trial);
  if (!header) return std::unexpected(header.error());

  if (auto s = internal::read_marker_rows(lines, header->columns, text.size(), trial); !s)
    return std::unexpected(s.error());
  note_rest(lines, which, trial);
  for (std::int64_t m = 0; m < std::ssize(header->state); ++m) {
    if (header->state[static_cast<std::size_t>(m)] == data::SampleState::measured) continue;
    for (std::int64_t f = 0; f < trial.markers.frames(); ++f)
      if (trial.markers.present(f, m))
        trial.markers.state[trial.markers.index(f, m)] = header->state[static_cast<std::size_t>(m)];
  }
  return trial;
}

}  // namespace

std::optional<MakerText> maker_text_of(std::string_view begin) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (begin.starts_with(kByteOrderMark)) begin.remove_prefix(kByteOrderMark.size());
  for (const std::string_view key : {"NO_OF_FRAMES\t", "FILE_VERSION\t", "NO_OF_CAMERAS\t"})
    if (begin.starts_with(key)) return MakerText::qtm;
  if (begin.starts_with("Format Version,")) return MakerText::motive;
  const auto first = internal::lower(begin.substr(0, begin.find_first_of(",\r\n")));
  constexpr std::array<std::string_view, 7> kVicon{"trajectories", "devices", "model outputs", "joints",
                                                   "segments",     "events",  "title"};
  if (std::ranges::find(kVicon, first) != kVicon.end()) return MakerText::vicon;
  return std::nullopt;
}

Result<data::Trial> parse_maker_text(std::string_view text, std::string_view name, MakerText which) {
  auto trial = parse(text, which);
  if (!trial) return fail_at(name, trial.error());
  trial->source = name;
  return trial;
}

Result<data::Trial> read_maker_text(const std::filesystem::path& path, MakerText which) {
  const auto text = read_lines_of_text(path);
  if (!text) return std::unexpected(text.error());
  return parse_maker_text(*text, path.string(), which);
}

}  // namespace kinemark::io
