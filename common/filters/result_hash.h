#pragma once

#include "filters/filter.h"

namespace multires {

/// 52 bits of a hash of all that a result changes, bit for bit; a double holds them exactly. Two calls gave the same
/// if these are the same. 0 if the result changes nothing. Cost: linear, as fast as memory is read.
double result_hash(const Result& result);

}  // namespace multires
