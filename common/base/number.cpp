#include "base/number.h"

#include <locale>
#include <sstream>

namespace multires {

std::string number(double value, int digits) {
    std::ostringstream out;
    out.imbue(std::locale::classic());
    out.precision(digits);
    out << value;
    return out.str();
}

}  // namespace multires
