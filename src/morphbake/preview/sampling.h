#pragma once

#include <Eigen/Core>
#include <vector>

namespace morphbake {

/// Side of the square of pixels that share one set of light samples between them.
constexpr int kPatternSide = 4;

/// Where every sample of every pixel goes: a pure function of the pixel's place and the sample's
/// number, so neither threads nor time change it.
///
/// Pixels repeat in squares of kPatternSide. The samples of the 16 pixels of such a square (any
/// such square, wherever it begins) together are one low-discrepancy set, which is what makes a
/// mean over the square as smooth as 16 times the samples.
/// @see Keller, Heidrich 2001, Interleaved sampling; Roberts 2018, R2 sequence
struct SamplePattern {
  int samples = 0;                    ///< a pixel
  std::vector<Eigen::Vector2f> lens;  ///< [sample]: place inside the pixel, 0 to 1
  std::vector<Eigen::Vector3f>
      hemisphere;                     ///< [cell * samples + sample]: cosine-distributed about +Z
  std::vector<Eigen::Vector2f> disk;  ///< [cell * samples + sample]: uniform in the unit disk

  std::size_t first_of_pixel(int x, int y) const;  ///< index of the pixel's sample 0
};

SamplePattern make_sample_pattern(int samples);

/// Two unit vectors that are perpendicular to `normal` (of unit length) and each other.
void perpendicular_axes(const Eigen::Vector3f& normal, Eigen::Vector3f& a, Eigen::Vector3f& b);

}  // namespace morphbake
