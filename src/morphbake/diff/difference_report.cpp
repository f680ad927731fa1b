#include "morphbake/diff/file_difference.h"
#include "morphbake/json/json.h"
#include "morphbake/version.h"

namespace morphbake {
namespace {

Json to_json(const std::vector<Finding>& findings) {
  Json list = Json::array();
  for (const Finding& finding : findings) {
    list.push_back({{"difference", finding.is_difference},
                    {"kind", finding.kind},
                    {"message", finding.message}});
  }
  return list;
}

Json to_json(const LargestDifference& largest) {
  return {{"value", largest.value},
          {"time", largest.time},
          {"primitive", largest.primitive},
          {"vertex", largest.vertex},
          {"sampling", largest.sampling}};
}

Json to_json(const ClipDifference& clip) {
  Json json;
  json["at_rest"] = clip.is_rest;
  json["names"] = {clip.name_a, clip.name_b};
  json["instants"] = clip.motion.instants;
  if (clip.motion.position.primitive >= 0) json["position"] = to_json(clip.motion.position);
  if (clip.motion.normal.primitive >= 0) json["normal"] = to_json(clip.motion.normal);
  return json;
}

Json to_json(const MeshDifference& mesh) {
  Json json;
  json["name"] = mesh.name;
  json["nodes"] = {mesh.node_a, mesh.node_b};
  json["diagonal"] = mesh.diagonal;
  json["allowed"]["distance"] = mesh.allowed.distance;
  if (mesh.allowed.normal_angle) json["allowed"]["normal_angle"] = *mesh.allowed.normal_angle;
  json["vertices"] = mesh.vertices.distance.size();
  json["vertices_beyond"] = mesh.vertices_beyond;
  json["normals_beyond"] = mesh.normals_beyond;
  json["clips"] = Json::array();
  for (const ClipDifference& clip : mesh.clips) json["clips"].push_back(to_json(clip));
  json["findings"] = to_json(mesh.findings);
  return json;
}

}  // namespace

std::string difference_json(const FileDifference& difference) {
  Json json;
  json["morphbake"] = version_with_commit();
  json["same"] = is_same(difference);
  json["files"] = {difference.file_a, difference.file_b};
  json["findings"] = to_json(difference.findings);
  json["meshes"] = Json::array();
  for (const MeshDifference& mesh : difference.meshes) json["meshes"].push_back(to_json(mesh));
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace morphbake
