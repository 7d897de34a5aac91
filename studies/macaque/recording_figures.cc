// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/macaque/recording_figures.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinemark/pipeline/joints/limb_figure.h"
#include "kinemark/stages/report/figures/space_drawing.h"
#include "kinemark/stages/simulation/limb.h"
#include "kinemark/stages/simulation/sleeve_room.h"
#include "kinemark/stages/simulation/upsample.h"
#include "kinemark/workflow/joints/joints.h"
#include "studies/macaque/macaque_names.h"

namespace kinemark::studies {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using report::Anchor;
using simulation::LimbRecording;

constexpr double kMm = 1e3;
const std::string kInk = "#1a1a1a", kBody = "#9a9a9a", kSight = "#e8b4b4", kSkin = "#cfcfcf";

Vector3d at(const Array<double>& values, std::size_t index) {
  return Eigen::Map<const Vector3d>(values.data() + 3 * index);
}

Matrix3Xd ring(const Vector3d& centre, const Vector3d& a, const Vector3d& b) {
  constexpr int kCorners = 32;
  Matrix3Xd out(3, kCorners + 1);
  for (int i = 0; i <= kCorners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kCorners;
    out.col(i) = centre + std::cos(angle) * a + std::sin(angle) * b;
  }
  return out;
}

Matrix3Xd between(const Vector3d& a, const Vector3d& b) {
  Matrix3Xd out(3, 2);
  out << a, b;
  return out;
}

StudyFigure figure_of(int number, std::string name, report::SpaceDrawing scene, double height) {
  StudyFigure out{.paper = kMacaque, .number = number, .name = std::move(name)};
  report::FigurePanel panel;
  panel.height = height;
  panel.picture = [scene = std::move(scene)](report::Canvas& canvas, const report::CanvasRoom& room) {
    scene.draw(canvas, room);
  };
  out.figure.panels.push_back(std::move(panel));
  return out;
}

/// Shoulder, elbow, wrist.
Matrix3Xd arm_of(const LimbRecording& limb, std::int64_t frame) {
  const auto f = static_cast<std::size_t>(frame);
  Matrix3Xd out(3, 3);
  out << Vector3d::Zero(), at(limb.centre_in_world, f), at(limb.end_in_world, f);
  return out;
}

/// The frame whose wrist is farthest from the mouth: the hand at the food.
std::int64_t at_food(const LimbRecording& limb) {
  const Vector3d mouth = simulation::sleeve_room().mouth;
  std::int64_t out = 0;
  double far = -1.0;
  for (std::int64_t f = 0; f < limb.markers.frames(); ++f)
    if (const double d = (at(limb.end_in_world, static_cast<std::size_t>(f)) - mouth).norm(); d > far)
      far = d, out = f;
  return out;
}

void draw_body(report::SpaceDrawing& scene) {
  const auto room = simulation::sleeve_room();
  const report::SpaceLine thin{.colour = kBody, .width = 1.4};
  for (const auto& ball : {room.head, room.trunk}) {
    scene.line(ring(ball.centre, ball.radius_m * Vector3d::UnitY(), ball.radius_m * Vector3d::UnitZ()), thin);
    scene.line(ring(ball.centre, ball.radius_m * Vector3d::UnitX(), ball.radius_m * Vector3d::UnitZ()), thin);
  }
}

/// A lens as the tip of a small pyramid that opens towards the arm.
void draw_camera(report::SpaceDrawing& scene, const Vector3d& lens, const Vector3d& target) {
  constexpr double kDeep = 0.07, kHalf = 0.03;
  const Vector3d z = (target - lens).normalized(), x = z.cross(Vector3d::UnitZ()).normalized(),
                 y = z.cross(x);
  Matrix3Xd rim(3, 5);
  int corner = 0;
  for (const auto& [a, b] : {std::pair{-1.0, -1.0}, std::pair{1.0, -1.0}, std::pair{1.0, 1.0},
                             std::pair{-1.0, 1.0}, std::pair{-1.0, -1.0}})
    rim.col(corner++) = lens + kDeep * z + kHalf * (a * x + b * y);
  const report::SpaceLine ink{.colour = kInk, .width = 1.3};
  scene.line(rim, ink);
  for (int i = 0; i < 4; ++i) scene.line(between(rim.col(i), lens), ink);
}

void draw_leds(report::SpaceDrawing& scene, const LimbRecording& limb, std::int64_t frame, double radius) {
  for (std::size_t s = 0; s < limb.layout.segments.size(); ++s)
    for (const int m : limb.layout.segments[s].markers) {
      const bool seen = limb.markers.present(frame, m);
      scene.dot(kSegmentInks[s % 2], at(limb.x_true, limb.markers.index(frame, m)), radius, !seen);
    }
}

StudyFigure among_cameras(const LimbRecording& limb) {
  const auto room = simulation::sleeve_room();
  const auto frame = at_food(limb);
  const Matrix3Xd arm = arm_of(limb, frame);
  report::SpaceDrawing scene(-100.0, 25.0);
  for (const auto& camera : room.cameras) {
    scene.line(between(camera, arm.col(1)), {.colour = kSight, .width = 1.0, .dashed = true});
    draw_camera(scene, camera, arm.col(1));
  }
  draw_body(scene);
  scene.line(arm, {.colour = "#000000", .width = 3.0});
  draw_leds(scene, limb, frame, 3.0);
  for (std::size_t c = 0; c < room.cameras.size(); ++c) {
    const bool below = c == 3;  // another camera stands beside it
    scene.label(fmt::format("camera {}", c + 1), room.cameras[c], below ? Anchor::middle : Anchor::start,
                below ? Eigen::Vector2d(4.0, 34.0) : Eigen::Vector2d(26.0, 4.0));
  }
  scene.label("sleeve", arm.col(2), Anchor::middle, {4.0, 30.0});
  scene.label("head", room.head.centre, Anchor::end, {-22.0, 2.0});
  auto out = figure_of(1, "the animal with the sleeve of LEDs among the cameras", scene, 360.0);
  out.numbers = {{"frames a second of the cameras", "Hz", 60.0, {}, limb.markers.time.rate_hz}};
  Matrix3Xd lenses(3, static_cast<Eigen::Index>(room.cameras.size()));
  for (std::size_t c = 0; c < room.cameras.size(); ++c)
    lenses.col(static_cast<Eigen::Index>(c)) = room.cameras[c];
  out.curves = {curve_of("cameras, m", lenses), curve_of("arm, m", arm)};
  return out;
}

/// The stretched sleeve: both segments behind each other, upper arm first, and a marker's position on them.
StudyFigure sleeve(const LimbRecording& limb, double radius_m) {
  report::SpaceDrawing scene(0.0, 14.0);  // y to the right
  const auto stretched = [](const Vector3d& x, double from) { return Vector3d(x.x(), from + x.z(), x.y()); };
  const double upper = at(limb.centre_in_world, 0).norm(),
               fore = (at(limb.end_in_world, 0) - at(limb.centre_in_world, 0)).norm();
  const report::SpaceLine skin{.colour = kSkin, .width = 1.2};
  double from = 0.0;
  std::size_t s = 0;
  StudyFigure out;
  for (const double length : {upper, fore}) {
    for (const double share : {0.04, 0.35, 0.65, 0.96})
      scene.line(
          ring({0.0, from + share * length, 0.0}, radius_m * Vector3d::UnitX(), radius_m * Vector3d::UnitZ()),
          skin);
    for (const double z : {-radius_m, radius_m})
      scene.line(between({0.0, from + 0.04 * length, z}, {0.0, from + 0.96 * length, z}), skin);
    scene.line(between({0.0, from, 0.0}, {0.0, from + length, 0.0}), {.colour = "#000000", .width = 4.0});
    const auto& leds = limb.x_in_segment[s];
    Matrix3Xd shown(3, leds.cols());
    for (Eigen::Index k = 0; k < leds.cols(); ++k) {
      shown.col(k) = stretched(leds.col(k), from);
      scene.dot(kSegmentInks[s], shown.col(k), 6.0, shown.col(k).x() < -1e-9);
      scene.label(
          limb.markers
              .names[static_cast<std::size_t>(limb.layout.segments[s].markers[static_cast<std::size_t>(k)])],
          shown.col(k), Anchor::middle, {0.0, shown.col(k).z() >= 0.0 ? -11.0 : 21.0});
    }
    out.curves.push_back(curve_of(limb.layout.segments[s].name + ", m", shown));
    from += length;
    ++s;
  }
  for (const auto& [name, y] :
       {std::pair{"shoulder", 0.0}, std::pair{"elbow", upper}, std::pair{"wrist", upper + fore}})
    scene.label(name, {0.0, y, -1.9 * radius_m}, Anchor::middle, {0.0, 14.0});
  auto curves = std::move(out.curves);
  out = figure_of(2, "the sleeve and its LEDs; rings lie behind the arm", scene, 190.0);
  out.curves = std::move(curves);
  out.numbers = {{"LEDs on the sleeve", "1", 16.0, {}, static_cast<double>(limb.markers.markers())}};
  return out;
}

/// Some LEDs of both segments and their distances from the elbow in two postures.
StudyFigure distances(const LimbRecording& limb) {
  const std::int64_t food = at_food(limb);
  report::SpaceDrawing scene(52.0, 16.0);
  StudyFigure out;
  std::vector<std::pair<int, std::size_t>> chosen;  // marker, segment
  for (std::size_t s = 0; s < limb.layout.segments.size(); ++s) {
    const auto& markers = limb.layout.segments[s].markers;
    for (const double share : {0.15, 0.5, 0.85})
      chosen.emplace_back(markers[static_cast<std::size_t>(share * static_cast<double>(markers.size()))], s);
  }
  const Matrix3Xd arm = arm_of(limb, food);
  scene.line(arm, {.colour = "#000000", .width = 4.0});
  int k = 0;
  for (const auto& [marker, segment] : chosen) {
    const auto index = [&](std::int64_t f) { return limb.markers.index(f, marker); };
    VectorXd distance(limb.markers.frames());
    for (std::int64_t f = 0; f < limb.markers.frames(); ++f)
      distance[f] =
          kMm * (at(limb.x_true, index(f)) - at(limb.centre_in_world, static_cast<std::size_t>(f))).norm();
    const Vector3d x = at(limb.x_true, index(food));
    scene.line(between(arm.col(1), x), {.colour = kSegmentInks[segment], .width = 1.4, .dashed = true});
    scene.dot(kSegmentInks[segment], x, 5.5);
    const auto& name = limb.markers.names[static_cast<std::size_t>(marker)];
    const std::string said = fmt::format("{}: {:.0f} mm", name, distance.mean());
    if (segment == 0)
      scene.label(said, x, Anchor::start, {11.0, 4.0});
    else
      scene.label(said, x, Anchor::middle, {0.0, k % 2 == 0 ? -12.0 : 22.0});
    out.curves.push_back(
        curve_of(name + " to the elbow, mm",
                 {VectorXd::LinSpaced(distance.size(), 0.0,
                                      static_cast<double>(distance.size() - 1) / limb.markers.time.rate_hz),
                  distance}));
    ++k;
  }
  scene.dot(kInk, arm.col(1), 6.5);
  scene.label("elbow", arm.col(1), Anchor::start, {12.0, 14.0});
  scene.label("shoulder", arm.col(0), Anchor::end, {-10.0, 4.0});
  scene.label("wrist", arm.col(2), Anchor::end, {-10.0, 4.0});
  auto curves = std::move(out.curves);
  out = figure_of(3, "distances from a joint to the markers of its segments, which stay in every posture",
                  scene, 330.0);
  out.curves = std::move(curves);
  return out;
}

/// Spans in which each LED is seen, and the stream of one of them beside the cameras' samples.
Result<StudyFigure> stream(const LimbRecording& limb) {
  constexpr int kFactor = 4;
  const auto made = simulation::upsample(limb.markers, {.factor = kFactor});
  if (!made) return std::unexpected(made.error());
  StudyFigure out{.paper = kMacaque,
                  .number = 4,
                  .name = "LEDs that are seen, and the stream between the cameras' samples"};
  const auto& seen = limb.markers;
  report::FigurePanel lanes{.x_label = "time, s", .y_label = "LED", .tight = true, .height = 190.0};
  for (std::int64_t m = 0; m < seen.markers(); ++m) {
    VectorXd time(seen.frames()), lane = VectorXd::Constant(seen.frames(), std::nan(""));
    for (std::int64_t f = 0; f < seen.frames(); ++f) {
      time[f] = seen.time.time_s(f);
      if (seen.present(f, m)) lane[f] = static_cast<double>(m + 1);
    }
    lanes.lines.push_back(
        {.colour = kSegmentInks[m < seen.markers() / 2 ? 0 : 1], .x = time, .y = lane, .width = 5.0});
  }
  // The LED and half second with the most samples but for a gap in the middle.
  constexpr std::int64_t kShown = 30;
  std::int64_t marker = 0, first = 0, best = -1;
  for (std::int64_t m = 0; m < seen.markers(); ++m)
    for (std::int64_t f = 0; f + kShown < seen.frames(); f += 5) {
      std::int64_t here = 0, middle = 0;
      for (std::int64_t k = 0; k <= kShown; ++k) {
        here += seen.present(f + k, m);
        if (k >= kShown / 3 && k < 2 * kShown / 3) middle += seen.present(f + k, m);
      }
      const std::int64_t worth = middle < kShown / 3 && middle > 0 ? here : 0;
      if (worth > best) best = worth, marker = m, first = f;
    }
  const auto& name = seen.names[static_cast<std::size_t>(marker)];
  report::FigurePanel close{
      .x_label = "time, s", .y_label = fmt::format("{}, height, mm", name), .tight = true, .height = 150.0};
  VectorXd time(kFactor * kShown + 1), z = VectorXd::Constant(kFactor * kShown + 1, std::nan(""));
  for (std::int64_t k = 0; k <= kFactor * kShown; ++k) {
    const auto f = kFactor * first + k;
    time[k] = made->time.time_s(f);
    if (made->present(f, marker)) z[k] = kMm * made->x(f, marker).z();
    if (made->present(f, marker)) close.dots.emplace_back(time[k], z[k]);
  }
  const std::string ink = kSegmentInks[marker < seen.markers() / 2 ? 0 : 1];
  for (std::int64_t k = 0; k <= kShown; ++k)
    if (seen.present(first + k, marker))
      close.symbols.push_back({.shape = report::SymbolShape::disc,
                               .name = close.symbols.empty() ? "cameras, 60 Hz" : "",
                               .colour = ink,
                               .at = {seen.time.time_s(first + k), kMm * seen.x(first + k, marker).z()}});
  close.lines.push_back({.name = "stream, 240 Hz", .colour = kInk, .x = time, .y = z, .width = 1.0});
  out.figure.panels = {lanes, close};
  const double share =
      100.0 * (1.0 - static_cast<double>(seen.count_missing()) / static_cast<double>(seen.state.size()));
  out.figure.notes = {fmt::format("{:.0f} % of the samples are seen.", share)};
  out.numbers = {{"samples a second of the stream", "Hz", 240.0, {}, made->time.rate_hz}};
  out.curves = {curve_of(name + ", time s, height mm", {time, z})};
  return out;
}

}  // namespace

Result<std::vector<StudyFigure>> recording_figures(std::uint64_t seed) {
  const simulation::SleeveOptions options{.duration_s = kSleeveFigure_s, .seed = seed};
  const auto limb = simulation::simulate_sleeve(options);
  if (!limb) return std::unexpected(limb.error());
  std::vector<StudyFigure> out{among_cameras(*limb), sleeve(*limb, options.radius_m), distances(*limb)};
  auto recorded = stream(*limb);
  if (!recorded) return std::unexpected(recorded.error());
  out.push_back(std::move(*recorded));
  return out;
}

Result<StudyFigure> recorded_arm(std::uint64_t seed) {
  const auto limb = simulation::simulate_sleeve({.duration_s = kSleeveFigure_s, .tip = true, .seed = seed});
  if (!limb) return std::unexpected(limb.error());
  data::Recording recording;
  recording.trial.markers = limb->markers;
  recording.trial.markers.time.first_number = recording.trial.first_frame;  // as a file would count
  workflow::JointsOptions options;
  options.segments = limb->layout;
  const auto found = workflow::joints(recording, options);
  if (!found) return std::unexpected(found.error());
  auto picture = pipeline::limb_picture(found->used, found->skeleton, Vector3d::UnitZ());
  StudyFigure out{
      .paper = kMacaque, .number = 7, .name = "the arm from its recorded markers, in some postures"};
  out.figure = std::move(picture.figure);
  out.figure.title.clear();
  out.figure.notes.push_back(std::exchange(out.figure.caption, {}));
  const auto centres = workflow::centre_trajectories(found->skeleton);
  for (const auto f : picture.frames)
    for (std::int64_t c = 0; c < centres.markers(); ++c)
      out.curves.push_back(
          curve_of(fmt::format("{} of frame {}, m", centres.names[static_cast<std::size_t>(c)],
                               found->skeleton.time.number(f)),
                   Matrix3Xd(centres.x(f, c))));
  return out;
}

}  // namespace kinemark::studies
