#pragma once

#include <Eigen/Core>
#include <vector>

namespace morphbake {

/// Part of a light that is seen from a surface: `seen` of `all`, both sums over samples.
struct Visibility {
  float seen = 0;
  float all = 0;

  void add(const Visibility& other, float weight) {
    seen += weight * other.seen;
    all += weight * other.all;
  }

  float share() const { return all > 0 ? seen / all : 1.0f; }
};

/// What the samples of one pixel found, as sums over its samples.
struct PixelLight {
  float subject = 0;  ///< samples that met the subject
  float floor = 0;    ///< samples that met the floor near it, each by its weight from 0 to 1
  Eigen::Array3f base_colour = Eigen::Array3f::Zero();
  Eigen::Array3f key = Eigen::Array3f::Zero();   ///< unshadowed light of the soft box, reflected
  Eigen::Array3f room = Eigen::Array3f::Zero();  ///< unshadowed light of the room, reflected
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  float distance = 0;
  Visibility subject_key, subject_room;
  Visibility floor_key, floor_room;
};

/// Picture of sums, row by row from the top.
struct LightBuffer {
  int width = 0;
  int height = 0;
  std::vector<PixelLight> pixels;

  PixelLight& at(int x, int y) {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }

  const PixelLight& at(int x, int y) const { return const_cast<LightBuffer&>(*this).at(x, y); }
};

/// The visibilities of a pixel after averaging.
struct SmoothVisibility {
  float subject_key = 1;
  float subject_room = 1;
  float floor_key = 1;
  float floor_room = 1;
};

/// Averages the visibilities around a pixel over a window of 5 x 5 whose edge counts half, so that
/// every cell of the sample pattern counts the same: samples of 16 pixels make one smooth mean. The
/// subject's are averaged only over what lies on the same surface.
SmoothVisibility filter_visibility(const LightBuffer& buffer, int x, int y);

}  // namespace morphbake
