// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/poizner/rig_components.h"

#include <fmt/core.h>

#include <cmath>
#include <numbers>

#include "kinemark/stages/simulation/rig_recording.h"
#include "studies/poizner/poizner_names.h"

namespace kinemark::studies {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using report::Anchor;
using report::Canvas;
using report::CanvasRoom;
using Points = std::vector<Vector2d>;

constexpr double kHeight = 372.0, kArm = 250.0;  // of the picture; width of the arm's part
constexpr double kPosture_s = 0.2;               // of the sign
const std::string kInk = "#1a1a1a", kLed = "#c0392b", kLight = "#d98880", kBody = "#9a9a9a";

Matrix3Xd ring(const Vector3d& centre, const Vector3d& a, const Vector3d& b) {
  constexpr int kCorners = 36;
  Matrix3Xd out(3, kCorners + 1);
  for (int i = 0; i <= kCorners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kCorners;
    out.col(i) = centre + std::cos(angle) * a + std::sin(angle) * b;
  }
  return out;
}

struct Block {
  CanvasRoom room;
  std::vector<std::string> words;  // the first one bold
};

void draw_block(Canvas& canvas, const Block& block) {
  const auto& r = block.room;
  canvas.area(Points{{r.left, r.top}, {r.right, r.top}, {r.right, r.bottom}, {r.left, r.bottom}}, "#f3f5f8",
              1.0);
  canvas.line(
      Points{{r.left, r.top}, {r.right, r.top}, {r.right, r.bottom}, {r.left, r.bottom}, {r.left, r.top}},
      {.colour = kInk, .width = 1.2});
  constexpr double kLine = 14.0;
  double y = 0.5 * (r.top + r.bottom - kLine * static_cast<double>(block.words.size())) + 11.0;
  for (std::size_t i = 0; i < block.words.size(); ++i, y += kLine)
    canvas.text({0.5 * (r.left + r.right), y}, block.words[i],
                {.size = i == 0 ? 12.0 : 11.0, .anchor = Anchor::middle, .colour = kInk, .bold = i == 0});
}

void draw_arrow(Canvas& canvas, const Points& along) {
  canvas.line(along, {.colour = kInk, .width = 1.4});
  const Vector2d &tip = along.back(), &back = along[along.size() - 2];
  const Vector2d d = (tip - back).normalized(), n(-d.y(), d.x());
  canvas.area(Points{tip, tip - 8.0 * d + 3.5 * n, tip - 8.0 * d - 3.5 * n}, kInk, 1.0);
}

/// What the blocks say of this rig.
struct Words {
  std::string camera, sheet, amplifiers, converter, frames, leds;
};

Words words_of(const simulation::PhysicalRig& rig, const data::Counts& counts) {
  constexpr double kMm = 1e3, kUs = 1e6;
  const auto& nominal = rig.nominal;
  const auto cameras = nominal.camera_count();
  return {.camera = fmt::format("{:.0f} mm f/{:.3g}, at {:.0f} m", kMm * rig.light.focal_length_m,
                                rig.light.f_number, rig.light.distance_m),
          .sheet = fmt::format("{}, {:.1f} mm", to_string(nominal.cameras.front().detector.kind),
                               2.0 * kMm * nominal.cameras.front().detector.half_side_m),
          .amplifiers =
              fmt::format("{} channels, {:.0f} µs", 4 * cameras, kUs * nominal.electronics.time_constant_s),
          .converter = fmt::format("{} bit, {:.0f} µs a channel", nominal.electronics.bits,
                                   kUs * nominal.timing.conversion_s),
          .frames = fmt::format("{:g} frames a second", counts.time.rate_hz),
          .leds = fmt::format("{} of {} LEDs in turn", counts.led_count(), simulation::kMostLeds)};
}

/// Two columns: the cameras with the LEDs' control, and what becomes of their signals.
void draw_blocks(Canvas& canvas, const CanvasRoom& room, const Words& words,
                 const std::vector<std::string>& cameras, const Vector2d& hand, double below_arm) {
  const double left = room.left + kArm + 20.0, right = room.right - 4.0, gap = 34.0,
               width = 0.5 * (right - left - gap), second = left + width + gap, top = room.top + 6.0;
  const auto block = [&](double x, double y, double height, std::vector<std::string> text) {
    draw_block(canvas, {{.left = x, .right = x + width, .top = top + y, .bottom = top + y + height},
                        std::move(text)});
  };
  block(left, 0.0, 70.0, {fmt::format("Camera {}", cameras[0]), words.camera, words.sheet});
  block(left, 100.0, 70.0, {fmt::format("Camera {}", cameras[1]), words.camera, words.sheet});
  block(left, 280.0, 60.0, {"LED control", words.leds});
  block(second, 50.0, 70.0, {"Amplifiers", words.amplifiers});
  block(second, 150.0, 60.0, {"Multiplexer, A/D", words.converter});
  block(second, 240.0, 50.0, {"Computer", words.frames});
  block(second, 320.0, 46.0, {"Disk, 3-D graphics"});
  const double middle = second + 0.5 * width, edge = left + width;
  draw_arrow(canvas, {{edge, top + 35.0},
                      {edge + 0.5 * gap, top + 35.0},
                      {edge + 0.5 * gap, top + 70.0},
                      {second, top + 70.0}});
  draw_arrow(canvas, {{edge, top + 135.0},
                      {edge + 0.5 * gap, top + 135.0},
                      {edge + 0.5 * gap, top + 100.0},
                      {second, top + 100.0}});
  draw_arrow(canvas, {{middle, top + 120.0}, {middle, top + 150.0}});
  draw_arrow(canvas, {{middle, top + 210.0}, {middle, top + 240.0}});
  draw_arrow(canvas, {{middle, top + 290.0}, {middle, top + 320.0}});
  draw_arrow(canvas,
             {{second, top + 265.0}, {left + 0.5 * width, top + 265.0}, {left + 0.5 * width, top + 280.0}});
  draw_arrow(
      canvas,
      {{left, top + 322.0}, {room.left + 0.45 * kArm, top + 322.0}, {room.left + 0.45 * kArm, below_arm}});
  canvas.text({left - 14.0, top + 338.0}, "wires to the LEDs",
              {.size = 11.0, .anchor = Anchor::end, .colour = kInk});
  for (const double y : {35.0, 135.0})
    canvas.line(Points{hand, {left, top + y}}, {.colour = kLight, .width = 1.2, .dashed = true});
}

}  // namespace

Matrix3Xd upright(const Matrix3Xd& world) {
  Matrix3Xd out(3, world.cols());
  out << world.row(2), world.row(0), world.row(1);
  return out;
}

void draw_signer(report::SpaceDrawing& scene, const Vector3d& shoulder) {
  const report::SpaceLine thin{.colour = kBody, .width = 1.6};
  const Vector3d neck = shoulder + Vector3d(-0.185, 0.045, 0.0), head = neck + Vector3d(0.0, 0.165, 0.02);
  const auto add = [&](const Matrix3Xd& world) { scene.line(upright(world), thin); };
  add(ring(head, 0.075 * Vector3d::UnitX(), 0.105 * Vector3d::UnitY()));
  add(ring(head, 0.09 * Vector3d::UnitZ(), 0.105 * Vector3d::UnitY()));
  Matrix3Xd trunk(3, 7);
  const Vector3d other = neck + Vector3d(-0.185, -0.045, 0.0);
  trunk << neck, shoulder, neck + Vector3d(0.14, -0.30, 0.0), neck + Vector3d(0.15, -0.47, 0.0),
      neck + Vector3d(-0.15, -0.47, 0.0), neck + Vector3d(-0.14, -0.30, 0.0), other;
  add(trunk);
  Matrix3Xd yoke(3, 2), throat(3, 2);
  yoke << neck, other;
  throat << neck, neck + Vector3d(0.0, 0.06, 0.01);
  add(yoke);
  add(throat);
}

StudyFigure rig_components(const simulation::PhysicalRig& rig, const simulation::RigScene& scene,
                           const data::Counts& counts) {
  const auto leds = static_cast<int>(scene.leds.size());
  Matrix3Xd arm(3, leds);
  for (int led = 0; led < leds; ++led) arm.col(led) = scene.led(led, kPosture_s).x_in_world;
  report::SpaceDrawing drawn(-25.0, 8.0);
  draw_signer(drawn, arm.col(0));
  drawn.line(upright(arm), {.colour = kInk, .width = 4.0});
  for (int led = 0; led < leds; ++led) {
    const Vector3d at = upright(arm).col(led);
    drawn.dot(kLed, at, 6.0);
    // Shoulder and hand to the left, out of the light's way.
    const bool beside = led == 0 || led == 3;
    drawn.label(fmt::format("{} {}", led + 1, scene.leds[static_cast<std::size_t>(led)]), at,
                beside ? Anchor::end : Anchor::start, {beside ? -6.0 : 9.0, beside ? -10.0 : 18.0});
  }
  StudyFigure out{
      .paper = kPoizner, .number = 1, .name = "components of the system, and the LEDs on the arm"};
  report::FigurePanel panel;
  panel.height = kHeight;
  panel.picture = [drawn, words = words_of(rig, counts), cameras = counts.cameras,
                   hand = Vector3d(upright(arm).rightCols<1>())](Canvas& canvas, const CanvasRoom& room) {
    const CanvasRoom of_arm{
        .left = room.left - 10.0, .right = room.left + kArm, .top = room.top, .bottom = room.bottom - 60.0};
    drawn.draw(canvas, of_arm);
    draw_blocks(canvas, room, words, cameras, drawn.place(hand, of_arm), of_arm.bottom - 14.0);
  };
  out.figure.panels.push_back(std::move(panel));
  out.numbers = {{"LEDs that it can drive", "1", 8.0, {}, static_cast<double>(simulation::kMostLeds)},
                 {"bits of the converter", "1", 12.0, {}, static_cast<double>(rig.nominal.electronics.bits)}};
  out.curves.push_back(curve_of("LEDs on the arm, m", arm));
  return out;
}

}  // namespace kinemark::studies
