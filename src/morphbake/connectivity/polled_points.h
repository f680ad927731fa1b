#pragma once

#include "morphbake/diagnostics/observer.h"

namespace boost {
struct read_write_property_map_tag;  // headers show no library
}

namespace morphbake {

/// Tells now and then whether to stop, in a loop that has no place of its own for the question.
class Poll {
 public:
  explicit Poll(const Observer& observer) : observer_(observer) {}

  /// @throws Cancelled
  void look() {
    if (++looks_ % kStride == 0) stop_if_cancelled(observer_);
  }

 private:
  static constexpr unsigned kStride = 1024;

  const Observer& observer_;
  unsigned looks_ = 0;
};

/// The points of a CGAL surface, as a property map that stops the algorithm that reads them when
/// the caller has asked to. CGAL's remeshing, distances and intersections have no visitor, but all
/// of them read points all the time, and let what is thrown then through.
template <typename Surface>
class PolledPoints {
 public:
  // NOLINTBEGIN(readability-identifier-naming): Boost asks for these names
  using key_type = typename Surface::Vertex_index;
  using value_type = typename Surface::Point;
  using reference = const value_type&;
  using category = boost::read_write_property_map_tag;
  // NOLINTEND(readability-identifier-naming)

  PolledPoints() = default;  // CGAL makes some before it knows the surface

  /// @param poll  of this thread alone
  PolledPoints(Surface& surface, Poll& poll) : points_(surface.points()), poll_(&poll) {}

  friend reference get(const PolledPoints& map, key_type vertex) {
    map.poll_->look();
    return map.points_[vertex];
  }

  friend void put(const PolledPoints& map, key_type vertex, const value_type& point) {
    map.points_[vertex] = point;
  }

 private:
  typename Surface::template Property_map<key_type, value_type> points_;
  Poll* poll_ = nullptr;
};

}  // namespace morphbake
