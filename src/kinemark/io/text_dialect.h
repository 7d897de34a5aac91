// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Texts as people save them, brought to the one form that the readers expect.
#pragma once

#include <string>
#include <string_view>

namespace kinemark::io {

/// The same text in UTF-8, with tabs or commas between cells, points in numbers, no quotes around numbers.
/// What is taken for what, by its first 64 KiB:
/// - UTF-16 by its byte-order mark, or by zeros in each second byte;
/// - `;` between cells where most lines hold one outside of quotes, two at least, and the first line that
///   holds `;` or commas holds more of the former; tabs are put there in TRC, MOT, STO and QTM files, else
///   commas, and quotes around text that holds a comma;
/// - decimal commas where rows of nothing but numbers, between tabs, blanks, `;` or in quotes, hold some and
///   no number with a point. Rows of vectors ("1,2,3") are no such rows;
/// - thousands, which are then written without: "1,234.5" in quotes or between tabs or `;`, "1.234,5", and
///   "1,234" or "1.234" where other numbers of the text have the other sign, or where a column of it goes on
///   from numbers such as 987; "1 234,5" with any blank and "1'234.5". What several signs contradict is left
///   for the reader to refuse;
/// - a minus of its own (U+2212) and the D of Fortran's exponents, in numbers;
/// - tabs where commas belong: exports of Vicon and Motive that went through a spreadsheet.
/// A text that needs none of it comes back as it is, at the cost of that look. O(bytes).
[[nodiscard]] std::string in_plain_dialect(std::string text);

/// Whether a text that begins like this is UTF-16, in which each second byte of most letters is zero.
[[nodiscard]] bool is_utf16(std::string_view begin);

}  // namespace kinemark::io
