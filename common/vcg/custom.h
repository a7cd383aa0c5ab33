#pragma once

#include <vcg/complex/complex.h>

#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

/// Custom attributes of vcg meshes by their types, which vcg knows at run time only.
namespace multires::vcg_detail {

template <class... T>
struct Types {};

/// Types of custom attributes that travel to a layer.
using LayerTypes = Types<float, double, vcg::Point3f, vcg::Point3d>;

/// Types of custom attributes that are copied to a derived mesh.
using CustomTypes = Types<float, double, vcg::Point3f, vcg::Point3d, int, unsigned, short, unsigned short, char,
                          signed char, unsigned char, long, unsigned long, long long, unsigned long long, vcg::Point2f,
                          vcg::Point2d, vcg::Point3i, vcg::Color4b, std::string>;

/// Calls f with the typed data of a custom attribute; false if its type is not in the list.
template <class Container, class F, class... T>
bool visit(const vcg::PointerToAttribute& attribute, Types<T...>, F&& f) {
    const auto as = [&](auto* type) {
        using Data = vcg::SimpleTempData<Container, std::remove_pointer_t<decltype(type)>>;
        if (attribute._type != typeid(*type)) return false;
        f(static_cast<Data&>(*attribute._handle));
        return true;
    };
    return (as(static_cast<T*>(nullptr)) || ...);
}

template <class S>
double component(const S& scalar, int) {
    return scalar;
}
template <class S>
double component(const vcg::Point3<S>& point, int k) {
    return point[k];
}
template <class S>
void set_component(S& scalar, int, double value) {
    scalar = static_cast<S>(value);
}
template <class S>
void set_component(vcg::Point3<S>& point, int k, double value) {
    point[k] = static_cast<S>(value);
}
template <class S>
inline constexpr int width = 1;
template <class S>
inline constexpr int width<vcg::Point3<S>> = 3;

/// What a reference to vcg::SimpleTempData gives by index.
template <class Data>
using ValueOf = std::decay_t<decltype(std::declval<Data>()[std::size_t()])>;

template <class M>
const vcg::PointerToAttribute* find_custom(const M& mesh, const std::string& name) {
    for (const vcg::PointerToAttribute& a : mesh.vert_attr)
        if (!name.empty() && a._name == name) return &a;
    return nullptr;
}

inline void require(bool condition, const char* message) {
    if (!condition) throw std::invalid_argument(message);
}

}  // namespace multires::vcg_detail
