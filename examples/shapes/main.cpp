// SPDX-License-Identifier: GPL-3.0-or-later
// Usage: morphbake_shapes [folder [name...]]
// Writes the example sources and their landmarks; without a folder, beside this program's source.
// Names choose what is written: giraffe, face, bar_straight; relatives come with their first.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "character.h"
#include "glb.h"
#include "landmarks.h"
#include "mesher.h"
#include "models.h"

namespace {

using namespace shapes;

void write(const std::filesystem::path& folder, const std::string& name, const Mesh& mesh,
           const Model& model, const std::vector<Landmark>& landmarks) {
  write_glb(folder / (name + ".glb"), name, model);
  write_landmarks(folder / (name + ".landmarks.json"), mesh, landmarks);
  const AngleReport quality = angles(mesh);
  std::printf("%-18s %6td vertices %6td faces, smallest angle %3.0f degrees, %.2f %% below 15\n",
              name.c_str(), mesh.positions.rows(), mesh.triangles.rows(), quality.smallest,
              100 * quality.below_15);
}

void write_painted(const std::filesystem::path& folder, const std::string& name, Mesh mesh,
                   const std::vector<Landmark>& landmarks, Topology topology = Topology::Sphere) {
  stand_on_floor(mesh);
  check(mesh, name, topology);
  write(folder, name, mesh, painted_model(mesh), landmarks);
}

/// Meshes the base; its variants get the same triangles and landmarks.
void write_family(const std::filesystem::path& folder, const Family& family) {
  const Solid& base = family.base;
  const Topology topology = base.cut_z ? Topology::Disk : Topology::Sphere;
  const Mesh mesh = mesh_surface(base);
  const std::vector<Landmark> landmarks = find_landmarks(mesh, base.landmarks);
  write_painted(folder, base.name, mesh, landmarks, topology);
  for (const Variant& variant : family.variants)
    write_painted(folder, variant.name, varied(mesh, base, variant), landmarks, topology);
}

void write_bars(const std::filesystem::path& folder) {
  const std::vector<NamedMesh> pair = bars();
  const std::vector<Landmark> ends =
      find_landmarks(pair.front().mesh, {{"bottom", {0, -1, 0}}, {"top", {0, 2, 0}}});
  for (const NamedMesh& bar : pair) write_painted(folder, bar.name, bar.mesh, ends);
}

void write_foxes(const std::filesystem::path& folder) {
  for (const Dressed& fox : dressed(foxes()))
    write(folder, fox.name, fox.mesh, fox.model, fox.landmarks);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const std::filesystem::path folder = argc > 1 ? argv[1] : MORPHBAKE_SHAPES_FOLDER;
    std::filesystem::create_directories(folder);
    const std::set<std::string> chosen(argv + std::min(argc, 2), argv + argc);
    const auto wanted = [&](const std::string& name) {
      return chosen.empty() || chosen.count(name);
    };
    const std::vector<Family> families{{egg()}, {giraffe()}, {horse()}, {bird()},
                                       {cow()}, {pig()},     faces(),   creatures()};
    for (const Family& family : families)
      if (wanted(family.base.name)) write_family(folder, family);
    if (wanted("fox")) write_foxes(folder);
    if (wanted("bar_straight")) write_bars(folder);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "morphbake_shapes: %s\n", error.what());
    return 1;
  }
}
