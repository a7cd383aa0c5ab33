#include "filters/attributes/texcoord.h"

#include "fixtures.h"
#include "measure/measure.h"

#include <cmath>

namespace multires {

using namespace fixtures;

namespace {

struct Mapped {
    Result result;
    const std::vector<double>& uv() const { return result.attributes.at(0).values; }
    const std::vector<Wedge>& wedges() const { return *result.wedges; }
    int reported(const std::string& key) const {
        for (const Report::Entry& e : result.report.entries())
            if (e.key == key) return std::get<int>(e.value);
        ADD_FAILURE() << "no " << key;
        return -1;
    }
};

Mapped map(const Layer& layer, const TexcoordOptions& options) {
    Session session;
    return {generate_texcoord(layer, options, session)};
}

Mapped map(const Mesh& mesh, const TexcoordOptions& options) {
    Layer layer;
    layer.mesh = mesh;
    return map(layer, options);
}

TexcoordOptions about_z(Projection projection, int coarse_vertices = 300) {
    TexcoordOptions o;
    o.projection = projection;
    o.axis = ProjectionAxis::z;
    o.coarse_vertices = coarse_vertices;
    o.pyramid.hierarchy.base_vertices = std::min(100, coarse_vertices);
    return o;
}

double span(const Wedge* w) { return std::max({w[0].u, w[1].u, w[2].u}) - std::min({w[0].u, w[1].u, w[2].u}); }

/// Twice the signed area of a face in the picture.
double area(const Wedge* w) { return (w[1].u - w[0].u) * (w[2].v - w[0].v) - (w[2].u - w[0].u) * (w[1].v - w[0].v); }

/// Wedges must say what the vertices say, but for whole turns and poles.
void expect_wedges_follow_vertices(const Mesh& mesh, const Mapped& m) {
    for (std::size_t c = 0; c < m.wedges().size(); ++c) {
        const std::size_t v = mesh.faces[c / 3][c % 3];
        EXPECT_EQ(m.wedges()[c].v, m.uv()[2 * v + 1]);
        const double turns = m.wedges()[c].u - m.uv()[2 * v];
        if (m.reported("pole_faces") == 0) {
            EXPECT_NEAR(turns, std::round(turns), 1e-12);
        }
    }
}

TEST(Texcoord, CylinderIsUnrolledWithoutFacesTheWrongWayRound) {
    const Mesh mesh = shapes::open_cylinder(60, 30);
    const Mapped m = map(mesh, about_z(Projection::cylindrical));
    EXPECT_EQ(m.reported("pole_faces"), 0);
    EXPECT_GE(m.reported("seam_faces"), 60) << "two for each of 30 rows";
    double total = 0;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const Wedge* w = m.wedges().data() + 3 * f;
        EXPECT_LT(span(w), 0.1);
        EXPECT_GT(area(w), 0);
        EXPECT_GE(std::min({w[0].u, w[1].u, w[2].u}), 0);
        total += area(w) / 2;
    }
    EXPECT_NEAR(total, 1, 0.02) << "the whole picture, once";
    expect_wedges_follow_vertices(mesh, m);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const Vec3& p = mesh.positions[v];
        const double turn = std::atan2(p.y(), p.x()) / (2 * std::acos(-1.0)), off = m.uv()[2 * v] - turn;
        EXPECT_NEAR(off, std::round(off), 0.01);
        EXPECT_NEAR(m.uv()[2 * v + 1], (p.z() + 1) / 2, 0.02);
        EXPECT_TRUE(m.uv()[2 * v] >= 0 && m.uv()[2 * v] < 1);
    }
}

TEST(Texcoord, PrincipalAxisOfATurnedCylinderIsItsOwn) {
    const Motion motion;
    const Mesh mesh = shapes::open_cylinder(60, 60, 1, 6);
    TexcoordOptions o = about_z(Projection::cylindrical);
    o.axis = ProjectionAxis::principal;
    const Mapped m = map(motion(mesh), o);
    double low = 1, high = 0;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const double along = (mesh.positions[v].z() + 3) / 6, up = m.uv()[2 * v + 1];
        low = std::min({low, std::abs(up - along), std::abs(1 - up - along)});
        high = std::max(high, std::min(std::abs(up - along), std::abs(1 - up - along)));
    }
    EXPECT_LT(high, 0.02);
}

TEST(Texcoord, SphereHasAFewFacesAtThePolesOnly) {
    for (const Mesh& mesh : {shapes::icosphere(20), shapes::irregular_sphere(4000)}) {
        const Mapped m = map(mesh, about_z(Projection::spherical));
        EXPECT_LE(m.reported("pole_faces"), 2);
        int turned = 0;
        for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
            const Wedge* w = m.wedges().data() + 3 * f;
            turned += area(w) <= 0;
            if (span(w) > 0.5) {
                EXPECT_TRUE(std::min({w[0].v, w[1].v, w[2].v}) < 0.1 || std::max({w[0].v, w[1].v, w[2].v}) > 0.9);
            }
        }
        EXPECT_LE(turned, 8) << "around the poles";
    }
}

TEST(Texcoord, PoleCornersTakeTheMeanOfTheOthers) {
    Mesh mesh = shapes::fan(8, 1);  // vertex 0 on the axis
    const Mapped m = map(mesh, about_z(Projection::cylindrical, 1000));
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const Wedge* w = m.wedges().data() + 3 * f;
        EXPECT_NEAR(span(w), 1 / 8.0, 1e-12);
        for (int k = 0; k < 3; ++k)
            if (mesh.faces[f][k] == 0) {
                EXPECT_NEAR(w[k].u, (w[(k + 1) % 3].u + w[(k + 2) % 3].u) / 2, 1e-12);
            }
    }
}

TEST(Texcoord, PlanarProjectionOfAPlaneIsLinear) {
    const Mesh mesh = shapes::plane(40);
    const Mapped m = map(mesh, about_z(Projection::planar, 400));
    // The four corners are rounded off, which changes the extent that is mapped to 0 .. 1.
    const auto inside = [&](std::size_t v) {
        const Vec3& p = mesh.positions[v];
        return std::hypot(std::min(p.x(), 1 - p.x()), std::min(p.y(), 1 - p.y())) >= 0.35;
    };
    for (int c = 0; c < 2; ++c) {
        double count = 0, x = 0, u = 0, xx = 0, xu = 0;
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            if (!inside(v)) continue;
            const double at = mesh.positions[v][c], to = m.uv()[2 * v + c];
            ++count, x += at, u += to, xx += at * at, xu += at * to;
        }
        const double slope = (count * xu - x * u) / (count * xx - x * x);
        EXPECT_NEAR(slope, 1, 0.06);
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            if (!inside(v)) continue;
            EXPECT_NEAR(m.uv()[2 * v + c], (u + slope * (count * mesh.positions[v][c] - x)) / count, 0.005);
        }
    }
    expect_wedges_follow_vertices(mesh, m);
}

TEST(Texcoord, VariesMoreSmoothlyThanAProjectionOfTheRoughMesh) {
    const Mesh clean = shapes::irregular_sphere(4000);
    Mesh mesh = clean;
    shapes::Random random(7);
    for (Vec3& p : mesh.positions) p *= 1 + random.uniform(-0.02, 0.02);
    // Roughness: how far v is from its mean around it, by weights that know the true geometry.
    const Rings rings = vertex_rings(clean);
    const RingWeights weights = ring_weights(rings, clean.positions);
    const auto roughness = [&](const std::vector<double>& uv) {
        Positions v;
        for (std::size_t i = 0; i < clean.positions.size(); ++i) v.emplace_back(uv[2 * i + 1], 0, 0);
        return displacement(v, relaxed(rings, weights, v)).rms;
    };
    const double direct = roughness(map(mesh, about_z(Projection::cylindrical, 100000)).uv());
    const double smooth = roughness(map(mesh, about_z(Projection::cylindrical, 300)).uv());
    EXPECT_LT(smooth, 0.5 * direct);
}

TEST(Texcoord, ExistingCoordinatesAreContinued) {
    Layer layer;
    layer.mesh = shapes::plane(40);
    Attribute uv{AttributeKind::texcoord, "", 2, {}};
    for (const Vec3& p : layer.mesh.positions) {
        uv.values.push_back(2 * p.x() - p.y());
        uv.values.push_back(0.25);
    }
    layer.attributes = {uv};
    const Mapped m = map(layer, about_z(Projection::existing, 200));
    double inside = 0;
    for (std::size_t v = 0; v < layer.mesh.positions.size(); ++v) {
        const Vec3& p = layer.mesh.positions[v];
        EXPECT_NEAR(m.uv()[2 * v + 1], 0.25, 1e-12);
        if (std::min({p.x(), p.y(), 1 - p.x(), 1 - p.y()}) > 0.3)
            inside = std::max(inside, std::abs(m.uv()[2 * v] - uv.values[2 * v]));
    }
    EXPECT_LT(inside, 0.01);
    // From the finest level they come back as they are.
    EXPECT_EQ(map(layer, about_z(Projection::existing, 100000)).uv(), uv.values);
}

TEST(Texcoord, WorksOnEveryClassAndKeepsTextureNumbers) {
    for (const auto& [name, mesh] : every_class())
        for (const Projection projection : {Projection::cylindrical, Projection::spherical, Projection::planar}) {
            Layer layer;
            layer.mesh = mesh;
            for (std::size_t c = 0; c < 3 * mesh.faces.size(); ++c)
                layer.wedges.push_back({0, 0, static_cast<int>(c % 5)});
            TexcoordOptions o;
            o.projection = projection;
            o.coarse_vertices = 50;
            const Mapped m = map(layer, o);
            ASSERT_EQ(m.wedges().size(), layer.wedges.size()) << name;
            ASSERT_EQ(m.uv().size(), 2 * mesh.positions.size()) << name;
            for (const double x : m.uv()) EXPECT_TRUE(std::isfinite(x)) << name;
            for (std::size_t c = 0; c < m.wedges().size(); ++c) {
                const Wedge& w = m.wedges()[c];
                EXPECT_TRUE(std::isfinite(w.u) && w.u >= 0 && w.u < 2 && w.v >= -1e-12 && w.v <= 1 + 1e-12) << name;
                EXPECT_EQ(w.texture, layer.wedges[c].texture) << name;
            }
        }
}

TEST(Texcoord, RefusesWhatIsMissing) {
    Layer layer;
    layer.mesh = shapes::icosphere(4);
    EXPECT_THROW(map(layer, about_z(Projection::existing)), InputError);
    TexcoordOptions o = about_z(Projection::planar);
    o.coarse_vertices = 0;
    EXPECT_THROW(map(layer, o), InputError);
    layer.attributes = {{AttributeKind::texcoord, "", 2, std::vector<double>(2 * layer.mesh.positions.size(), NAN)}};
    EXPECT_THROW(map(layer, about_z(Projection::existing)), InputError);
}

}  // namespace
}  // namespace multires
