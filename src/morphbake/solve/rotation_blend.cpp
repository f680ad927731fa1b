#include "morphbake/solve/rotation_blend.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "morphbake/differential/laplacian.h"
#include "morphbake/differential/rotation_vector.h"
#include "morphbake/linear/iterate.h"
#include "morphbake/solve/rotation_passes.h"

namespace morphbake {
namespace {

/// Radians of a step. Steps shrink tenfold each, so no more than a tenth of it is left. What is
/// not fitted afterwards settles further.
constexpr double kSettled = 1e-4;
constexpr double kSettledForGood = 1e-6;
constexpr int kMostSteps = 50;

/// Beyond these nothing is gained that shows: lengths and areas of poses are within 10 % of ARAP's
/// (tests/property/arap_long_test.cpp). Steps beyond what each fit asks for spare as many again.
constexpr int kFits = 3;
constexpr double kRelaxation = 1.8;

TurnedShapes turned_shapes(const MorphableMesh& mesh, const SourceDeformations& deformations) {
  TurnedShapes shapes;
  shapes.mesh = &mesh;
  shapes.rings = one_rings(mesh.connectivity);
  shapes.edges = &deformations.edges;
  shapes.deformations = &deformations.against_first;
  for (const Deformation& deformation : deformations.against_first) {
    std::vector<Eigen::Matrix3d>& back = shapes.back.emplace_back();
    for (const Eigen::Quaterniond& rotation : deformation.rotations) {
      back.push_back(rotation.conjugate().toRotationMatrix());
    }
  }
  return shapes;
}

RotationField field_of(const LaneFrames& frames, int lane) {
  RotationField field;
  for (const LaneQuaternion& rotation : frames.rotations) field.push_back(lane_of(rotation, lane));
  return field;
}

Positions shape_of(const LaneFrames& frames, int lane) {
  Positions shape(static_cast<Eigen::Index>(frames.shape.size()), 3);
  for (std::size_t v = 0; v < frames.shape.size(); ++v) {
    const LaneVector& position = frames.shape[v];
    shape.row(static_cast<Eigen::Index>(v)) << position.x[lane], position.y[lane], position.z[lane];
  }
  return shape;
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
                             const DisplacementSystem& system, const Eigen::VectorXd& reference,
                             const Effort& effort, const Observer& observer)
    : mesh_(mesh),
      source_deformations_(std::move(deformations)),
      edges_(source_deformations_->edges),
      deformations_(source_deformations_->against_first),
      turned_(std::make_unique<TurnedShapes>(turned_shapes(mesh, *source_deformations_))),
      components_(system.components()),
      held_(mesh.connectivity.vertex_count, false),
      holds_(system.holds()),
      gauge_(system.constraints().gauge),
      effort_(effort),
      observer_(observer) {
  root_ = middle_vertices(turned_->rings, components_, edges_, deformations_, gauge_);
  turned_->tree = tree_from(turned_->rings, edges_, root_);
  factorise();
  if (!holds_) {
    fit_sources();
  } else {
    hold(system.constraints().held, reference);
  }
}

/// What is held is turned as it would be if all were: by the reference, with nothing held.
void RotationBlend::hold(const std::vector<bool>& held, const Eigen::VectorXd& reference) {
  const TransitionState all = reference.replicate(1, mesh_.connectivity.vertex_count);
  const std::vector<LaneFrames> groups = synchronised({&all, 1});
  reference_ = field_of(groups.front(), 0);
  reference_differences_ = differences_of(groups).front();
  held_ = held;
  std::vector<int> starts;
  for (std::size_t v = 0; v < held_.size(); ++v) {
    if (!held_[v]) continue;
    root_[static_cast<std::size_t>(components_.label[v])] = -1;
    starts.push_back(static_cast<int>(v));
  }
  std::copy_if(root_.begin(), root_.end(), std::back_inserter(starts),
               [](int root) { return root >= 0; });
  turned_->tree = tree_from(turned_->rings, edges_, starts);
  factorise();
}

RotationBlend::~RotationBlend() = default;

void RotationBlend::factorise() {
  unknowns_ = Unknowns(held_);
  const Eigen::SparseMatrix<double> select = unknowns_.selection();
  const Eigen::SparseMatrix<double> K_L = symmetric_laplacian(turned_->rings);
  equations_.matrix = select.transpose() * Eigen::SparseMatrix<double>(K_L * select);
  number_singular_blocks(unknowns_, components_.label,
                         unknown_parts(unknowns_, components_.label, components_.count),
                         equations_);
  if (effort_.makes_factor) {
    constexpr double kSolvesPerFrame = 8;
    factor_ = std::make_shared<const CholeskyFactor>(
        equations_, Precision::Single,
        cheaper_ordering(equations_.matrix.rows(), kSolvesPerFrame * effort_.frames),
        effort_.orders);
  } else {
    multigrid_ = std::make_unique<const Multigrid>(equations_);
  }
}

/// By the float32 factor, or as well as that.
void RotationBlend::solve_in_place(ColumnRows& columns) const {
  if (factor_) return factor_->solve_in_place(columns);
  constexpr double kSingle = 1e-6;
  for (Eigen::Index first = 0; first < columns.cols(); first += 3) {
    const Eigen::MatrixXd b = columns.middleCols(first, 3);
    Eigen::MatrixXd x = multigrid_->cycle(b);
    StopRule stop;
    stop.tolerance = kSingle * std::sqrt(x.rowwise().squaredNorm().maxCoeff());
    stop.max_iterations = kMostSteps;
    iterate_conjugate_gradients(
        equations_,
        [this](const Eigen::MatrixXd& r) { return Eigen::MatrixXd(multigrid_->cycle(r)); }, b, stop,
        x);
    columns.middleCols(first, 3) = x;
  }
}

/// What the fit makes of the sources, which all fits leave away.
void RotationBlend::fit_sources() {
  for (std::size_t s = 0; s < deformations_.size(); ++s) {
    Eigen::VectorXd shares =
        Eigen::VectorXd::Zero(static_cast<Eigen::Index>(mesh_.geometries.size()));
    shares(static_cast<Eigen::Index>(s + 1)) = 1;
    const TransitionState T = uniform_transition(shares, mesh_.connectivity.vertex_count);
    LaneFrames source({&T, 1});
    const RotationField& own = deformations_[s].rotations;
    for (std::size_t v = 0; v < own.size(); ++v) set_all_lanes(source.rotations[v], own[v]);
    mix_sources(*turned_, source);
    TurnedShapes unfitted = *turned_;
    unfitted.own_fits.clear();
    fit_rotations(unfitted, 1, source);
    std::vector<Eigen::Vector3d> fits;
    for (std::size_t v = 0; v < own.size(); ++v) {
      fits.push_back(rotation_vector(own[v].conjugate() * lane_of(source.rotations[v], 0)));
    }
    turned_->own_fits.push_back(std::move(fits));
  }
}

/// What is held, and the roots, which are turned by the mean shares where their component's place
/// is measured; all others by the turns along the tree.
LaneFrames RotationBlend::first_guess(std::span<const TransitionState> states) const {
  LaneFrames frames(states);
  for (std::size_t v = 0; v < held_.size(); ++v) {
    if (held_[v]) set_all_lanes(frames.rotations[v], reference_[v]);
  }
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const TransitionState& T = states[std::min(lane, states.size() - 1)];
    Eigen::MatrixXd means = Eigen::MatrixXd::Zero(T.rows(), components_.count);
    for (Eigen::Index v = 0; v < T.cols(); ++v) {
      means.col(components_.label[static_cast<std::size_t>(v)]) += gauge_(v) * T.col(v);
    }
    for (std::size_t c = 0; c < root_.size(); ++c) {
      if (root_[c] < 0) continue;
      const auto root = static_cast<std::size_t>(root_[c]);
      Eigen::Vector3d turn = Eigen::Vector3d::Zero();
      for (std::size_t s = 0; s < deformations_.size(); ++s) {
        turn += means(static_cast<Eigen::Index>(s + 1), static_cast<Eigen::Index>(c)) *
                rotation_vector(deformations_[s].rotations[root]);
      }
      set_lane(frames.rotations[root], static_cast<int>(lane), rotation_of(turn));
    }
  }
  turn_along_tree(*turned_, frames);
  return frames;
}

/// Least squares of log(R_a exp(sum_s T_s l_s) R_b^T), by Gauss-Newton steps.
std::vector<LaneFrames> RotationBlend::synchronised(std::span<const TransitionState> states) const {
  std::vector<LaneFrames> groups;
  for (std::size_t first = 0; first < states.size(); first += kLanes) {
    groups.push_back(first_guess(
        states.subspan(first).first(std::min<std::size_t>(kLanes, states.size() - first))));
  }
  // Steps leave each free component's rotation as a whole open: its root keeps what it was given.
  std::vector<std::vector<LaneQuaternion>> root_rotations;
  for (const LaneFrames& frames : groups) root_rotations.push_back(rotations_at_roots(frames));
  const Eigen::Index unknowns = equations_.matrix.rows();
  std::vector<std::array<bool, kLanes>> moves(groups.size());
  for (auto& lanes : moves) lanes.fill(unknowns > 0);
  ColumnRows columns(unknowns, kGroupColumns * static_cast<Eigen::Index>(groups.size()));
  const auto is_moving = [](const std::array<bool, kLanes>& lanes) {
    return std::find(lanes.begin(), lanes.end(), true) != lanes.end();
  };
  for (int step = 0; step < kMostSteps && std::any_of(moves.begin(), moves.end(), is_moving);
       ++step) {
    stop_if_cancelled(observer_);
    for (std::size_t g = 0; g < groups.size(); ++g) {
      put_misfits(*turned_, groups[g], unknowns_.of_row, static_cast<int>(g), columns);
    }
    solve_in_place(columns);
    remove_block_means(equations_, columns);
    for (std::size_t g = 0; g < groups.size(); ++g) {
      turn_by(columns, static_cast<int>(g), unknowns_.of_row, holds_ ? kSettledForGood : kSettled,
              moves[g], groups[g]);
    }
  }
  for (std::size_t g = 0; g < groups.size(); ++g) {
    turn_components(components_, root_, root_rotations[g], groups[g]);
  }
  return groups;
}

/// Fits the rotations to the shape that they give. A correction by the float32 factor leaves 1e-6
/// of the residual, which the next one finds; the first one corrects a mix of sources that may be
/// turned away from one another, and its residual is large.
void RotationBlend::fit(std::vector<LaneFrames>& groups) const {
  for (LaneFrames& frames : groups) mix_sources(*turned_, frames);
  std::vector<std::vector<LaneQuaternion>> root_rotations;
  for (const LaneFrames& frames : groups) root_rotations.push_back(rotations_at_roots(frames));
  ColumnRows columns(mesh_.connectivity.vertex_count,
                     kGroupColumns * static_cast<Eigen::Index>(groups.size()));
  for (int pass = 0; pass <= kFits; ++pass) {
    stop_if_cancelled(observer_);
    for (std::size_t g = 0; g < groups.size(); ++g) {
      put_differences(*turned_, groups[g], Left::Residual, static_cast<int>(g), columns);
    }
    solve_in_place(columns);
    for (std::size_t g = 0; g < groups.size(); ++g) {
      move_by(columns, static_cast<int>(g), groups[g]);
      if (pass > 0) fit_rotations(*turned_, kRelaxation, groups[g]);
    }
  }
  for (std::size_t g = 0; g < groups.size(); ++g) {
    turn_components(components_, root_, root_rotations[g], groups[g]);
  }
}

std::vector<LaneQuaternion> RotationBlend::rotations_at_roots(const LaneFrames& frames) const {
  std::vector<LaneQuaternion> rotations(root_.size());
  for (std::size_t c = 0; c < root_.size(); ++c) {
    if (root_[c] >= 0) rotations[c] = frames.rotations[static_cast<std::size_t>(root_[c])];
  }
  return rotations;
}

std::vector<RotationField> RotationBlend::rotations(std::span<const TransitionState> states) const {
  const std::vector<LaneFrames> groups = synchronised(states);
  std::vector<RotationField> fields;
  for (std::size_t i = 0; i < states.size(); ++i) {
    fields.push_back(field_of(groups[i / kLanes], static_cast<int>(i % kLanes)));
  }
  return fields;
}

/// Of all lanes.
std::vector<Positions> RotationBlend::differences_of(const std::vector<LaneFrames>& groups) const {
  ColumnRows columns(mesh_.connectivity.vertex_count,
                     kGroupColumns * static_cast<Eigen::Index>(groups.size()));
  std::vector<Positions> differences;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    put_differences(*turned_, groups[g], Left::Differences, static_cast<int>(g), columns);
    for (int lane = 0; lane < kLanes; ++lane) {
      const Eigen::Index first = kGroupColumns * static_cast<Eigen::Index>(g) + lane;
      Positions& b = differences.emplace_back(columns.rows(), 3);
      for (Eigen::Index k = 0; k < 3; ++k) b.col(k) = columns.col(first + kLanes * k);
    }
  }
  return differences;
}

std::vector<BlendedShape> RotationBlend::shapes(std::span<const TransitionState> states) const {
  std::vector<LaneFrames> groups = synchronised(states);
  if (!holds_) fit(groups);
  std::vector<Positions> differences = differences_of(groups);
  std::vector<BlendedShape> blended;
  for (std::size_t i = 0; i < states.size(); ++i) {
    BlendedShape& shape = blended.emplace_back();
    shape.differences = std::move(differences[i]);
    if (!holds_) shape.start = shape_of(groups[i / kLanes], static_cast<int>(i % kLanes));
  }
  return blended;
}

}  // namespace morphbake
