// connectivity project RECIPE             the plainest common connectivity, measured: a report
// connectivity copy GLB FOLDER COUNT EDGE  bent copies, with new even edges where EDGE is above 0
// connectivity finer GLB FOLDER LEVELS     a copy with every edge halved, and a little noise
// connectivity shrink PNG PNG WIDTH        a picture, scaled down
//
// Made meshes stand as FOLDER/<stem>_<number>.glb, with their landmarks beside them. Without
// landmarks, eight points far from one another serve.

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <random>

#include "bench/timing.h"
#include "morphbake/bake/load_sources.h"
#include "morphbake/bake/remesh.h"
#include "morphbake/bake/source_surfaces.h"
#include "morphbake/connectivity/measure_triangulation.h"
#include "morphbake/diagnostics/problem.h"
#include "morphbake/files/files.h"
#include "morphbake/gltf/write_mesh.h"
#include "morphbake/images/images.h"
#include "morphbake/mesh/closest_point.h"
#include "morphbake/mesh/measures.h"
#include "morphbake/mesh/normals.h"
#include "morphbake/recipe/read_landmarks.h"
#include "morphbake/recipe/read_recipe.h"

namespace morphbake::bench {
namespace {

namespace fs = std::filesystem;

Positions landmark_positions(const SourceSurface& surface) {
  Positions positions(static_cast<Eigen::Index>(surface.landmarks.size()), 3);
  for (std::size_t i = 0; i < surface.landmarks.size(); ++i) {
    positions.row(static_cast<Eigen::Index>(i)) = position_of(surface.mesh, surface.landmarks[i]);
  }
  return positions;
}

int nearest_vertex(const Positions& positions, const Eigen::RowVector3d& to) {
  Eigen::Index nearest = 0;
  (positions.rowwise() - to).rowwise().squaredNorm().minCoeff(&nearest);
  return static_cast<int>(nearest);
}

/// The first source's triangles, laid on each other one: its vertices after the similarity that
/// brings the landmarks together, then each at the closest point.
SharedTriangulation project(const std::vector<SourceSurface>& surfaces) {
  const Mesh& first = surfaces[0].mesh;
  SharedTriangulation shared;
  shared.connectivity = {static_cast<int>(first.positions.rows()), first.triangles};
  shared.on_boundary.assign(static_cast<std::size_t>(first.positions.rows()), 0);
  shared.geometries.push_back(first.positions);
  shared.on_source.push_back(closest_points(first, first.positions));
  const Positions marks = landmark_positions(surfaces[0]);
  for (Eigen::Index i = 0; i < marks.rows(); ++i) {
    shared.landmarks.push_back(nearest_vertex(first.positions, marks.row(i)));
  }
  for (std::size_t s = 1; s < surfaces.size(); ++s) {
    const Eigen::Matrix4d similarity =
        Eigen::umeyama(marks.transpose(), landmark_positions(surfaces[s]).transpose());
    const Positions aligned =
        (first.positions * similarity.topLeftCorner<3, 3>().transpose()).rowwise() +
        similarity.topRightCorner<3, 1>().transpose();
    Positions& onto = shared.geometries.emplace_back(aligned.rows(), 3);
    const std::vector<SurfacePoint> places = closest_points(surfaces[s].mesh, aligned);
    for (Eigen::Index v = 0; v < onto.rows(); ++v) {
      onto.row(v) = position_of(surfaces[s].mesh, places[static_cast<std::size_t>(v)]);
    }
    shared.on_source.push_back(places);
  }
  return shared;
}

void measure_projection(const fs::path& file) {
  const auto [recipe, sources] = load_aligned(read_recipe(file), {});
  const std::vector<SourceSurface> surfaces = own_surfaces(recipe, sources, {});
  SharedTriangulation shared;
  const double seconds = seconds_of([&] { shared = project(surfaces); });
  RemeshReport report;
  report.recipe = recipe.name;
  report.connectivity = {ConnectivityMode::Remesh,
                         shared.connectivity.vertex_count,
                         static_cast<int>(shared.connectivity.triangles.rows()),
                         {},
                         {{"project", seconds}},
                         {},
                         measure_triangulation(surfaces, shared)};
  std::cout << report_to_json(report);
}

SourceSurface surface_of(const fs::path& file) {
  SourceRef ref{file.stem().string(), file, {}, {}};
  const fs::path beside = landmarks_beside(file);
  if (fs::exists(beside)) ref.landmarks = read_landmarks(beside, beside.string());
  SourceSurface surface = source_surface(load_source(ref), ref, {});
  if (!surface.landmarks.empty()) return surface;
  const Positions& positions = surface.mesh.positions;
  Eigen::VectorXd distance =
      (positions.rowwise() - positions.colwise().mean()).rowwise().squaredNorm();
  for (int i = 0; i < 8; ++i) {
    Eigen::Index furthest = 0;
    distance.maxCoeff(&furthest);
    distance =
        distance.cwiseMin((positions.rowwise() - positions.row(furthest)).rowwise().squaredNorm());
    surface.landmark_names.push_back("tip_" + std::to_string(i));
    surface.landmarks.push_back(closest_point(surface.mesh, positions.row(furthest).transpose()));
  }
  return surface;
}

void write(const fs::path& file, const Mesh& mesh, const std::vector<std::string>& names,
           const Positions& marks) {
  const int count = static_cast<int>(mesh.positions.rows());
  const std::vector<int> groups(mesh.triangles.data(),
                                mesh.triangles.data() + mesh.triangles.size());
  PlainMesh plain;
  plain.name = file.stem().string();
  plain.triangles = mesh.triangles;
  plain.positions = mesh.positions.cast<float>();
  plain.normals = corner_group_normals(mesh.positions, mesh.triangles, groups, count).cast<float>();
  std::vector<Landmark> landmarks;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Eigen::Vector3d at = marks.row(static_cast<Eigen::Index>(i));
    landmarks.push_back({names[i], at});
  }
  PendingOutputs outputs;
  outputs.stage(file, write_mesh_glb(plain, "morphbake bench"));
  outputs.stage(landmarks_beside(file), landmarks_to_json(landmarks, file, {}));
  outputs.commit();
}

fs::path numbered(const fs::path& folder, const fs::path& file, int number) {
  return folder / (file.stem().string() + "_" + std::to_string(number) + ".glb");
}

/// Points bent by a turn that grows along the longest side and a wave across it.
Positions bent(const Positions& points, const Positions& whole, int number) {
  const Eigen::RowVector3d centre = whole.colwise().mean();
  const Eigen::RowVector3d size = whole.colwise().maxCoeff() - whole.colwise().minCoeff();
  Eigen::Index along = 0;
  size.maxCoeff(&along);
  const Eigen::Index across = (along + 1) % 3;
  const double sign = number % 2 == 0 ? 1 : -1;
  Positions moved = points;
  for (Eigen::Index v = 0; v < points.rows(); ++v) {
    const double t = (points(v, along) - centre(along)) / size(along);
    const Eigen::AngleAxisd turn(sign * (0.5 + 0.05 * number) * t,
                                 Eigen::Vector3d::Unit(static_cast<int>(along)));
    moved.row(v) = centre + (points.row(v) - centre) * turn.toRotationMatrix().transpose();
    moved(v, across) += sign * 0.06 * size(along) * std::sin(3 * t + 0.7 * number);
  }
  return moved;
}

void write_copies(const fs::path& file, const fs::path& folder, int count, double edge) {
  const SourceSurface surface = surface_of(file);
  const Positions marks = landmark_positions(surface);
  for (int number = 0; number < count; ++number) {
    SourceSurface copy = surface;
    const bool is_itself = number == 0;
    if (!is_itself) copy.mesh.positions = bent(copy.mesh.positions, surface.mesh.positions, number);
    Mesh mesh = copy.mesh;
    if (!is_itself && edge > 0) {
      RemeshOptions options;
      options.sizing = Sizing::Uniform;
      options.target_edge_length = edge;
      const SharedTriangulation even = resample({copy}, options, {});
      mesh = {even.geometries[0], even.connectivity.triangles};
    }
    write(numbered(folder, file, number), mesh, surface.landmark_names,
          is_itself ? marks : bent(marks, surface.mesh.positions, number));
  }
}

/// Every triangle cut into four at the middles of its edges.
Mesh halved(const Mesh& mesh) {
  std::map<std::pair<int, int>, int> middles;
  std::vector<Eigen::RowVector3d> added;
  const auto first = static_cast<int>(mesh.positions.rows());
  const auto middle = [&](int a, int b) {
    const auto [found, is_new] =
        middles.try_emplace(std::minmax(a, b), first + static_cast<int>(added.size()));
    if (is_new) added.push_back((mesh.positions.row(a) + mesh.positions.row(b)) / 2);
    return found->second;
  };
  Mesh fine;
  fine.triangles.resize(4 * mesh.triangles.rows(), 3);
  for (Eigen::Index f = 0; f < mesh.triangles.rows(); ++f) {
    const Eigen::RowVector3i t = mesh.triangles.row(f);
    const Eigen::RowVector3i m(middle(t(0), t(1)), middle(t(1), t(2)), middle(t(2), t(0)));
    fine.triangles.middleRows<4>(4 * f) << t(0), m(0), m(2), m(0), t(1), m(1), m(2), m(1), t(2),
        m(0), m(1), m(2);
  }
  fine.positions.resize(first + static_cast<Eigen::Index>(added.size()), 3);
  fine.positions.topRows(first) = mesh.positions;
  for (std::size_t i = 0; i < added.size(); ++i) {
    fine.positions.row(first + static_cast<Eigen::Index>(i)) = added[i];
  }
  return fine;
}

void write_finer(const fs::path& file, const fs::path& folder, int levels) {
  const SourceSurface surface = surface_of(file);
  Mesh mesh = surface.mesh;
  for (int level = 0; level < levels; ++level) mesh = halved(mesh);
  std::mt19937 random(1);
  const double amount = 2e-5 * bounding_diagonal(mesh.positions) / 4294967296.0;
  for (Eigen::Index i = 0; i < mesh.positions.size(); ++i) {
    mesh.positions.data()[i] += amount * static_cast<double>(random());
  }
  write(numbered(folder, file, 0), mesh, surface.landmark_names, landmark_positions(surface));
}

void shrink(const fs::path& from, const fs::path& to, int width) {
  const Image picture = decode_image(read_file(from, 1u << 28), from.string());
  PendingOutputs outputs;
  outputs.stage(to, encode_png(scale_down(picture, width, picture.height * width / picture.width)));
  outputs.commit();
}

void run(const std::vector<std::string>& arguments) {
  const std::string& command = arguments.at(0);
  if (command == "project") return measure_projection(arguments.at(1));
  if (command == "copy") {
    return write_copies(arguments.at(1), arguments.at(2), std::stoi(arguments.at(3)),
                        std::strtod(arguments.at(4).c_str(), nullptr));
  }
  if (command == "finer") {
    return write_finer(arguments.at(1), arguments.at(2), std::stoi(arguments.at(3)));
  }
  if (command == "shrink") {
    return shrink(arguments.at(1), arguments.at(2), std::stoi(arguments.at(3)));
  }
  throw std::out_of_range("no such command: " + command);
}

}  // namespace
}  // namespace morphbake::bench

int main(int argc, char** argv) {
  try {
    morphbake::bench::run({argv + 1, argv + argc});
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
