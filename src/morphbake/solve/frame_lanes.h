#pragma once

#include "morphbake/differential/rotation_vector.h"

// Inlined into functions for one kind of machine each (see rotation_passes.cpp). No multiplication
// is fused with an addition, so that all give the same bytes.
#define MORPHBAKE_INLINE [[gnu::always_inline]] inline

namespace morphbake {

/// Four frames beside each other: what an edge does to one frame it does to all. No frame sees
/// another, so a frame has the same bytes in any lane.
inline constexpr int kLanes = 4;
typedef double Lanes
    __attribute__((vector_size(kLanes * sizeof(double))));  // "using" knows no such

// GCC aligns the type itself by the registers that are there where it is read: these are aligned by
// name.
inline constexpr int kLaneBytes = kLanes * sizeof(double);

struct alignas(kLaneBytes) LaneNumber {
  Lanes value{};
};

struct alignas(kLaneBytes) LaneVector {
  Lanes x{}, y{}, z{};
};

/// Of length 1.
struct alignas(kLaneBytes) LaneQuaternion {
  Lanes w = {1, 1, 1, 1}, x{}, y{}, z{};
};

MORPHBAKE_INLINE LaneVector operator+(const LaneVector& p, const LaneVector& q) {
  return {p.x + q.x, p.y + q.y, p.z + q.z};
}

MORPHBAKE_INLINE LaneVector operator-(const LaneVector& p, const LaneVector& q) {
  return {p.x - q.x, p.y - q.y, p.z - q.z};
}

MORPHBAKE_INLINE LaneVector operator*(const Lanes& s, const LaneVector& p) {
  return {s * p.x, s * p.y, s * p.z};
}

MORPHBAKE_INLINE LaneVector operator*(double s, const LaneVector& p) {
  return {s * p.x, s * p.y, s * p.z};
}

/// The same vector in all lanes, scaled in each.
MORPHBAKE_INLINE LaneVector scaled(const Lanes& s, const Eigen::Vector3d& p) {
  return {s * p.x(), s * p.y(), s * p.z()};
}

MORPHBAKE_INLINE Lanes dot(const LaneVector& p, const LaneVector& q) {
  return p.x * q.x + p.y * q.y + p.z * q.z;
}

MORPHBAKE_INLINE LaneVector cross(const LaneVector& p, const LaneVector& q) {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}

MORPHBAKE_INLINE LaneQuaternion operator*(const LaneQuaternion& p, const LaneQuaternion& q) {
  return {
      p.w * q.w - p.x * q.x - p.y * q.y - p.z * q.z, p.w * q.x + p.x * q.w + p.y * q.z - p.z * q.y,
      p.w * q.y + p.y * q.w + p.z * q.x - p.x * q.z, p.w * q.z + p.z * q.w + p.x * q.y - p.y * q.x};
}

MORPHBAKE_INLINE LaneQuaternion inverse(const LaneQuaternion& q) { return {q.w, -q.x, -q.y, -q.z}; }

/// Of a quaternion that has nearly the length 1: one step of Newton's for 1 / sqrt.
MORPHBAKE_INLINE LaneQuaternion normalised(const LaneQuaternion& q) {
  const Lanes s = 1.5 - 0.5 * (q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {s * q.w, s * q.x, s * q.y, s * q.z};
}

MORPHBAKE_INLINE LaneVector turned(const LaneQuaternion& q, const LaneVector& p) {
  const LaneVector axis{q.x, q.y, q.z};
  LaneVector t = cross(axis, p);
  t = t + t;
  return p + (q.w * t + cross(axis, t));
}

MORPHBAKE_INLINE Eigen::Quaterniond lane_of(const LaneQuaternion& q, int lane) {
  return {q.w[lane], q.x[lane], q.y[lane], q.z[lane]};
}

MORPHBAKE_INLINE void set_lane(LaneQuaternion& q, int lane, const Eigen::Quaterniond& rotation) {
  q.w[lane] = rotation.w();
  q.x[lane] = rotation.x();
  q.y[lane] = rotation.y();
  q.z[lane] = rotation.z();
}

MORPHBAKE_INLINE void set_all_lanes(LaneQuaternion& q, const Eigen::Quaterniond& rotation) {
  for (int lane = 0; lane < kLanes; ++lane) set_lane(q, lane, rotation);
}

/// Whether something holds in any lane.
template <class Mask>
MORPHBAKE_INLINE bool any(const Mask& mask) {
  return (mask[0] | mask[1] | mask[2] | mask[3]) != 0;
}

/// rotation_of(), lane by lane.
MORPHBAKE_INLINE LaneQuaternion lane_rotation_of(const LaneVector& vector) {
  const Lanes square = dot(vector, vector) / 4;
  const Lanes half_sine = half_angle_series::sine(square) / 2;
  LaneQuaternion rotation{half_angle_series::cosine(square), half_sine * vector.x,
                          half_sine * vector.y, half_sine * vector.z};
  const auto is_large = !(square < half_angle_series::kLargest);
  if (any(is_large)) {
    for (int lane = 0; lane < kLanes; ++lane) {
      if (is_large[lane] == 0) continue;
      set_lane(rotation, lane, rotation_of({vector.x[lane], vector.y[lane], vector.z[lane]}));
    }
  }
  return rotation;
}

/// rotation_vector(), lane by lane.
MORPHBAKE_INLINE LaneVector lane_rotation_vector(const LaneQuaternion& rotation) {
  const Lanes square = rotation.x * rotation.x + rotation.y * rotation.y + rotation.z * rotation.z;
  const Lanes arc = 2 * half_angle_series::arc(square);
  const Lanes scale = rotation.w < 0 ? -arc : arc;
  LaneVector vector{scale * rotation.x, scale * rotation.y, scale * rotation.z};
  const auto is_large = !(square < half_angle_series::kLargestSine);
  if (any(is_large)) {
    for (int lane = 0; lane < kLanes; ++lane) {
      if (is_large[lane] == 0) continue;
      const Eigen::Vector3d whole = rotation_vector(lane_of(rotation, lane));
      vector.x[lane] = whole.x();
      vector.y[lane] = whole.y();
      vector.z[lane] = whole.z();
    }
  }
  return vector;
}

}  // namespace morphbake
