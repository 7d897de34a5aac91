// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/subject_source.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "kinemark/core/random.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/workspace.h"
#include "kinemark/stages/simulation/internal/dropout.h"
#include "kinemark/stages/simulation/internal/motion.h"
#include "kinemark/stages/simulation/internal/streams.h"

namespace kinemark::simulation {
namespace {

constexpr int kLookedAt = 200;    // instants whose markers give the extent
constexpr double kLookAt_s = 60;  // of the beginning

/// One marker's gaps, drawn as time goes.
class Gaps {
 public:
  Gaps(const SubjectOptions& options, std::size_t marker)
      : random_(internal::stream(options.seed, internal::Draw::gaps, 1 + marker)), rate_hz_(options.rate_hz) {
    // Seen for 1 / begins_ - 1 frames in the mean, then lost for the mean length of a gap.
    const double share = options.dropout_random;
    begins_ = share / (internal::mean_gap_frames(rate_hz_) * (1.0 - share) + share);
  }
  /// Whether the marker is lost in the next frame.
  bool next() {
    if (left_ == 0 && begins_ > 0.0 && random_.uniform() < begins_)
      left_ = internal::draw_gap_frames(random_, rate_hz_);
    if (left_ == 0) return false;
    --left_;
    return true;
  }

 private:
  Random random_;
  double rate_hz_, begins_ = 0.0;
  std::int64_t left_ = 0;
};

}  // namespace

struct SubjectSource::Impl {
  Impl(std::shared_ptr<const model::Model> of, const SubjectOptions& asked)
      : model(std::move(of)), options(asked), motion(*model, options), w(*model) {
    for (std::size_t m = 0; m < model->description().markers.size(); ++m) {
      noise.push_back(internal::stream(options.seed, internal::Draw::noise, m));
      gaps.emplace_back(options, m);
    }
  }
  const Eigen::Matrix3Xd& markers_at(double time_s) {
    model::kinematics(*model, w, motion.state(time_s));
    return w.marker;
  }

  std::shared_ptr<const model::Model> model;
  SubjectOptions options;
  internal::Motion motion;
  model::Workspace w;
  std::vector<Random> noise;
  std::vector<Gaps> gaps;
  std::int64_t next = 0;
};

SubjectSource::SubjectSource(std::unique_ptr<Impl> impl, stream::SourceFacts facts)
    : Source(std::move(facts)), impl_(std::move(impl)) {}

SubjectSource::~SubjectSource() = default;

Result<std::unique_ptr<SubjectSource>> SubjectSource::create(std::shared_ptr<const model::Model> model,
                                                             const SubjectOptions& options,
                                                             stream::SourceFacts facts) {
  if (auto status = options.check(); !status) return std::unexpected(status.error());
  if (options.soft_tissue != 0.0 || options.dropout_sight != 0.0)
    return fail(Code::usage, "soft_tissue and dropout_sight need a whole recording; expected 0 for a stream");
  if (model->marker_count() == 0)
    return fail(Code::bad_input, "the model \"" + model->description().name +
                                     "\" has no markers; a simulated recording needs at least one");
  for (const auto& marker : model->description().markers) facts.markers.push_back(marker.name);
  facts.rate_hz = options.rate_hz;
  facts.t0_s = 0.0;
  facts.frames = options.frames();
  auto impl = std::make_unique<Impl>(std::move(model), options);
  for (int i = 0; i < kLookedAt; ++i) {
    const auto& x = impl->markers_at(std::min(kLookAt_s, options.duration_s) * i / kLookedAt);
    const Eigen::Vector3d low = x.rowwise().minCoeff(), high = x.rowwise().maxCoeff();
    if (!facts.extent_m) facts.extent_m = {low, high};
    (*facts.extent_m)[0] = (*facts.extent_m)[0].cwiseMin(low);
    (*facts.extent_m)[1] = (*facts.extent_m)[1].cwiseMax(high);
  }
  return std::unique_ptr<SubjectSource>(new SubjectSource(std::move(impl), std::move(facts)));
}

Result<bool> SubjectSource::next(stream::Frame& frame) {
  auto& s = *impl_;
  if (s.next == *facts().frames) return false;
  const std::size_t markers = facts().markers.size();
  frame.number = s.next;
  frame.time_s = static_cast<double>(s.next++) / facts().rate_hz;
  frame.clear(markers);
  const auto& x = s.markers_at(frame.time_s);
  for (std::size_t m = 0; m < markers; ++m) {
    Eigen::Vector3d error;
    for (int axis = 0; axis < 3; ++axis) error[axis] = s.options.noise_sd_m * s.noise[m].gaussian();
    if (s.gaps[m].next()) continue;
    Eigen::Map<Eigen::Vector3d>(frame.x_in_world.data() + 3 * m) =
        x.col(static_cast<Eigen::Index>(m)) + error;
    frame.state[m] = data::SampleState::measured;
  }
  return true;
}

}  // namespace kinemark::simulation
