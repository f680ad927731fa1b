#include "morphbake/preview/turntable.h"
namespace morphbake { std::vector<Image> render_turntable(const AnimatedMesh&, const TurntableOptions& o, const Observer&) { return {Image{o.width,o.height,std::vector<std::uint8_t>(static_cast<std::size_t>(o.width*o.height*3))}}; } }
