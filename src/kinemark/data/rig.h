// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A rig of cameras: all parameters of the map from a point in the laboratory to the output of the cameras.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/core/result.h"
#include "kinemark/math/se3.h"

namespace kinemark::data {

/// What a camera is made of.
enum class CameraKind : std::uint8_t {
  pinhole,         ///< image in pixels
  lateral_effect,  ///< position-sensitive detector: image in half-sides of the sheet, reported as four
                   ///< currents
};

/// How the sheet shares the photocurrent among its four electrodes.
enum class DetectorKind : std::uint8_t {
  tetra_lateral,  ///< one square sheet, an electrode along each edge
  duo_lateral,    ///< two sheets, a pair of electrodes each
  pin_cushion,    ///< one sheet shaped to be linear, electrodes at the corners
  generic,        ///< polynomials, when the physics is unknown
};

[[nodiscard]] std::string_view to_string(CameraKind kind);    ///< "pinhole", "lateral-effect"
[[nodiscard]] std::string_view to_string(DetectorKind kind);  ///< "tetra-lateral", ...
/// The kind of that name; Code::usage for any other, listing all names.
[[nodiscard]] Result<CameraKind> parse_camera_kind(std::string_view name);
/// The kind of that name; Code::usage for any other, listing all names.
[[nodiscard]] Result<DetectorKind> parse_detector_kind(std::string_view name);

/// Brown's lens distortion of the slopes x = X/Z, y = Y/Z: radial factor 1 + k1 r^2 + k2 r^4 + k3 r^6;
/// tangential 2 p1 x y + p2 (r^2 + 2 x^2) in x and p1 (r^2 + 2 y^2) + 2 p2 x y in y.
struct Distortion {
  double k1 = 0.0, k2 = 0.0, k3 = 0.0, p1 = 0.0, p2 = 0.0;  ///< dimensionless, of slopes
};

/// Number of monomials x^i y^j with lowest <= i + j <= highest; 0 when highest < lowest.
[[nodiscard]] int monomial_count(int lowest_degree, int highest_degree);

inline constexpr int kHighestDegree = 15;  ///< of warp and generic shares

/// Sheet and channels of a lateral-effect camera. Positions are in half-sides, x to the right, y down.
struct Detector {
  DetectorKind kind = DetectorKind::tetra_lateral;  ///< how the sheet shares its current
  double half_side_m = 5.08e-3;                     ///< > 0; half the length of the sheet's side
  double edge = 0.985;  ///< (0, 1]: spots farther out, in either axis, count as lying there
  /// Departure of the sheet from the ideal one: x += sum warp_x[n] B_n(x, y), likewise y; B_n the monomials
  /// x^(k-j) y^j, k from 2 to warp_degree, j from 0 to k. Empty below degree 2.
  int warp_degree = 0;
  std::vector<double> warp_x, warp_y;  ///< half-sides; monomial_count(2, warp_degree) each
  /// Channel k also receives crosstalk(j, k) times what electrode j does.
  Eigen::Matrix4d crosstalk = Eigen::Matrix4d::Zero();
  /// Generic shares: polynomials of degree 0 to generic_degree for +x, -x and +y, one after the other; -y has
  /// the rest of 1.
  int generic_degree = 0;
  std::vector<double> generic;                     ///< coefficients, half-sides in, share of the current out
  Eigen::Vector4d gain = Eigen::Vector4d::Ones();  ///< > 0, of channels +x, -x, +y, -y
  /// What a channel reads beside the LED's direct light: the electronics, and what the room returns of the
  /// light of an LED of light 1.
  Eigen::Vector4d offset_counts = Eigen::Vector4d::Zero();
  /// The part of the electronics: what a channel reads while no LED shines. NaN: not known. The rest of the
  /// offset, the stray light, grows with an LED's light; see camera::with_light().
  Eigen::Vector4d dark_counts = Eigen::Vector4d::Constant(kNaN);
  double dark_sd_counts = 0.0;  ///< >= 0; of each channel's dark counts
  /// Sum of the channels' counts by an LED of light 1 on the axis, facing the camera from 1 m. NaN: not
  /// known.
  double light_counts = kNaN;

  /// whether the electronics' part of the offset is known
  [[nodiscard]] bool knows_dark() const { return dark_counts.allFinite(); }
  /// size of warp_x and of warp_y
  [[nodiscard]] int warp_terms() const { return monomial_count(2, warp_degree); }
};

/// Look-up table of the grid method: the ratios that nodes of a plane grid, square to the axis, gave.
struct RatioTable {
  int nodes = 0;            ///< along each side; 0: there is no table
  double spacing_m = 0.0;   ///< between nodes
  double distance_m = 0.0;  ///< of the grid from the lens
  std::vector<double>
      uv;  ///< nodes x nodes x 2, x index first; node (i, j) at ((i, j) - (nodes - 1) / 2) spacing
};

/// One camera. Its axes are x right, y down, z forward; slopes X/Z, Y/Z go through distortion, then
/// image = principal_point + focal * (x, aspect * y), in half-sides of the detector or in pixels.
struct Camera {
  std::string name;                                           ///< unique in the rig
  CameraKind kind = CameraKind::lateral_effect;               ///< pinhole or lateral-effect
  math::SE3 cam_from_world;                                   ///< m
  double focal = 1.0;                                         ///< > 0, image units
  double aspect = 1.0;                                        ///< > 0
  Eigen::Vector2d principal_point = Eigen::Vector2d::Zero();  ///< half-sides or px
  Distortion distortion;                                      ///< of the lens
  Detector detector;                                          ///< lateral-effect only
  RatioTable table;                                           ///< lateral-effect only; for the classic method

  /// the lens in the world, m
  [[nodiscard]] Eigen::Vector3d centre_in_world() const { return cam_from_world.inverse().translation; }
};

/// Index of each calibrated parameter of a camera in Jacobians and in Rig::covariance. Values are the
/// fields of Camera, but for rotation: a small rotation vector (rad) applied after cam_from_world's, and
/// centre: a shift of the lens in the world (m).
struct ParameterLayout {
  /// Layout of a camera's parameters by its kind and the degrees of its detector.
  explicit ParameterLayout(const Camera& camera);
  static constexpr int rotation = 0;     ///< 3
  static constexpr int centre = 3;       ///< 3
  static constexpr int focal = 6;        ///< 1
  static constexpr int aspect = 7;       ///< 1
  static constexpr int principal = 8;    ///< 2
  static constexpr int distortion = 10;  ///< 5: k1 k2 k3 p1 p2
  static constexpr int warp_x = 15;      ///< warp_terms; here the pinhole camera ends
  int warp_terms = 0;                    ///< coefficients of the warp along one axis
  int warp_y = 15;                       ///< warp_terms
  int crosstalk = 15;                    ///< 12: off-diagonal terms, row by row
  int generic = 15;                      ///< size of Detector::generic
  int gain = 15;                         ///< 4
  int offset = 15;                       ///< 4
  int count = 15;                        ///< all parameters of the camera
};

/// Amplifiers and converter, the same for every channel.
struct Electronics {
  double time_constant_s =
      35e-6;                     ///< pole of the amplifier: a conversion sees the light of this much earlier
  double full_scale_a = 1.2e-6;  ///< photocurrent of code 2^bits
  int bits = 12;                 ///< 1 to 15
  double converter_noise_counts = 0.5;    ///< standard deviation of a conversion besides its rounding
  double interelectrode_ohm = 10e3;       ///< resistance of the sheet between opposite electrodes
  double amplifier_noise_v_rthz = 15e-9;  ///< voltage noise density of the amplifier, V per root hertz
  double feedback_ohm = 1e6;              ///< of the transimpedance amplifier
  double ambient_a = 5e-6;                ///< photocurrent of the room, steady, shared by four channels
  double temperature_k = 295.0;           ///< of resistors, for their thermal noise

  [[nodiscard]] double count_a() const;                               ///< photocurrent of one count, A
  [[nodiscard]] int highest_code() const { return (1 << bits) - 1; }  ///< 2^bits - 1
};

/// One LED after the other: on, settle, four conversions per camera, off.
struct SlotTiming {
  double settle_s = 320e-6;     ///< from switching an LED on to its first conversion
  double conversion_s = 48e-6;  ///< of one channel
  double off_s = 200e-6;        ///< from an LED's last conversion to the next LED
  bool dark_slot = false;       ///< a last slot of each frame without any LED

  /// length of one LED's slot, s
  [[nodiscard]] double slot_s(int cameras) const { return settle_s + 4 * cameras * conversion_s + off_s; }
  /// Frames per second that the slots of this many LEDs just fill.
  [[nodiscard]] double highest_rate_hz(int leds, int cameras) const {
    return 1.0 / ((leds + (dark_slot ? 1 : 0)) * slot_s(cameras));
  }
  /// Seconds from the frame's time to a conversion; led = number of LEDs: the dark slot.
  [[nodiscard]] double conversion_offset_s(int led, int camera, int channel, int cameras) const {
    return led * slot_s(cameras) + settle_s + (4 * camera + channel) * conversion_s;
  }
};

/// Cameras, electronics and timing of one installation: what a calibration file holds.
struct Rig {
  std::string id;      ///< links recordings to their rig; empty when unknown
  std::string method;  ///< how it was calibrated: "grid-lut", "bundle", "scan", "nominal", "simulated"
  std::vector<Camera> cameras;  ///< C, in the order of recordings
  Electronics electronics;      ///< of lateral-effect cameras
  SlotTiming timing;            ///< of LEDs lit in turn
  /// Joint covariance of all parameters of all cameras, one ParameterLayout after the other; rows of
  /// parameters that were held are 0. Empty when unknown.
  Eigen::MatrixXd covariance;
  double chi2_per_dof = 0.0;  ///< of the calibration; 0 when unknown

  [[nodiscard]] int camera_count() const { return static_cast<int>(cameras.size()); }  ///< C
  /// Parameters of all cameras, and those before camera c.
  [[nodiscard]] int parameter_count() const { return first_parameter(camera_count()); }
  /// Index of a camera's first parameter in the rows of `covariance`.
  [[nodiscard]] int first_parameter(int camera) const;

  /// Names are unique, rotations are rotations, numbers are finite and in range, shapes agree, covariance is
  /// symmetric with a diagonal that is not negative.
  [[nodiscard]] Status validate() const;
};

}  // namespace kinemark::data
