#pragma once

#include <string>

namespace multires {

/// A number in words for people: as many significant digits as asked for, a decimal point whatever the locale.
std::string number(double value, int digits = 6);

}  // namespace multires
