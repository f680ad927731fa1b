#include "morphbake/images/drawing.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

namespace morphbake {
namespace {

constexpr int kLetterWidth = 5;
constexpr int kAdvance = kLetterWidth + 1;
constexpr int kLetterHeight = 7;  // and one row below it for g, j, p, q, y

// Columns of the printable ASCII letters from " " on, five bytes a letter, the lowest bit on top.
// clang-format off
constexpr std::string_view kLetters{
    "\000\000\000\000\000" "\000\000\137\000\000" "\000\007\000\007\000" "\024\177\024\177\024"
    "\044\052\177\052\022" "\043\023\010\144\142" "\066\111\126\040\120" "\000\010\007\003\000"
    "\000\034\042\101\000" "\000\101\042\034\000" "\052\034\177\034\052" "\010\010\076\010\010"
    "\000\200\160\060\000" "\010\010\010\010\010" "\000\000\140\140\000" "\040\020\010\004\002"
    "\076\121\111\105\076" "\000\102\177\100\000" "\162\111\111\111\106" "\041\101\111\115\063"
    "\030\024\022\177\020" "\047\105\105\105\071" "\074\112\111\111\061" "\101\041\021\011\007"
    "\066\111\111\111\066" "\106\111\111\051\036" "\000\000\024\000\000" "\000\100\064\000\000"
    "\000\010\024\042\101" "\024\024\024\024\024" "\000\101\042\024\010" "\002\001\131\011\006"
    "\076\101\135\131\116" "\174\022\021\022\174" "\177\111\111\111\066" "\076\101\101\101\042"
    "\177\101\101\101\076" "\177\111\111\111\101" "\177\011\011\011\001" "\076\101\101\121\163"
    "\177\010\010\010\177" "\000\101\177\101\000" "\040\100\101\077\001" "\177\010\024\042\101"
    "\177\100\100\100\100" "\177\002\034\002\177" "\177\004\010\020\177" "\076\101\101\101\076"
    "\177\011\011\011\006" "\076\101\121\041\136" "\177\011\031\051\106" "\046\111\111\111\062"
    "\003\001\177\001\003" "\077\100\100\100\077" "\037\040\100\040\037" "\077\100\070\100\077"
    "\143\024\010\024\143" "\003\004\170\004\003" "\141\131\111\115\103" "\000\177\101\101\101"
    "\002\004\010\020\040" "\000\101\101\101\177" "\004\002\001\002\004" "\100\100\100\100\100"
    "\000\003\007\010\000" "\040\124\124\170\100" "\177\050\104\104\070" "\070\104\104\104\050"
    "\070\104\104\050\177" "\070\124\124\124\030" "\000\010\176\011\002" "\030\244\244\234\170"
    "\177\010\004\004\170" "\000\104\175\100\000" "\040\100\100\075\000" "\177\020\050\104\000"
    "\000\101\177\100\000" "\174\004\170\004\170" "\174\010\004\004\170" "\070\104\104\104\070"
    "\374\030\044\044\030" "\030\044\044\030\374" "\174\010\004\004\010" "\110\124\124\124\044"
    "\004\004\077\104\044" "\074\100\100\040\174" "\034\040\100\040\034" "\074\100\060\100\074"
    "\104\050\020\050\104" "\114\220\220\220\174" "\104\144\124\114\104" "\000\010\066\101\000"
    "\000\000\167\000\000" "\000\101\066\010\000" "\002\001\002\004\002",
    95 * kLetterWidth};

// clang-format on

bool begins_letter(char byte) { return (byte & 0xC0) != 0x80; }

/// The five columns of a letter.
std::string_view columns_of(char letter) {
  const bool is_known = letter >= ' ' && letter <= '~';
  const auto index = static_cast<std::size_t>((is_known ? letter : '?') - ' ');
  return kLetters.substr(index * kLetterWidth, kLetterWidth);
}

void blend(Image& image, int x, int y, const Ink& ink, float coverage) {
  if (x < 0 || y < 0 || x >= image.width || y >= image.height || coverage <= 0) return;
  const float share = std::min(coverage, 1.0f) * ink.opacity;
  const std::size_t at = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                              static_cast<std::size_t>(x));
  for (std::size_t k = 0; k < 3; ++k) {
    const auto under = static_cast<float>(image.rgb[at + k]);
    const float over = static_cast<float>(ink.colour[k]);
    image.rgb[at + k] = static_cast<std::uint8_t>(std::lround(under + share * (over - under)));
  }
}

void draw_letter(Image& image, char letter, const Eigen::Vector2i& corner, int scale,
                 const Ink& ink) {
  const std::string_view columns = columns_of(letter);
  for (int column = 0; column < kLetterWidth * scale; ++column) {
    const auto bits = static_cast<unsigned char>(columns[static_cast<std::size_t>(column / scale)]);
    for (int row = 0; row < (kLetterHeight + 1) * scale; ++row) {
      const bool is_set = (bits >> (row / scale) & 1) != 0;
      if (is_set) blend(image, corner.x() + column, corner.y() + row, ink, 1);
    }
  }
}

/// Blends every pixel of a box by `coverage(middle of the pixel)`.
template <class Coverage>
void fill(Image& image, const Eigen::Vector2f& low, const Eigen::Vector2f& high, const Ink& ink,
          const Coverage& coverage) {
  const auto from_x = std::max(0, static_cast<int>(std::floor(low.x())));
  const auto from_y = std::max(0, static_cast<int>(std::floor(low.y())));
  const auto to_x = std::min(image.width - 1, static_cast<int>(std::ceil(high.x())));
  const auto to_y = std::min(image.height - 1, static_cast<int>(std::ceil(high.y())));
  for (int y = from_y; y <= to_y; ++y) {
    for (int x = from_x; x <= to_x; ++x) {
      const Eigen::Vector2f middle(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      blend(image, x, y, ink, coverage(middle));
    }
  }
}

}  // namespace

Image blank_image(int width, int height, const std::array<std::uint8_t, 3>& colour) {
  Image image{width, height, {}};
  image.rgb.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
  for (std::size_t i = 0; i < image.rgb.size(); ++i) image.rgb[i] = colour[i % 3];
  return image;
}

void paste(const Image& image, int left, int top, Image& target) {
  const int from = std::max(0, -left), to = std::min(image.width, target.width - left);
  if (from >= to) return;
  for (int row = std::max(0, -top); row < image.height && top + row < target.height; ++row) {
    const auto* source =
        image.rgb.data() + 3 * (static_cast<std::ptrdiff_t>(row) * image.width + from);
    auto* place = target.rgb.data() +
                  3 * (static_cast<std::ptrdiff_t>(top + row) * target.width + left + from);
    std::copy_n(source, 3 * (to - from), place);
  }
}

void draw_ring(Image& image, const Eigen::Vector2f& centre, float inner, float outer,
               const Ink& ink) {
  const Eigen::Vector2f reach = Eigen::Vector2f::Constant(outer + 1);
  fill(image, centre - reach, centre + reach, ink, [&](const Eigen::Vector2f& middle) {
    const float distance = (middle - centre).norm();
    const float inside = std::clamp(outer - distance + 0.5f, 0.0f, 1.0f);
    const float hole = inner > 0 ? std::clamp(inner - distance + 0.5f, 0.0f, 1.0f) : 0.0f;
    return inside - hole;
  });
}

void draw_line(Image& image, const Eigen::Vector2f& from, const Eigen::Vector2f& to, float width,
               const Ink& ink) {
  const Eigen::Vector2f reach = Eigen::Vector2f::Constant(width + 1);
  const Eigen::Vector2f along = to - from;
  const float length = along.squaredNorm();
  fill(image, from.cwiseMin(to) - reach, from.cwiseMax(to) + reach, ink,
       [&](const Eigen::Vector2f& middle) {
         const float t =
             length > 0 ? std::clamp((middle - from).dot(along) / length, 0.0f, 1.0f) : 0.0f;
         const float distance = (middle - from - t * along).norm();
         return std::clamp(width / 2 - distance + 0.5f, 0.0f, 1.0f);
       });
}

Eigen::Vector2i text_size(std::string_view text, int scale) {
  const auto letters = static_cast<int>(std::count_if(text.begin(), text.end(), begins_letter));
  return {std::max(0, letters * kAdvance - 1) * scale, kLetterHeight * scale};
}

std::string fitted_text(const std::string& text, int width, int scale) {
  if (text_size(text, scale).x() <= width) return text;
  std::vector<std::size_t> letters;  // where they begin
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (begins_letter(text[i])) letters.push_back(i);
  }
  for (std::size_t kept = letters.size(); kept-- > 0;) {
    const std::size_t at_end = kept / 2;
    const std::string shown = text.substr(0, letters[kept - at_end]) + "..." +
                              (at_end == 0 ? "" : text.substr(letters[letters.size() - at_end]));
    if (text_size(shown, scale).x() <= width) return shown;
  }
  return "";
}

void draw_text(Image& image, std::string_view text, const Eigen::Vector2i& corner, int scale,
               const Ink& ink) {
  Eigen::Vector2i at = corner;
  for (const char letter : text) {
    if (!begins_letter(letter)) continue;
    draw_letter(image, letter, at, scale, ink);
    at.x() += kAdvance * scale;
  }
}

}  // namespace morphbake
