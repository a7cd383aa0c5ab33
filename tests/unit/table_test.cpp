#include "all_tables.h"
#include "attribute_fixtures.h"
#include "given.h"
#include "shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <regex>
#include <set>
#include <utility>

// What every filter table must keep to, whatever the filter does.

using namespace multires::plugin;

namespace {

struct Row {
    const Plugin* plugin;
    const Filter* filter;
};

std::vector<Row> rows() {
    std::vector<Row> all;
    for (const Plugin* plugin : all_tables())
        for (const Filter& filter : plugin->filters) all.push_back({plugin, &filter});
    return all;
}

class TableRow : public testing::TestWithParam<Row> {
protected:
    const Filter& filter() const { return *GetParam().filter; }
};

void check_range(const Parameter& p, double value) {
    const Range range = p.hint.range.value_or(Range());
    EXPECT_LT(range.least, range.most) << p.name;
    EXPECT_GE(value, range.least) << p.name;
    EXPECT_LE(value, range.most) << p.name;
    if (!p.hint.slider) return;
    EXPECT_TRUE(std::isfinite(range.least) && std::isfinite(range.most)) << p.name << ": a slider needs two ends";
}

void check_choice(const std::string& name, const Choice& choice) {
    EXPECT_GE(choice.names.size(), 2u) << name;
    EXPECT_GE(choice.value(), 0) << name;
    EXPECT_LT(choice.value(), static_cast<int>(choice.names.size())) << name;
    EXPECT_EQ(std::set<std::string>(choice.names.begin(), choice.names.end()).size(), choice.names.size()) << name;
}

void check_parameters(const Filter& filter, const multires::Layer* layer) {
    static const std::regex snake_case("[a-z][a-z0-9]*(_[a-z0-9]+)*");
    std::set<std::string> names;
    const Call call = filter.call(layer);
    for (const Parameter& p : call.parameters) {
        EXPECT_TRUE(std::regex_match(p.name, snake_case)) << p.name;
        EXPECT_TRUE(names.insert(p.name).second) << p.name << " is there twice";
        EXPECT_FALSE(p.hint.label.empty()) << p.name;
        EXPECT_FALSE(p.hint.tooltip.empty()) << p.name;
        const auto no_range = [&](const auto&) { EXPECT_FALSE(p.hint.range || p.hint.slider) << p.name; };
        std::visit(Overloaded{
                       [&](int* value) { check_range(p, *value); },
                       [&](double* value) { check_range(p, *value); },
                       [&](const Angle& angle) { check_range(p, *angle.degrees); },
                       [&](const Choice& choice) { check_choice(p.name, choice), no_range(choice); },
                       [&](const Direction& d) { EXPECT_NEAR(d.unit->norm(), 1, 1e-15) << p.name, no_range(d); },
                       no_range,
                   },
                   p.field);
    }
}

/// Defaults by name, as text.
std::map<std::string, std::string> defaults(const Filter& filter, const multires::Layer* layer) {
    std::map<std::string, std::string> out;
    for (const Declared& d : declared(filter, layer)) out[d.name] = std::to_string(d.value);
    return out;
}

multires::Layer tetrahedron() {
    multires::Layer layer;
    layer.mesh.positions = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}};
    layer.mesh.faces = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    return layer;
}

}  // namespace

TEST(Tables, NamesAreUnique) {
    std::set<std::string> names, python_names, plugins;
    for (const Plugin* plugin : all_tables()) {
        EXPECT_TRUE(plugins.insert(plugin->name).second) << plugin->name;
        EXPECT_FALSE(plugin->filters.empty()) << plugin->name;
    }
    for (const Row& row : rows()) {
        EXPECT_TRUE(names.insert(row.filter->name).second) << row.filter->name;
        EXPECT_TRUE(python_names.insert(row.filter->python_name).second) << row.filter->python_name;
    }
}

TEST_P(TableRow, NameBeginsWithTheGroup) {
    EXPECT_TRUE(std::regex_match(filter().name, std::regex("Multiresolution: [A-Z0-9].*"))) << filter().name;
    EXPECT_EQ(filter().name.find('&'), std::string::npos) << "hosts strip it to find the action";
}

TEST_P(TableRow, PythonNameStartsWithAVerb) {
    const std::regex verb_first("(apply|compute|create|generate|get|meshing|set|transfer)(_[a-z0-9]+)+");
    EXPECT_TRUE(std::regex_match(filter().python_name, verb_first)) << filter().python_name;
}

TEST_P(TableRow, InfoEndsWithACitation) {
    // Authors in italics, title in bold, then a year, as MeshLab's own filters have it.
    const std::regex citation("[\\s\\S]+<i>[\\s\\S]+</i>[\\s\\S]*<b>[\\s\\S]+</b>[\\s\\S]*(19|20)[0-9]{2}[\\s\\S]*");
    EXPECT_TRUE(std::regex_match(filter().info, citation)) << filter().info;
}

TEST_P(TableRow, MasksHoldPartsThatMakeSense) {
    constexpr std::uint32_t all = (edge_selection << 1) - 1;
    constexpr std::uint32_t attributes = vertex_quality | vertex_color | vertex_texcoord | wedge_texcoord;
    EXPECT_EQ(filter().needs & ~(faces | closed_seams | attributes), 0u);
    EXPECT_EQ(filter().reads & ~(attributes | custom_attributes), 0u);
    EXPECT_EQ(filter().changes & ~all, 0u);
    EXPECT_TRUE(filter().call);
}

TEST_P(TableRow, DefaultsWithoutAMeshAreInRange) { check_parameters(filter(), nullptr); }

TEST_P(TableRow, DefaultsForATetrahedronAreInRange) {
    const multires::Layer layer = tetrahedron();
    check_parameters(filter(), &layer);
}

TEST_P(TableRow, DefaultsThatDependOnTheMeshAreMarkedAsDerived) {
    const multires::Layer small = tetrahedron();
    multires::Layer large =
        multires::fixtures::with_everything(multires::shapes::scan(5000, {}), multires::fixtures::random_value);
    large.selected_vertex.assign(large.mesh.positions.size(), 1);
    const Call call = filter().call(nullptr);
    for (const Parameter& p : call.parameters) {
        std::set<std::string> values;
        for (const multires::Layer* layer :
             {&small, &std::as_const(large), static_cast<const multires::Layer*>(nullptr)})
            values.insert(defaults(filter(), layer)[p.name]);
        EXPECT_TRUE(values.size() == 1 || p.hint.derived) << p.name;
    }
}

INSTANTIATE_TEST_SUITE_P(AllPlugins, TableRow, testing::ValuesIn(rows()),
                         [](const auto& info) { return info.param.filter->python_name; });
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(TableRow);
