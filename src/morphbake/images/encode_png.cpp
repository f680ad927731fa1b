#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <cassert>
#include <memory>
#include <stdexcept>

#include "morphbake/images/images.h"

namespace morphbake {

std::string encode_png(const Image& image) {
  assert(image.rgb.size() == static_cast<std::size_t>(image.width) * image.height * 3);
  OIIO::Filesystem::IOVecOutput written;
  const auto output = OIIO::ImageOutput::create("out.png", &written);
  OIIO::ImageSpec spec(image.width, image.height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("png:compressionLevel", 6);
  spec.attribute("png:filter",
                 0xf8);  // libpng's best of all five a row; OpenImageIO's default is none
  if (!output || !output->open("out.png", spec) ||
      !output->write_image(OIIO::TypeDesc::UINT8, image.rgb.data()) || !output->close()) {
    // Nothing the user wrote can cause this: memory is the only device.
    throw std::runtime_error("encode_png: " + (output ? output->geterror() : OIIO::geterror()));
  }
  const auto& bytes = written.buffer();
  return std::string(bytes.begin(), bytes.end());
}

}  // namespace morphbake
