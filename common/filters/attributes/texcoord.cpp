#include "filters/attributes/texcoord.h"

#include "base/angles.h"
#include "base/decompositions.h"
#include "filters/channels.h"
#include "measure/measure.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

/// Axes of a projection: u is measured from `a` towards `b`, and `axis` = a x b.
struct Axes {
    Vec3 origin, a, b, axis;
    double nothing = 0;  ///< a distance from the axis that is none
};

/// Second moments of the surface about a point: the exact integrals of x x^T over its triangles.
Eigen::Matrix3d moments(const Mesh& mesh, const Vec3& center) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (const Face& f : mesh.faces) {
        const Vec3 p = mesh.positions[f[0]] - center, q = mesh.positions[f[1]] - center,
                   r = mesh.positions[f[2]] - center, total = p + q + r;
        const double area = 0.5 * (q - p).cross(r - p).norm();
        sum += area / 12 * (p * p.transpose() + q * q.transpose() + r * r.transpose() + total * total.transpose());
    }
    return sum;
}

/// The direction itself or its opposite: the one whose largest component is positive.
Vec3 upright(const Vec3& v) {
    Eigen::Index k = 0;
    v.cwiseAbs().maxCoeff(&k);
    return v[k] < 0 ? Vec3(-v) : v;
}

Axes axes_of(const Mesh& mesh, const TexcoordOptions& o) {
    Axes x;
    x.origin = surface(mesh.faces, mesh.positions).centroid;
    if (o.axis == ProjectionAxis::principal) {
        const Eigen::Matrix3d v = principal_axes(moments(mesh, x.origin)).vectors;  // by ascending variance
        const bool planar = o.projection == Projection::planar;
        x.axis = upright(v.col(planar ? 0 : 2));
        x.a = upright(v.col(planar ? 2 : 1));
    } else {
        const int k = static_cast<int>(o.axis) - static_cast<int>(ProjectionAxis::x);
        x.axis = Vec3::Unit(k);
        x.a = Vec3::Unit((k + 1) % 3);
    }
    x.b = x.axis.cross(x.a);
    x.nothing = 1e-9 * bounding_box(mesh.positions).diagonal();
    return x;
}

/// What is subdivided, at one point.
void project(const Axes& x, Projection projection, const Vec3& point, double* out) {
    const Vec3 d = point - x.origin, local(d.dot(x.a), d.dot(x.b), d.dot(x.axis));
    const double around = std::hypot(local.x(), local.y()), length = local.norm();
    switch (projection) {
    case Projection::cylindrical:
        out[0] = around > x.nothing ? local.x() / around : 0;
        out[1] = around > x.nothing ? local.y() / around : 0;
        out[2] = local.z();
        break;
    case Projection::spherical:
        for (int k = 0; k < 3; ++k) out[k] = length > 0 ? local[k] / length : 0;
        break;
    case Projection::planar:
        out[0] = local.x();
        out[1] = local.y();
        break;
    case Projection::existing:
        break;
    }
}

bool goes_around(Projection p) { return p == Projection::cylindrical || p == Projection::spherical; }

/// The continuous values at the finest level, in order of the input.
Field subdivided(const Layer& layer, const TexcoordOptions& options, const Pyramid& pyramid, std::size_t level,
                 const Axes& axes) {
    const Hierarchy& h = pyramid.hierarchy();
    Field coarse(h.size[level], goes_around(options.projection) ? 3 : 2);
    coarse.has_positions = false;
    if (options.projection == Projection::existing) {
        AttributeChoice own;
        own.texcoord = true;
        const Field given = vertex_channels(layer, own, false).at(0).field;
        for (Index p = 0; p < coarse.rows(); ++p) std::copy_n(given.row(h.order[p]), 2, coarse.row(p));
    } else {
        for (Index p = 0; p < coarse.rows(); ++p)
            project(axes, options.projection, layer.mesh.positions[h.order[p]], coarse.row(p));
    }
    return to_input(h, pyramid.scheme().synthesise({}, starting_at(level, coarse)));
}

/// Range of a channel over the vertices that faces use.
std::pair<double, double> range(const Mesh& mesh, const Field& f, int channel) {
    double low = f.row(mesh.faces[0][0])[channel], high = low;
    for (const Face& face : mesh.faces)
        for (const Index v : face) {
            low = std::min(low, f.row(v)[channel]);
            high = std::max(high, f.row(v)[channel]);
        }
    return {low, high};
}

/// Texture coordinates of the vertices; a pole has none for u.
struct Coordinates {
    std::vector<double> uv;           ///< #V by 2
    std::vector<std::uint8_t> poles;  ///< #V, 1 where the angle has no meaning
};

Coordinates coordinates_of(const Mesh& mesh, Projection projection, const Field& f) {
    Coordinates out{std::vector<double>(2 * mesh.positions.size()),
                    std::vector<std::uint8_t>(mesh.positions.size(), 0)};
    const bool planar = projection == Projection::planar;
    const auto [low_u, high_u] = range(mesh, f, 0);
    const auto [low_v, high_v] = range(mesh, f, projection == Projection::cylindrical ? 2 : 1);
    const double size = planar ? std::max(high_u - low_u, high_v - low_v) : high_v - low_v,
                 scale = size > 0 ? 1 / size : 0;
    for (Index i = 0; i < f.rows(); ++i) {
        const double* x = f.row(i);
        double &u = out.uv[2 * static_cast<std::size_t>(i)], &v = out.uv[2 * static_cast<std::size_t>(i) + 1];
        if (goes_around(projection)) {
            const double around = std::hypot(x[0], x[1]);
            u = std::atan2(x[1], x[0]) / (2 * pi);
            if (u < 0) u += 1;
            if (u >= 1) u = 0;  // a negative angle too small to count
            v = projection == Projection::spherical ? 0.5 + std::atan2(x[2], around) / pi : (x[2] - low_v) * scale;
            out.poles[i] = around <= 1e-9 * std::max(1.0, std::abs(x[2]) * (projection == Projection::spherical));
        } else {
            u = planar ? (x[0] - low_u) * scale : x[0];
            v = planar ? (x[1] - low_v) * scale : x[1];
        }
    }
    return out;
}

/// Difference of two angles in turns, the short way.
double short_way(double turns) { return turns - std::round(turns); }

/// Makes u of a face's corners continuous.
/// @returns  0: it was; 1: the face crosses the seam; 2: it goes around a pole
int unwrap(const std::array<bool, 3>& pole, std::array<double, 3>& u) {
    int first = 0;
    while (first < 3 && pole[first]) ++first;
    if (first == 3) return 0;
    const std::array<double, 3> given = u;
    double sum = 0, turns = 0;
    int count = 0;
    for (int k = 0; k < 3; ++k) {
        if (pole[k]) continue;
        u[k] = given[first] + short_way(given[k] - given[first]);
        sum += u[k], ++count;
    }
    if (count == 3)
        for (int k = 0; k < 3; ++k) turns += short_way(given[(k + 1) % 3] - given[k]);
    for (int k = 0; k < 3; ++k)
        if (pole[k]) u[k] = sum / count;
    const bool below = *std::min_element(u.begin(), u.end()) < 0;
    if (below)
        for (double& x : u) x += 1;
    if (std::abs(turns) > 0.5) return 2;
    return below || *std::max_element(u.begin(), u.end()) >= 1 ? 1 : 0;
}

std::vector<Wedge> wedges_of(const Layer& layer, const Coordinates& c, bool around, Report& report) {
    const Faces& faces = layer.mesh.faces;
    std::vector<Wedge> out = layer.wedges;
    out.resize(3 * faces.size());
    int counts[3] = {0, 0, 0};
    for (std::size_t f = 0; f < faces.size(); ++f) {
        std::array<double, 3> u{};
        std::array<bool, 3> pole{};
        for (int k = 0; k < 3; ++k) {
            u[k] = c.uv[2 * static_cast<std::size_t>(faces[f][k])];
            pole[k] = c.poles[faces[f][k]] != 0;
        }
        if (around) ++counts[unwrap(pole, u)];
        for (int k = 0; k < 3; ++k) {
            out[3 * f + k].u = u[k];
            out[3 * f + k].v = c.uv[2 * static_cast<std::size_t>(faces[f][k]) + 1];
        }
    }
    report.add("seam_faces", counts[1]);
    report.add("pole_faces", counts[2]);
    return out;
}

}  // namespace

Result generate_texcoord(const Layer& layer, const TexcoordOptions& options, Session& session) {
    if (options.coarse_vertices < 1) throw InputError("coarse_vertices must be at least 1");
    const bool existing = options.projection == Projection::existing;
    const auto is_texcoord = [](const Attribute& a) { return a.kind == AttributeKind::texcoord; };
    if (existing && std::none_of(layer.attributes.begin(), layer.attributes.end(), is_texcoord))
        throw InputError("projection: the mesh has no vertex texture coordinates that could be continued");
    Result result;
    const auto pyramid = pyramid_of(layer, options.pyramid, session, result.report);
    require_starts_anywhere(options.pyramid.scheme);
    std::size_t level = 0;
    const Index most = options.coarse_vertices + pyramid->hierarchy().beside;
    while (level + 1 < pyramid->levels().size() && pyramid->levels()[level].vertices > most) ++level;
    session.progress.report(0.9, "Subdividing texture coordinates");
    const Axes axes = axes_of(layer.mesh, options);
    const Field values = subdivided(layer, options, *pyramid, level, axes);
    Coordinates c = coordinates_of(layer.mesh, options.projection, values);

    result.report.add("level", static_cast<int>(level));
    result.report.add("coarse_vertices", static_cast<int>(pyramid->levels()[level].vertices));
    if (!existing) result.report.add("axis", std::vector<double>(axes.axis.data(), axes.axis.data() + 3));
    result.wedges = wedges_of(layer, c, goes_around(options.projection), result.report);
    result.attributes.push_back({AttributeKind::texcoord, "", 2, std::move(c.uv)});
    return result;
}

std::vector<std::size_t> kept_apart(const Layer& layer, const TexcoordOptions& options) {
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < layer.attributes.size(); ++i)
        if (options.projection == Projection::existing && layer.attributes[i].kind == AttributeKind::texcoord)
            kept.push_back(i);
    return kept;
}

}  // namespace multires
