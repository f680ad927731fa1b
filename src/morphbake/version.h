#pragma once

namespace morphbake {

/// "0.1.0": the version of the library that is linked. Baked files carry it: the same sources and
/// recipe give the same bytes, from whichever commit of a version.
const char* version();

/// "0.1.0 (4a2789c12)": with the commit that the library was built from, followed by "-dirty" where
/// its files differed from it; the version alone where that is not known. For people and reports.
const char* version_with_commit();

}  // namespace morphbake
