#include "morphbake/transition/spatial.h"

#include <fmt/core.h>
#include <muParser.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string_view>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/mesh/centre_of_mass.h"

namespace morphbake {
namespace {

[[noreturn]] void fail(const std::string& message, const std::string& hint) {
  throw BakeError(Problem{Severity::Error, "recipe.expression", {}, message, hint});
}

Eigen::Vector3d direction(const Animated<Eigen::Vector3d>& vector, double time) {
  double largest = 0;  // of the keys, whose lengths do not matter
  for (const Eigen::Vector3d& key : vector.values) {
    largest = std::max(largest, key.cwiseAbs().maxCoeff());
  }
  const Eigen::Vector3d v = vector.at(time) / largest;
  if (!(v.norm() > 1e-12)) {
    fail(fmt::format("the direction is (0, 0, 0) at {:.4g} s", time),
         "between two opposite keys give a third one that is turned sideways");
  }
  return v.normalized();
}

/// An expression with its own x, y, z and t.
struct Formula {
  explicit Formula(const std::string& text) {
    parser.DefineVar("x", &point.x());
    parser.DefineVar("y", &point.y());
    parser.DefineVar("z", &point.z());
    parser.DefineVar("t", &time);
    parser.DefineConst("pi", M_PI);
    parser.SetExpr(text);
  }

  Formula(const Formula&) = delete;
  Formula& operator=(const Formula&) = delete;

  double value() {
    int count = 0;
    const double* values = parser.Eval(count);  // more than one: separated by commas
    if (count != 1) throw mu::ParserError("more than one value: a comma outside of a function");
    return values[0];
  }

  mu::Parser parser;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double time = 0;
};

/// Whether a variable is set, which muParser allows: = not as a part of ==, !=, <= or >=.
bool assigns(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') continue;
    const bool is_compared = i > 0 && std::string_view("=!<>").find(text[i - 1]) != text.npos;
    const bool is_equal = i + 1 < text.size() && text[i + 1] == '=';
    if (!is_compared && !is_equal) return true;
  }
  return false;
}

struct SignedDistance {
  const Positions& points;
  double time;

  template <typename Each>
  Eigen::VectorXd of_each(const Each& each) const {
    Eigen::VectorXd distances(points.rows());
    for (Eigen::Index v = 0; v < points.rows(); ++v) {
      const Eigen::Vector3d p = points.row(v);
      distances(v) = each(p);
    }
    return distances;
  }

  Eigen::VectorXd operator()(const HalfSpace& half) const {
    const Eigen::Vector3d n = direction(half.normal, time);
    return (points * n).array() - half.offset.at(time);
  }

  Eigen::VectorXd operator()(const Slab& slab) const {
    const Eigen::Vector3d n = direction(slab.normal, time);
    const double middle = slab.offset.at(time), half = slab.thickness.at(time) / 2;
    return ((points * n).array() - middle).abs() - half;
  }

  Eigen::VectorXd operator()(const Box& box) const {
    const Eigen::Vector3d centre = box.centre.at(time), half = box.size.at(time) / 2;
    return of_each([&](const Eigen::Vector3d& p) {
      const Eigen::Vector3d q = (p - centre).cwiseAbs() - half;
      return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
    });
  }

  Eigen::VectorXd operator()(const SphereShape& sphere) const {
    const Eigen::RowVector3d centre = sphere.centre.at(time);
    return (points.rowwise() - centre).rowwise().norm().array() - sphere.radius.at(time);
  }

  Eigen::VectorXd operator()(const Cylinder& cylinder) const {
    const Eigen::Vector3d axis = direction(cylinder.axis, time), centre = cylinder.centre.at(time);
    const double radius = cylinder.radius.at(time);
    const bool ends = !cylinder.length.values.empty();
    const double half = ends ? cylinder.length.at(time) / 2 : 0;
    return of_each([&](const Eigen::Vector3d& p) {
      const double along = axis.dot(p - centre);
      const double across = (p - centre - along * axis).norm() - radius;
      if (!ends) return across;
      const Eigen::Vector2d q(across, std::abs(along) - half);
      return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
    });
  }

  Eigen::VectorXd operator()(const Ramp& ramp) const {
    const Eigen::Vector3d from = ramp.from.at(time), way = ramp.to.at(time) - from;
    if (!(way.squaredNorm() > 0)) {
      fail(fmt::format("the ramp's ends lie at one point at {:.4g} s", time),
           "a ramp goes from one point to another");
    }
    return ((points.rowwise() - from.transpose()) * way).array() / way.squaredNorm();
  }

  Eigen::VectorXd operator()(const Expression& expression) const {
    Formula formula(expression.text);
    formula.time = time;
    return of_each([&](const Eigen::Vector3d& p) {
      formula.point = p;
      const double value = formula.value();
      if (!std::isfinite(value)) {
        fail(fmt::format("\"{}\" is {} at x = {:.4g}, y = {:.4g}, z = {:.4g}, t = {:.4g}",
                         expression.text, value, p.x(), p.y(), p.z(), time),
             "keep it away from divisions by zero and roots of negative numbers");
      }
      return value;
    });
  }
};

}  // namespace

Eigen::VectorXd signed_distance(const SpatialRegion& region, const Positions& points, double time) {
  return std::visit(SignedDistance{points, time}, region.shape);
}

namespace {

Eigen::VectorXd mean_distance(const SpatialField& field, double time) {
  const bool is_ramp = std::holds_alternative<Ramp>(field.region.shape);
  const double width = is_ramp ? 0 : field.region.width.at(time);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(field.coordinates.front()->rows());
  for (const auto& coordinates : field.coordinates) {
    const Eigen::ArrayXd distance = signed_distance(field.region, *coordinates, time);
    if (is_ramp) {
      sum.array() += distance.max(0).min(1);
    } else if (width > 0) {
      sum.array() += (distance / width + 0.5).max(0).min(1);
    } else {
      sum.array() += (distance > 0).cast<double>();
    }
  }
  return sum / static_cast<double>(field.coordinates.size());
}

}  // namespace

Eigen::VectorXd spatial_distance(const SpatialField& field, double time) {
  try {
    return mean_distance(field, time);
  } catch (const BakeError& error) {
    std::vector<Problem> problems = error.problems();
    for (Problem& problem : problems) problem.location = field.where;
    throw BakeError(std::move(problems));
  }
}

std::string expression_error(const std::string& text) {
  if (text.find('\0') != std::string::npos) return "it has a zero character in it";
  if (assigns(text)) return "= would change a variable; == compares";
  try {
    Formula(text).value();
    return "";
  } catch (const mu::ParserError& error) {
    return error.GetMsg();
  }
}

bool moves_with_time(const SpatialRegion& region) {
  const bool shape_moves = std::visit(
      [](const auto& shape) {
        using Shape = std::decay_t<decltype(shape)>;
        if constexpr (std::is_same_v<Shape, HalfSpace>) {
          return shape.normal.moves() || shape.offset.moves();
        } else if constexpr (std::is_same_v<Shape, Slab>) {
          return shape.normal.moves() || shape.offset.moves() || shape.thickness.moves();
        } else if constexpr (std::is_same_v<Shape, Box>) {
          return shape.centre.moves() || shape.size.moves();
        } else if constexpr (std::is_same_v<Shape, SphereShape>) {
          return shape.centre.moves() || shape.radius.moves();
        } else if constexpr (std::is_same_v<Shape, Cylinder>) {
          return shape.centre.moves() || shape.axis.moves() || shape.radius.moves() ||
                 shape.length.moves();
        } else if constexpr (std::is_same_v<Shape, Ramp>) {
          return shape.from.moves() || shape.to.moves();
        } else {
          return Formula(shape.text).parser.GetUsedVar().contains("t");
        }
      },
      region.shape);
  return shape_moves || region.width.moves();
}

Positions centred_coordinates(const Mesh& mesh, double unit) {
  const Eigen::Vector3d centre = centre_of_mass(mesh.positions, mesh.triangles);
  return (mesh.positions.rowwise() - centre.transpose()) / unit;
}

}  // namespace morphbake
