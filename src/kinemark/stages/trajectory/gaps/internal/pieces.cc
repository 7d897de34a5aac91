// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/gaps/internal/pieces.h"

#include <algorithm>
#include <limits>

namespace kinemark::trajectory::internal {
namespace {

constexpr std::size_t kMarkersOfFrame = 3;
constexpr std::size_t kMaxPieces = 8;
constexpr Index kLeastFrames = 3;
constexpr double kWorse = 1.5;  // times the SD of the third most rigid neighbour, and
constexpr double kSlackM = 0.001;

/// SD of the third most rigid neighbour that is complete in [first, end); infinity when there are fewer.
double third_sd(const Recording& r, const std::vector<Neighbour>& neighbours, Index first, Index end) {
  std::size_t found = 0;
  for (const Neighbour& n : neighbours)
    if (r.complete(n.marker, first, end) && ++found == kMarkersOfFrame) return n.sd_m;
  return std::numeric_limits<double>::infinity();
}

bool worse(double sd, double than) { return sd > kWorse * than + kSlackM; }

}  // namespace

std::vector<GapSpan> split_gap(const Recording& r, const std::vector<Neighbour>& neighbours,
                               const GapSpan& gap) {
  const double whole = third_sd(r, neighbours, gap.first - gap.left, gap.end + gap.right);
  std::vector<GapSpan> pieces;
  Index first = gap.first;
  double worst_frame = 0.0;  // of the piece so far: what it could have at best
  double worst_of_all = 0.0;
  for (Index f = gap.first; f < gap.end; ++f) {
    const double here = third_sd(r, neighbours, f, f + 1);
    const Index from = first == gap.first ? gap.first - gap.left : first;
    const Index to = f + 1 == gap.end ? gap.end + gap.right : f + 1;
    const double next = std::max(worst_frame, here);
    if (f > first && worse(third_sd(r, neighbours, from, to), next)) {
      pieces.push_back({.marker = gap.marker, .first = first, .end = f});
      first = f;
      worst_frame = here;
    } else {
      worst_frame = next;
    }
    worst_of_all = std::max(worst_of_all, here);
  }
  pieces.push_back({.marker = gap.marker, .first = first, .end = gap.end});
  const bool short_piece =
      std::ranges::any_of(pieces, [](const GapSpan& p) { return p.end - p.first < kLeastFrames; });
  if (pieces.size() == 1 || pieces.size() > kMaxPieces || short_piece || !worse(whole, worst_of_all))
    return {gap};
  pieces.front().left = gap.left;
  pieces.back().right = gap.right;
  return pieces;
}

void join_pieces(std::span<Filled> pieces) {
  for (std::size_t k = 0; k + 1 < pieces.size(); ++k) {
    Combination& a = pieces[k].combination;
    Combination& b = pieces[k + 1].combination;
    const Index na = a.gap.rows();
    const Index nb = b.gap.rows();
    Eigen::RowVector3d step = Eigen::RowVector3d::Zero();  // that the path would make across the joint
    if (na > 1) step += 0.5 * (a.gap.row(na - 1) - a.gap.row(na - 2));
    if (nb > 1) step += 0.5 * (b.gap.row(1) - b.gap.row(0));
    const Eigen::RowVector3d miss = b.gap.row(0) - a.gap.row(na - 1) - step;
    const double va = a.sd_m(na - 1) * a.sd_m(na - 1);
    const double vb = b.sd_m(0) * b.sd_m(0);
    const double share = va + vb > 0.0 ? va / (va + vb) : 0.5;
    for (Index i = 0; i < na; ++i)
      a.gap.row(i) += share * static_cast<double>(i + 1) / static_cast<double>(na) * miss;
    for (Index i = 0; i < nb; ++i)
      b.gap.row(i) -= (1.0 - share) * static_cast<double>(nb - i) / static_cast<double>(nb) * miss;
  }
}

}  // namespace kinemark::trajectory::internal
