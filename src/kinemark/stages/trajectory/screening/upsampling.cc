// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/screening/upsampling.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "kinemark/math/statistics.h"
#include "kinemark/stages/trajectory/screening/band_check.h"
#include "kinemark/stages/trajectory/screening/internal/phase_table.h"

namespace kinemark::trajectory {
namespace {

using data::BandVerdict;
using data::InterpolationKernel;

using internal::Candidate;
using internal::PhaseTable;
using internal::Piece;

constexpr std::int64_t kEnoughBlocks = 6;  // informative ones, for a verdict of a marker's own

/// Candidates of one stream: all that fire, and the closest of the others.
struct Contest {
  std::vector<Candidate> constant;  ///< fire with one phase
  std::vector<Candidate> slipping;  ///< fire only with changing phases
  Candidate closest;
  std::int64_t most_blocks = 0;

  void enter(const Candidate& c) {
    most_blocks = std::max(most_blocks, c.blocks);
    if (c.fires)
      (c.slips ? slipping : constant).push_back(c);
    else if (c.kernel != InterpolationKernel::none && c.ratio < closest.ratio)
      closest = c;
  }

  /// A true factor makes its divisors fire too, but not as well where it has a kernel that fits: the largest
  /// factor that comes near the best, then the kernel that fits best.
  [[nodiscard]] Candidate winner() const {
    const std::vector<Candidate>& all = constant.empty() ? slipping : constant;
    if (all.empty()) {
      Candidate none = closest;
      none.factor = 1;
      none.phase = 0;
      none.kernel = InterpolationKernel::none;
      none.blocks = most_blocks;
      return none;
    }
    const double best = std::ranges::min_element(all, {}, &Candidate::ratio)->ratio;
    const Candidate* winner = nullptr;
    for (const Candidate& c : all) {
      if (c.ratio > std::max(2.0 * best, 0.25) && c.above_rounding() >= 4.0) continue;
      if (winner == nullptr || c.factor > winner->factor ||
          (c.factor == winner->factor && c.ratio < winner->ratio))
        winner = &c;
    }
    return *winner;
  }
};

/// Where between two blocks the phase changes: the border that leaves least unexplained.
void place_changes(const std::vector<Piece>& pieces, const Candidate& c, std::vector<data::PhaseRun>& runs) {
  const std::int64_t reach = 32 * c.factor;
  internal::Knots knots;
  for (std::size_t r = 1; r < runs.size(); ++r) {
    const std::int64_t low = std::max(runs[r].first_frame - reach, r == 1 ? 0 : runs[r - 1].first_frame + 1);
    const std::int64_t high = runs[r].first_frame + reach;
    std::vector<double> gain(static_cast<std::size_t>(high - low), 0.0);  // of the new phase, per frame
    for (const Piece& piece : pieces) {
      const auto n = static_cast<std::int64_t>(piece.y.size());
      if (piece.first_frame >= high || piece.first_frame + n <= low) continue;
      std::vector<double> residual(piece.y.size());
      for (const int sign : {1, -1}) {
        const int phase = sign > 0 ? runs[r - 1].phase : runs[r].phase;
        const auto shift = static_cast<int>(piece.first_frame % c.factor);
        internal::residuals(piece.y, c.factor, (phase - shift + c.factor) % c.factor, c.kernel, knots,
                            residual);
        for (std::int64_t f = std::max(low, piece.first_frame); f < std::min(high, piece.first_frame + n);
             ++f) {
          const double e = residual[static_cast<std::size_t>(f - piece.first_frame)];
          if (e != internal::kNotPredicted) gain[static_cast<std::size_t>(f - low)] += sign * e * e;
        }
      }
    }
    double sum = 0.0;
    double least = 0.0;
    std::int64_t border = low;
    for (std::size_t i = 0; i < gain.size(); ++i) {
      sum += gain[i];
      if (sum < least) {
        least = sum;
        border = low + static_cast<std::int64_t>(i) + 1;
      }
    }
    runs[r].first_frame = border;
  }
}

data::Upsampling describe(const Candidate& c) {
  data::Upsampling u;
  u.factor = c.factor;
  u.phase = c.phase;
  u.kernel = c.kernel;
  u.ratio = c.ratio;
  u.agreement = c.agreement;
  u.blocks = c.blocks;
  u.residual_m = c.residual_m;
  u.rounding_m = c.rounding_m;
  u.runs = {{.first_frame = 0, .phase = c.phase}};
  return u;
}

/// Follow the phase of a found stream through all its frames; `first` to `last` are its markers.
data::Upsampling trace(const data::Trajectories& t, const Candidate& c, std::int64_t first,
                       std::int64_t last) {
  data::Upsampling u = describe(c);
  if (c.factor == 1) return u;
  PhaseTable table{.factor = c.factor};
  internal::Knots knots;
  for (std::int64_t m = first; m < last; ++m)
    for (const Piece& piece : internal::pieces_of(t, m, 0)) internal::add_rows(piece, c.kernel, knots, table);
  u.runs = internal::follow_phase(table);
  if (u.runs.size() == 1) return u;
  std::vector<Piece> pieces;  // of a few markers: enough to place a border
  for (std::int64_t m = first; m < std::min(last, first + 8); ++m)
    for (Piece& piece : internal::pieces_of(t, m, 0)) pieces.push_back(std::move(piece));
  place_changes(pieces, c, u.runs);
  return u;
}

/// Multiplexed markers have one factor and a phase each, which no pooled test can see: the recording then
/// takes the factor that all markers with enough evidence share, and the phase that most of them have.
void agree_on_factor(data::UpsamplingAccount& report) {
  const data::Upsampling* model = nullptr;
  std::vector<std::int64_t> share(13, 0);  // markers per phase
  for (const data::Upsampling& u : report.markers) {
    if (!u.found() && u.blocks < kEnoughBlocks) continue;
    if (!u.found() || (model != nullptr && u.factor != model->factor)) return;
    ++share[static_cast<std::size_t>(u.phase)];
    if (model == nullptr) model = &u;
  }
  if (model == nullptr || model->factor == report.recording.factor) return;
  const int phase = static_cast<int>(std::ranges::max_element(share) - share.begin());
  const auto typical = std::ranges::find_if(
      report.markers, [&](const data::Upsampling& u) { return u.found() && u.phase == phase; });
  report.recording = *typical;
}

std::string sentence_of(const data::Upsampling& u, double rate_hz) {
  if (u.blocks == 0)
    return "Interpolation from a lower rate cannot be looked for: no block tells phases apart.";
  if (!u.found())
    return fmt::format(
        "No interpolation from a lower rate was found in {} blocks: the best supposed phase leaves {:.2f} of "
        "what the next best leaves and wins {:.0f} % of those that tell.",
        u.blocks, u.ratio, 100.0 * u.agreement);
  const std::string slips =
      u.runs.size() > 1 ? fmt::format(" The phase changes {} times.", u.runs.size() - 1) : std::string();
  return fmt::format(
      "Made from {:.6g} Hz by {} interpolation, factor {}: real samples are the frames n with n mod {} = {} "
      "(counted from "
      "0); the others follow from them within {:.4f} mm (rounding alone {:.4f} mm), {:.3f} of what any other "
      "phase "
      "leaves, in {:.0f} % of {} blocks.{}",
      rate_hz / u.factor, to_string(u.kernel), u.factor, u.factor, u.phase, 1e3 * u.residual_m,
      1e3 * u.rounding_m, u.ratio, 100.0 * u.agreement, u.blocks, slips);
}

data::BandCheck middle_of(std::vector<data::BandCheck> bands) {
  std::erase_if(bands, [](const data::BandCheck& b) { return b.verdict == BandVerdict::unknown; });
  if (bands.empty()) return {};
  const auto middle = [&](auto member) {
    std::vector<double> values;
    for (const data::BandCheck& b : bands) values.push_back(b.*member);
    return math::upper_median(values);
  };
  data::BandCheck b;
  b.top_m = middle(&data::BandCheck::top_m);
  b.middle_m = middle(&data::BandCheck::middle_m);
  b.edge_hz = middle(&data::BandCheck::edge_hz);
  for (const BandVerdict verdict : {BandVerdict::undecided, BandVerdict::low_passed, BandVerdict::open})
    if (2 * std::ranges::count(bands, verdict, &data::BandCheck::verdict) >=
        static_cast<std::ptrdiff_t>(bands.size()))
      b.verdict = verdict;
  if (b.verdict == BandVerdict::unknown) b.verdict = BandVerdict::undecided;
  return b;
}

void write_sentences(const data::Trajectories& t, data::UpsamplingAccount& report) {
  const double rate_hz = t.time.rate_hz;
  report.sentences.push_back(sentence_of(report.recording, rate_hz));
  for (std::size_t m = 0; m < report.markers.size(); ++m) {
    const data::Upsampling& u = report.markers[m];
    const bool as_recording = u.factor == report.recording.factor && u.phase == report.recording.phase;
    if (!as_recording && (u.found() || report.recording.found()))
      report.sentences.push_back(fmt::format("Marker '{}': {}", t.names[m], sentence_of(u, rate_hz)));
  }
  const data::BandCheck& b = report.band;
  if (b.verdict != BandVerdict::unknown)
    report.sentences.push_back(fmt::format(
        "Spectrum: {}; noise of {:.4f} mm near half the rate, {:.4f} mm in the middle of the band{}.",
        to_string(b.verdict), 1e3 * b.top_m, 1e3 * b.middle_m,
        b.edge_hz > 0.0 ? fmt::format(", content up to {:.3g} Hz", b.edge_hz) : std::string()));
  report.sentences.emplace_back(
      "Not visible to this test: interpolation followed by a low-pass filter, band-limited resampling, "
      "factors that are "
      "no integer, and streams without noise above their rounding. Only the spectrum shows the first "
      "two.");
}

}  // namespace

Status UpsamplingOptions::check() const {
  if (max_factor < 2 || max_factor > 12)
    return fail(Code::usage, fmt::format("the largest upsampling factor is {}; need 2 to 12", max_factor));
  if (max_frames < 1000)
    return fail(Code::usage,
                fmt::format("the upsampling detector may use {} frames; need 1000 or more", max_frames));
  return {};
}

Result<data::UpsamplingAccount> detect_upsampling(const data::Trajectories& t,
                                                  const UpsamplingOptions& options) {
  if (const Status s = options.check(); !s) return std::unexpected(s.error());
  if (const Status s = t.validate(); !s) return std::unexpected(s.error());
  const auto markers = static_cast<std::size_t>(t.markers());
  std::vector<std::vector<Piece>> pieces(markers);
  for (std::size_t m = 0; m < markers; ++m)
    pieces[m] = internal::pieces_of(t, static_cast<std::int64_t>(m), options.max_frames);

  std::vector<Contest> contests(markers);
  Contest all;
  internal::Knots knots;
  for (int f = 2; f <= options.max_factor; ++f) {
    for (const InterpolationKernel kernel : internal::kKernels) {
      PhaseTable pooled{.factor = f};
      for (std::size_t m = 0; m < markers; ++m) {
        PhaseTable table{.factor = f};
        for (const Piece& piece : pieces[m]) internal::add_rows(piece, kernel, knots, table);
        contests[m].enter(internal::judge(table, kernel));
        pooled.append(table);
      }
      all.enter(internal::judge(pooled, kernel));
    }
  }

  data::UpsamplingAccount report{.looked = true};
  report.recording = trace(t, all.winner(), 0, t.markers());
  for (std::size_t m = 0; m < markers; ++m) {
    const auto marker = static_cast<std::int64_t>(m);
    report.markers.push_back(trace(t, contests[m].winner(), marker, marker + 1));
    report.marker_bands.push_back(check_band(t, marker));
  }
  const int pooled_factor = report.recording.factor;
  agree_on_factor(report);
  if (report.recording.found() && report.recording.factor == pooled_factor) {
    for (data::Upsampling& u : report.markers) {
      if (u.found() || u.blocks >= kEnoughBlocks) continue;
      u = report.recording;
      u.inherited = true;
    }
  }
  report.band = middle_of(report.marker_bands);
  write_sentences(t, report);
  return report;
}

}  // namespace kinemark::trajectory
