#include "pyramid/with_gains.h"

namespace multires {

Field with_gains(const Pyramid& pyramid, const Field& field, const std::vector<double>& gain) {
    const Coefficients details = pyramid.scheme().analyse(to_places(pyramid.hierarchy(), field));
    return to_input(pyramid.hierarchy(), pyramid.scheme().synthesise(details, with_gain(gain)));
}

}  // namespace multires
