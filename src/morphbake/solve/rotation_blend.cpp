#include "morphbake/solve/rotation_blend.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "morphbake/differential/rotation_vector.h"

namespace morphbake {
namespace {

/// Radians of a step. Steps shrink tenfold each, so no more than a tenth of it is left.
constexpr double kSettled = 1e-6;
constexpr int kMostSteps = 50;

}  // namespace

SourceDeformations source_deformations(const MorphableMesh& mesh) {
  const OneRings rings = one_rings(mesh.connectivity);
  SourceDeformations deformations{edges_of(rings), {}};
  for (std::size_t s = 1; s < mesh.geometries.size(); ++s) {
    deformations.against_first.push_back(deformation_of(rings, deformations.edges,
                                                        mesh.connectivity.triangles,
                                                        mesh.geometries[0], mesh.geometries[s]));
  }
  return deformations;
}

RotationBlend::RotationBlend(const MorphableMesh& mesh,
                             std::shared_ptr<const SourceDeformations> deformations,
                             const Constraints& constraints, const Eigen::VectorXd& reference)
    : mesh_(mesh),
      rings_(one_rings(mesh.connectivity)),
      components_(connected_components(rings_)),
      source_deformations_(std::move(deformations)),
      edges_(source_deformations_->edges),
      deformations_(source_deformations_->against_first),
      held_(mesh.connectivity.vertex_count, false),
      gauge_(constraints.gauge) {
  choose_roots();
  plan_tree();
  const bool holds =
      std::find(constraints.held.begin(), constraints.held.end(), true) != constraints.held.end();
  if (holds) {
    // What is held is turned as it would be if all were: by the reference, with nothing held.
    factorise();
    reference_ = rotations(reference.replicate(1, mesh.connectivity.vertex_count));
    held_ = constraints.held;
    for (std::size_t v = 0; v < held_.size(); ++v) {
      if (held_[v]) root_[static_cast<std::size_t>(components_.label[v])] = -1;
    }
    plan_tree();
  }
  factorise();
}

/// What each vertex is turned by, unrolled: sums of the turns along the tree, as seen in space.
Positions RotationBlend::unrolled(const Deformation& deformation) const {
  Positions turned = Positions::Zero(mesh_.connectivity.vertex_count, 3);
  for (const Step& step : tree_) {
    const auto e = static_cast<std::size_t>(step.edge);
    const Edge& edge = edges_[e];
    const Eigen::Vector3d turn =
        deformation.rotations[static_cast<std::size_t>(edge.a)] * deformation.turns[e];
    turned.row(step.vertex) = step.forward ? (turned.row(edge.a) + turn.transpose()).eval()
                                           : (turned.row(edge.b) - turn.transpose()).eval();
  }
  return turned;
}

/// The vertex of each component whose rotations, unrolled, are nearest to their mean: a component
/// is turned as a whole as its midst is, not as a detail.
void RotationBlend::choose_roots() {
  const auto count = static_cast<std::size_t>(components_.count);
  root_.assign(count, -1);
  for (std::size_t v = components_.label.size(); v-- > 0;) {
    root_[static_cast<std::size_t>(components_.label[v])] = static_cast<int>(v);
  }
  plan_tree();
  Eigen::VectorXd away = Eigen::VectorXd::Zero(gauge_.size());
  for (const Deformation& deformation : deformations_) {
    const Positions turned = unrolled(deformation);
    Positions means = Positions::Zero(components_.count, 3);
    for (Eigen::Index v = 0; v < gauge_.size(); ++v) {
      means.row(components_.label[static_cast<std::size_t>(v)]) += gauge_(v) * turned.row(v);
    }
    for (Eigen::Index v = 0; v < gauge_.size(); ++v) {
      const int component = components_.label[static_cast<std::size_t>(v)];
      away(v) += (turned.row(v) - means.row(component)).squaredNorm();
    }
  }
  std::vector<double> least(count, std::numeric_limits<double>::infinity());
  for (Eigen::Index v = 0; v < gauge_.size(); ++v) {
    const auto component = static_cast<std::size_t>(components_.label[static_cast<std::size_t>(v)]);
    if (!(gauge_(v) > 0) || away(v) >= least[component]) continue;
    least[component] = away(v);
    root_[component] = static_cast<int>(v);
  }
}

/// Breadth first, so that paths are short.
void RotationBlend::plan_tree() {
  const std::size_t vertex_count = components_.label.size();
  std::vector<std::vector<int>> incident(vertex_count);  // edges
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    incident[static_cast<std::size_t>(edges_[e].a)].push_back(static_cast<int>(e));
    incident[static_cast<std::size_t>(edges_[e].b)].push_back(static_cast<int>(e));
  }
  std::vector<bool> is_reached = held_;
  std::vector<int> open;
  for (std::size_t v = 0; v < vertex_count; ++v) {
    if (held_[v]) open.push_back(static_cast<int>(v));
  }
  for (const int root : root_) {
    if (root < 0) continue;
    is_reached[static_cast<std::size_t>(root)] = true;
    open.push_back(root);
  }
  tree_.clear();
  for (std::size_t next = 0; next < open.size(); ++next) {
    const int vertex = open[next];
    for (const int e : incident[static_cast<std::size_t>(vertex)]) {
      const Edge& edge = edges_[static_cast<std::size_t>(e)];
      const int neighbour = edge.a == vertex ? edge.b : edge.a;
      if (is_reached[static_cast<std::size_t>(neighbour)]) continue;
      is_reached[static_cast<std::size_t>(neighbour)] = true;
      tree_.push_back({neighbour, e, edge.b == neighbour});
      open.push_back(neighbour);
    }
  }
}

void RotationBlend::factorise() {
  unknown_.assign(held_.size(), -1);
  int count = 0;
  equations_ = {};
  for (std::size_t v = 0; v < held_.size(); ++v) {
    if (!held_[v]) unknown_[v] = count++;
  }
  std::vector<int> block(static_cast<std::size_t>(components_.count), -1);
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t v = 0; v < held_.size(); ++v) {
    if (held_[v]) continue;
    const auto component = static_cast<std::size_t>(components_.label[v]);
    const bool is_free = root_[component] >= 0;
    if (is_free && block[component] < 0) block[component] = equations_.singular_block_count++;
    equations_.singular_block.push_back(block[component]);
    entries.emplace_back(unknown_[v], unknown_[v], rings_.degree(static_cast<int>(v)));
  }
  for (const Edge& edge : edges_) {
    const int a = unknown_[static_cast<std::size_t>(edge.a)];
    const int b = unknown_[static_cast<std::size_t>(edge.b)];
    if (a < 0 || b < 0) continue;
    entries.emplace_back(a, b, -1.0);
    entries.emplace_back(b, a, -1.0);
  }
  equations_.matrix.resize(count, count);
  equations_.matrix.setFromTriplets(entries.begin(), entries.end());
  factor_.emplace(equations_);
}

std::vector<Eigen::Vector3d> RotationBlend::blended_turns(const Eigen::MatrixXd& T) const {
  std::vector<Eigen::Vector3d> turns(edges_.size(), Eigen::Vector3d::Zero());
  for (std::size_t s = 0; s < deformations_.size(); ++s) {
    const auto row = static_cast<Eigen::Index>(s + 1);
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const double share = (T(row, edges_[e].a) + T(row, edges_[e].b)) / 2;
      turns[e] += share * deformations_[s].turns[e];
    }
  }
  return turns;
}

/// Sets what is held and the roots, which are turned by the mean shares where their component's
/// place is measured.
void RotationBlend::set_known(const Eigen::MatrixXd& T, RotationField& rotations) const {
  Eigen::MatrixXd means = Eigen::MatrixXd::Zero(T.rows(), components_.count);
  for (Eigen::Index v = 0; v < T.cols(); ++v) {
    const auto vertex = static_cast<std::size_t>(v);
    means.col(components_.label[vertex]) += gauge_(v) * T.col(v);
    if (held_[vertex]) rotations[vertex] = reference_[vertex];
  }
  for (std::size_t c = 0; c < root_.size(); ++c) {
    if (root_[c] < 0) continue;
    const auto root = static_cast<std::size_t>(root_[c]);
    Eigen::Vector3d turn = Eigen::Vector3d::Zero();
    for (std::size_t s = 0; s < deformations_.size(); ++s) {
      turn += means(static_cast<Eigen::Index>(s + 1), static_cast<Eigen::Index>(c)) *
              rotation_vector(deformations_[s].rotations[root]);
    }
    rotations[root] = rotation_of(turn);
  }
}

void RotationBlend::turn_along_tree(const std::vector<Eigen::Vector3d>& turns,
                                    RotationField& rotations) const {
  for (const Step& step : tree_) {
    const auto e = static_cast<std::size_t>(step.edge);
    const int from = step.forward ? edges_[e].a : edges_[e].b;
    const Eigen::Vector3d turn = step.forward ? turns[e] : (-turns[e]).eval();
    rotations[static_cast<std::size_t>(step.vertex)] =
        rotations[static_cast<std::size_t>(from)] * rotation_of(turn);
  }
}

/// One Gauss-Newton step: K_L phi = -sum_b log(R_a exp(l) R_b^T), R <- exp(phi) R.
///
/// @return  the largest phi: radians
double RotationBlend::improve(const std::vector<Eigen::Vector3d>& turns,
                              RotationField& rotations) const {
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(equations_.matrix.rows(), 3);
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const auto from = static_cast<std::size_t>(edges_[e].a);
    const auto to = static_cast<std::size_t>(edges_[e].b);
    const Eigen::RowVector3d misfit =
        rotation_vector(rotations[from] * rotation_of(turns[e]) * rotations[to].conjugate());
    if (unknown_[from] >= 0) b.row(unknown_[from]) -= misfit;
    if (unknown_[to] >= 0) b.row(unknown_[to]) += misfit;
  }
  Eigen::MatrixXd phi = factor_->solve(b);
  remove_block_means(equations_, phi);
  for (std::size_t v = 0; v < rotations.size(); ++v) {
    if (unknown_[v] < 0) continue;
    rotations[v] = (rotation_of(phi.row(unknown_[v])) * rotations[v]).normalized();
  }
  return phi.rows() == 0 ? 0 : phi.rowwise().norm().maxCoeff();
}

RotationField RotationBlend::rotations(const Eigen::MatrixXd& T) const {
  RotationField rotations(held_.size(), Eigen::Quaterniond::Identity());
  set_known(T, rotations);
  const RotationField known = rotations;
  const std::vector<Eigen::Vector3d> turns = blended_turns(T);
  turn_along_tree(turns, rotations);
  for (int step = 0; step < kMostSteps && improve(turns, rotations) > kSettled; ++step) {
  }
  // A step leaves each free component's rotation as a whole open: its root is what was set.
  RotationField back(root_.size(), Eigen::Quaterniond::Identity());
  for (std::size_t c = 0; c < root_.size(); ++c) {
    if (root_[c] < 0) continue;
    const auto root = static_cast<std::size_t>(root_[c]);
    back[c] = known[root] * rotations[root].conjugate();
  }
  for (std::size_t v = 0; v < rotations.size(); ++v) {
    const auto component = static_cast<std::size_t>(components_.label[v]);
    if (root_[component] >= 0) rotations[v] = back[component] * rotations[v];
  }
  return rotations;
}

Positions RotationBlend::differences(const Eigen::MatrixXd& T,
                                     const RotationField& rotations) const {
  const Positions& first = mesh_.geometries.front();
  std::vector<Eigen::Matrix3d> R, M;
  for (std::size_t v = 0; v < rotations.size(); ++v) {
    const auto column = static_cast<Eigen::Index>(v);
    Eigen::Matrix3d S = T(0, column) * Eigen::Matrix3d::Identity();
    for (std::size_t s = 0; s < deformations_.size(); ++s) {
      S += T(static_cast<Eigen::Index>(s + 1), column) * deformations_[s].stretches[v];
    }
    R.push_back(rotations[v].toRotationMatrix());
    M.push_back(R.back() * S);
  }
  Positions b = Positions::Zero(first.rows(), 3);
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const Edge& edge = edges_[e];
    const auto a = static_cast<std::size_t>(edge.a), other = static_cast<std::size_t>(edge.b);
    Eigen::Vector3d remainder = Eigen::Vector3d::Zero();
    for (std::size_t s = 0; s < deformations_.size(); ++s) {
      const auto row = static_cast<Eigen::Index>(s + 1);
      remainder += (T(row, edge.a) + T(row, edge.b)) / 2 * deformations_[s].remainders[e];
    }
    const Eigen::Vector3d whole = (first.row(edge.a) - first.row(edge.b)).transpose();
    const Eigen::RowVector3d blended =
        ((M[a] + M[other]) * whole / 2 + (R[a] + R[other]) * remainder / 2).transpose();
    b.row(edge.a) += blended;
    b.row(edge.b) -= blended;
  }
  return b;
}

Goal goal_of_rotations(const DisplacementSystem& system, const RotationBlend& blend,
                       const MorphableMesh& mesh, const Eigen::MatrixXd& T,
                       const Positions& reference) {
  Positions mixed = Positions::Zero(reference.rows(), 3);
  for (std::size_t s = 0; s < mesh.geometries.size(); ++s) {
    mixed += T.row(static_cast<Eigen::Index>(s)).asDiagonal() * mesh.geometries[s];
  }
  const Components& components = system.components();
  std::vector<bool> is_source(static_cast<std::size_t>(components.count), true);
  std::vector<Eigen::Index> first(is_source.size(), -1);
  for (Eigen::Index v = 0; v < T.cols(); ++v) {
    const auto vertex = static_cast<std::size_t>(v);
    const auto component = static_cast<std::size_t>(components.label[vertex]);
    if (first[component] < 0) first[component] = v;
    if (T.col(v) != T.col(first[component]) || (T.col(v).array() == 1).count() != 1 ||
        (T.col(v).array() == 0).count() + 1 != T.rows()) {
      is_source[component] = false;
    }
    if (system.constraints().held[vertex]) mixed.row(v) = reference.row(v);
  }
  if (std::find(is_source.begin(), is_source.end(), false) == is_source.end()) {
    return system.goal_of_shape(Positions::Zero(T.cols(), 3), mixed, std::move(is_source),
                                reference);
  }
  const Positions b = blend.differences(T, blend.rotations(T));
  return system.goal_of_shape(b, mixed, std::move(is_source), reference);
}

}  // namespace morphbake
