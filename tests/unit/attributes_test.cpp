#include "attribute_fixtures.h"

#include <cmath>
#include <limits>

namespace multires {

using namespace fixtures;

namespace {

constexpr Operator operators[] = {Operator::umbrella,          Operator::cotangent,
                                  Operator::cotangent_clamped, Operator::cotangent_delaunay,
                                  Operator::second_difference, Operator::second_difference_flaps};

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
    return largest;
}

class AttributeOperator : public testing::TestWithParam<Operator> {};

TEST_P(AttributeOperator, KeepsConstantsExactly) {
    for (const auto& [name, mesh] : every_class()) {
        const Layer layer = with_everything(mesh, [](Index, int k) { return 0.1 * (k + 1); });
        for (const bool light : {false, true}) {
            AttributeRelaxationOptions options;
            options.what = everything();
            options.op = GetParam();
            options.iterations = 5;
            options.keep_outline = false;
            options.linear_light = light;
            const Result result = relax(layer, options);
            ASSERT_EQ(result.attributes.size(), 5u);
            for (std::size_t i = 0; i < 5; ++i)
                EXPECT_EQ(result.attributes[i].values, layer.attributes[i].values) << name;
            for (std::size_t c = 0; c < layer.wedges.size(); ++c) {
                EXPECT_EQ((*result.wedges)[c].u, layer.wedges[c].u) << name;
                EXPECT_EQ((*result.wedges)[c].v, layer.wedges[c].v) << name;
            }
        }
    }
}

TEST_P(AttributeOperator, KeepsLinearFunctionsOnPlanes) {
    if (GetParam() == Operator::umbrella || GetParam() == Operator::cotangent_clamped) return;  // do not promise it
    const Mesh mesh = shapes::plane(20);
    const Layer layer = with_everything(mesh, [&](Index v, int k) {
        const Vec3& p = mesh.positions[v];
        return 100 + (30 + 5 * k) * p.x() - 20 * p.y();
    });
    AttributeRelaxationOptions options;
    options.what = everything();
    options.op = GetParam();
    options.iterations = 20;
    options.keep_outline = false;
    const Result result = relax(layer, options);
    for (std::size_t i = 0; i < 5; ++i)
        EXPECT_LT(largest_difference(result.attributes[i].values, layer.attributes[i].values), 1e-9);
    for (std::size_t c = 0; c < layer.wedges.size(); ++c) EXPECT_NEAR((*result.wedges)[c].u, layer.wedges[c].u, 1e-9);
}

TEST_P(AttributeOperator, DoesTheSameOnEveryChannel) {
    const Mesh mesh = shapes::irregular_sphere(300);
    const Layer layer = with_everything(mesh, [](Index v, int) { return random_value(v, 0); });
    AttributeRelaxationOptions options;
    options.what = everything();
    options.op = GetParam();
    options.iterations = 1;
    const Result result = relax(layer, options);
    for (const Attribute& a : result.attributes)
        for (std::size_t i = 0; i < a.values.size(); ++i) {
            const double x = result.attributes[1].values[i / a.width];
            EXPECT_EQ(a.values[i], a.kind == AttributeKind::color ? std::clamp(x, 0.0, 255.0) : x);
        }
    for (std::size_t c = 0; c < result.wedges->size(); ++c)  // the cut mesh has other numbers: sums in other order
        EXPECT_NEAR((*result.wedges)[c].u, result.attributes[1].values[mesh.faces[c / 3][c % 3]], 1e-9);
}

INSTANTIATE_TEST_SUITE_P(RelaxAttributes, AttributeOperator, testing::ValuesIn(operators));

TEST(RelaxAttributes, StaysInRangeAndLowersTheDirichletEnergy) {
    const Mesh mesh = shapes::irregular_sphere(1000);
    Layer layer = with_everything(mesh, random_value);
    // Weights in [0, 1] and symmetric but for the sums of the rows: the umbrella's energy is over the edges.
    const auto energy = [&](const std::vector<double>& f) {
        double sum = 0;
        for (const Face& face : mesh.faces)
            for (int k = 0; k < 3; ++k) sum += std::pow(f[face[k]] - f[face[(k + 1) % 3]], 2);
        return sum;
    };
    AttributeRelaxationOptions options;
    options.what.quality = true;
    const auto bounds = std::minmax_element(layer.attributes[1].values.begin(), layer.attributes[1].values.end());
    const double low = *bounds.first, high = *bounds.second;
    for (const Operator op : {Operator::umbrella, Operator::cotangent_delaunay}) {
        options.op = op;
        Layer now = layer;
        for (int i = 0; i < 20; ++i) {
            const double before = energy(now.attributes[1].values);
            now.attributes[1] = relax(now, options).attributes[0];
            EXPECT_LT(energy(now.attributes[1].values), before) << "step " << i;
        }
        for (const double x : now.attributes[1].values) {
            EXPECT_GE(x, low);
            EXPECT_LE(x, high);
        }
    }
}

TEST(RelaxAttributes, IterationsAreStepsAndColoursAreNotRoundedBetweenThem) {
    Layer layer = with_everything(shapes::irregular_sphere(300), random_value);
    AttributeRelaxationOptions options;
    options.what.color = true;
    options.iterations = 7;
    const Attribute at_once = relax(layer, options).attributes[0];
    options.iterations = 1;
    for (int i = 0; i < 7; ++i) layer.attributes[0] = relax(layer, options).attributes[0];
    EXPECT_LT(largest_difference(at_once.values, layer.attributes[0].values), 1e-10);
    int fractions = 0;
    for (const double x : at_once.values) fractions += x != std::round(x);
    EXPECT_GT(fractions, 1000) << "rounding is for the host";
}

TEST(RelaxAttributes, DoesNotDependOnThreads) {
    const Layer layer = with_everything(shapes::irregular_sphere(5000), random_value);
    AttributeRelaxationOptions options;
    options.what = everything();
    options.iterations = 3;
    std::vector<Result> results;
    for (const int count : {1, 3}) {
        const Threads threads(count);
        results.push_back(relax(layer, options));
    }
    for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(results[0].attributes[i].values, results[1].attributes[i].values);
    for (std::size_t c = 0; c < layer.wedges.size(); ++c)
        EXPECT_EQ((*results[0].wedges)[c].u, (*results[1].wedges)[c].u);
}

TEST(RelaxAttributes, AveragesLightIfAskedTo) {
    // One white vertex among black ones: half the light is 188 of 255.
    Layer layer = with_everything(shapes::fan(6), [](Index v, int) { return v == 0 ? 255.0 : 0.0; });
    AttributeRelaxationOptions options;
    options.what.color = true;
    options.strength = 0.5;
    EXPECT_NEAR(relax(layer, options).attributes[0].values[0], 127.5, 1e-9);
    options.linear_light = true;
    const Attribute light = relax(layer, options).attributes[0];
    EXPECT_NEAR(light.values[0], 187.516, 1e-3);
    EXPECT_NEAR(light.values[3], 127.5, 1e-9) << "alpha is no light";
}

TEST(RelaxAttributes, LightCodeIsInvertible) {
    for (int i = -20; i < 300; ++i) EXPECT_NEAR(encode_light(decode_light(i)), i, 1e-3);
    for (int i = 0; i < 256; ++i) EXPECT_EQ(std::lround(encode_light(decode_light(i))), i);
    EXPECT_EQ(decode_light(255), 255);
    EXPECT_EQ(decode_light(0), 0);
}

TEST(RelaxAttributes, HonoursTheRegion) {
    Layer layer = with_everything(shapes::irregular_sphere(1000), random_value);
    layer.attributes[1] = attribute(layer.mesh, AttributeKind::quality, 1,
                                    [&](Index v, int) { return layer.mesh.positions[v].x() > 0 ? 0.5 : -3.0; });
    AttributeRelaxationOptions options;
    options.what.color = options.what.wedge_texcoord = true;
    options.region.selected = true;
    EXPECT_THROW(relax(layer, options), InputError) << "nothing is selected";
    layer.selected_face.assign(layer.mesh.faces.size(), 0);
    layer.selected_face[17] = 1;
    options.iterations = 4;
    Result result = relax(layer, options);
    const Face& chosen = layer.mesh.faces[17];
    const auto is_chosen = [&](Index v) { return std::find(chosen.begin(), chosen.end(), v) != chosen.end(); };
    for (std::size_t i = 0; i < result.attributes[0].values.size(); ++i)
        EXPECT_EQ(result.attributes[0].values[i] != layer.attributes[0].values[i],
                  is_chosen(static_cast<Index>(i / 4)));
    for (std::size_t c = 0; c < layer.wedges.size(); ++c)
        EXPECT_EQ((*result.wedges)[c].u != layer.wedges[c].u, is_chosen(layer.mesh.faces[c / 3][c % 3]));

    options.iterations = 1;
    options.region = {};
    const std::vector<double> full = relax(layer, options).attributes[0].values;
    options.region.quality_mask = true;
    const std::vector<double> soft = relax(layer, options).attributes[0].values;
    for (std::size_t i = 0; i < full.size(); ++i) {
        const double old = layer.attributes[0].values[i], share = layer.mesh.positions[i / 4].x() > 0 ? 0.5 : 0;
        EXPECT_NEAR(soft[i], old + share * (full[i] - old), 1e-10);
    }
}

TEST(RelaxAttributes, NamesWhatIsMissingOrNotANumber) {
    const auto message = [](const Layer& layer, const AttributeRelaxationOptions& options) -> std::string {
        try {
            relax(layer, options);
        } catch (const InputError& e) {
            return e.what();
        }
        return "";
    };
    Layer bare;
    bare.mesh = shapes::icosphere(3);
    const Layer full = with_everything(bare.mesh, random_value);
    const auto only = [](bool AttributeChoice::*what) {
        AttributeRelaxationOptions options;
        options.what.*what = true;
        return options;
    };
    const std::pair<const char*, bool AttributeChoice::*> kinds[] = {
        {"color", &AttributeChoice::color},
        {"quality", &AttributeChoice::quality},
        {"texcoord", &AttributeChoice::texcoord},
        {"wedge_texcoord", &AttributeChoice::wedge_texcoord},
        {"custom", &AttributeChoice::custom}};
    for (std::size_t i = 0; i < std::size(kinds); ++i) {
        const auto [name, member] = kinds[i];
        EXPECT_EQ(message(bare, only(member)).find(name), 0u) << message(bare, only(member));
        Layer broken = full;
        if (i == 3)
            broken.wedges[7].v = std::numeric_limits<double>::infinity();
        else
            broken.attributes[std::min<std::size_t>(i, 3)].values[5] = std::numeric_limits<double>::quiet_NaN();
        EXPECT_EQ(message(broken, only(member)).find(name), 0u) << message(broken, only(member));
    }
    EXPECT_NE(message(full, {}), "") << "nothing chosen";
    AttributeRelaxationOptions options = only(&AttributeChoice::custom);
    options.what.custom_names = "flow, cold";
    EXPECT_EQ(message(full, options).find("custom_names"), 0u);
    options.what.custom_names = " heat ,flow";
    EXPECT_EQ(relax(full, options).attributes.size(), 2u);
    options.what.custom_names = "flow";
    EXPECT_EQ(relax(full, options).attributes.at(0).name, "flow");
    for (auto change : {+[](AttributeRelaxationOptions& o) { o.iterations = 0; },
                        +[](AttributeRelaxationOptions& o) { o.strength = 0; },
                        +[](AttributeRelaxationOptions& o) { o.strength = NAN; },
                        +[](AttributeRelaxationOptions& o) { o.corner_angle = 181; }}) {
        AttributeRelaxationOptions wrong = only(&AttributeChoice::color);
        change(wrong);
        EXPECT_NE(message(full, wrong), "");
    }
}

TEST(RelaxAttributes, DefaultIsTheFirstAttributeThereIs) {
    Layer layer;
    layer.mesh = shapes::icosphere(2);
    EXPECT_TRUE(default_choice(nullptr).color);
    EXPECT_TRUE(default_choice(&layer).color);
    const Layer full = with_everything(layer.mesh, random_value);
    EXPECT_TRUE(default_choice(&full).color && !default_choice(&full).quality);
    layer.attributes = {full.attributes[4]};
    EXPECT_TRUE(default_choice(&layer).custom);
    layer.attributes.push_back(full.attributes[2]);
    EXPECT_TRUE(default_choice(&layer).texcoord);
    layer.wedges = full.wedges;
    EXPECT_TRUE(default_choice(&layer).wedge_texcoord);
    layer.attributes.push_back(full.attributes[1]);
    EXPECT_TRUE(default_choice(&layer).quality && !default_choice(&layer).wedge_texcoord);
}

// Hosts say that a mesh has colours, all white, when nobody gave it any.
TEST(RelaxAttributes, DefaultPassesOverWhatIsTheSameEverywhere) {
    Layer layer;
    layer.mesh = shapes::icosphere(2);
    const auto white = [](Index, int) { return 255.0; };
    layer.attributes = {attribute(layer.mesh, AttributeKind::color, 4, white),
                        attribute(layer.mesh, AttributeKind::quality, 1, random_value)};
    EXPECT_TRUE(default_choice(&layer).quality && !default_choice(&layer).color);
    layer.attributes[0].values.back() = 254;
    EXPECT_TRUE(default_choice(&layer).color);
    layer.attributes = {attribute(layer.mesh, AttributeKind::quality, 1, white)};
    EXPECT_TRUE(default_choice(&layer).quality);
}

}  // namespace
}  // namespace multires
