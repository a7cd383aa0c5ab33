#include "bands/transmission.h"

#include <cmath>

namespace multires {

double transmission(LowPassOrder order, double cutoff, double wave) {
    const double s = (cutoff / wave) * (cutoff / wave);
    switch (order) {
    case LowPassOrder::first:
        return 1 / (1 + s);
    case LowPassOrder::second:
        return 1 / (1 + s * s);
    case LowPassOrder::fourth:
        return 1 / (1 + s * s * s * s);
    case LowPassOrder::gaussian:
        return std::exp2(-s);
    }
    return 0;
}

std::vector<Term> terms(LowPassOrder order) {
    const double r = std::sqrt(0.5);
    switch (order) {
    case LowPassOrder::first:
        return {{{1, 0}, {1, 0}}};
    case LowPassOrder::second:
        return {{{0, -1}, {0, -1}}};
    case LowPassOrder::fourth:
        return {{{r, -r}, {r / 2, -r / 2}}, {{-r, -r}, {-r / 2, -r / 2}}};
    case LowPassOrder::gaussian:
        return {{{2.23386982442684, -1.7194412490646}, {0.179393232744664, -5.49870263746996}},
                {{-0.530678512033608, -5.27757073051665}, {-0.209645857568455, 1.30156971626408}}};
    }
    return {};
}

}  // namespace multires
