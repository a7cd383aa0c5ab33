#include "fixtures.h"

#include "base/error.h"
#include "stream/bit_model.h"
#include "stream/decoder.h"
#include "stream/encoder.h"
#include "stream/plan.h"
#include "stream/regression.h"
#include "stream/two.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>
#include <string>

namespace multires {
namespace {

using fixtures::every_class;
using stream::Bytes;
using stream::decode;
using stream::Decoder;
using stream::encode;
using stream::EncodeOptions;
using stream::region_first;

constexpr std::size_t small = 1500;  // vertices: more tell nothing new

bool same_bits(const Positions& a, const Positions& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(static_cast<const void*>(a.data()), static_cast<const void*>(b.data()),
                                     a.size() * sizeof(Vec3)) == 0);
}

bool is_finite(const Mesh& mesh) {
    return std::all_of(mesh.positions.begin(), mesh.positions.end(), [](const Vec3& p) { return p.allFinite(); });
}

Layer layer_of(const Mesh& mesh) {
    Layer layer;
    layer.mesh = mesh;
    return layer;
}

/// Colours, a float quality and double points, and wedges that differ between the faces of a vertex.
Layer with_attributes(const Mesh& mesh) {
    Layer layer = layer_of(mesh);
    Attribute color{AttributeKind::color, "", 4, {}}, quality{AttributeKind::quality, "", 1, {}};
    Attribute flow{AttributeKind::point, "flow", 3, {}};
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        for (const int x : {3, 5, 7, 11}) color.values.push_back(static_cast<double>(v * x % 256));
        quality.values.push_back(static_cast<float>(std::sin(0.1 * static_cast<double>(v))));
        for (int c = 0; c < 3; ++c) flow.values.push_back(v % 17 == 0 ? -0.0 : mesh.positions[v][c] / 3);
    }
    layer.attributes = {color, quality, flow};
    for (std::size_t i = 0; i < 3 * mesh.faces.size(); ++i)
        layer.wedges.push_back(
            {static_cast<double>(i % 5) / 7, static_cast<double>(i % 11) / 3, static_cast<int>(i % 3) - 1});
    return layer;
}

void expect_same(const Layer& a, const Layer& b) {
    EXPECT_TRUE(same_bits(a.mesh.positions, b.mesh.positions));
    EXPECT_EQ(a.mesh.faces, b.mesh.faces);
    ASSERT_EQ(a.attributes.size(), b.attributes.size());
    for (std::size_t k = 0; k < a.attributes.size(); ++k) {
        EXPECT_EQ(a.attributes[k].kind, b.attributes[k].kind);
        EXPECT_EQ(a.attributes[k].name, b.attributes[k].name);
        ASSERT_EQ(a.attributes[k].values.size(), b.attributes[k].values.size());
        if (a.attributes[k].values.empty()) continue;
        EXPECT_EQ(std::memcmp(a.attributes[k].values.data(), b.attributes[k].values.data(),
                              8 * a.attributes[k].values.size()),
                  0);
    }
    ASSERT_EQ(a.wedges.size(), b.wedges.size());
    for (std::size_t i = 0; i < a.wedges.size(); ++i)
        ASSERT_TRUE(a.wedges[i].u == b.wedges[i].u && a.wedges[i].v == b.wedges[i].v &&
                    a.wedges[i].texture == b.wedges[i].texture);
}

void expect_valid(const Layer& layer) {
    const auto n = static_cast<Index>(layer.mesh.positions.size());
    for (const Vec3& p : layer.mesh.positions) ASSERT_TRUE(p.allFinite());
    for (const Face& f : layer.mesh.faces)
        for (const Index v : f) ASSERT_TRUE(v >= 0 && v < n);
    for (const Attribute& a : layer.attributes) ASSERT_EQ(a.values.size(), static_cast<std::size_t>(n * a.width));
}

TEST(Stream, ExactFilesGiveEveryClassOfMeshBackBitForBit) {
    EncodeOptions options;
    options.exact = options.keep_order = true;
    int meshes = 0;
    for (const auto& [name, mesh] : every_class()) {
        if (mesh.positions.size() > small) continue;
        SCOPED_TRACE(name);
        const Layer layer = with_attributes(mesh);
        expect_same(decode(encode(layer, options)), layer);
        ++meshes;
    }
    EXPECT_GT(meshes, 15);
}

TEST(Stream, CoordinatesAreWithinHalfACellAndFacesAreTheSame) {
    for (const auto& [name, mesh] : every_class()) {
        if (mesh.positions.size() > small || mesh.positions.empty() || !is_finite(mesh)) continue;
        SCOPED_TRACE(name);
        EncodeOptions options;
        options.bits = 10;
        options.keep_order = true;
        Decoder decoder;
        const Bytes bytes = encode(layer_of(mesh), options);
        decoder.feed(bytes.data(), bytes.size());
        ASSERT_TRUE(decoder.finished());
        const Layer out = decoder.layer();
        EXPECT_EQ(out.mesh.faces, mesh.faces);
        const double half = 0.5001 * decoder.header().step;
        for (std::size_t v = 0; v < mesh.positions.size(); ++v)
            ASSERT_LE((out.mesh.positions[v] - mesh.positions[v]).cwiseAbs().maxCoeff(), half);
    }
}

/// Fed byte by byte: each prefix is a mesh or says that there is none yet, and vertices only become more.
TEST(Stream, EveryPrefixIsAMesh) {
    for (const auto& [name, mesh] : every_class()) {
        if (mesh.positions.size() > small || !is_finite(mesh)) continue;
        SCOPED_TRACE(name);
        const Bytes bytes = encode(with_attributes(mesh), {});
        Decoder decoder;
        Index before = 0;
        for (const std::uint8_t& b : bytes) {
            decoder.feed(&b, 1);
            if (!decoder.started() || decoder.vertices() == before) continue;
            ASSERT_GT(decoder.vertices(), before);
            before = decoder.vertices();
            expect_valid(decoder.layer());
        }
        EXPECT_TRUE(decoder.finished());
        EXPECT_EQ(before, static_cast<Index>(mesh.positions.size()));
        EXPECT_EQ(decoder.missing(), 0U);
    }
}

TEST(Stream, LimitsStopAtSoManyVerticesOrSoSmallAnError) {
    const Mesh mesh = shapes::torus(40, 30);
    const Bytes bytes = encode(layer_of(mesh), {});
    stream::Limits few, near;
    few.vertices = 300;
    const Index vertices = static_cast<Index>(decode(bytes, few).mesh.positions.size());
    EXPECT_GE(vertices, 300);
    EXPECT_LE(vertices, 303);
    Decoder decoder;
    decoder.feed(bytes.data(), bytes.size() / 2);
    near.error = decoder.error();
    EXPECT_LE(decode(bytes, near).mesh.positions.size(), decoder.layer().mesh.positions.size());
}

/// The faces with all corners below x = 0, as sorted triples of places.
std::set<std::array<double, 9>> faces_below_zero(const Mesh& mesh) {
    std::set<std::array<double, 9>> out;
    for (const Face& f : mesh.faces) {
        std::array<std::array<double, 3>, 3> p{};
        for (int k = 0; k < 3; ++k)
            for (int c = 0; c < 3; ++c) p[k][c] = mesh.positions[f[k]][c];
        if (p[0][0] > 0 || p[1][0] > 0 || p[2][0] > 0) continue;
        std::sort(p.begin(), p.end());
        std::array<double, 9> flat{};
        for (int i = 0; i < 9; ++i) flat[i] = p[i / 3][i % 3];
        out.insert(flat);
    }
    return out;
}

TEST(Stream, ARegionThatComesFirstIsWholeWhileTheRestIsCoarse) {
    const Bytes plain = encode(layer_of(shapes::torus(40, 30)), {});
    Decoder whole;
    EXPECT_THROW(region_first(whole, [](const Vec3&) { return true; }), InputError);
    whole.feed(plain.data(), plain.size());
    const Bytes bytes = region_first(whole, [](const Vec3& p) { return p[0] <= 0; });
    EXPECT_LT(static_cast<double>(bytes.size()), 1.15 * static_cast<double>(plain.size()));
    const std::set<std::array<double, 9>> wanted = faces_below_zero(whole.layer().mesh);
    Decoder decoder;
    Index complete = 0;
    for (const std::uint8_t& b : bytes) {
        const std::size_t before = decoder.missing();
        decoder.feed(&b, 1);
        if (!decoder.started() || decoder.missing() == before) continue;
        const bool all = faces_below_zero(decoder.layer().mesh) == wanted;
        if (all && complete == 0) complete = decoder.vertices();
        EXPECT_EQ(all, complete > 0);  // once it is whole it stays so
    }
    EXPECT_TRUE(decoder.finished());
    EXPECT_GE(complete, 600);
    EXPECT_LE(complete, 800);  // half of 1200, those next to them, and few of the rest
}

/// Whatever is in the region; bits, exactness and order are those of the file that was there before.
TEST(Stream, ARegionFirstChangesNothingOfTheMesh) {
    for (const auto& [name, mesh] : every_class()) {
        if (mesh.positions.size() > small || mesh.positions.empty() || !is_finite(mesh)) continue;
        SCOPED_TRACE(name);
        EncodeOptions options;
        options.keep_order = true;
        for (const bool exact : {false, true}) {
            options.exact = exact;
            const Bytes bytes = encode(layer_of(mesh), options);
            Decoder whole;
            whole.feed(bytes.data(), bytes.size());
            const double middle = mesh.positions[mesh.positions.size() / 2][0];
            expect_same(decode(region_first(whole, [&](const Vec3& p) { return p[0] <= middle; })), whole.layer());
        }
    }
}

TEST(Stream, FewBytesAreClearlyRefused) {
    const Bytes bytes = encode(layer_of(shapes::torus(8, 8)), {});
    const auto message = [](const Bytes& b) -> std::string {
        try {
            decode(b);
            return "";
        } catch (const InputError& e) {
            return e.what();
        }
    };
    EXPECT_EQ(message(Bytes(bytes.begin(), bytes.begin() + 20)), "the file ends before its first mesh");
    EXPECT_EQ(message({'p', 'l', 'y'}), "this is no .mrm file");
    Bytes later = bytes;
    later[7] = 99;
    EXPECT_EQ(message(later), "this .mrm file is of a version that is not known here");
}

/// All bytes behind the signature are under a checksum or frame what is.
TEST(Stream, AFlippedBitIsFoundOrEndsTheStream) {
    const Bytes bytes = encode(with_attributes(shapes::torus(8, 8)), {});
    int found = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        Bytes damaged = bytes;
        damaged[i] ^= static_cast<std::uint8_t>(1 << i % 8);
        Decoder decoder;
        try {
            decoder.feed(damaged.data(), damaged.size());
            EXPECT_FALSE(decoder.finished()) << i;  // a size that grew: the rest is waited for
        } catch (const InputError&) {
            ++found;
        }
        if (decoder.started()) expect_valid(decoder.layer());
    }
    EXPECT_GT(found, static_cast<int>(bytes.size()) / 2);
}

TEST(Stream, NumbersThatAreNoneNeedExactFiles) {
    Mesh mesh = shapes::torus(6, 6);
    mesh.positions[7].x() = std::numeric_limits<double>::quiet_NaN();
    mesh.positions[9].y() = std::numeric_limits<double>::infinity();
    EXPECT_THROW(encode(layer_of(mesh), {}), InputError);
    EncodeOptions exact;
    exact.exact = exact.keep_order = true;
    expect_same(decode(encode(layer_of(mesh), exact)), layer_of(mesh));
}

TEST(Stream, BitsOutOfRangeAreRefused) {
    const Layer layer = layer_of(shapes::torus(6, 6));
    for (const int bits : {0, 25}) {
        EncodeOptions options;
        options.bits = bits;
        EXPECT_THROW(encode(layer, options), InputError);
    }
    for (const int bits : {1, 2, 24}) {
        EncodeOptions options;
        options.bits = bits;
        EXPECT_EQ(decode(encode(layer, options)).mesh.faces.size(), layer.mesh.faces.size());
    }
}

/// A bumpy square of 25 vertices, one of which is in no face, and a fin on one of its edges.
Layer kept_layer() {
    Mesh mesh;
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 5; ++x) mesh.positions.emplace_back(x, y, 0.125 * ((3 * x + 5 * y + x * y) % 7));
    for (Index y = 0; y < 4; ++y)
        for (Index x = 0; x < 4; ++x) {
            const Index v = 5 * y + x;
            mesh.faces.push_back({v, v + 1, v + 6});
            if (v != 18) mesh.faces.push_back({v + 6, v + 5, v});
        }
    mesh.positions.emplace_back(1.5, 1, 2.25);
    mesh.positions.emplace_back(7, 7, 7);
    mesh.faces.push_back({6, 7, 25});
    return with_attributes(mesh);
}

/// White, of quality 0 or NaN: the same at every vertex, but for what the first has if it differs.
Layer uniform_layer(const Mesh& mesh, double quality, double first_quality) {
    Layer layer = layer_of(mesh);
    Attribute color{AttributeKind::color, "", 4, {}}, plain{AttributeKind::quality, "", 1, {}};
    Attribute flow{AttributeKind::point, "flow", 3, {}};
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        color.values.insert(color.values.end(), {255, 254, 0, 255});
        plain.values.push_back(v == 0 ? first_quality : quality);
        flow.values.insert(flow.values.end(), {1.0 / 3, -0.0, 1e300});
    }
    layer.attributes = {color, plain, flow};
    return layer;
}

Layer kept_layer_of_one_color() {
    Layer layer = kept_layer();
    layer.attributes[0] = uniform_layer(layer.mesh, 0, 0).attributes[0];
    return layer;
}

TEST(Stream, AttributesThatAreTheSameAtEveryVertexAreStoredOnce) {
    EncodeOptions options;
    options.exact = options.keep_order = true;
    const double none = std::numeric_limits<double>::quiet_NaN();
    const Mesh mesh = shapes::torus(20, 20);
    const std::size_t bare = encode(layer_of(mesh), options).size();
    for (const double first : {0.0, -0.0, none}) {
        const Layer layer = uniform_layer(mesh, first, first);
        const Bytes bytes = encode(layer, options);
        EXPECT_LE(bytes.size(), bare + 60);  // their numbers have 4 + 1 + 24 bytes
        expect_same(decode(bytes, {}), layer);
        stream::Limits few;
        few.vertices = 50;
        const Layer prefix = decode(bytes, few);
        ASSERT_LT(prefix.mesh.positions.size(), 60U);
        for (const std::size_t i : {std::size_t{0}, prefix.mesh.positions.size() - 1})
            EXPECT_EQ(prefix.attributes[0].values[4 * i + 1], 254);
    }
    for (const double first : {-0.0, none, 1.0}) {
        const Layer layer = uniform_layer(mesh, 0, first);
        expect_same(decode(encode(layer, options)), layer);
    }
}

TEST(Stream, AttributesWithoutEndAreRefused) {
    Layer layer = layer_of(shapes::torus(6, 6));
    layer.attributes.assign(256, {AttributeKind::scalar, "s", 1, std::vector<double>(36, 1.5)});
    EXPECT_EQ(decode(encode(layer, {})).attributes.size(), 256U);
    layer.attributes.push_back(layer.attributes[0]);
    EXPECT_THROW(encode(layer, {}), InputError);
}

Bytes kept_file(const std::string& name) {
    std::ifstream in(std::string(MULTIRES_TEST_DATA) + "/" + name, std::ios::binary);
    return Bytes(std::istreambuf_iterator<char>(in), {});
}

/// A sheet of n by n vertices.
/// @param place  Vec3(Index i, Index j)
template <class Place>
Mesh sheet(Index n, const Place& place) {
    Mesh mesh;
    for (Index i = 0; i < n; ++i)
        for (Index j = 0; j < n; ++j) mesh.positions.push_back(place(i, j));
    for (Index i = 0; i + 1 < n; ++i)
        for (Index j = 0; j + 1 < n; ++j) {
            const Index at = i * n + j;
            mesh.faces.push_back({at, at + n, at + 1});
            mesh.faces.push_back({at + 1, at + n, at + n + 1});
        }
    return mesh;
}

/// Large enough for models to learn from; all coordinates are dyadic.
Layer kept_sheet() {
    return layer_of(sheet(16, [](Index i, Index j) {
        return Vec3(i + (7 * i + 3 * j) % 5 / 8.0, j + i * j % 3 / 8.0, i * i % 7 * j / 16.0);
    }));
}

/// Files of version 1 stay readable: this one was written when the version was made.
TEST(Stream, TheFileKeptOfVersion1DecodesAsEver) {
    expect_same(decode(kept_file("stream_version_1_exact.mrm")), kept_layer());
    const Layer rounded = decode(kept_file("stream_version_1.mrm"));
    EXPECT_EQ(rounded.mesh.faces.size(), kept_layer().mesh.faces.size());
    EXPECT_EQ(rounded.mesh.positions.size(), 27U);
    expect_same(decode(kept_file("stream_version_1_sheet.mrm")), kept_sheet());
}

/// The first version that stores uniform attributes once.
TEST(Stream, TheFileKeptOfVersion2DecodesAsEver) {
    expect_same(decode(kept_file("stream_version_2_exact.mrm")), kept_layer_of_one_color());
}

/// The first version with experts.
TEST(Stream, TheFileKeptOfVersion3DecodesAsEver) {
    expect_same(decode(kept_file("stream_version_3_exact.mrm")), kept_layer_of_one_color());
    expect_same(decode(kept_file("stream_version_3_sheet.mrm")), kept_sheet());
}

/// Where vertices lie as on a grid, their places are found again.
TEST(Stream, GridsTakeFewerBits) {
    const auto size = [](double jitter) {
        const Mesh mesh = sheet(40, [&](Index i, Index j) {
            const double x = (37 * i + 11 * j + i * j) % 17 / 16.0 - 0.5,
                         y = (23 * i + 29 * j + 3 * i * j) % 19 / 18.0 - 0.5;
            return Vec3(i + 0.5 * j + jitter * x, 0.866 * j + jitter * y, 0.01 * i * j);
        });
        return static_cast<double>(encode(layer_of(mesh), {}).size());
    };
    EXPECT_LT(size(0), 0.75 * size(0.5));  // 0.68 when this was written, 0.85 before there were experts
}

/// Sizes must not creep up unnoticed; small meshes pay for what the models have to learn.
TEST(Stream, FilesAreSmall) {
    const Mesh mesh = shapes::torus(60, 40);
    const double size = static_cast<double>(encode(layer_of(mesh), {}).size());
    EXPECT_LT(8 * size / 2400, 20);  // 18.6 when this was written; packed as 36 + 2 * 36 bits: 108
}

TEST(Stream, TwoNumbersSideBySideAreWhatTheyAreOneByOne) {
    using stream::Two;
    const auto expect_same = [](Two both, double a, double b) {
        EXPECT_EQ(both.first(), a);
        EXPECT_EQ(both.second(), b);
    };
    for (int i = 0; i < 2000; ++i) {
        const double x = std::pow(1.03, i - 1000), y = 100 * std::sin(1.7 * i);
        expect_same(exponential(Two(y, x)), stream::exponential(y), stream::exponential(x));
        expect_same(logarithm(Two(x, y * y)), stream::logarithm(x), stream::logarithm(y * y));
        expect_same(where_positive(Two(x, y), Two(y, x)), y > 0 ? x : 0, y);
        expect_same(where_positive(Two(x, y), Two(y, x), Two(1, 2)), y > 0 ? x : 1, y);
        std::array<std::int64_t, 2> steps{};
        for (const int per_octave : {2, 3}) {
            store_octaves(Two(x, 1 / x), per_octave, 5000, steps.data());
            EXPECT_EQ(steps[0], stream::octave_steps(x, per_octave) + 5000);
            EXPECT_EQ(steps[1], stream::octave_steps(1 / x, per_octave) + 5000);
        }
        store_whole(Two(y, 2 * y), steps.data());
        EXPECT_EQ(static_cast<std::int32_t>(steps[0]), static_cast<std::int32_t>(y));
        EXPECT_EQ(static_cast<std::int32_t>(steps[1]), static_cast<std::int32_t>(2 * y));
    }
    const double none = std::numeric_limits<double>::quiet_NaN();
    expect_same(larger(Two(none, 3), 2), 2, 3);
    expect_same(smaller(Two(none, 3), 2), 2, 2);
}

TEST(Stream, RegressionsSideBySideAreWhatTheyAreOneByOne) {
    const std::array<double, 3> start = {0.5, 0, 1};
    stream::Regression<3, stream::Two> both(start);
    stream::Regression<3> first(start), second(start);
    for (int i = 0; i < 200; ++i) {
        // The second one's numbers are none at first, so that its weights stay.
        const double x = std::sin(1.3 * i), y = i < 20 ? std::numeric_limits<double>::quiet_NaN() : std::cos(0.7 * i);
        both.learn({1, stream::Two(x, y), 2}, stream::Two(3 * x, i)), both.end_sample();
        first.learn({1, x, 2}, 3 * x), first.end_sample();
        second.learn({1, y, 2}, i), second.end_sample();
        const stream::Two out = both.predict({1, 2, 3});
        EXPECT_EQ(out.first(), first.predict({1, 2, 3}));
        EXPECT_EQ(out.second(), second.predict({1, 2, 3}));
    }
    EXPECT_NEAR(first.predict({0, 1, 0}), 3, 0.01);
    EXPECT_EQ(second.predict({1, 2, 3}), 3.5);
}

TEST(Stream, ExponentialAndLogarithmAreThoseOfTheLibrary) {
    for (double x = -30; x <= 30; x += 0.37) {
        EXPECT_NEAR(stream::exponential(x) / std::exp(x), 1, 1e-6);
        EXPECT_NEAR(stream::logarithm(std::exp(x)), x / std::log(2.0), 1e-6);
    }
}

TEST(Stream, KnowsMachinedParts) {
    const auto planes = [](const Mesh& mesh) {
        std::vector<stream::Cell> cells;
        for (const Vec3& p : mesh.positions) {
            const auto cell = [](double x) { return static_cast<std::int32_t>(std::lround(1000 * x)); };
            cells.push_back({cell(p.x()), cell(p.y()), cell(p.z())});
        }
        return stream::Plan(mesh.faces, cells).planes();
    };
    EXPECT_TRUE(planes(shapes::block(12)));
    EXPECT_TRUE(planes(shapes::plane(12)));
    EXPECT_FALSE(planes(shapes::scan(1000)));
    EXPECT_FALSE(planes(shapes::irregular_sphere(1000)));
}

}  // namespace
}  // namespace multires
