#include "morphbake/transition/fit.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/json/json.h"
#include "morphbake/mesh/adjacency.h"
#include "morphbake/transition/timeline.h"

namespace morphbake {
namespace {

/// How much each vertex belongs to the ring: most where d is a half; of a hard region, its inner
/// border.
Eigen::VectorXd ring_weights(const Connectivity& connectivity, const Eigen::VectorXd& d) {
  Eigen::VectorXd weights = d.array() * (1 - d.array());
  if (weights.maxCoeff() > 1e-6) return weights;
  const OneRings rings = one_rings(connectivity);
  weights.setZero();
  for (std::size_t v = 0; v + 1 < rings.offsets.size(); ++v) {
    for (int n = rings.offsets[v]; n < rings.offsets[v + 1]; ++n) {
      const double outside = d(rings.neighbours[static_cast<std::size_t>(n)]);
      const auto vertex = static_cast<Eigen::Index>(v);
      if (d(vertex) < 0.5 && outside > 0.5) weights(vertex) = 1;
    }
  }
  return weights;
}

/// An edit, what it starts from, and where it stands in the recipe.
struct EditToFit {
  Edit* edit;
  Shares start;
  std::string pointer;
};

std::vector<EditToFit> edits_to_fit(Recipe& recipe) {
  std::vector<EditToFit> found;
  const auto add = [&](Edit& edit, const Shares& start, const std::string& pointer) {
    if (edit.fit != Fit::None) found.push_back({&edit, start, pointer + "/fit"});
  };
  std::vector<Track>& tracks = recipe.timeline.tracks;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    add(tracks[i].edit, recipe.timeline.start, child_pointer("/timeline/tracks", i));
  }
  for (State& state : recipe.states) {
    const std::string edits = child_pointer("/states", state.name) + "/edits";
    for (std::size_t i = 0; i < state.edits.size(); ++i) {
      add(state.edits[i], state.mix, child_pointer(edits, i));
    }
  }
  return found;
}

[[noreturn]] void fail(const Recipe& recipe, const EditToFit& edit, const std::string& message,
                       const std::string& hint) {
  throw BakeError(Problem{Severity::Error, "recipe.cannot-fit", location_in(recipe, edit.pointer),
                          message, hint});
}

Positions fitted_shape(const Recipe& recipe, const MorphableMesh& mesh, const RegionFields& regions,
                       const EditToFit& each) {
  const RegionField& region = regions[static_cast<std::size_t>(each.edit->region)];
  if (region.moves || region.floods) {
    fail(recipe, each, "a region that changes with time has no ring to fit to",
         "leave \"fit\" out, or name a region that stands still");
  }
  const Eigen::VectorXd weights =
      ring_weights(mesh.connectivity, fixed_distance(regions, each.edit->region));
  Positions shape;
  if (weights.maxCoeff() > 0) {
    shape = fitted(mixed_positions(mesh, each.edit->to), mixed_positions(mesh, each.start), weights,
                   each.edit->fit == Fit::Similarity);
  }
  if (shape.rows() == 0) {
    fail(recipe, each, "the ring of this region does not show a direction",
         "a ring goes around something: give the region a soft border, or leave \"fit\" out");
  }
  return shape;
}

/// Gives all shares a row more, of 0.
void add_shape(Recipe& recipe) {
  const auto grow = [](Shares& shares) {
    shares.conservativeResize(shares.rows() + 1, Eigen::NoChange);
    shares.bottomRows(1).setZero();
  };
  if (recipe.timeline.start.size() > 0) grow(recipe.timeline.start);
  for (Track& track : recipe.timeline.tracks) grow(track.edit.to);
  for (State& state : recipe.states) {
    grow(state.mix);
    for (Edit& edit : state.edits) grow(edit.to);
  }
}

}  // namespace

Positions fitted(const Positions& from, const Positions& to, const Eigen::VectorXd& weights,
                 bool scales) {
  const Eigen::VectorXd w = weights / weights.sum();
  const Eigen::RowVector3d from_centre = w.transpose() * from, to_centre = w.transpose() * to;
  const Positions a = from.rowwise() - from_centre, b = to.rowwise() - to_centre;
  const Eigen::Matrix3d covariance = b.transpose() * w.asDiagonal() * a;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d& sigma = svd.singularValues();
  if (!(sigma(1) > 1e-9 * sigma(0))) return {};  // in one line: any turn about it fits
  Eigen::Vector3d sign = Eigen::Vector3d::Ones();
  sign(2) = svd.matrixU().determinant() * svd.matrixV().determinant() < 0 ? -1 : 1;
  const Eigen::Matrix3d R = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  const double spread = w.dot(a.rowwise().squaredNorm());
  const double c = scales ? sigma.dot(sign) / spread : 1;
  return (c * a * R.transpose()).rowwise() + to_centre;
}

void fit_edits(Recipe& recipe, MorphableMesh& mesh, const RegionFields& regions) {
  for (const EditToFit& each : edits_to_fit(recipe)) {
    Eigen::Index most = 0;  // the source that it is made from, or most of it
    each.edit->to.rowwise().sum().maxCoeff(&most);
    mesh.geometries.push_back(fitted_shape(recipe, mesh, regions, each));
    mesh.names.push_back(mesh.names[static_cast<std::size_t>(most)] + " fitted");
    add_shape(recipe);
    each.edit->to.setZero();
    each.edit->to.bottomRows(1).setOnes();
  }
}

}  // namespace morphbake
