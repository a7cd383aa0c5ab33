#include "all_tables.h"
#include "attribute_fixtures.h"
#include "result_numbers.h"
#include "suited.h"
#include "variants.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

// The table of what is wrong with meshes and parameters, and what every filter makes of it: it works, with a result
// that is finite everywhere, or it refuses with an InputError, the one the table names. docs/promises.md tells users.

namespace multires {
namespace {

using namespace plugin;

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Layer with_data(Mesh mesh) {
    return fixtures::marked(fixtures::with_everything(std::move(mesh), fixtures::random_value));
}

Mesh sphere() { return shapes::irregular_sphere(162, {}); }

Mesh scaled(double scale, const Vec3& offset = Vec3::Zero()) {
    Mesh mesh = sphere();
    for (Vec3& p : mesh.positions) p = scale * p + offset;
    return mesh;
}

Mesh in_single_precision(Mesh mesh) {
    for (Vec3& p : mesh.positions) p = p.cast<float>().cast<double>();
    return mesh;
}

Mesh with_faces(Positions positions, Faces faces) { return {std::move(positions), std::move(faces)}; }

Mesh components(int count) {
    Mesh all;
    for (int i = 0; i < count; ++i) {
        const Mesh one = shapes::tetrahedron();
        const auto first = static_cast<Index>(all.positions.size());
        for (const Vec3& p : one.positions) all.positions.push_back(p + Vec3(4.0 * (i % 32), 4.0 * (i / 32), 0));
        for (const Face& f : one.faces) all.faces.push_back({f[0] + first, f[1] + first, f[2] + first});
    }
    return all;
}

/// Quadrilaterals and triangles as MeshLab keeps polygons: the edges within a polygon are faux.
Layer polygonal() {
    Layer layer = with_data(shapes::torus(12, 8));
    layer.faux_edges.assign(layer.mesh.faces.size(), 0);
    for (std::size_t f = 0; f + 1 < layer.mesh.faces.size(); f += 2)  // the diagonal of a quadrilateral
        for (std::size_t side : {f, f + 1})
            for (int k = 0; k < 3; ++k) {
                const Face &a = layer.mesh.faces[side], &b = layer.mesh.faces[side == f ? f + 1 : f];
                const auto in = [&](Index v) { return v == b[0] || v == b[1] || v == b[2]; };
                if (in(a[k]) && in(a[(k + 1) % 3])) layer.faux_edges[side] |= 1 << k;
            }
    return layer;
}

Layer with_bad_attribute(AttributeKind kind, double value) {
    Layer layer = with_data(sphere());
    for (Attribute& a : layer.attributes)
        if (a.kind == kind) a.values[5 * a.width + a.width - 1] = value;
    return layer;
}

Layer with_bad_wedge(double value) {
    Layer layer = with_data(sphere());
    layer.wedges[17].v = value;
    return layer;
}

/// What a filter is to do. Errors are named by a part of their text.
struct Input {
    std::string name;
    Layer (*layer)();
    const char* error = "";  ///< "": must work
    /// For bad attributes: must work, unless the filter computes with the attribute, and then say `error`.
    bool only_if_used = false;
};

Layer bad_position(double value) { return with_data(shapes::not_finite(value)); }

const std::vector<Input>& inputs() {
    static const std::vector<Input> all = {
        {"no_vertices", [] { return Layer(); }, "no vertices"},
        {"points_only",
         [] {
             return with_data({sphere().positions, {}});
         },
         "has no faces"},
        {"one_triangle", [] { return with_data(shapes::triangle()); }},
        {"two_triangles", [] { return with_data(shapes::two_triangles()); }},
        {"faces_that_repeat_a_vertex",
         [] {
             return with_data(with_faces({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 1}, {2, 2, 2}}));
         },
         "all degenerate"},
        {"collinear_faces",
         [] {
             return with_data(with_faces({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, {{0, 1, 2}, {1, 2, 3}}));
         },
         "all degenerate"},
        {"one_point",
         [] {
             return with_data(with_faces({{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}, {{0, 1, 2}}));
         },
         "same point"},
        {"zero_area_parts", [] { return with_data(shapes::collinear_faces()); }},
        {"coincident_vertices", [] { return with_data(shapes::coincident_vertices()); }},
        {"degenerate_faces", [] { return with_data(shapes::degenerate_faces()); }},
        {"nan_position", [] { return bad_position(nan); }, "not a number or infinite"},
        {"infinite_position", [] { return bad_position(inf); }, "not a number or infinite"},
        {"minus_infinite_position", [] { return bad_position(-inf); }, "not a number or infinite"},
        {"nan_color", [] { return with_bad_attribute(AttributeKind::color, nan); }, "finite", true},
        {"nan_quality", [] { return with_bad_attribute(AttributeKind::quality, nan); }, "not a", true},
        {"infinite_quality", [] { return with_bad_attribute(AttributeKind::quality, inf); }, "finite", true},
        {"nan_texcoord", [] { return with_bad_attribute(AttributeKind::texcoord, nan); }, "finite", true},
        {"nan_scalar", [] { return with_bad_attribute(AttributeKind::scalar, nan); }, "finite", true},
        {"infinite_point", [] { return with_bad_attribute(AttributeKind::point, -inf); }, "finite", true},
        {"nan_wedge", [] { return with_bad_wedge(nan); }, "finite", true},
        {"infinite_wedge", [] { return with_bad_wedge(inf); }, "finite", true},
        {"color_1e80", [] { return with_bad_attribute(AttributeKind::color, 1e80); }, "beyond 1e70", true},
        {"quality_1e80", [] { return with_bad_attribute(AttributeKind::quality, -1e80); }, "1e70", true},
        {"scalar_1e300", [] { return with_bad_attribute(AttributeKind::scalar, 1e300); }, "beyond 1e70", true},
        {"wedge_1e300", [] { return with_bad_wedge(1e300); }, "beyond 1e70", true},
        {"enormous_attributes",
         [] {
             return fixtures::marked(
                 fixtures::with_everything(sphere(), [](Index v, int) { return v % 2 ? 1e30 : -1e30; }));
         }},
        {"size_1e-30", [] { return with_data(in_single_precision(scaled(1e-30))); }},
        {"size_1e30", [] { return with_data(in_single_precision(scaled(1e30))); }},
        {"size_1e-80", [] { return with_data(scaled(1e-80)); }, "too small"},
        {"size_1e80", [] { return with_data(scaled(1e80)); }, "too large"},
        {"size_1e308", [] { return with_data(scaled(1e308)); }, "too large"},
        {"sizes_1e-30_and_1e30", [] { return with_data(shapes::join(scaled(1e-30), scaled(1e30))); }},
        {"far_from_the_origin",
         [] {
             return with_data(in_single_precision(scaled(1, {1e6, -1e6, 1e6})));
         }},
        {"far_and_flat",
         [] {
             return with_data(in_single_precision(scaled(0.1, {1e6, 1e6, 1e6})));
         }},
        {"duplicate_vertices", [] { return with_data(shapes::duplicate_vertices()); }},
        {"duplicate_faces", [] { return with_data(shapes::duplicate_faces()); }},
        {"unreferenced_vertices", [] { return with_data(shapes::unreferenced_vertices()); }},
        {"non_manifold_edge", [] { return with_data(shapes::three_faces_on_an_edge()); }},
        {"non_manifold_vertex", [] { return with_data(shapes::bowtie()); }},
        {"moebius_band", [] { return with_data(shapes::moebius_band()); }},
        {"inconsistent_orientation", [] { return with_data(shapes::inconsistent_orientation()); }},
        {"double_sided_triangle", [] { return with_data(shapes::double_sided_triangle()); }},
        {"components_1000", [] { return with_data(components(1000)); }},
        {"valence_3", [] { return with_data(shapes::valence_three()); }},
        {"valence_5000", [] { return with_data(shapes::fan(5000, 0.5)); }},
        {"polygons", [] { return polygonal(); }},
        {"triangular_grid",
         [] {
             return with_data(shapes::grid_terrain({9, 12}));
         }},
        {"triangular_grid_with_holes",
         [] {
             shapes::GridShape shape;
             shape.rows = 12, shape.columns = 15, shape.hole = 3, shape.missing = 0.05;
             return with_data(shapes::grid_terrain(shape));
         }},
    };
    return all;
}

/// The numbers of a result, or why there is none.
struct Outcome {
    std::vector<double> numbers;
    std::string error;
    std::size_t positions = 0;
};

Outcome call(const Filter& filter, const Layer& layer, const std::map<std::string, double>& values) {
    Session session;
    session.progress = Progress([](int percent, const char* what) {
        EXPECT_TRUE(percent >= 0 && percent <= 100) << what << ": " << percent << " %";
        return true;
    });
    Outcome out;
    try {
        const Result result = run(filter, layer, session, values);
        out.numbers = fixtures::numbers(result);
        EXPECT_TRUE(!result.positions || result.positions->size() == layer.mesh.positions.size());
        EXPECT_TRUE(!result.wedges || result.wedges->size() == 3 * layer.mesh.faces.size());
    } catch (const InputError& e) {
        out.error = e.what();
    }
    const auto bad = std::find_if(out.numbers.begin(), out.numbers.end(), [](double x) { return !std::isfinite(x); });
    EXPECT_EQ(bad, out.numbers.end()) << "number " << bad - out.numbers.begin() << " of " << out.numbers.size();
    return out;
}

/// Filters of triangular grids say so of all other meshes.
bool blames_no_grid(const std::string& error) { return error.find("not a triangular grid: ") == 0; }

/// Whether a filter may refuse an input because it is no grid; the inputs that are must work.
bool may_be_no_grid(const Filter& filter, const Input& input) {
    return wants_grid(filter) && input.name.find("triangular_grid") != 0;
}

/// Small meshes have few levels.
bool blames_size(const std::string& error) { return error.find("the number of levels of this mesh") < error.size(); }

std::string filter_name(const testing::TestParamInfo<const Filter*>& info) { return info.param->python_name; }

class BadInput : public testing::TestWithParam<const Filter*> {};

}  // namespace

// With sanitizers each filter and each variant takes every third kind, each another third.
#ifdef MULTIRES_SANITIZED
constexpr std::size_t every = 3;
#else
constexpr std::size_t every = 1;
#endif

TEST_P(BadInput, EveryKindWorksOrIsRefusedAsTheTableSays) {
    std::size_t turn = GetParam()->python_name.size();
    for (const Input& input : inputs()) {
        if (input.only_if_used) continue;  // see BadAttributes
        if (turn++ % every != 0) continue;
        SCOPED_TRACE(input.name);
        const Layer layer = input.layer();
        const Outcome out = call(*GetParam(), layer, {});
        if (may_be_no_grid(*GetParam(), input) && blames_no_grid(out.error)) continue;
        if (*input.error)
            EXPECT_NE(out.error.find(input.error), std::string::npos) << '"' << out.error << '"';
        else
            EXPECT_EQ(out.error, "");
    }
}

TEST_P(BadInput, EveryVariantWorksOrIsRefused) {
    std::size_t kinds = 0;
    for (const Input& input : inputs()) {
        std::size_t turn = kinds++;
        if (input.only_if_used) continue;
        if (input.name == "valence_5000" || input.name == "components_1000") continue;  // the defaults above will do
        const Layer layer = input.layer();
        for (const Variant& variant : variants(*GetParam(), layer)) {
            if (turn++ % every != 0) continue;
            SCOPED_TRACE(input.name + ", " + variant.name);
            const Outcome out = call(*GetParam(), layer, variant.values);
            if (may_be_no_grid(*GetParam(), input) && blames_no_grid(out.error)) continue;
            if (*input.error) {
                EXPECT_NE(out.error, "");
            } else if (!out.error.empty()) {
                EXPECT_TRUE(fixtures::blames_parameters(out.error) || blames_size(out.error)) << out.error;
            }
        }
    }
}

TEST_P(BadInput, AbsurdParametersWorkOrAreRefused) {
    const Layer layer = with_data(suited(*GetParam(), sphere()));
    for (const Declared& d : declared(*GetParam(), &layer)) {
        if (d.type == Declared::Type::boolean || d.type == Declared::Type::text) continue;
        for (const double value :
             {-inf, -1e30, -2147483648.0, -1.0, -1e-30, 0.0, 1e-30, 1.0, 65536.0, 2147483647.0, 1e30, inf, nan, d.least,
              d.most, std::nextafter(d.least, -inf), std::nextafter(d.most, inf), 0.5 * (d.least + d.most)}) {
            const bool whole = d.type == Declared::Type::integer || d.type == Declared::Type::choice;
            if (whole && std::isfinite(value) && value != std::round(value)) continue;
            SCOPED_TRACE(d.name + " = " + std::to_string(value));
            const Outcome out = call(*GetParam(), layer, {{d.name, value}});
            const double slack = 1e-6 * std::abs(value);  // hosts pass single precision: this is the end of the range
            if (!(value >= d.least - slack && value <= d.most + slack)) {
                EXPECT_NE(out.error, "");
            } else if (!out.error.empty()) {  // then for what this parameter is
                EXPECT_TRUE(out.error.find(d.name) != std::string::npos ||
                            out.error.find("gains or fewer steps") != std::string::npos)
                    << out.error;
            }
        }
    }
}

TEST(BadAttributes, OfEveryKindAreRefusedBySomeFiltersAndDoNotHinderTheOthers) {
    for (const Input& input : inputs()) {
        if (!input.only_if_used) continue;
        SCOPED_TRACE(input.name);
        const Layer layer = input.layer();
        std::map<bool, int> worked;
        std::size_t turn = 0;
        for (const Filter* filter : all_filters()) {
            int refused = 0;  // by some variant
            for (const Variant& variant : variants(*filter, layer)) {
                if (turn++ % every != 0) continue;
                const std::string error = call(*filter, layer, variant.values).error;
                if (may_be_no_grid(*filter, input) && blames_no_grid(error)) continue;
                const bool for_this =
                    error.find(input.error) != std::string::npos || error.find("1e70 everywhere") != std::string::npos;
                EXPECT_TRUE(error.empty() || for_this || fixtures::blames_parameters(error) || blames_size(error))
                    << filter->python_name << ", " << variant.name << ": " << error;
                refused += for_this;
            }
            ++worked[refused == 0];
        }
        if (every == 1) {
            EXPECT_GE(worked[false], 1);
        }
        EXPECT_GE(worked[true], 1);
    }
}

INSTANTIATE_TEST_SUITE_P(AllPlugins, BadInput, testing::ValuesIn(all_filters()), filter_name);

}  // namespace multires
