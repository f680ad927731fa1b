#include "morphbake/solve/solve_fields.h"

#include <utility>

#include "morphbake/transition/timeline.h"

namespace morphbake {

Positions solve_goal(const SurfaceSolver& solver, Goal goal, const std::string& name,
                     std::vector<SolveRecord>& records) {
  if (goal.is_blend()) return std::move(goal.blend);
  const DisplacementSystem& system = solver.system();
  const std::vector<Goal> goals = {std::move(goal)};
  std::vector<Eigen::MatrixXd> x = {system.start(goals[0])};
  records.push_back({name, 0, solver.solve(goals, x)[0]});
  return system.displacement(goals[0], x[0]);
}

Positions solve_change(const SurfaceSolver& solver, const Eigen::MatrixXd& change,
                       const std::string& name, std::vector<SolveRecord>& records) {
  return solve_goal(solver, solver.system().goal(change), name, records);
}

SolvedShapes solve_fields(const SurfaceSolver& solver, const MorphableMesh& mesh,
                          const SeparableTimeline& timeline, const Observer& observer) {
  SolvedShapes shapes;
  const auto count = static_cast<int>(timeline.fields.size());
  for (int k = 0; k < count; ++k) {
    advance(observer, {"solve", k, count});
    const TransitionField& field = timeline.fields[static_cast<std::size_t>(k)];
    Positions solved = solve_change(solver, field.change, field.name, shapes.records);
    if (k == 0) {
      shapes.base = mixed_positions(mesh, timeline.reference) + solved;
    } else {
      shapes.names.push_back(field.name);
      shapes.displacements.push_back(std::move(solved));
    }
  }
  return shapes;
}

Positions combine_shapes(const SolvedShapes& shapes, const Eigen::VectorXd& phi) {
  return combine_shapes(shapes, phi, 0, shapes.base.rows());
}

Positions combine_shapes(const SolvedShapes& shapes, const Eigen::VectorXd& phi, Eigen::Index first,
                         Eigen::Index count) {
  Positions positions = shapes.base.middleRows(first, count);
  for (std::size_t k = 0; k < shapes.displacements.size(); ++k) {
    const double share = phi(static_cast<Eigen::Index>(k) + 1);
    if (share != 0) positions += share * shapes.displacements[k].middleRows(first, count);
  }
  return positions;
}

}  // namespace morphbake
