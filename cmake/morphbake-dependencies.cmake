# Every third-party package in one place, with what Debian 12's packages get wrong. A package that the
# library links is also listed in morphbake-config.cmake.in.
include(morphbake-import)
set(MORPHBAKE_UNPACKED_PACKAGES ${PROJECT_SOURCE_DIR}/build/packages)  # by pipeline/setup

# CGAL and Boost announce themselves on every configure, and CGAL dislikes any build type but Release.
set(CGAL_DO_NOT_WARN_ABOUT_CMAKE_BUILD_TYPE TRUE)
set(log_level "${CMAKE_MESSAGE_LOG_LEVEL}")
set(CMAKE_MESSAGE_LOG_LEVEL WARNING)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt 9 REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
morphbake_import(tinygltf tiny_gltf.h "")
morphbake_import(spectra Spectra/SymEigsSolver.h "")
morphbake_import(xxhash xxhash.h "")
find_package(draco REQUIRED)
find_package(meshoptimizer REQUIRED)
find_package(CGAL 5.5 REQUIRED)
find_package(embree 3 REQUIRED)
find_package(TBB REQUIRED)
find_package(muparser REQUIRED)
find_package(CLI11 REQUIRED)
morphbake_import_linked()
morphbake_import(valijson valijson/validator.hpp "")
set(CMAKE_MESSAGE_LOG_LEVEL "${log_level}")
