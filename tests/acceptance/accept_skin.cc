// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Joint centres and axes under skin that follows the posture, on limbs of known bones: coverage, chi-square,
// error beside SCoRE's, and when the word is said. `accept_skeleton skin PART SUBJECTS SEED`; PART: limbs,
// rigid (no skin at all), word or all.
#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "kinemark/core/units.h"
#include "kinemark/stages/skeleton/articulated/articulated.h"
#include "kinemark/stages/skeleton/functional/functional.h"
#include "skin_limbs.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using namespace kinemark::skin_limbs;
using testing_support::print_note;
using testing_support::print_row;

/// Errors over stated standard deviations.
struct Tally {
  int subjects = 0, numbers = 0, in_1sd = 0, in_2sd = 0;
  double chi2 = 0.0, squares = 0.0, stated = 0.0, other_squares = 0.0;

  void add(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance, double other_squared = 0.0) {
    ++subjects;
    chi2 += error.dot(covariance.ldlt().solve(error)) / static_cast<double>(error.size());
    squares += error.squaredNorm();
    stated += covariance.trace();
    other_squares += other_squared;
    for (Eigen::Index i = 0; i < error.size(); ++i, ++numbers) {
      const double z = std::abs(error(i)) / std::sqrt(covariance(i, i));
      in_1sd += z < 1.0;
      in_2sd += z < 1.96;
    }
  }
  void add(const Tally& o) {
    subjects += o.subjects, numbers += o.numbers, in_1sd += o.in_1sd, in_2sd += o.in_2sd;
    chi2 += o.chi2, squares += o.squares, stated += o.stated, other_squares += o.other_squares;
  }
  [[nodiscard]] double one() const { return 100.0 * in_1sd / numbers; }
  [[nodiscard]] double two() const { return 100.0 * in_2sd / numbers; }
  [[nodiscard]] double chi() const { return chi2 / subjects; }
  [[nodiscard]] double rms() const { return std::sqrt(squares / subjects); }
  [[nodiscard]] double sd() const { return std::sqrt(stated / subjects); }
  [[nodiscard]] double beside() const { return std::sqrt(squares / other_squares); }
};

/// Bounds hold for a hundred subjects; with fewer they are wider by two standard errors of what a subject
/// adds.
double slack(const Tally& t) {
  return t.subjects >= 100 ? 0.0 : 2.0 / std::sqrt(static_cast<double>(t.subjects));
}

void coverage(const std::string& what, const Tally& t, double from1, double to1, double from2, double to2) {
  const double more = 35.0 * slack(t);
  print_row(t.one() >= from1 - more && t.one() <= to1 + more && t.two() >= from2 - 0.6 * more &&
                t.two() <= to2 + 0.6 * more,
            what + ": coverage",
            fmt::format("{:.0f} to {:.0f} and {:.0f} to {:.0f} %", from1, to1, from2, to2),
            fmt::format("{:.0f} and {:.0f} % of {} numbers; error {:.2f}, stated {:.2f}", t.one(), t.two(),
                        t.numbers, 1e3 * t.rms(), 1e3 * t.sd()));
}

void chi_square(const std::string& what, const Tally& t, double most) {
  print_row(t.chi() <= most * (1.0 + 2.0 * slack(t)), what + ": chi-square a degree of freedom",
            fmt::format("<= {:.1f}", most), fmt::format("{:.2f}, {} subjects", t.chi(), t.subjects));
}

void ratio(const std::string& what, const Tally& t, double most) {
  print_row(t.beside() <= most * (1.0 + 0.3 * slack(t)), what + ": error over SCoRE's",
            fmt::format("<= {:.2f}", most),
            fmt::format("{:.2f} ({:.1f} mm), {} subjects", t.beside(), 1e3 * t.rms(), t.subjects));
}

void scale(const std::string& what, const Tally& t, double least, double most) {
  const double by = t.sd() / t.rms();
  print_row(by >= least / (1.0 + slack(t)) && by <= most * (1.0 + slack(t)), what + ": stated over true",
            fmt::format("{:.1f} to {:.1f}", least, most),
            fmt::format("{:.2f} ({:.3f} mm)", by, 1e3 * t.rms()));
}

/// What a cell of subjects shows.
struct Cell {
  Tally place, axis, deforming;   ///< deforming: places of hinges where a fifth of the slides' energy deforms
  int stiff = 0, stiff_said = 0;  ///< hinges of which less deforms; those called prior-dominated
  int said = 0, none_said = 0;
};

Cell run(Case of, int subjects, std::uint64_t seed) {
  Cell out;
  const bool ball = is_ball(of.limb);
  for (int i = 0; i < subjects; ++i) {
    of.seed = seed + static_cast<std::uint64_t>(i);
    const Subject subject = make_subject(of);
    const auto kind = ball ? data::JointChoice::ball : data::JointChoice::hinge;
    const auto found =
        skeleton::fit_articulated(subject.markers, subject.layout, {.joint = kind}).value().skeleton;
    const auto score = skeleton::find_joints(subject.markers, subject.layout, {.kind = kind}).value();
    const Comparison c = compare(found, subject);
    out.place.add(c.error, c.covariance, compare(score, subject).error.squaredNorm());
    out.said += found.joints[0].skin.verdict == data::SkinVerdict::follows;
    out.none_said += found.joints[0].skin.verdict == data::SkinVerdict::none_seen;
    if (ball) continue;
    out.axis.add(1e-3 * kDegPerRad * c.tilt, 1e-6 * kDegPerRad * kDegPerRad * c.tilt_covariance);
    if (subject.deforming >= 0.2) {
      out.deforming.add(c.error, c.covariance);
    } else if (of.skin != Skin::none && of.skin != Skin::coloured) {
      ++out.stiff;
      out.stiff_said += found.joints[0].prior_dominated();
    }
  }
  return out;
}

std::string name_of(const Case& of) {
  return fmt::format("{}, {:.0f} deg, {}{}", to_string(of.limb), of.range_deg, to_string(of.skin),
                     of.skin == Skin::none ? "" : fmt::format(" {:.0f} mm", 1e3 * of.slide_m));
}

const std::vector<Skin> kSkins = {Skin::linear, Skin::curved, Skin::late, Skin::sheet};

/// Four kinds of skin on a limb, each and together.
void limb(Limb of, double range_deg, int subjects, std::uint64_t seed) {
  Tally place, axis, deforming;
  int stiff = 0, stiff_said = 0;
  const bool ball = is_ball(of);
  for (const Skin skin : kSkins) {
    const Case one{.limb = of, .skin = skin, .range_deg = range_deg};
    const Cell cell = run(one, subjects, seed);
    coverage(name_of(one), cell.place, 52, 90, 84, 100);
    chi_square(name_of(one), cell.place, ball ? 1.3 : 2.2);
    place.add(cell.place);
    axis.add(cell.axis);
    deforming.add(cell.deforming);
    stiff += cell.stiff;
    stiff_said += cell.stiff_said;
  }
  const std::string all = fmt::format("{}, {:.0f} deg, all skins", to_string(of), range_deg);
  coverage(all, place, 62, 85, 91, 99);
  ratio(all, place, ball ? 0.9 : 1.0);
  if (ball) return;
  coverage(all + ", the axis' direction (deg)", axis, 60, 90, 88, 100);
  if (deforming.subjects > 0)
    chi_square(all + ", the axis' place where a fifth of the slide deforms", deforming, 1.6);
  if (stiff > 0)
    print_row(stiff_said >= 0.9 * stiff - 1.0, all + ", the axis' place where less deforms",
              "called prior-dominated in >= 90 %", fmt::format("{} of {}", stiff_said, stiff));
}

/// What hardly deforms or turns as one body, reported as it is.
void limits(int subjects, std::uint64_t seed) {
  for (const Limb of : {Limb::hip, Limb::knee})
    for (const Skin skin : {Skin::rigid, Skin::plate}) {
      const Case one{.limb = of, .skin = skin, .range_deg = is_ball(of) ? 40.0 : 60.0};
      const Cell cell = run(one, subjects, seed);
      print_note(
          name_of(one),
          fmt::format("{:.0f} and {:.0f} % of {} numbers, chi-square {:.1f}, error {:.1f}, stated {:.1f} mm",
                      cell.place.one(), cell.place.two(), cell.place.numbers, cell.place.chi(),
                      1e3 * cell.place.rms(), 1e3 * cell.place.sd()));
    }
}

void without_skin(int subjects, std::uint64_t seed) {
  for (const Limb of : {Limb::hip, Limb::knee}) {
    const double range = is_ball(of) ? 40.0 : 60.0;
    const Case white{.limb = of, .skin = Skin::none, .range_deg = range};
    const Cell rigid = run(white, subjects, seed);
    coverage(name_of(white), rigid.place, 62, 78, 92, 99);
    scale(name_of(white), rigid.place, 0.7, 1.5);
    const Case ar{.limb = of, .skin = Skin::coloured, .slide_m = 0.003, .range_deg = range};
    const Cell coloured = run(ar, subjects, seed);
    coverage(name_of(ar), coloured.place, 60, 90, 90, 100);
    scale(name_of(ar), coloured.place, 0.7, 2.0);
  }
}

void small_arcs(int subjects, std::uint64_t seed) {
  for (const Limb of : {Limb::hip, Limb::knee}) {
    Tally place;
    for (const Skin skin : kSkins)
      place.add(run({.limb = of, .skin = skin, .slide_m = 0.005, .range_deg = 20.0}, subjects, seed).place);
    ratio(fmt::format("{}, 20 deg, all skins", to_string(of)), place, 1.15);
  }
}

// The word

data::SkinVerdict verdict_of(const Case& of) {
  const Subject subject = make_subject(of);
  const auto kind = is_ball(of.limb) ? data::JointChoice::ball : data::JointChoice::hinge;
  return skeleton::find_joints(subject.markers, subject.layout, {.kind = kind})
      .value()
      .joints[0]
      .skin.verdict;
}

void word(int subjects, std::uint64_t seed) {
  int empty = 0, false_ones = 0;
  for (const Limb of : {Limb::hip, Limb::knee})
    for (const double coloured_m : {0.0, 0.003})
      for (int i = 0; i < 5 * subjects / 4; ++i, ++empty)
        false_ones +=
            verdict_of({.limb = of,
                        .skin = coloured_m > 0.0 ? Skin::coloured : Skin::none,
                        .slide_m = coloured_m,
                        .range_deg = is_ball(of) ? 40.0 : 60.0,
                        .noise_m = 0.001,
                        .seed = seed + static_cast<std::uint64_t>(i)}) == data::SkinVerdict::follows;
  print_row(false_ones <= empty / 100, "the word \"skin\" on markers that do not slide", "<= 1 %",
            fmt::format("{} of {}", false_ones, empty));
  for (const double slide_m : {0.005, 0.002}) {
    int found = 0, all = 0;
    for (const Limb of : {Limb::hip, Limb::knee})
      for (const Skin skin : kSkins)
        for (int i = 0; i < std::max(subjects / 4, 1); ++i, ++all)
          found +=
              verdict_of({.limb = of,
                          .skin = skin,
                          .slide_m = slide_m,
                          .range_deg = is_ball(of) ? 40.0 : 60.0,
                          .noise_m = 0.001,
                          .seed = seed + 1000 + static_cast<std::uint64_t>(i)}) == data::SkinVerdict::follows;
    const double least = slide_m > 0.004 ? 95.0 : 65.0, share = 100.0 * found / all;
    print_row(share >= least - (all >= 200 ? 0.0 : 10.0),
              fmt::format("the word \"skin\", slides of {:.0f} mm", 1e3 * slide_m),
              fmt::format(">= {:.0f} %", least), fmt::format("{:.1f} % of {}", share, all));
  }
}

int run_check(int argc, char** argv) {
  const std::string part = argc > 1 ? argv[1] : "all";
  const int subjects = argc > 2 ? std::max(1, std::atoi(argv[2])) : 100;
  const auto seed = argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 1ULL;
  if (part == "rigid") {
    without_skin(subjects, seed);
    return testing_support::exit_status();
  }
  if (part != "word") {
    limb(Limb::hip, 40.0, subjects, seed);
    limb(Limb::knee, 60.0, subjects, seed);
    if (part == "all") limb(Limb::shoulder, 60.0, subjects, seed);
    if (part == "all") limb(Limb::elbow, 60.0, subjects, seed);
    without_skin(subjects, seed);
    small_arcs(std::max(subjects / 4, 1), seed);
    if (part == "all") limits(std::max(subjects / 2, 1), seed);
  }
  if (part != "limbs") word(subjects, seed);
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("skin", run_check);

}  // namespace
