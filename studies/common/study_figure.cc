// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/common/study_figure.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>

#include "kinemark/core/check.h"

namespace kinemark::studies {
namespace {

// Lower case, with a hyphen for whatever is neither a letter nor a digit.
std::string hyphened(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const auto letter = static_cast<unsigned char>(c);
    if (std::isalnum(letter) != 0)
      out += static_cast<char>(std::tolower(letter));
    else if (!out.empty() && out.back() != '-')
      out += '-';
  }
  while (!out.empty() && out.back() == '-') out.pop_back();
  return out;
}

std::string with_unit(double value, const std::string& unit) {
  return unit.empty() || unit == "1" ? fmt::format("{:.3g}", value) : fmt::format("{:.3g} {}", value, unit);
}

}  // namespace

std::string StudyFigure::title() const {
  return number > 0 ? fmt::format("{}, figure {}", paper, number) : name;
}

std::string StudyFigure::caption() const {
  return number > 0 ? fmt::format("{}, figure {}: {}", paper, number, name) : name;
}

std::string StudyFigure::file_name() const {
  return hyphened(number > 0 ? title() : fmt::format("{} {}", paper, name));
}

FigureCurve curve_of(std::string name, std::initializer_list<Eigen::VectorXd> columns) {
  check(columns.size() > 0, "a curve has columns");
  FigureCurve out{std::move(name), Eigen::MatrixXd(columns.begin()->size(), columns.size())};
  Eigen::Index c = 0;
  for (const auto& column : columns) {
    check(column.size() == out.points.rows(), "columns of a curve are of one size");
    out.points.col(c++) = column;
  }
  return out;
}

FigureCurve curve_of(std::string name, const Eigen::Matrix3Xd& path) {
  return {std::move(name), path.transpose()};
}

std::vector<FigureNumber> numbers_of(const StudyTable& table,
                                     const std::vector<std::string_view>& quantities) {
  std::vector<FigureNumber> out;
  for (const auto quantity : quantities) {
    const auto row = std::ranges::find(table.rows, quantity, &StudyRow::quantity);
    check(row != table.rows.end(), "a figure's number is a row of the table");
    out.push_back({row->quantity, row->unit, row->paper, row->classic, row->ours});
  }
  return out;
}

std::string number_text(const FigureNumber& number, std::string_view classic) {
  std::string out = number.quantity;
  if (!out.empty()) out[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(out[0])));
  out += ": ";
  if (number.paper) out += fmt::format("{} in the paper, ", with_unit(*number.paper, number.unit));
  if (number.classic) out += fmt::format("{} ({}), ", with_unit(*number.classic, number.unit), classic);
  return out + with_unit(number.ours, number.unit) + " here.";
}

report::Figure figure_for_print(const StudyFigure& figure, std::string_view classic) {
  report::Figure out = figure.figure;
  out.title = figure.title();
  out.caption = figure.number > 0 ? figure.name : "";
  if (!out.caption.empty()) {
    out.caption[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(out.caption[0])));
    out.caption += '.';
  }
  for (const auto& number : figure.numbers) out.notes.push_back(number_text(number, classic));
  return out;
}

std::string figure_csv(const StudyFigure& figure) {
  std::string out = "curve,x,y,z\n";
  for (const auto& curve : figure.curves)
    for (Eigen::Index i = 0; i < curve.points.rows(); ++i) {
      out += curve.name.find(',') == std::string::npos ? curve.name : '"' + curve.name + '"';
      for (Eigen::Index c = 0; c < 3; ++c)
        out += c < curve.points.cols() ? fmt::format(",{:.9g}", curve.points(i, c)) : std::string(",");
      out += '\n';
    }
  return out;
}

}  // namespace kinemark::studies
