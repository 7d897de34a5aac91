// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// One marker's recording, smoothed, and the measures of its stretches.
#pragma once

#include <cstdint>
#include <expected>
#include <span>
#include <string>
#include <vector>

#include "kinemark/data/measure.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/analysis/path/internal/velocity_jumps.h"
#include "kinemark/stages/analysis/path/path_facts.h"
#include "kinemark/stages/analysis/path/path_measures.h"
#include "kinemark/stages/analysis/path/path_noise.h"
#include "kinemark/stages/analysis/path/path_rhythm.h"
#include "kinemark/stages/analysis/path/refits.h"
#include "kinemark/stages/analysis/path/stated_measure.h"

namespace kinemark::analysis {

namespace internal {
struct MovementEnds;
struct RefitValues;
}  // namespace internal

/// Samples of a marker that were measured, from which a smoother can be chosen.
inline constexpr std::int64_t kLeastSamples = 30;

/// Why a marker is not measured.
enum class NotMeasuredWhy : std::uint8_t {
  made_samples,     ///< the recorder made as many samples as it measured, or more
  too_few_samples,  ///< less than a smoother can be chosen by
  unknown_noise,    ///< neither found nor stated
  too_slow,         ///< a frame rate below what movement needs
  no_smoother,      ///< none fits the samples
};

/// A marker that is not measured.
struct NotMeasured {
  std::string subject;                                   ///< marker
  NotMeasuredWhy why = NotMeasuredWhy::too_few_samples;  ///< what is lacking
  std::int64_t samples = 0;                              ///< that were measured
  double rate_hz = 0.0;                                  ///< of the recording
};

/// Sentences on markers that are not measured, those that lack the same together: most recordings of models
/// have points by the dozen without a sample.
[[nodiscard]] std::vector<std::string> not_measured_sentences(std::span<const NotMeasured> markers);

/// A marker from its first to its last measured sample. Failures are sentences for people, which the caller
/// puts beside the measures of others.
class MeasuredPath {
 public:
  /// Fails where too few samples were measured or no smoother fits them.
  [[nodiscard]] static std::expected<MeasuredPath, NotMeasured> create(const data::Trajectories& markers,
                                                                       std::int64_t marker,
                                                                       const PathMeasureOptions& options);

  /// The measures of a stretch, in the order of path_definitions(). Fails where the stretch is too short.
  /// @param curves  what they are taken of, where not null
  [[nodiscard]] std::expected<std::vector<data::Measure>, std::string> measure(
      const data::Region& region, PathCurves* curves = nullptr) const;

  /// What repeats in a stretch, and when. Fails where the stretch is too short.
  [[nodiscard]] std::expected<PathRhythm, std::string> rhythm(const data::Region& region) const;

  [[nodiscard]] const std::string& name() const { return name_; }  ///< of the marker
  [[nodiscard]] const PathNoise& noise() const { return noise_; }  ///< of its samples

 private:
  struct Stretch {
    std::int64_t first = 0, count = 0;  // in the recording
    double share_not_measured = 0.0;    // of the samples
    double longest_gap_s = 0.0;         // in it
  };
  // A part of the recording, from its sample `first` on.
  struct Neighbourhood {
    std::int64_t first = 0;
    Recording recording;
  };
  [[nodiscard]] PathCurves curves_of(const PathSamples& path, const PathFrame& frame, const Stretch& stretch,
                                     const CurveSpread& spread) const;

  [[nodiscard]] Stretch stretch_of(const data::Region& region) const;
  [[nodiscard]] Neighbourhood around(const Stretch& stretch) const;
  void refit(const Stretch& stretch, const Neighbourhood& near, const SeriesMatrix& pilot,
             const PathFrame& frame, internal::RefitValues& refits, CurveSpread* spread) const;
  [[nodiscard]] internal::MovementEnds ends_of(const Stretch& stretch, const PathSamples& path) const;
  void put_jumps(const Stretch& stretch, const PathSamples& path, const internal::MovementEnds& ends,
                 StretchSummary& summary) const;
  // Times the noise by which the stretch moves about its slow trend at most; 0: by more.
  [[nodiscard]] double below_noise(const Stretch& stretch) const;
  [[nodiscard]] double excess_about_mean(const Stretch& stretch, double seconds) const;
  [[nodiscard]] StretchSummary summary_of(const Stretch& stretch, const PathFrame& frame,
                                          bool intervals) const;

  std::string name_;
  PathNoise noise_;
  std::int64_t marker_ = 0;
  double first_s_ = 0.0;           // time of the first measured sample
  std::int64_t first_number_ = 0;  // of its frame, in the file
  PathMeasureOptions options_;
  Recording recording_;
  std::vector<internal::VelocityJump> jumps_;  // in the recording
  SeriesMatrix less_, least_;  // smoothed by kLessSmooth, kLeastSmooth; the latter for intervals alone
};

}  // namespace kinemark::analysis
