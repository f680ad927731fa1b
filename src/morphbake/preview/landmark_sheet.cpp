#include "morphbake/preview/landmark_sheet.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "morphbake/images/drawing.h"
#include "morphbake/preview/still_view.h"

namespace morphbake {
namespace {

using Colour = std::array<std::uint8_t, 3>;

constexpr Colour kPaper{246, 245, 243};
constexpr Colour kText{40, 40, 44};
constexpr Colour kWhite{255, 255, 255};
constexpr int kGap = 12;      // pixels between pictures
constexpr int kCaption = 26;  // pixels above each row
constexpr int kLegendRow = 26;
constexpr int kTextScale = 2;

struct View {
  const char* name;
  double azimuth;
  double elevation;
};

constexpr std::array<View, 4> kViews = {
    {{"front", 0, 8}, {"left", 90, 8}, {"back", 180, 8}, {"top", 0, 78}}};

/// Twelve hues that differ in brightness too; from then on they repeat.
Colour colour_of(std::size_t number) {
  constexpr std::array<Colour, 12> kColours = {{{214, 39, 40},
                                                {31, 96, 196},
                                                {24, 128, 56},
                                                {168, 60, 190},
                                                {224, 112, 0},
                                                {0, 134, 150},
                                                {150, 82, 30},
                                                {216, 44, 130},
                                                {92, 92, 102},
                                                {110, 124, 0},
                                                {84, 66, 204},
                                                {130, 20, 40}}};
  return kColours[number % kColours.size()];
}

/// A rectangle in a picture.
struct Box {
  Eigen::Vector2f low;
  Eigen::Vector2f high;

  float overlap(const Box& other) const {
    const Eigen::Vector2f size = high.cwiseMin(other.high) - low.cwiseMax(other.low);
    return size.x() > 0 && size.y() > 0 ? size.x() * size.y() : 0;
  }
};

/// Where numbers go: beside their dots, on nothing else if that can be.
class LabelPlaces {
 public:
  LabelPlaces(const Image& picture, const std::vector<SeenPoint>& points, float radius)
      : picture_(picture), radius_(radius) {
    for (const SeenPoint& point : points) {
      const Eigen::Vector2f reach = Eigen::Vector2f::Constant(radius + 1);
      taken_.push_back({point.pixel - reach, point.pixel + reach});
    }
  }

  /// The place with the least overlap among rings of places around a dot; it is taken from now on.
  Box find(const Eigen::Vector2f& dot, const Eigen::Vector2f& size) {
    Box best{};
    float least = std::numeric_limits<float>::infinity();
    for (int ring = 0; ring < 4; ++ring) {
      for (int direction = 0; direction < 16; ++direction) {
        const Box place = place_at(dot, size, ring, direction);
        float cost = static_cast<float>(ring) * 40 + static_cast<float>(direction % 4) * 0.5f +
                     outside(place) * 20;
        for (const Box& other : taken_) cost += 4 * place.overlap(other);
        if (cost >= least) continue;
        least = cost;
        best = place;
      }
    }
    taken_.push_back(best);
    return best;
  }

 private:
  Box place_at(const Eigen::Vector2f& dot, const Eigen::Vector2f& size, int ring,
               int direction) const {
    const float angle = static_cast<float>(direction) * static_cast<float>(M_PI) / 8 - 0.7854f;
    const Eigen::Vector2f towards(std::cos(angle), std::sin(angle));
    const float away = radius_ + 4 + static_cast<float>(ring) * 14;
    const Eigen::Vector2f middle = dot + towards * away + towards.cwiseProduct(size) / 2;
    return {middle - size / 2, middle + size / 2};
  }

  float outside(const Box& box) const {
    const Eigen::Vector2f size(static_cast<float>(picture_.width),
                               static_cast<float>(picture_.height));
    return (-box.low).cwiseMax(0).sum() + (box.high - size).cwiseMax(0).sum();
  }

  const Image& picture_;
  float radius_;
  std::vector<Box> taken_;
};

void draw_outlined_text(Image& image, std::string_view text, int left, int top, const Ink& ink) {
  for (int dy = -2; dy <= 2; ++dy) {
    for (int dx = -2; dx <= 2; ++dx) {
      draw_text(image, text, {left + dx, top + dy}, kTextScale, {kWhite, ink.opacity});
    }
  }
  draw_text(image, text, {left, top}, kTextScale, ink);
}

void draw_dot(Image& image, const Eigen::Vector2f& at, float radius, const Colour& colour,
              bool is_hidden) {
  if (is_hidden) {
    draw_ring(image, at, radius - 1.6f, radius, {colour, 0.45f});
    return;
  }
  draw_ring(image, at, 0, radius + 1.5f, {kWhite, 1});
  draw_ring(image, at, 0, radius, {colour, 1});
}

/// Dots and numbers of a view; hidden ones first, so that they are below.
void draw_marks(StillView& view) {
  const float radius = std::max(4.0f, static_cast<float>(view.picture.width) / 80);
  LabelPlaces places(view.picture, view.points, radius);
  for (const bool hidden : {true, false}) {
    for (std::size_t i = 0; i < view.points.size(); ++i) {
      if (view.points[i].is_hidden != hidden) continue;
      draw_dot(view.picture, view.points[i].pixel, radius, colour_of(i), hidden);
    }
  }
  for (const bool hidden : {false, true}) {
    for (std::size_t i = 0; i < view.points.size(); ++i) {
      const SeenPoint& point = view.points[i];
      if (point.is_hidden != hidden) continue;
      const std::string number = fmt::format("{}", i + 1);
      const Eigen::Vector2f size = text_size(number, kTextScale).cast<float>();
      const Box box = places.find(point.pixel, size + Eigen::Vector2f::Constant(2));
      const Ink ink{colour_of(i), hidden ? 0.45f : 1.0f};
      const Eigen::Vector2f middle = (box.low + box.high) / 2;
      // Numbers that had to go further off are tied to their dots.
      if ((middle - point.pixel).norm() > radius + 26) {
        draw_line(view.picture, point.pixel, middle, 1.2f, ink);
      }
      draw_outlined_text(view.picture, number, static_cast<int>(std::lround(box.low.x())) + 1,
                         static_cast<int>(std::lround(box.low.y())) + 1, ink);
    }
  }
}

/// Pixels that the legend needs on the right.
int legend_width(const std::vector<std::string>& names) {
  int width = 0;
  for (const std::string& name : names) width = std::max(width, text_size(name, kTextScale).x());
  return names.empty() ? 0 : width + 80;
}

void draw_legend(const std::vector<std::string>& names, int left, int top, Image& sheet) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    const int y = top + static_cast<int>(i) * kLegendRow;
    const std::string number = fmt::format("{}", i + 1);
    draw_dot(sheet, {static_cast<float>(left) + 8, static_cast<float>(y) + 7}, 6, colour_of(i),
             false);
    const int right = left + 52;
    draw_text(sheet, number, {right - text_size(number, kTextScale).x(), y}, kTextScale,
              {colour_of(i), 1});
    draw_text(sheet, names[i], {left + 64, y}, kTextScale, {kText, 1});
  }
}

}  // namespace

Image render_landmark_sheet(const std::vector<MarkedShape>& shapes,
                            const std::vector<std::string>& names,
                            const LandmarkSheetOptions& options, const Observer& observer) {
  const int size = options.view_size;
  const auto rows = static_cast<int>(shapes.size());
  const auto columns = static_cast<int>(kViews.size());
  const int row_height = kCaption + size + kGap;
  const int legend_left = kGap + columns * (size + kGap);
  const int legend_height = kGap + kCaption + static_cast<int>(names.size()) * kLegendRow;
  Image sheet = blank_image(legend_left + legend_width(names) + kGap,
                            std::max(rows * row_height + kGap, legend_height), kPaper);
  TurntableOptions look;
  look.width = look.height = size;
  look.frames = 1;
  look.fill = 0.85;
  look.samples = options.samples;
  look.threads = options.threads;
  for (int row = 0; row < rows; ++row) {
    const MarkedShape& shape = shapes[static_cast<std::size_t>(row)];
    const int top = kGap + row * row_height;
    for (int column = 0; column < columns; ++column) {
      advance(observer, {"sheet", row * columns + column, rows * columns});
      const View& from = kViews[static_cast<std::size_t>(column)];
      look.azimuth = from.azimuth;
      look.elevation = from.elevation;
      const bool is_first = column == 0;  // one warning a texture is enough
      StillView view =
          render_still(shape.mesh, look, shape.marks, is_first ? observer : Observer());
      draw_marks(view);
      const int left = kGap + column * (size + kGap);
      paste(view.picture, left, top + kCaption, sheet);
      const std::string caption =
          column == 0
              ? fmt::format("{}: {}", fitted_text(shape.title, size - 110, kTextScale), from.name)
              : from.name;
      draw_text(sheet, caption, {left + 2, top + 2}, kTextScale, {kText, 1});
    }
  }
  draw_legend(names, legend_left + kGap, kGap + kCaption, sheet);
  return sheet;
}

}  // namespace morphbake
