// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Groups of curves from tables.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/measure.h"
#include "kinemark/io/text/tidy_csv.h"

namespace kinemark::pipeline {

/// Which columns of a table of one value a line say what. Tables of numbers alone need none of it: a curve a
/// row.
struct CurveColumns {
  std::string group;               ///< curves of one value here are a group; empty: those of a file are
  std::string subject;             ///< curves of one value here are averaged; empty: each stands for itself
  std::vector<std::string> curve;  ///< together they name a curve; empty: kCurveColumns, those that are there
  std::string at = "percent";      ///< where on the curve
  std::string value = "value";     ///< the curve
  std::vector<std::string> where;  ///< rows_where()
};

/// What tells curves apart unless columns are named.
inline constexpr std::string_view kCurveColumns[] = {"participant", "session", "file",  "trial", "subject",
                                                     "context",     "region",  "cycle", "curve"};

/// G groups of curves at P common points.
struct CurveGroups {
  std::vector<std::string> names;         ///< G, unique
  std::vector<data::CycleCurves> curves;  ///< G; values and unit are the file's
  std::vector<double> at;                 ///< P, where on the curve, rising
  std::string at_name;                    ///< of `at`: "percent", "point"
  std::string unit;                       ///< of the values; empty: not told
  std::vector<std::string> warnings;      ///< what was averaged or left out
};

/// Read groups of curves.
///
/// A table of numbers alone is a group whose rows are curves, as `savetxt` writes them. Of a table with names
/// each line is a value of a curve; a curve without a line at a point is missing there. With `subject`, the
/// curves of a subject in a group are averaged at each point over those that are there, so that a person who
/// walked more often counts no more.
///
/// Code::bad_input, with file and line, for columns that are not there, text where a number belongs, two
/// values of a curve at one point, curves of different numbers of points and values of different units;
/// Code::usage as rows_where() and for options of columns with tables of numbers alone.
[[nodiscard]] Result<CurveGroups> read_curve_groups(const std::vector<std::filesystem::path>& files,
                                                    const CurveColumns& columns);

/// The same from tables in memory.
[[nodiscard]] Result<CurveGroups> make_curve_groups(const std::vector<io::TidyTable>& tables,
                                                    const CurveColumns& columns);

/// Curves of two groups that bear the same names, in the same order; the others are left out, which is a
/// warning. Curves of tables of numbers alone go by their row. Code::bad_input unless there are two groups.
[[nodiscard]] Status pair_curves(CurveGroups& groups);

}  // namespace kinemark::pipeline
