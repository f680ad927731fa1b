#pragma once

#include "morphbake/diagnostics/observer.h"
#include "morphbake/landmarks/correspondences.h"
#include "morphbake/sources/source_surface.h"

namespace morphbake {

/// Warns "landmarks.several-pieces".
void warn_of_pieces(const Observer& observer, const SourceSurface& surface,
                    const ShapeSketch& sketch);

/// Warns "correspondence.different-topology" of an open surface beside a closed one.
void warn_of_borders(const Observer& observer, const SourceSurface& a, const SourceSurface& b,
                     const ShapeSketch& sketch_a, const ShapeSketch& sketch_b);

/// Warns "landmarks.mirrored" when the second surface fits the first one far better in a mirror.
void warn_of_mirror(const Observer& observer, const SourceSurface& a, const SourceSurface& b,
                    const Correspondences& all, const Alignment& kept);

/// Warns "landmarks.uncertain" of two signs of wrong pairs: few tips have a partner, or even the
/// best alignment is a bad one. docs/landmarks-measured.md shows on which pairs it does.
void warn_if_uncertain(const Observer& observer, const SourceSurface& a, const SourceSurface& b,
                       const Correspondences& all, const Alignment& kept);

}  // namespace morphbake
