#include "morphbake/diff/file_difference.h"

#include <fmt/core.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "morphbake/diff/mesh_findings.h"
#include "morphbake/diff/paired_names.h"
#include "morphbake/gltf/morphed_rows.h"

namespace morphbake {
namespace {

constexpr double kSameDuration = 1e-4;  // seconds
constexpr double kSameWeight = 1e-5;

/// An open file and the meshes of it that are looked at.
struct OpenFile {
  GltfFile file;
  std::vector<ShownMesh> meshes;
};

/// Both results, or the problems of both.
template <typename Result>
std::pair<Result, Result> both(const std::function<Result()>& first,
                               const std::function<Result()>& second) {
  std::pair<Result, Result> results;
  std::vector<Problem> problems, more;
  const auto attempt = [](const std::function<Result()>& make, Result& result,
                          std::vector<Problem>& wrong) {
    try {
      result = make();
    } catch (const BakeError& error) {
      wrong = error.problems();
    }
  };
  tbb::parallel_invoke([&] { attempt(first, results.first, problems); },
                       [&] { attempt(second, results.second, more); });
  problems.insert(problems.end(), more.begin(), more.end());
  if (!problems.empty()) throw BakeError(std::move(problems));
  return results;
}

OpenFile open_file(const std::filesystem::path& path, const DiffOptions& options) {
  OpenFile open{open_gltf(path), {}};
  if (is_chosen(options.node)) {
    open.meshes.push_back(mesh_of_node(open.file, options.node));
    return open;
  }
  open.meshes = shown_meshes(open.file);
  if (open.meshes.empty()) {
    throw BakeError(Problem{Severity::Error,
                            "gltf.no-mesh",
                            {file_of(open.file), "/nodes", 0, 0},
                            "no node of the file has a mesh",
                            "compare files that show a mesh"});
  }
  return open;
}

OpenMesh open_mesh(const OpenFile& open, std::size_t index) {
  const ShownMesh& at = open.meshes[index];
  return {open.file, at, read_base_mesh(open.file, {.node = at.node}),
          TargetRows(open.file, at.mesh)};
}

std::vector<std::string> names_of_meshes(const std::vector<ShownMesh>& meshes) {
  std::vector<std::string> names;
  for (const ShownMesh& mesh : meshes) names.push_back(mesh.name);
  return names;
}

std::vector<std::string> names_of_clips(const std::vector<WeightsAnimation>& clips) {
  std::vector<std::string> names;
  for (const WeightsAnimation& clip : clips) names.push_back(clip.name);
  return names;
}

/// The animations of a mesh's weights; none where there is nothing to weigh.
std::vector<WeightsAnimation> clips_of(const OpenMesh& open) {
  if (open.mesh.target_names.empty()) return {};
  return weights_animations(open.file, open.at.node);
}

AnimationCurve resting(const AnimatedMesh& mesh) {
  AnimationCurve curve;
  curve.values = mesh.rest_weights.transpose().cast<float>();
  return curve;
}

/// The curves of a clip of both files.
struct OwnedCurves {
  AnimationCurve a;
  AnimationCurve b;

  CurvePair pair() const { return {a, b}; }
};

/// Whether both files play the same targets in the same way, as far as names and weights tell.
bool have_same_weights(const OpenMesh& a, const OpenMesh& b, const CurvePair& curves) {
  return a.mesh.target_names.size() == b.mesh.target_names.size() && have_same_keys(curves) &&
         curves.a.interpolation == curves.b.interpolation &&
         curves.a.values.rows() == curves.b.values.rows() &&
         (curves.a.values.size() == 0 ||
          (curves.a.values - curves.b.values).cwiseAbs().maxCoeff() <= kSameWeight);
}

/// All vertices with these weights, scene space: #R by 3.
Positions posed(const OpenMesh& open, const Eigen::VectorXd& weights) {
  AnimatedMesh shape = open.mesh;
  for (std::size_t p = 0; p < shape.primitives.size(); ++p) {
    Float3s& positions = shape.primitives[p].positions;
    Positions moved = positions.cast<double>();
    Float3s displacement(positions.rows(), 3);
    for (std::size_t k = 0; k < open.targets.count(); ++k) {
      const double weight = weights(static_cast<Eigen::Index>(k));
      const TargetPlace place{p, k, MorphedAttribute::Position};
      if (weight == 0 || !open.targets.has(place)) continue;
      open.targets.read(place, 0, positions.rows(), displacement.data());
      moved += weight * displacement.cast<double>();
    }
    positions = moved.cast<float>();
  }
  return morphed_positions(shape, {});
}

/// Length of the bounding box's diagonal at the first key of an animation, or at rest; scene units.
double first_diagonal(const OpenMesh& open) {
  const AnimationCurve& curve = open.mesh.weights;
  const double first = curve.times.empty() ? 0 : curve.times.front();
  const Positions positions = posed(open, value_at(curve, first));
  if (positions.rows() == 0) return 0;
  return (positions.colwise().maxCoeff() - positions.colwise().minCoeff()).norm();
}

double allowed_distance(const DiffOptions& options, double diagonal) {
  const double fraction =
      options.relative.value_or(options.absolute.has_value() ? 0 : kDefaultRelative);
  return std::max(options.absolute.value_or(0), fraction * diagonal);
}

/// Compares two meshes and gathers what is found.
class MeshDiffer {
 public:
  MeshDiffer(const OpenMesh& a, const OpenMesh& b, const DiffOptions& options,
             const Observer& observer)
      : a_(a),
        b_(b),
        options_(options),
        observer_(observer),
        meshes_{{a.mesh, a.targets}, {b.mesh, b.targets}, comparable_primitives(a, b)} {}

  MeshDifference compare() {
    found_.name = a_.at.name;
    found_.node_a = a_.at.node;
    found_.node_b = b_.at.node;
    found_.primitives = meshes_.primitives;
    found_.vertices = no_differences(meshes_);
    found_.findings = mesh_findings(a_, b_, options_);
    if (a_.at.name != b_.at.name) {
      note_or_differ(
          "name", fmt::format("the mesh is called \"{}\" against \"{}\"", a_.at.name, b_.at.name));
    }
    found_.diagonal = first_diagonal(a_);
    found_.allowed.distance = allowed_distance(options_, found_.diagonal);
    compare_clip({true, "", "", {}}, {resting(a_.mesh), resting(b_.mesh)});
    compare_animations();
    judge_normals();
    count_vertices();
    return std::move(found_);
  }

 private:
  void differ(const char* kind, std::string message) {
    found_.findings.push_back({true, kind, std::move(message)});
  }

  void note_or_differ(const char* kind, std::string message) {
    found_.findings.push_back({options_.strict, kind, std::move(message)});
  }

  void compare_animations() {
    const std::vector<WeightsAnimation> in_a = clips_of(a_), in_b = clips_of(b_);
    const NamePairs names = paired_names(names_of_clips(in_a), names_of_clips(in_b));
    for (const std::size_t i : names.only_a) {
      differ("animations", fmt::format("animation \"{}\" is in the first file only", in_a[i].name));
    }
    for (const std::size_t j : names.only_b) {
      differ("animations",
             fmt::format("animation \"{}\" is in the second file only", in_b[j].name));
    }
    for (const auto& [i, j] : names.pairs) {
      if (in_a[i].name != in_b[j].name) {
        differ("animations", fmt::format("an animation is called \"{}\" against \"{}\"",
                                         in_a[i].name, in_b[j].name));
      }
      if (std::abs(in_a[i].duration - in_b[j].duration) > kSameDuration) {
        differ("duration", fmt::format("animation \"{}\" ends at {:.6g} s against {:.6g} s",
                                       in_a[i].name, in_a[i].duration, in_b[j].duration));
      }
      compare_clip({false, in_a[i].name, in_b[j].name, {}},
                   {weights_curve(a_.file, a_.at.node, in_a[i].index),
                    weights_curve(b_.file, b_.at.node, in_b[j].index)});
    }
  }

  void compare_clip(ClipDifference clip, const OwnedCurves& curves) {
    if (!have_same_weights(a_, b_, curves.pair())) {
      has_same_weights_ = false;
      note_or_differ("weights", fmt::format("{}: other weights", shown(clip)));
    }
    clip.motion = compare_motions(meshes_, curves.pair(), {!options_.strict, options_.threads},
                                  found_.vertices, observer_);
    const LargestDifference& worst = clip.motion.position;
    if (worst.value > found_.allowed.distance) {
      const double share = found_.diagonal > 0 ? worst.value / found_.diagonal : 0;
      differ("positions",
             fmt::format("{}: vertex {} of primitive {} is {:.3g} away ({:.3g} of the diagonal) at "
                         "{:.4g} s; {:.3g} is allowed",
                         shown(clip), worst.vertex, worst.primitive, worst.value, share, worst.time,
                         found_.allowed.distance));
    }
    found_.clips.push_back(std::move(clip));
  }

  /// Only once all clips are known: one that has other weights has other targets.
  void judge_normals() {
    const bool is_judged =
        options_.normal_angle.has_value() || options_.strict || has_same_weights_;
    const double allowed = options_.normal_angle.value_or(kDefaultNormalAngle);
    if (is_judged) found_.allowed.normal_angle = allowed;
    for (const ClipDifference& clip : found_.clips) {
      const LargestDifference& worst = clip.motion.normal;
      if (worst.value <= allowed) continue;
      std::string message = fmt::format(
          "{}: the normal of vertex {} of primitive {} is turned by {:.3g} degrees at {:.4g} s; ",
          shown(clip), worst.vertex, worst.primitive, worst.value, worst.time);
      message += is_judged ? fmt::format("{:.3g} are allowed", allowed)
                           : "not judged, for normals depend on the targets and these are others";
      found_.findings.push_back({is_judged, "normals", std::move(message)});
    }
  }

  void count_vertices() {
    const VertexDifferences& vertices = found_.vertices;
    const auto beyond = [](const Eigen::VectorXd& values, double allowed) {
      return static_cast<std::size_t>((values.array() > allowed).count());
    };
    found_.vertices_beyond = beyond(vertices.distance, found_.allowed.distance);
    if (!found_.allowed.normal_angle) return;
    found_.normals_beyond = beyond(vertices.normal_angle, *found_.allowed.normal_angle);
  }

  static std::string shown(const ClipDifference& clip) {
    return clip.is_rest ? "at rest" : fmt::format("animation \"{}\"", clip.name_a);
  }

  const OpenMesh& a_;
  const OpenMesh& b_;
  const DiffOptions& options_;
  const Observer& observer_;
  MeshPair meshes_;
  MeshDifference found_;
  bool has_same_weights_ = true;
};

/// A mesh of points or lines has no surface to compare; that is told, and is no error.
bool is_left_out(const ShownMesh& a, const ShownMesh& b, FileDifference& difference) {
  if (a.is_surface && b.is_surface) return false;
  const bool is_difference = a.is_surface != b.is_surface;
  difference.findings.push_back(
      {is_difference, "not-triangles",
       fmt::format("mesh \"{}\" of node {} has points or lines and is not compared", a.name,
                   a.is_surface ? b.node : a.node)});
  return true;
}

void compare_meshes(const OpenFile& a, const OpenFile& b, const DiffOptions& options,
                    const Observer& observer, FileDifference& difference) {
  NamePairs names = paired_names(names_of_meshes(a.meshes), names_of_meshes(b.meshes));
  if (is_chosen(options.node)) names = {{{0, 0}}, {}, {}};
  const auto tell_missing = [&](const ShownMesh& mesh, const char* which) {
    difference.findings.push_back({true, "meshes",
                                   fmt::format("mesh \"{}\" of node {} is in the {} file only",
                                               mesh.name, mesh.node, which)});
  };
  for (const std::size_t i : names.only_a) tell_missing(a.meshes[i], "first");
  for (const std::size_t j : names.only_b) tell_missing(b.meshes[j], "second");
  for (const auto& [i, j] : names.pairs) {
    if (is_left_out(a.meshes[i], b.meshes[j], difference)) continue;
    const auto [in_a, in_b] = both<OpenMesh>([&, k = i] { return open_mesh(a, k); },
                                             [&, k = j] { return open_mesh(b, k); });
    difference.meshes.push_back(MeshDiffer(in_a, in_b, options, observer).compare());
  }
}

bool has_difference(const std::vector<Finding>& findings) {
  return std::ranges::any_of(findings, &Finding::is_difference);
}

}  // namespace

bool is_same(const FileDifference& difference) {
  return !has_difference(difference.findings) &&
         std::ranges::none_of(difference.meshes, [](const MeshDifference& mesh) {
           return has_difference(mesh.findings);
         });
}

FileDifference diff_files(const std::filesystem::path& a, const std::filesystem::path& b,
                          const DiffOptions& options, const Observer& observer) {
  advance(observer, {"load", 0, 1});
  const auto [in_a, in_b] =
      both<OpenFile>([&] { return open_file(a, options); }, [&] { return open_file(b, options); });
  FileDifference difference;
  difference.file_a = a.string();
  difference.file_b = b.string();
  compare_meshes(in_a, in_b, options, observer, difference);
  return difference;
}

}  // namespace morphbake
