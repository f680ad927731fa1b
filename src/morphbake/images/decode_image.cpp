#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/images/image_header.h"
#include "morphbake/images/images.h"

namespace morphbake {
namespace {

constexpr int kLargestSide = 16384;
constexpr std::int64_t kMostPixels = std::int64_t{1} << 26;  // some bytes each, while decoding

[[noreturn]] void fail(const std::string& name, const std::string& code, const std::string& message,
                       const std::string& hint) {
  Problem problem;
  problem.code = code;
  // "face.glb#/images/0" names a place in a file.
  const std::size_t pointer = name.rfind("#/");
  problem.location.file = name.substr(0, pointer);
  if (pointer != std::string::npos) problem.location.pointer = name.substr(pointer + 1);
  problem.message = message;
  problem.hint = hint;
  throw BakeError(std::move(problem));
}

[[noreturn]] void fail_unreadable(const std::string& name, const std::string& reason) {
  fail(name, "image.unreadable", "the image cannot be decoded: " + reason,
       "a complete PNG or JPEG file is needed");
}

/// The decoders allocate by what the header says (a progressive JPEG even when it is opened), so
/// the size is read and checked before they see the file.
ImageHeader checked_header(std::string_view bytes, const std::string& name) {
  const auto header = read_image_header(bytes);
  if (!header) fail_unreadable(name, "it is neither PNG nor JPEG, or ends within its header");
  if (header->width < 1 || header->height < 1) {
    fail_unreadable(name, fmt::format("its size is {} x {}", header->width, header->height));
  }
  if (std::max(header->width, header->height) > kLargestSide) {
    fail(name, "image.too-large",
         fmt::format("the image is {} x {} pixels", header->width, header->height),
         fmt::format("at most {} pixels a side", kLargestSide));
  }
  if (std::int64_t{header->width} * header->height > kMostPixels) {
    fail(name, "image.too-large",
         fmt::format("the image is {} x {} pixels", header->width, header->height),
         fmt::format("at most {} pixels in all, such as 8192 x 8192", kMostPixels));
  }
  // libpng would find this as well, but says so on stderr.
  if (header->format == ImageFormat::Png &&
      (!has_whole_png_chunks(bytes) || !can_hold_png_pixels(bytes))) {
    fail_unreadable(name, "it is cut short");
  }
  return *header;
}

std::string last_error(const OIIO::ImageInput* input) {
  const std::string text = input != nullptr ? input->geterror() : OIIO::geterror();
  if (text.empty()) return "the data is damaged";
  return text.substr(0, text.find('\n'));  // what follows repeats it
}

/// Grey becomes three equal channels; alpha (the last of 2 or 4 channels) is dropped.
std::vector<std::uint8_t> rgb_of_channels(const std::vector<std::uint8_t>& pixels, int channels) {
  const std::size_t stride = static_cast<std::size_t>(channels);
  const std::size_t count = pixels.size() / stride;
  const std::size_t step = channels < 3 ? 0 : 1;
  std::vector<std::uint8_t> rgb(count * 3);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t c = 0; c < 3; ++c) rgb[i * 3 + c] = pixels[i * stride + c * step];
  }
  return rgb;
}

}  // namespace

Image decode_image(std::string_view bytes, const std::string& name) {
  const ImageHeader header = checked_header(bytes, name);
  OIIO::Filesystem::IOMemReader reader(bytes.data(), bytes.size());
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);  // colours under alpha 0 count as well
  const std::string format_name = header.format == ImageFormat::Png ? "png" : "jpeg";
  OIIO::Filesystem::IOProxy* proxy = &reader;
  config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  // A format's name: for a file name, create() looks for the file.
  const auto input = OIIO::ImageInput::create(format_name);
  OIIO::ImageSpec spec;
  if (!input || !input->open(format_name, spec, config)) {
    fail_unreadable(name, last_error(input.get()));
  }
  if (spec.width != header.width || spec.height != header.height || spec.nchannels < 1 ||
      spec.nchannels > 4) {
    fail_unreadable(name, "its header contradicts its data");
  }
  std::vector<std::uint8_t> pixels(spec.image_pixels() * static_cast<std::size_t>(spec.nchannels));
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, pixels.data())) {
    fail_unreadable(name, last_error(input.get()));
  }
  Image image{spec.width, spec.height, {}};
  image.rgb = spec.nchannels == 3 ? std::move(pixels) : rgb_of_channels(pixels, spec.nchannels);
  return image;
}

}  // namespace morphbake
