#pragma once

#include "solvers/system.h"

#include <vector>

/// Low passes with a known transmission: how much of a wave each leaves.
namespace multires {

/// Kinds of low pass, by how steeply they separate long waves from short ones. With s = (cutoff / wave)^2:
enum class LowPassOrder {
    first,     ///< 1 / (1 + s), the membrane
    second,    ///< 1 / (1 + s^2), the spline filter of ISO 16610-22
    fourth,    ///< 1 / (1 + s^4)
    gaussian,  ///< exp(-ln 2 s), ISO 16610-21, within 1.4e-4
};

/// The share of a wave that is left, in [0, 1]: 1/2 where it is as long as the cutoff.
/// @param cutoff, wave  lengths in the same unit, > 0
double transmission(LowPassOrder order, double cutoff, double wave);

/// The same as a sum of simple poles in s, for System::rational: T(s) = sum of Re w / (s + z).
///
/// Those of 1 / (1 + s^n) are the n-th roots of -1, one of each conjugate pair with twice the residue. The Gaussian's
/// are those of the Caratheodory-Fejer approximation of exp(-x), x = ln 2 s, of type (3, 4) (Trefethen, Weideman and
/// Schmelzer 2006), with weights refitted for the least error that leaves constants alone: T(0) = 1.
std::vector<Term> terms(LowPassOrder order);

}  // namespace multires
