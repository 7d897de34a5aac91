// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Bands of a norm for many curves and measures, from tables.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/core/result.h"
#include "kinemark/data/gait_event.h"
#include "kinemark/io/text/tidy_csv.h"

namespace kinemark::pipeline {

/// The band of one curve over the cycle, at P points.
struct NormCurve {
  std::string name;                ///< as in the file: of a curve, a key, or a title
  std::optional<data::Side> side;  ///< that its row tells; none: of both
  std::string unit;                ///< of the values; empty: not told
  std::vector<double> at;          ///< P, per cent of the cycle, rising
  std::vector<double> low, high;   ///< P; NaN where the file has none of that meaning
  std::vector<double> mean;        ///< P; NaN where the file has none
  std::string meaning;             ///< what the ends are, for people: "mean +- 2 SD at each point"
  std::string source;              ///< who says so: column `source`, else the file's name
};

/// The band of one measure.
struct NormMeasure {
  std::string id;                  ///< "walking_speed"
  std::optional<data::Side> side;  ///< that its row tells; none: of both
  std::string unit;                ///< of the ends; empty: that of the measure
  double low = kNaN, high = kNaN;  ///< in the unit
  std::string source;              ///< as of a curve
};

/// All of some files.
struct GaitNorms {
  std::vector<NormCurve> curves;      ///< in the order of the files
  std::vector<NormMeasure> measures;  ///< in the order of the files
};

/// Read norms. A line is of a curve at a place (column `percent`; its name in `curve`, else in `group`, as
/// `kinemark groups band` writes it, else the file's stem) or, with a name in column `measure`, of a measure.
/// Ends are one_low and one_high; or low and high; or mean and sd, whose band is two deviations wide to each
/// side: of each line the first that it has. Columns `context` (Left, Right), `unit` and `source` may be
/// there. Lines whose ends are blank are passed over.
///
/// Code::bad_input, with file and line, for text where a number belongs, ends in the wrong order, a place of
/// a curve or a measure that comes twice, units of a curve that differ, a context that is no side, and a file
/// without a band; Code::io as io::read_tidy_csv().
[[nodiscard]] Result<GaitNorms> read_gait_norms(std::span<const std::filesystem::path> files);

/// The same of a table in memory.
[[nodiscard]] Result<GaitNorms> gait_norms_of(const io::TidyTable& table);

/// The norm of a curve: that which has its name, with or without its side, else that of the same angle where
/// both names say which way it counts. Null: none.
/// @param id  of the curve: "LKneeAngles x"
[[nodiscard]] const NormCurve* find_norm(const GaitNorms& norms, const std::string& id, data::Side side);

/// A band's ends and mean at a place, linear between its points; NaN beyond them.
struct NormAt {
  double low = kNaN;   ///< in the norm's unit
  double high = kNaN;  ///< in the norm's unit
  double mean = kNaN;  ///< in the norm's unit
};
[[nodiscard]] NormAt norm_at(const NormCurve& norm, double percent);  ///< Of a norm with a point at least.

}  // namespace kinemark::pipeline
