#pragma once

#include "filters/shape/band_filters.h"

#include "fixtures.h"

#include <Eigen/LU>

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <variant>

/// What the tests of the filters share: layers, reports by key, and a sphere with two bands.
namespace multires::fixtures {

inline Layer layer_of(Mesh mesh) {
    Layer layer;
    layer.mesh = std::move(mesh);
    return layer;
}

inline Layer with_quality(Layer layer, std::vector<double> quality) {
    layer.attributes.push_back({AttributeKind::quality, "", 1, std::move(quality)});
    return layer;
}

/// What a call is refused with; empty if it is not.
template <class Call>
std::string refusal(const Call& call) {
    try {
        call();
    } catch (const InputError& e) {
        return e.what();
    }
    return "";
}

inline const Report::Value* find(const Report& report, const std::string& key) {
    for (const auto& entry : report.entries())
        if (entry.key == key) return &entry.value;
    ADD_FAILURE() << "the report has no " << key;
    return nullptr;
}

template <class T>
T value(const Report& report, const std::string& key) {
    const Report::Value* v = find(report, key);
    return v ? std::get<T>(*v) : T();
}
inline double number(const Report& report, const std::string& key) { return value<double>(report, key); }
inline int count(const Report& report, const std::string& key) { return value<int>(report, key); }
inline std::vector<double> series(const Report& report, const std::string& key) {
    return value<std::vector<double>>(report, key);
}

inline double largest_distance(const Positions& a, const Positions& b) {
    EXPECT_EQ(a.size(), b.size());
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, (a[i] - b[i]).norm());
    return largest;
}

/// How much of each band is left in a sphere, by least squares of the radii on 1, the low and the high component.
struct BandsLeft {
    double low, high;
    double residual;  ///< RMS of what is neither, in RMS of the high component

    BandsLeft(const shapes::BandedSphere& sphere, const Positions& after) {
        Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
        Vec3 products = Vec3::Zero();
        const auto basis = [&](std::size_t i) { return Vec3(1, sphere.low[i], sphere.high[i]); };
        for (std::size_t i = 0; i < after.size(); ++i) {
            squares += basis(i) * basis(i).transpose();
            products += after[i].norm() * basis(i);
        }
        const Vec3 x = squares.inverse() * products;
        low = x[1];
        high = x[2];
        double rest = 0;
        for (std::size_t i = 0; i < after.size(); ++i) {
            const double missed = after[i].norm() - x.dot(basis(i));
            rest += missed * missed;
        }
        residual = std::sqrt(rest / squares(2, 2));
    }
};

}  // namespace multires::fixtures
