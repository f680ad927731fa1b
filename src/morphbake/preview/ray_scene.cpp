#include "morphbake/preview/ray_scene.h"

#include <embree3/rtcore.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>

namespace morphbake {
namespace {

constexpr float kMargin = 1e-4f;  ///< of the bounds, for rounding; the subject's radius is 1

void set_triangles(RTCGeometry geometry, const TriangleIndices& triangles) {
  const std::size_t count = static_cast<std::size_t>(triangles.rows());
  void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                          3 * sizeof(unsigned), count);
  if (indices != nullptr) std::memcpy(indices, triangles.data(), count * 3 * sizeof(int));
}

}  // namespace

struct RayScene::Embree {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<RTCGeometry> geometries;

  ~Embree() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
};

RayScene::RayScene(const AnimatedMesh& mesh, const std::vector<PosedPrimitive>& poses)
    : embree_(std::make_unique<Embree>()) {
  embree_->device = rtcNewDevice(nullptr);
  if (embree_->device == nullptr) throw std::runtime_error("Embree offers no device");
  embree_->scene = rtcNewScene(embree_->device);
  // Dynamic scene, low quality and refitted geometry together: with any other Embree rebuilds.
  rtcSetSceneFlags(embree_->scene,
                   static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_DYNAMIC | RTC_SCENE_FLAG_ROBUST));
  rtcSetSceneBuildQuality(embree_->scene, RTC_BUILD_QUALITY_LOW);
  for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
    if (mesh.primitives[i].triangles.rows() == 0) continue;
    RTCGeometry geometry = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    set_triangles(geometry, mesh.primitives[i].triangles);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               poses[i].positions.data(), 0, 3 * sizeof(float),
                               static_cast<std::size_t>(mesh.primitives[i].positions.rows()));
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_REFIT);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(embree_->scene, geometry, static_cast<unsigned>(i));
    embree_->geometries.push_back(geometry);
    rtcReleaseGeometry(geometry);  // the scene keeps it
  }
  commit();
  if (rtcGetDeviceError(embree_->device) != RTC_ERROR_NONE) {
    throw std::runtime_error("Embree cannot build its scene");
  }
}

RayScene::~RayScene() = default;

void RayScene::commit() {
  // The tree's shape decides which of two triangles at the same distance is met, and Embree's
  // builders let it depend on the number of threads: one thread, always. A thread count in the
  // device's configuration would limit the whole process instead.
  tbb::task_arena one_thread(1);
  one_thread.execute([&] { rtcJoinCommitScene(embree_->scene); });
  RTCBounds bounds;
  rtcGetSceneBounds(embree_->scene, &bounds);
  low_ = Eigen::Array3f(bounds.lower_x, bounds.lower_y, bounds.lower_z) - kMargin;
  high_ = Eigen::Array3f(bounds.upper_x, bounds.upper_y, bounds.upper_z) + kMargin;
}

bool RayScene::misses_bounds(const Eigen::Vector3f& origin,
                             const Eigen::Vector3f& direction) const {
  // Slabs; a zero direction gives infinities of the right sign, or NaN on a slab's face: no miss.
  float enter = 0, leave = std::numeric_limits<float>::infinity();
  for (int k = 0; k < 3; ++k) {
    const float inverse = 1 / direction[k];
    const float a = (low_[k] - origin[k]) * inverse, b = (high_[k] - origin[k]) * inverse;
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter > leave;
}

void RayScene::refit() {
  for (RTCGeometry geometry : embree_->geometries) {
    rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
    rtcCommitGeometry(geometry);
  }
  commit();
}

std::optional<RayHit> RayScene::first_hit(const Eigen::Vector3f& origin,
                                          const Eigen::Vector3f& direction) const {
  if (misses_bounds(origin, direction)) return std::nullopt;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  RTCRayHit query{};
  query.ray = {origin.x(),
               origin.y(),
               origin.z(),
               0.0f,
               direction.x(),
               direction.y(),
               direction.z(),
               0.0f,
               std::numeric_limits<float>::infinity(),
               ~0u,
               0,
               0};
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(embree_->scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  RayHit hit;
  hit.primitive = static_cast<int>(query.hit.geomID);
  hit.triangle = static_cast<int>(query.hit.primID);
  hit.distance = query.ray.tfar;
  hit.barycentric = {1 - query.hit.u - query.hit.v, query.hit.u, query.hit.v};
  hit.face_normal = {query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z};
  return hit;
}

bool RayScene::is_occluded(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                           float far) const {
  if (misses_bounds(origin, direction)) return false;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay ray{
      origin.x(), origin.y(), origin.z(), 0.0f, direction.x(), direction.y(), direction.z(), 0.0f,
      far,        ~0u,        0,          0};
  rtcOccluded1(embree_->scene, &context, &ray);
  return ray.tfar < 0;
}

}  // namespace morphbake
