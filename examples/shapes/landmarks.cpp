// SPDX-License-Identifier: GPL-3.0-or-later
#include "landmarks.h"

#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace shapes {

std::vector<Landmark> find_landmarks(const Mesh& mesh, const std::vector<LandmarkHint>& hints) {
  std::vector<Vector> near;
  for (const LandmarkHint& hint : hints) near.push_back(hint.near);
  const std::vector<SurfacePoint> at = closest(mesh, near);
  std::vector<Landmark> landmarks;
  for (std::size_t i = 0; i < hints.size(); ++i) landmarks.push_back({hints[i].name, at[i]});
  return landmarks;
}

void write_landmarks(const std::filesystem::path& file, const Mesh& mesh,
                     const std::vector<Landmark>& landmarks) {
  nlohmann::ordered_json json{{"$schema", "../../schemas/landmarks.schema.json"}, {"version", 1}};
  for (const Landmark& landmark : landmarks) {
    Eigen::RowVector3d p = Eigen::RowVector3d::Zero();
    for (int corner = 0; corner < 3; ++corner)
      p += landmark.at.barycentric[corner] *
           mesh.positions.row(mesh.triangles(landmark.at.triangle, corner));
    json["landmarks"][landmark.name]["position"] = {p.x(), p.y(), p.z()};
  }
  std::ofstream out(file, std::ios::binary);
  out << json.dump(2) << '\n';
  if (!out.flush()) throw std::runtime_error("cannot write " + file.string());
}

}  // namespace shapes
