#include "morphbake/preview/weights_picture.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "morphbake/images/drawing.h"

namespace morphbake {
namespace {

constexpr int kMostStrips = 500;
constexpr int kWidth = 1200, kLeft = 232, kRight = 24, kTop = 48, kBottom = 44;
constexpr int kAllStrips = 600;  // pixels that few strips share
constexpr int kLeastStrip = 24, kMostStrip = 150;
constexpr int kText = 2;  // scale of letters
constexpr float kLine = 2, kLeastGap = 3;
constexpr std::size_t kMostKeys = 20000;  // that are drawn one by one

constexpr Ink kBlack{{40, 40, 40}, 1}, kGrey{{205, 205, 205}, 1};

/// Where weights and times lie in the picture.
struct Plot {
  int strips = 0;
  int strip = 0;   ///< pixels from one to the next
  double end = 0;  ///< seconds
  float low = 0, high = 1;

  float x_of(double time) const {
    const double share = end > 0 ? time / end : 0;
    return static_cast<float>(kLeft + share * (kWidth - kLeft - kRight));
  }

  float y_of(int row, float weight) const {
    const float gap = std::max(kLeastGap, static_cast<float>(strip) / 12);
    const float bottom = static_cast<float>(kTop + (row + 1) * strip) - gap;
    const float height = static_cast<float>(strip) - 2 * gap;
    return bottom - (weight - low) / (high - low) * height;
  }

  int bottom() const { return kTop + strips * strip; }
};

Plot plot_of(const AnimationCurve& curve) {
  Plot plot;
  plot.strips = std::min(kMostStrips, static_cast<int>(curve.values.cols()));
  plot.strip = std::clamp(kAllStrips / std::max(1, plot.strips), kLeastStrip, kMostStrip);
  plot.end = curve.times.empty() ? 0 : curve.times.back();
  if (curve.values.size() > 0) {
    plot.low = std::min(0.0F, curve.values.minCoeff());
    plot.high = std::max(1.0F, curve.values.maxCoeff());
  }
  return plot;
}

/// Colours that differ most from those just before: the hue turns by the golden angle.
Ink colour_of(int target) {
  const double hue = std::fmod(0.6 + target * 0.6180339887498949, 1.0) * 6;
  const auto part = [&](double shift) {
    const double ramp = std::clamp(std::abs(std::fmod(hue + shift, 6.0) - 3) - 1, 0.0, 1.0);
    return static_cast<std::uint8_t>(std::lround(15 + 160 * ramp));
  };
  return {{part(0), part(4), part(2)}, 1};
}

/// Moments at which lines have corners: a picture's columns, and keys between them.
std::vector<double> moments_of(const AnimationCurve& curve, const Plot& plot) {
  std::vector<double> moments;
  const int columns = kWidth - kLeft - kRight;
  for (int c = 0; c <= columns; ++c) moments.push_back(plot.end * c / columns);
  if (curve.times.size() <= kMostKeys) {
    moments.insert(moments.end(), curve.times.begin(), curve.times.end());
  }
  std::ranges::sort(moments);
  return moments;
}

/// A step of 1, 2 or 5 times a power of ten that goes about eight times into `range`.
double tick_of(double range) {
  const double rough = range / 8;
  const double power = std::pow(10, std::floor(std::log10(rough)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (rough <= step * power) return step * power;
  }
  return 10 * power;
}

void draw_time_axis(Image& image, const Plot& plot) {
  const auto bottom = static_cast<float>(plot.bottom());
  if (plot.end > 0) {
    const double tick = tick_of(plot.end);
    for (int i = 0; i * tick <= plot.end * (1 + 1e-9); ++i) {
      const float x = plot.x_of(i * tick);
      draw_line(image, {x, static_cast<float>(kTop)}, {x, bottom + 5}, 1, kGrey);
      const std::string label = fmt::format("{:.4g}{}", i * tick, i == 0 ? " s" : "");
      const int width = text_size(label, kText).x();
      const int left = std::min(static_cast<int>(x) - width / 2, kWidth - width - 2);
      draw_text(image, label, {left, plot.bottom() + 12}, kText, kBlack);
    }
  }
}

/// A strip's name, and lines at weights 0 and 1.
void draw_frame(Image& image, const Plot& plot, int row, const std::string& name, const Ink& ink) {
  for (const float weight : {0.0F, 1.0F}) {
    const float y = plot.y_of(row, weight);
    draw_line(image, {kLeft, y}, {kWidth - kRight, y}, 1, kGrey);
  }
  const std::string text = fitted_text(name, kLeft - 60, kText);
  const int middle = kTop + row * plot.strip + plot.strip / 2;
  draw_text(image, text, {12, middle - text_size(text, kText).y() / 2}, kText, ink);
  if (plot.strip < 4 * text_size("0", 1).y()) return;  // no room for numbers
  for (const float weight : {0.0F, 1.0F}) {
    draw_text(image, weight == 0 ? "0" : "1",
              {kLeft - 14, static_cast<int>(plot.y_of(row, weight)) - 4}, 1, kBlack);
  }
}

void draw_curve(Image& image, const Plot& plot, int row, const std::vector<double>& moments,
                const Eigen::VectorXf& weights, const Ink& ink) {
  const Ink shade{ink.colour, 0.2F};
  for (std::size_t m = 0; m + 1 < moments.size(); ++m) {
    const auto at = static_cast<Eigen::Index>(m);
    const Eigen::Vector2f from(plot.x_of(moments[m]), plot.y_of(row, weights(at)));
    const Eigen::Vector2f to(plot.x_of(moments[m + 1]), plot.y_of(row, weights(at + 1)));
    const bool is_column = std::floor(from.x()) != std::floor(to.x());
    if (is_column && weights(at) != 0) {
      const float x = std::floor(from.x()) + 0.5F;
      draw_line(image, {x, plot.y_of(row, 0)}, {x, from.y()}, 1, shade);
    }
    draw_line(image, from, to, kLine, ink);
  }
}

}  // namespace

Image draw_weights(const AnimationCurve& curve, const std::vector<std::string>& names,
                   const std::string& title) {
  const Plot plot = plot_of(curve);
  Image image = blank_image(kWidth, plot.bottom() + kBottom, {255, 255, 255});
  const std::string cut =
      plot.strips < curve.values.cols()
          ? fmt::format(", the first {} of {} targets", plot.strips, curve.values.cols())
          : "";
  draw_text(image, fitted_text(title + cut, kWidth - 24, kText), {12, 14}, kText, kBlack);
  draw_time_axis(image, plot);
  const std::vector<double> moments = moments_of(curve, plot);
  Eigen::MatrixXf weights(static_cast<Eigen::Index>(moments.size()), plot.strips);
  for (std::size_t m = 0; m < moments.size() && plot.strips > 0; ++m) {
    weights.row(static_cast<Eigen::Index>(m)) =
        value_at(curve, moments[m]).head(plot.strips).transpose().cast<float>();
  }
  for (int row = 0; row < plot.strips; ++row) {
    const Ink ink = colour_of(row);
    const std::string& name = names[static_cast<std::size_t>(row)];
    draw_frame(image, plot, row, name.empty() ? fmt::format("target {}", row) : name, ink);
    draw_curve(image, plot, row, moments, weights.col(row), ink);
  }
  return image;
}

}  // namespace morphbake
