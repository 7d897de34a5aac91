// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/markers/foreign_text.h"

#include <algorithm>
#include <array>
#include <vector>

#include "kinemark/core/number.h"

namespace kinemark::io {
namespace {

constexpr std::size_t kHead = 8192;
constexpr int kHeadLines = 24;

/// The first lines in small letters.
std::string head_of(std::string_view begin) {
  std::string out;
  int lines = 0;
  for (const char c : begin.substr(0, kHead)) {
    lines += c == '\n';
    if (lines == kHeadLines) break;
    out += c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  }
  return out;
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'); }

/// Words between anything that is no letter or digit.
std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> out;
  for (std::size_t at = 0; at < text.size();) {
    const auto first = std::find_if(text.begin() + static_cast<std::ptrdiff_t>(at), text.end(), is_letter);
    const auto last = std::find_if_not(first, text.end(), is_letter);
    if (first != last) out.emplace_back(first, last);
    at = static_cast<std::size_t>(last - text.begin());
  }
  return out;
}

/// Whether one of the lines is a row of numbers: a table, and no words about one.
bool has_row_of_numbers(std::string_view head) {
  while (!head.empty()) {
    const auto line = head.substr(0, head.find('\n'));
    head.remove_prefix(std::min(line.size() + 1, head.size()));
    std::size_t cells = 0;
    bool all = true;
    for (std::size_t at = 0; at <= line.size();) {
      const auto end = std::min(line.find_first_of(",;\t ", at), line.size());
      const auto cell = trim(line.substr(at, end - at));
      all = all && (cell.empty() || parse_number(cell));
      cells += cell.empty() ? 0 : 1;
      at = end + 1;
    }
    if (all && cells >= 2) return true;
  }
  return false;
}

/// Whether a line labels w, x, y and z, or four components of a quaternion.
bool labels_quaternions(std::string_view head) {
  const auto words = words_of(head.substr(0, head.find('\n')));
  const auto has = [&](std::string_view word) { return std::ranges::find(words, word) != words.end(); };
  const auto all = [&](const std::array<std::string_view, 4>& wanted) {
    return std::ranges::all_of(wanted, has);
  };
  return all({"w", "x", "y", "z"}) || all({"q0", "q1", "q2", "q3"}) || all({"qw", "qx", "qy", "qz"}) ||
         head.find("quat") != std::string_view::npos;
}

}  // namespace

std::string foreign_text(std::string_view begin) {
  if (begin.starts_with("PK\x03\x04"))
    return "it is a ZIP archive, as a workbook of Excel is: unpack it, or save its sheet as CSV";
  if (begin.starts_with("\x1F\x8B")) return "it is compressed by gzip: unpack it first";
  const std::string head = head_of(begin);
  if (head.starts_with("version https://git-lfs."))
    return "it is a pointer of Git LFS and not the file itself: 'git lfs pull' brings that";
  if (head.starts_with("<!doctype html") || head.starts_with("<html"))
    return "it is a web page, and not the file that its address was to give: download that again";
  const auto holds = [&](std::string_view word) { return head.find(word) != std::string::npos; };
  const auto words = words_of(head);
  const auto any_begins = [&](std::string_view part) {
    return std::ranges::any_of(words, [&](std::string_view word) { return word.starts_with(part); });
  };
  const bool is_table = has_row_of_numbers(head);
  if (head.starts_with("#kinovea") || holds("<kinovea") || (is_table && holds("kinovea")) ||
      (holds("trajectory") && (holds("/x") || holds("/0/"))))
    return "it holds paths that Kinovea followed in the image of one camera, and no positions in space";
  if (holds("<opensimdocument"))
    return "it is a model or a setup of OpenSim and no recording: a model is given by --model, a setup by "
           "--setup";
  if (holds("<mvnx"))
    return "it is an MVNX file of Xsens: export the recording as C3D, whose points are read, or its "
           "orientations as "
           "a table";
  if (head.starts_with("bioware"))
    return "it is a text of Kistler's BioWare, of forces alone: export them as C3D, which 'kinemark convert' "
           "and "
           "'analyze' read";
  if (!is_table) return {};
  if (labels_quaternions(head))
    return "it holds orientations of inertial sensors: 'kinemark ik --orientations' takes a table with the "
           "columns "
           "time, NAME_w, NAME_x, NAME_y and NAME_z of each";
  if (any_begins("acc") && (any_begins("gyr") || any_begins("mag")))
    return "it holds what an inertial sensor measured (accelerations, angular velocities), and no positions; "
           "'kinemark ik --orientations' takes orientations made of them";
  if (any_begins("emg")) return "it holds EMG; channels are read from C3D, MAT and NWB files";
  return {};
}

}  // namespace kinemark::io
