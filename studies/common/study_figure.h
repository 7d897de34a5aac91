// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A founding paper's figure from our own data: by the paper's number, with the numbers that it draws and
// those of the paper beside ours.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/stages/report/figures/figure.h"
#include "studies/common/study_table.h"

namespace kinemark::studies {

/// A number of the paper, by its own method on our data where there is one, and ours.
struct FigureNumber {
  std::string quantity, unit;  ///< in words; "mm", "1" for a plain number
  std::optional<double> paper, classic;
  double ours = 0.0;
};

/// What a figure draws, as numbers: one point a row, two or three columns, the units of the figure.
struct FigureCurve {
  std::string name;
  Eigen::MatrixXd points;
};

/// A figure of a study. Its own title and notes are made from what stands here.
struct StudyFigure {
  std::string paper;                  ///< "Poizner 1986"
  int number = 0;                     ///< of the paper's figure; 0: a figure that the paper does not have
  std::string name;                   ///< what it shows, in words
  report::Figure figure;              ///< panels, keys and notes
  std::vector<FigureNumber> numbers;  ///< under it
  std::vector<FigureCurve> curves;    ///< what it draws

  /// "Poizner 1986, figure 5"; without a number its name.
  [[nodiscard]] std::string title() const;
  /// "Poizner 1986, figure 5: the wheel in its best-fit plane".
  [[nodiscard]] std::string caption() const;
  /// "poizner-1986-figure-5"; without a number from its name.
  [[nodiscard]] std::string file_name() const;
};

/// A curve of a figure by its columns, all of one size.
[[nodiscard]] FigureCurve curve_of(std::string name, std::initializer_list<Eigen::VectorXd> columns);
/// A path in space: x, y, z.
[[nodiscard]] FigureCurve curve_of(std::string name, const Eigen::Matrix3Xd& path);

/// Rows of the table with these quantities, which must be there, as numbers under a figure.
[[nodiscard]] std::vector<FigureNumber> numbers_of(const StudyTable& table,
                                                   const std::vector<std::string_view>& quantities);

/// "Scatter of the diameter: 0.5 mm in the paper, 0.58 mm (1986 method), 0.17 mm here."
[[nodiscard]] std::string number_text(const FigureNumber& number, std::string_view classic);

/// The figure with its title, its name below it and the numbers as notes: what is written to a file.
[[nodiscard]] report::Figure figure_for_print(const StudyFigure& figure, std::string_view classic);

/// "curve,x,y,z" and a line a point, 9 digits; z is empty for curves of two columns. Names with a comma are
/// in quotes; none holds a quote.
[[nodiscard]] std::string figure_csv(const StudyFigure& figure);

}  // namespace kinemark::studies
