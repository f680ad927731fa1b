#include "morphbake/solve/rotation_blend.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "morphbake/differential/rotation_vector.h"

namespace morphbake {
namespace {

/// Radians of a step. Steps shrink tenfold each, so no more than a tenth of it is left.
constexpr double kSettled = 1e-6;
constexpr int kMostSteps = 50;

constexpr int kFits = 10;

/// The rotation nearest to a matrix, from one close by.
///
/// @see Müller, Bender, Chentanez and Macklin 2016, A robust method to extract the rotational part
///      of deformations
Eigen::Quaterniond nearest_rotation(const Eigen::Matrix3d& A, Eigen::Quaterniond rotation) {
  constexpr int kMostTurns = 20;
  constexpr double kStill = 1e-9;
  for (int turn = 0; turn < kMostTurns; ++turn) {
    const Eigen::Matrix3d R = rotation.toRotationMatrix();
    Eigen::Vector3d omega = Eigen::Vector3d::Zero();
    double along = 0;
    for (int k = 0; k < 3; ++k) {
      omega += R.col(k).cross(A.col(k));
      along += R.col(k).dot(A.col(k));
    }
    omega /= std::abs(along) + 1e-300;
    rotation = (rotation_of(omega) * rotation).normalized();
    if (omega.squaredNorm() < kStill * kStill) break;
  }
  return rotation;
}

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
  for (std::size_t s = 0; s < deformations_.size(); ++s) {
    TransitionState T = TransitionState::Zero(static_cast<Eigen::Index>(mesh.geometries.size()),
                                              mesh.connectivity.vertex_count);
    T.row(static_cast<Eigen::Index>(s + 1)).setOnes();
    const RotationField& own = deformations_[s].rotations;
    const RotationField fit = fitted(T, own, mesh.geometries[s + 1]);
    std::vector<Eigen::Vector3d> misfits;
    for (std::size_t v = 0; v < own.size(); ++v) {
      misfits.push_back(rotation_vector(own[v].conjugate() * fit[v]));
    }
    misfits_.push_back(std::move(misfits));
  }
  choose_roots();
  plan_tree();
  const bool holds =
      std::find(constraints.held.begin(), constraints.held.end(), true) != constraints.held.end();
  if (holds) {
    // What is held is turned as it would be if all were: by the reference, with nothing held.
    factorise();
    const TransitionState all = reference.replicate(1, mesh.connectivity.vertex_count);
    reference_ = rotations({&all, 1}).front();
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

/// sum_s T_s l_s along an edge.
Eigen::Vector3d RotationBlend::turn_of(const TransitionState& T, std::size_t edge) const {
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();
  for (std::size_t s = 0; s < deformations_.size(); ++s) {
    const auto row = static_cast<Eigen::Index>(s + 1);
    const double share = (T(row, edges_[edge].a) + T(row, edges_[edge].b)) / 2;
    turn += share * deformations_[s].turns[edge];
  }
  return turn;
}

/// What is held, and the roots, which are turned by the mean shares where their component's place
/// is measured; all others by the turns along the tree.
RotationField RotationBlend::first_guess(const TransitionState& T) const {
  RotationField rotations(held_.size(), Eigen::Quaterniond::Identity());
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
  for (const Step& step : tree_) {
    const auto e = static_cast<std::size_t>(step.edge);
    const int from = step.forward ? edges_[e].a : edges_[e].b;
    const Eigen::Vector3d turn = turn_of(T, e);
    rotations[static_cast<std::size_t>(step.vertex)] =
        rotations[static_cast<std::size_t>(from)] * rotation_of(step.forward ? turn : -turn);
  }
  return rotations;
}

/// Right-hand side of a Gauss-Newton step: -sum_b log(R_a exp(l) R_b^T), unknowns by 3.
Eigen::MatrixXd RotationBlend::misfits(const TransitionState& T,
                                       const RotationField& rotations) const {
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(equations_.matrix.rows(), 3);
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const auto from = static_cast<std::size_t>(edges_[e].a);
    const auto to = static_cast<std::size_t>(edges_[e].b);
    const Eigen::RowVector3d misfit =
        rotation_vector(rotations[from] * rotation_of(turn_of(T, e)) * rotations[to].conjugate());
    if (unknown_[from] >= 0) b.row(unknown_[from]) -= misfit;
    if (unknown_[to] >= 0) b.row(unknown_[to]) += misfit;
  }
  return b;
}

/// R <- exp(phi) R
///
/// @return  the largest phi: radians
double RotationBlend::turn_by(const Eigen::MatrixXd& phi, RotationField& rotations) const {
  double largest = 0;
  for (std::size_t v = 0; v < rotations.size(); ++v) {
    if (unknown_[v] < 0) continue;
    const Eigen::Vector3d turn = phi.row(unknown_[v]);
    rotations[v] = (rotation_of(turn) * rotations[v]).normalized();
    largest = std::max(largest, turn.squaredNorm());
  }
  return std::sqrt(largest);
}

/// Steps leave each free component's rotation as a whole open: its root keeps what it was given.
void RotationBlend::turn_back(const RotationField& guess, RotationField& rotations) const {
  RotationField back(root_.size(), Eigen::Quaterniond::Identity());
  for (std::size_t c = 0; c < root_.size(); ++c) {
    if (root_[c] < 0) continue;
    const auto root = static_cast<std::size_t>(root_[c]);
    back[c] = guess[root] * rotations[root].conjugate();
  }
  for (std::size_t v = 0; v < rotations.size(); ++v) {
    const auto component = static_cast<std::size_t>(components_.label[v]);
    if (root_[component] >= 0) rotations[v] = back[component] * rotations[v];
  }
}

std::vector<RotationField> RotationBlend::rotations(std::span<const TransitionState> states) const {
  std::vector<RotationField> guesses;
  for (const TransitionState& T : states) guesses.push_back(first_guess(T));
  std::vector<RotationField> fields = guesses;
  std::vector<std::size_t> moving(states.size());
  std::iota(moving.begin(), moving.end(), std::size_t{0});
  if (equations_.matrix.rows() == 0) moving.clear();
  for (int step = 0; step < kMostSteps && !moving.empty(); ++step) {
    Eigen::MatrixXd b(equations_.matrix.rows(), 3 * static_cast<Eigen::Index>(moving.size()));
    for (std::size_t i = 0; i < moving.size(); ++i) {
      b.middleCols(3 * static_cast<Eigen::Index>(i), 3) =
          misfits(states[moving[i]], fields[moving[i]]);
    }
    Eigen::MatrixXd phi = factor_->solve(b);
    remove_block_means(equations_, phi);
    std::vector<std::size_t> still_moving;
    for (std::size_t i = 0; i < moving.size(); ++i) {
      const auto columns = phi.middleCols(3 * static_cast<Eigen::Index>(i), 3);
      if (turn_by(columns, fields[moving[i]]) > kSettled) still_moving.push_back(moving[i]);
    }
    moving = std::move(still_moving);
  }
  for (std::size_t i = 0; i < fields.size(); ++i) {
    for (int fit = 0; fit < kFits; ++fit) {
      const Positions shape = shape_of(states[i], differences(states[i], fields[i]));
      fields[i] = fitted(states[i], fields[i], shape);
    }
    turn_back(guesses[i], fields[i]);
  }
  return fields;
}

std::vector<Eigen::Matrix3d> RotationBlend::blended_stretches(const TransitionState& T) const {
  std::vector<Eigen::Matrix3d> stretches;
  for (Eigen::Index v = 0; v < T.cols(); ++v) {
    Eigen::Matrix3d S = T(0, v) * Eigen::Matrix3d::Identity();
    for (std::size_t s = 0; s < deformations_.size(); ++s) {
      S += T(static_cast<Eigen::Index>(s + 1), v) *
           deformations_[s].stretches[static_cast<std::size_t>(v)];
    }
    stretches.push_back(S);
  }
  return stretches;
}

/// S e + r of an edge as one of its ends sees it, before it is turned.
Eigen::Vector3d RotationBlend::blended_edge(const TransitionState& T,
                                            const std::vector<Eigen::Matrix3d>& S, std::size_t edge,
                                            bool at_first) const {
  const auto [a, b] = edges_[edge];
  const Positions& first = mesh_.geometries.front();
  Eigen::Vector3d remainder = Eigen::Vector3d::Zero();
  for (std::size_t s = 0; s < deformations_.size(); ++s) {
    const auto row = static_cast<Eigen::Index>(s + 1);
    remainder += (T(row, a) + T(row, b)) / 2 * deformations_[s].remainders[edge];
  }
  const Eigen::Vector3d whole = (first.row(a) - first.row(b)).transpose();
  return S[static_cast<std::size_t>(at_first ? a : b)] * whole + remainder;
}

Positions RotationBlend::differences(const TransitionState& T,
                                     const RotationField& rotations) const {
  const std::vector<Eigen::Matrix3d> S = blended_stretches(T);
  std::vector<Eigen::Matrix3d> R;
  for (const Eigen::Quaterniond& rotation : rotations) R.push_back(rotation.toRotationMatrix());
  Positions b = Positions::Zero(T.cols(), 3);
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const Edge& edge = edges_[e];
    const Eigen::RowVector3d blended =
        ((R[static_cast<std::size_t>(edge.a)] * blended_edge(T, S, e, true) +
          R[static_cast<std::size_t>(edge.b)] * blended_edge(T, S, e, false)) /
         2)
            .transpose();
    b.row(edge.a) += blended;
    b.row(edge.b) -= blended;
  }
  return b;
}

/// The shape of given differences, each free component anywhere; what is held as it stands.
Positions RotationBlend::shape_of(const TransitionState& T, const Positions& b) const {
  Positions shape = Positions::Zero(b.rows(), 3);
  (void)T;
  Eigen::MatrixXd right(equations_.matrix.rows(), 3);
  for (std::size_t v = 0; v < unknown_.size(); ++v) {
    if (unknown_[v] >= 0) right.row(unknown_[v]) = b.row(static_cast<Eigen::Index>(v));
  }
  const Eigen::MatrixXd x = factor_->solve(right);
  for (std::size_t v = 0; v < unknown_.size(); ++v) {
    if (unknown_[v] >= 0) shape.row(static_cast<Eigen::Index>(v)) = x.row(unknown_[v]);
  }
  return shape;
}

RotationField RotationBlend::fitted(const TransitionState& T, const RotationField& near,
                                    const Positions& shape) const {
  const std::vector<Eigen::Matrix3d> S = blended_stretches(T);
  std::vector<Eigen::Matrix3d> sums(near.size(), Eigen::Matrix3d::Zero());
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const Edge& edge = edges_[e];
    const Eigen::Vector3d now = (shape.row(edge.a) - shape.row(edge.b)).transpose();
    sums[static_cast<std::size_t>(edge.a)] += now * blended_edge(T, S, e, true).transpose();
    sums[static_cast<std::size_t>(edge.b)] += now * blended_edge(T, S, e, false).transpose();
  }
  RotationField rotations = near;
  for (std::size_t v = 0; v < near.size(); ++v) {
    if (held_[v]) continue;
    Eigen::Vector3d misfit = Eigen::Vector3d::Zero();
    for (std::size_t s = 0; s < misfits_.size(); ++s) {
      misfit += T(static_cast<Eigen::Index>(s + 1), static_cast<Eigen::Index>(v)) * misfits_[s][v];
    }
    rotations[v] = nearest_rotation(sums[v], near[v]) * rotation_of(-misfit);
  }
  return rotations;
}

}  // namespace morphbake
