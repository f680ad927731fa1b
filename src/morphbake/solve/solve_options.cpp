#include "morphbake/solve/solve_options.h"

namespace morphbake {

std::string name_of(Solver solver) {
  switch (solver) {
    case Solver::Auto:
      return "auto";
    case Solver::Direct:
      return "direct";
    case Solver::Warm:
      return "warm";
    case Solver::ConjugateGradients:
      return "pcg";
    case Solver::GaussSeidel:
      return "gauss-seidel";
    case Solver::Jacobi:
      return "jacobi";
  }
  return "";
}

}  // namespace morphbake
