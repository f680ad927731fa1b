#include "morphbake/preview/studio.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "morphbake/images/srgb.h"

namespace morphbake {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kRoughness = 0.42f;     ///< satin: shows form, hides no colour
constexpr float kFacingMirror = 0.04f;  ///< reflectance of any dielectric, glTF 2.0, B.2.3

/// Degrees to the camera's right and upwards, as a unit vector.
Eigen::Vector3f towards(float azimuth, float elevation) {
  const float a = azimuth * kPi / 180, e = elevation * kPi / 180;
  return {std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e)};
}

/// Real spherical harmonics to band 2 (Ramamoorthi, Hanrahan 2001).
Eigen::Matrix<float, 9, 1> harmonics(const Eigen::Vector3f& d) {
  Eigen::Matrix<float, 9, 1> y;
  y << 0.282095f, 0.488603f * d.y(), 0.488603f * d.z(), 0.488603f * d.x(),
      1.092548f * d.x() * d.y(), 1.092548f * d.y() * d.z(), 0.315392f * (3 * d.z() * d.z() - 1),
      1.092548f * d.x() * d.z(), 0.546274f * (d.x() * d.x() - d.y() * d.y());
  return y;
}

/// The room's light projected on the harmonics and blurred by the cosine: irradiance over pi.
Eigen::Matrix<float, 9, 3> room_harmonics() {
  constexpr int kDirections = 20000;
  Eigen::Matrix<double, 9, 3> sum = Eigen::Matrix<double, 9, 3>::Zero();
  for (int i = 0; i < kDirections; ++i) {  // Fibonacci lattice on the sphere
    const double y = 1 - (2 * i + 1.0) / kDirections;
    const double angle = 2 * std::numbers::pi * std::fmod(i * 0.6180339887498949, 1.0);
    const double side = std::sqrt(1 - y * y);
    const Eigen::Vector3f d =
        Eigen::Vector3d(side * std::cos(angle), y, side * std::sin(angle)).cast<float>();
    sum += (harmonics(d) * room_radiance(d).matrix().transpose()).cast<double>();
  }
  sum *= 4 * std::numbers::pi / kDirections;
  sum.middleRows<3>(1) *= 2.0 / 3;
  sum.bottomRows<5>() *= 0.25;
  return sum.cast<float>();
}

float facing(const Eigen::Vector3f& direction, const Eigen::Vector3f& light) {
  return std::max(direction.dot(light), 0.0f);
}

}  // namespace

Studio make_studio(const TurntableOptions& options) {
  Studio studio;
  studio.key_direction = towards(-42, 48);
  studio.key_radius = 0.26f;
  studio.key_across =
      Eigen::Vector3f::UnitY().cross(studio.key_direction).normalized() * studio.key_radius;
  studio.key_upward = studio.key_direction.cross(studio.key_across);
  studio.key_light = Eigen::Array3f(1.0f, 0.965f, 0.915f) * 0.80f;
  studio.room = room_harmonics();
  for (std::size_t k = 0; k < 3; ++k) {
    studio.backdrop[static_cast<int>(k)] =
        srgb_to_linear(static_cast<float>(options.background[k]));
  }
  return studio;
}

Eigen::Array3f room_radiance(const Eigen::Vector3f& direction) {
  static const Eigen::Vector3f fill = towards(60, 15);
  static const Eigen::Vector3f rim = towards(155, 30);
  const float upward = std::max(direction.y(), 0.0f);
  const float downward = std::max(-direction.y(), 0.0f);
  const float f = facing(direction, fill), r = facing(direction, rim);
  Eigen::Array3f light = Eigen::Array3f(0.96f, 0.985f, 1.0f) * (0.17f + 0.22f * upward);
  light += Eigen::Array3f(0.95f, 0.98f, 1.0f) * (0.20f * f * f * f);
  light += Eigen::Array3f(1.0f, 0.985f, 0.96f) * (0.60f * r * r * r * r * r);
  // The lit floor, warm and less bright where it is seen at a flat angle.
  light += (Eigen::Array3f(0.26f, 0.245f, 0.225f) - light) * std::min(1.0f, 2.5f * downward);
  return light;
}

Eigen::Array3f room_irradiance(const Studio& studio, const Eigen::Vector3f& normal) {
  return (studio.room.transpose() * harmonics(normal)).array().max(0.0f);
}

float key_cosine(const Studio& studio, const Eigen::Vector3f& normal) {
  const float cosine = normal.dot(studio.key_direction);
  const float setting = studio.key_radius;
  if (cosine >= setting) return cosine;
  if (cosine <= -setting) return 0;
  return (cosine + setting) * (cosine + setting) / (4 * setting);
}

float key_gloss(const Studio& studio, const Eigen::Vector3f& normal,
                const Eigen::Vector3f& to_viewer) {
  const float facing_light = normal.dot(studio.key_direction);
  const float facing_viewer = std::max(normal.dot(to_viewer), 0.05f);
  if (facing_light <= 0) return 0;
  const Eigen::Vector3f half = (studio.key_direction + to_viewer).normalized();
  constexpr float kAlpha = kRoughness * kRoughness;
  const float h = std::max(normal.dot(half), 0.0f);
  const float base = h * h * (kAlpha * kAlpha - 1) + 1;
  const float spread = kAlpha * kAlpha / (kPi * base * base);
  // Smith's masking over 4 n.l n.v, Hammon 2017's approximation.
  const float masking = 0.5f / ((1 - kAlpha) * 2 * facing_light * facing_viewer +
                                kAlpha * (facing_light + facing_viewer));
  const float mirrored = mirror_share(std::max(half.dot(to_viewer), 0.0f));
  return kPi * spread * masking * mirrored * facing_light;
}

float mirror_share(float cosine) {
  const float rest = 1 - std::clamp(cosine, 0.0f, 1.0f);
  return kFacingMirror + (1 - kFacingMirror) * rest * rest * rest * rest * rest;
}

Eigen::Array3f backdrop_at(const Studio& studio, float x, float y) {
  const float dx = (x - 0.5f) * 1.1f, dy = y - 0.52f;
  const float off = std::min(1.0f, (dx * dx + dy * dy) * 2.0f);
  return studio.backdrop * (1 - 0.34f * off * (1.5f - 0.5f * off));
}

Eigen::Array3f tone_mapped(const Eigen::Array3f& light) {
  constexpr float kStart = 0.6f;
  constexpr float kRest = 1 - kStart;
  const Eigen::Array3f over = (light - kStart).max(0.0f) / kRest;
  return light.min(kStart) + kRest * (1 - (-over).exp());
}

}  // namespace morphbake
