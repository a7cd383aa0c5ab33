#pragma once

#include "operators/relaxation.h"
#include "schemes/scheme.h"

namespace multires {

/// How even vertices are predicted.
enum class Scheme {
    /// From the reconstructed odd vertices, details in world axes (Roy et al. 2003, eq. 4-7).
    roy,
    /// From the predicted odd vertices, details in frames of the predicted surface, so that they turn with it
    /// (Guskov et al. 1999, section 3.2).
    guskov,
};

struct RelaxationTransformOptions {
    Scheme scheme = Scheme::guskov;
    RelaxationOptions relaxation;
    /// Presmoothing before subsampling (Burt and Adelson): even values move by this share of the way to their relaxed
    /// place, in [0, 1]. 0: none, as in both papers; 1 keeps fine bands from aliasing into coarse ones.
    double presmooth = 0;
    bool local_frames = true;  ///< only Scheme::guskov has them
    Storage weights = Storage::wide;
};

/// Pyramid after Burt and Adelson whose subdivision is a relaxation operator R. With f the values of a level:
///
///     analysis   c      = f + presmooth (R f - f)  on even vertices
///                d_odd  = f_odd  - R c
///                g      = c on even, on odd vertices f (Roy) or R c (Guskov)
///                d_even = f_even - R g
///     synthesis  the same lines solved for f, coarse to fine
///
/// Weights are taken from the hierarchy's positions, level by level, and kept. An odd vertex whose row keeps its value
/// (see operators/relaxation.h) is predicted by the vertex it was collapsed into.
/// Cost of both ways: linear in the rows' entries times the width.
std::unique_ptr<Transform> relaxation_transform(const Hierarchy& hierarchy, const RelaxationTransformOptions& options);

}  // namespace multires
