#pragma once

namespace morphbake {

/// "0.1.0": the version of the library that is linked.
const char* version();

}  // namespace morphbake
